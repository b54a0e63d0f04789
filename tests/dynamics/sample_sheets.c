#include "sample_sheets.h"

#include "dynamics/dynamics_plan.h"

#include <assert.h>

Quads quads_grid(uint32_t nx, uint32_t ny, float sx, float sy, bool wrap_x) {
    if (!wrap_x) return test_grid(nx, ny, sx, sy);
    Quads quads = test_cylinder(nx, ny, sx * (float)nx / (2 * 3.14159265f), sy * (float)ny);
    for (uint32_t v = 0; v < quads.vertex_count; v++) {
        float *p = quads.positions + 3 * v, y = p[1];
        p[1] = p[2], p[2] = -y;
    }
    return quads;
}

static Bench open_bench(Quads quads, const SingeMaterialDef *material, int threads, bool creases) {
    Bench bench = {.memory = memory_make((SingeAllocator){0}), .wind = singe_default_wind()};
    bench.settings = (DynamicsSettings){.gravity = {0, 0, -9.81f},
                                        .air_density = 1.2f,
                                        .solver = singe_default_solver(),
                                        .thread_count = threads,
                                        .time_step = 1.0f / 480};
    SingeSheetDef def = test_sheet(&quads);
    if (material) def.material = *material;
    float *uv = malloc(2 * quads.vertex_count * sizeof *uv), *along = malloc(quads.vertex_count * sizeof *along);
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < 2 * quads.vertex_count; i++) {
        float x = quads.positions[3 * (i / 2) + i % 2];
        low[i % 2] = fminf(low[i % 2], x), high[i % 2] = fmaxf(high[i % 2], x);
    }

    for (uint32_t i = 0; i < 2 * quads.vertex_count; i++) {
        uv[i] = (quads.positions[3 * (i / 2) + i % 2] - low[i % 2]) / fmaxf(high[i % 2] - low[i % 2], 1e-6f);
        if (i % 2 == 0) along[i / 2] = uv[i];
    }

    SingeAttribute attribute = {"along", along};
    def.uv = uv, def.attribute_count = 1, def.attributes = &attribute;
    assert_int_equal(sheet_source_create(&bench.memory, &def, &bench.source, &bench.error), SINGE_OK);
    assert_int_equal(shell_create(&bench.memory, &bench.source, 1, &bench.shell, &bench.error), SINGE_OK);
    bench.shell.creases = bench.settings.solver.creases = creases;
    assert_int_equal(state_create(&bench.memory, &bench.shell, &bench.state), SINGE_OK);
    assert_int_equal(dynamics_plan_create(&bench.memory, &bench.shell, &bench.settings, &bench.plan), SINGE_OK);
    assert_int_equal(pool_create(&bench.memory, (SingeTasks){0}, threads, &bench.pool), SINGE_OK);
    test_mesh_free(&quads);
    free(uv), free(along);
    return bench;
}

Bench bench_open(Quads quads, const SingeMaterialDef *material, int threads) {
    return open_bench(quads, material, threads, false);
}

Bench bench_open_creased(Quads quads, const SingeMaterialDef *material, int threads) {
    return open_bench(quads, material, threads, true);
}

SingeMaterialDef bench_plain_material(void) {
    SingeMaterialDef material = singe_default_material();
    material.drag = singe_param(0);
    material.damping = singe_param(0);
    return material;
}

Bench bench_open_plain(Quads quads) {
    const SingeMaterialDef material = bench_plain_material();
    return bench_open(quads, &material, 1);
}

void bench_add_collider(Bench *bench, SingeColliderDef def, uint32_t count, const SingePoseKey *keys) {
    bench->colliders = (ColliderList){1, 1, calloc(1, sizeof(Collider))};
    Collider *collider = bench->colliders.items;
    def.path_count = count, def.path = keys;
    if (collider_create(&bench->memory, &def, collider, &bench->error)) fail_msg("%s", bench->error.message);
    collider->generation = 1;
    assert_true(dynamics_plan_reserve(&bench->memory, bench->plan, 1));
}

void bench_prepare(Bench *bench) {
    dynamics_prepare(bench->plan, &bench->shell, STATE_INPUT(&bench->state), &bench->wind, NULL, bench->pool,
                     &bench->state.dynamics);
}

void bench_close(Bench *bench) {
    if (bench->colliders.items) collider_free(&bench->memory, bench->colliders.items);
    free(bench->colliders.items);
    pool_destroy(&bench->memory, bench->pool);
    dynamics_plan_free(&bench->memory, &bench->shell, bench->plan);
    state_free(&bench->memory, &bench->state);
    shell_free(&bench->memory, &bench->shell);
    sheet_source_free(&bench->memory, &bench->source);
    assert_int_equal(bench->memory.held, 0);
}

void bench_step(Bench *bench, float h) {
    StepContext context = {.shell = &bench->shell,
                           .state = state_input(&bench->state),
                           .pins = &bench->pins,
                           .colliders = &bench->colliders,
                           .wind = &bench->wind,
                           .pool = bench->pool,
                           .error = &bench->error,
                           .h = h};

    context.state.dynamics = NULL;
    SingeResult result = dynamics_step(&bench->memory, bench->plan, &context, &bench->state.dynamics, &bench->counters);
    assert_int_equal(result, SINGE_OK);
    bench->state.time += (double)h;
    bench->state.step++;
}

double bench_height(const Bench *bench, uint32_t cell) {
    Float3 mean = {0, 0, 0}, p[4];
    for (int i = 0; i < 4; i++) {
        p[i] = float3_load(bench->state.dynamics.position[bench->shell.cells[cell][i]]);
        mean = float3_mad(mean, p[i], 0.25f);
    }
    Float3 normal = float3_unit(float3_cross(float3_sub(p[2], p[0]), float3_sub(p[3], p[1])));
    return (double)float3_dot(
        float3_sub(float3_load(bench->state.dynamics.position[shell_centre(&bench->shell, cell)]), mean), normal);
}

float bench_weight(const Bench *bench, SingeColour colour, uint32_t spring) {
    const SpringSet *springs = &bench->shell.springs[colour];
    const StrandSet *set = &bench->plan->strands.sets[colour];
    uint32_t s = 0;
    while (springs->strand_first[s + 1] <= spring) s++;
    return 2 * set->weight[set->strand_slot[s] + (spring - springs->strand_first[s]) * STRAND_LANES];
}
