// Scenes that several tests of the step use.
#pragma once

#include "support/support.h"

/// A material that ignites, burns through and falls within tens of steps.
SingeMaterialDef scene_quick_material(void);

/// A simulation with everything in it: two sheets, one with an unused vertex; sources of all kinds; colliders of
/// all kinds, moving and hot; pins by points, by vertices and on a path; gusts; gas. Burning from the first steps on.
typedef struct TestScene {
    SingeSim *sim;
    SingeSheetId sheets[2];
    SingeSourceId ball, picture, spot, callback;
    SingeColliderId plane, sphere, box, capsule, mesh, heightfield;
    SingePinId points, vertices;
} TestScene;

void scene_end(TestScene *scene);
#define OwnTestScene OWNED(scene_end) TestScene

/// Builds it up to the commit and all objects. On failure what was made is in scene->sim (NULL when not
/// even that), for the caller to destroy. `cells` is the larger sheet's side.
SingeResult scene_build(const SingeSimDef *def, uint32_t cells, TestScene *scene);

/// The same with all objects before the commit.
SingeResult scene_build_early(const SingeSimDef *def, uint32_t cells, TestScene *scene);

/// The same, failing the test on failure. NULL: the default Def with a larger time step.
TestScene scene_make(const SingeSimDef *def, uint32_t cells);
SingeSimDef scene_def(void);

/// Makes every call that changes a simulation, and some that fail, with steps between them.
void scene_every_call(const TestScene *scene);

/// The callback source's function: a flux that grows with position and time; *context is a float, W/m2.
void scene_flux(void *context, const struct SingeView *view, float *flux, float *conductance,
                float *conductance_temperature);
