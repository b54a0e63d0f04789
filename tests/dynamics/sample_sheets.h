// Small sheets for the tests of the dynamics, built below the public API so that single stages can run.
#pragma once

#include "dynamics/dynamics.h"
#include "support/support.h"

/// A shell with its state and plan, and empty surroundings.
typedef struct Bench {
    Memory memory;
    SheetSource source;
    Shell shell;
    State state;
    DynamicsPlan *plan;
    DynamicsSettings settings;
    PinList pins;
    ColliderList colliders;
    SingeWindDef wind;
    Pool *pool;
    DynamicsCounters counters;
    SingeError error;
} Bench;

typedef TestMesh Quads;

/// nx × ny cells of sx × sy m in the x-y plane from the origin; wrap_x closes it to a cylinder about y.
Quads quads_grid(uint32_t nx, uint32_t ny, float sx, float sy, bool wrap_x);

/// Builds everything; frees the quads. Asserts success. u and v go from 0 to 1 along x and y, and so does the attribute
/// "along" along x.
Bench bench_open(Quads quads, const SingeMaterialDef *material, int threads);
/// The same with room for creases.
Bench bench_open_creased(Quads quads, const SingeMaterialDef *material, int threads);
/// The same as bench_open with a material without drag and damping, on one thread.
Bench bench_open_plain(Quads quads);
SingeMaterialDef bench_plain_material(void);
/// Adds the only collider.
void bench_add_collider(Bench *bench, SingeColliderDef def, uint32_t count, const SingePoseKey *keys);
void bench_close(Bench *bench);
#define OwnBench OWNED(bench_close) Bench

/// What a step begins with.
void bench_prepare(Bench *bench);
/// One step of h seconds; asserts success.
void bench_step(Bench *bench, float h);
/// m, of a cell's centre over its corners; negative where the cell is inverted.
double bench_height(const Bench *bench, uint32_t cell);

/// Weight of a spring in the strands' layout.
float bench_weight(const Bench *bench, SingeColour colour, uint32_t spring);
