// Adds a scene's objects to a simulation, one by one: for a simulation from the start (build_sim.c) and for one that goes
// on with other objects (branch.c).
#pragma once

#include "scene/scene.h"

/// The construction as far as it has come. A function that adds an object leaves the library's error in `error`.
typedef struct SceneBuilder {
    const Scene *scene;
    const SceneAssets *assets;
    SingeSim *sim;
    SingeSheetId *sheets;
    SingeError *error;
} SceneBuilder;

SINGE_NODISCARD SingeResult builder_add_source(const SceneBuilder *builder, uint32_t index);
SINGE_NODISCARD SingeResult builder_add_collider(const SceneBuilder *builder, uint32_t index);
SINGE_NODISCARD SingeResult builder_add_pin(const SceneBuilder *builder, uint32_t index);
