// A fixed scene of about 10,000 springs for scripts/count_instructions.py: a hanging sheet burns while a ball crosses
// it, over a plane, on one thread, recorded, with instructions that valgrind knows. valgrind counts those of
// measured_steps. With an argument, of isotropic bending.
#include "singe/singe.h"

#include <stdio.h>

enum { CELLS = 32, ROW = CELLS + 1, WARM_UP = 60, MEASURED = 20 };

#define TRY(call)                     \
    do {                              \
        SingeResult result_ = (call); \
        if (result_) return result_;  \
    } while (0)

static SingeResult instructions_build(SingeSim *sim) {
    static float positions[ROW * ROW][3];
    static uint32_t cells[CELLS * CELLS][4];

    for (uint32_t v = 0; v < ROW * ROW; v++) {
        positions[v][0] = 0.1f * (float)(v % ROW) / CELLS;
        positions[v][2] = 0.1f * (float)(v / ROW) / CELLS;
    }

    for (uint32_t c = 0; c < CELLS * CELLS; c++) {
        uint32_t v = c / CELLS * ROW + c % CELLS;
        cells[c][0] = v;
        cells[c][1] = v + 1;
        cells[c][2] = v + ROW + 1;
        cells[c][3] = v + ROW;
    }

    SingeSheetDef def = singe_default_sheet();
    def.vertex_count = ROW * ROW;
    def.positions = positions[0];
    def.cell_count = CELLS * CELLS;
    def.cells = cells[0];

    const SingeField noise = {.kind = SINGE_FIELD_NOISE, .noise = {0.02f, 4, 1}};
    const float rate = def.material.mass_rate.value;
    def.material.mass_rate = singe_param_field(rate, 2 * rate, &noise);
    SingeSheetId sheet;
    TRY(singe_sim_add_sheet(sim, &def, &sheet));
    TRY(singe_sim_commit(sim));

    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    const float corners[6] = {0, 0, 0.1f, 0.1f, 0, 0.1f};

    pin.sheet = sheet;
    pin.point_count = 2;
    pin.points = corners;
    pin.radius = 0.005f;
    TRY(singe_sim_add_pin(sim, &pin, &pin_id));

    const SingePoseKey across[2] = {{0, {0.02f, 0, 0.04f}, {0, 0, 0, 1}}, {0.5f, {0.08f, 0, 0.04f}, {0, 0, 0, 1}}};
    SingeSourceDef ball = singe_default_source();
    SingeSourceId source_id;

    ball.kind = SINGE_SOURCE_BALL;
    ball.radius = 0.012f;
    ball.falloff = 0.006f;
    ball.path_count = 2;
    ball.path = across;
    ball.conductance = 3000;
    TRY(singe_sim_add_source(sim, &ball, &source_id));

    const SingePoseKey floor_key = {0, {0, 0, 0.002f}, {0, 0, 0, 1}};
    SingeColliderDef plane = singe_default_collider();
    SingeColliderId collider_id;
    plane.path_count = 1;
    plane.path = &floor_key;
    return singe_sim_add_collider(sim, &plane, &collider_id);
}

SingeResult measured_steps(SingeSim *sim, int steps);

/// Not inlined, so that valgrind sees it begin and end.
__attribute__((noinline)) SingeResult measured_steps(SingeSim *sim, int steps) {
    for (int i = 0; i < steps; i++) TRY(singe_sim_step(sim));
    return SINGE_OK;
}

static SingeResult steps(SingeSim *sim) {
    for (int i = 0; i < WARM_UP; i++) TRY(singe_sim_step(sim));
    return measured_steps(sim, MEASURED);
}

static bool record_nowhere(void *context, const void *bytes, size_t size) {
    (void)context, (void)bytes, (void)size;
    return true;
}

int main(int argc, char **argv) {
    (void)argv;
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;
    SingeError error;

    def.record.write = record_nowhere;
    def.instructions = SINGE_INSTRUCTIONS_X86_V3;
    def.solver.substeps = 3;
    def.solver.isotropic = argc > 1; // any argument
    if (singe_sim_create(&def, &sim, &error)) {
        fprintf(stderr, "singe_bench_instructions: %s\n", error.message);
        return 1;
    }

    SingeResult result = instructions_build(sim);
    if (!result) result = steps(sim);

    SingeStats stats = singe_sim_stats(sim);
    if (result) fprintf(stderr, "singe_bench_instructions: %s\n", singe_sim_error(sim)->message);
    else
        printf("steps %d\nsprings %llu, %.2f %% burnt\n", MEASURED, (unsigned long long)stats.springs,
               100 * stats.burnt_fraction);
    singe_sim_destroy(sim);
    return result != SINGE_OK;
}
