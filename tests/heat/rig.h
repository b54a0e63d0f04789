// A sheet of nx by ny cells with everything the heat stage needs, for its tests.
#pragma once

#include "support/test.h"

#include "heat/heat.h"

/// Moves a vertex of the flat grid; may be NULL.
typedef void RigShape(float position[3], int column, int row);

typedef struct RigDef {
    int nx, ny;
    float dx, dy;
    SingeMaterialDef material;
    HeatSettings settings;
    RigShape *shape;
    float size; ///< of the sheet over that at rest, where a test moves it
} RigDef;

typedef struct Rig {
    Memory memory;
    int nx, ny;
    Shell shell;
    State state;
    HeatPlan *plan;
    HeatSettings settings;
    Pool *pool;
    SourceList sources;
    ColliderList colliders;
    float h;
    HeatCounters counters;
    SingeError error;
    double removed; ///< J, that left with particles
} Rig;

/// A sheet without losses, of diffusivity 1e-4 m2/s, F = 1, in a plane z = 0; ambient 293 K, tolerance 1e-7.
RigDef rig_default(int nx, int ny, float dx, float dy);
Rig rig_open(const RigDef *def);
/// Frees everything and fails when something was leaked.
void rig_close(Rig *rig);
#define OwnRig OWNED(rig_close) Rig
/// One heat step, which may fail; time stays.
SingeResult rig_try_step(Rig *rig);
/// One heat step that must succeed; time goes on.
void rig_step(Rig *rig);
/// Adds a source that must be good.
void rig_source(Rig *rig, const SingeSourceDef *def);
/// Takes a particle and its springs away, and its enthalpy to `removed`.
void rig_remove(Rig *rig, uint32_t particle);

static inline float *rig_position(const Rig *rig, uint32_t i) { return rig->shell.rest_position[i]; }
static inline uint32_t rig_vertex(const Rig *rig, int column, int row) {
    return (uint32_t)(row * (rig->nx + 1) + column);
}
static inline uint32_t rig_centre(const Rig *rig, int column, int row) {
    return rig->shell.vertex_count + (uint32_t)(row * rig->nx + column);
}

/// Sum of weight * (T - 293) over all particles: 0 areas, 1 capacities.
double rig_content(const Rig *rig, int weight);

/// A repeatable number in [0, 1).
float rig_random(uint32_t a, uint32_t b);

#define CHECK_NEAR(value, expected, tolerance)                                                        \
    do {                                                                                              \
        double value_ = (value), expected_ = (expected), tolerance_ = (tolerance);                    \
        if (!(fabs(value_ - expected_) <= tolerance_))                                                \
            fail_msg("%s is %.9g, expected %.9g within %.3g", #value, value_, expected_, tolerance_); \
    } while (0)
