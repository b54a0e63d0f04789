// Which way tears run: across the pull, whatever the direction of the cells.
#include "ablate/burning_sheet.h"
#include "tear/tear.h"

enum { BLOCKS = 14, BLOCK = 6, CELLS = BLOCKS * BLOCK };
static const float side = 5e-3f, degree = 0.0174532925f;

/// The middle of a block of cells, where it is the weakest.
static bool is_weak(uint32_t v) { return v % (CELLS + 1) % BLOCK == BLOCK / 2 && v / (CELLS + 1) % BLOCK == BLOCK / 2; }

/// A sheet with vertices in reserve. Every block counts as a piece of its own, so that a tear may begin in each.
static BurningSheet *blocks_of_a_sheet(void) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_spare_sheets(1, CELLS, CELLS, side, &material, 0, 4 * BLOCKS * BLOCKS);
    float *strength = burning_sheet_vary(b, &b->shell.matter.strength);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        strength[i] = i < (CELLS + 1) * (CELLS + 1) && is_weak(i) ? 1 : 2;
        const float *p = b->shell.rest_position[i];
        b->state.ablate.piece[i] = (int32_t)(p[1] / (BLOCK * side)) * (BLOCKS + 1) + (int32_t)(p[0] / (BLOCK * side));
    }

    return b;
}

/// Forces over lengths that make the line force xx, yy, xy everywhere.
static void pull_evenly(const BurningSheet *b, float xx, float yy, float xy, float *pull[SINGE_COLOUR_COUNT]) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *set = &b->shell.springs[colour];
        pull[colour] = calloc(set->count, sizeof *pull[colour]);
        for (uint32_t s = 0; s < set->count; s++) {
            const float *p = b->shell.rest_position[set->ends[s][0]], *q = b->shell.rest_position[set->ends[s][1]];
            float x = q[0] - p[0], y = q[1] - p[1];
            if (colour == SINGE_BLUE) pull[colour][s] = fabsf(x) > fabsf(y) ? xx : yy;
            if (colour == SINGE_YELLOW) pull[colour][s] = x * y > 0 ? 0.5f * xy : -0.5f * xy;
        }
    }
}

/// Degrees that the mean of the torn edges is off from across the pull, which is at this angle to the cells.
static double off_across(float angle) {
    OwnBurningSheet *b = blocks_of_a_sheet();
    float c = cosf(angle), s = sinf(angle), *pull[SINGE_COLOUR_COUNT];
    TearPlan *plan;
    bool short_of_spares;
    const float force = 1.3f;

    assert_int_equal(tear_plan_create(&b->memory, &b->shell, 1e-3f, &plan), SINGE_OK);
    pull_evenly(b, force * c * c, force * s * s, force * c * s, pull);
    uint32_t tears = tear_step(plan, &b->shell, &b->state, (const float *const *)pull, NULL, 1, &short_of_spares);
    assert_false(short_of_spares);
    assert_int_equal(tears, BLOCKS * BLOCKS);
    assert_int_equal(b->shell.edge_spare_used, 2 * tears);

    const SpringSet *blue = &b->shell.springs[SINGE_BLUE];
    double sum[2] = {0, 0};
    for (uint32_t k = blue->count - b->shell.edge_spare_count, end = k + 2 * tears; k < end; k++) {
        const float *p = b->shell.rest_position[blue->ends[k][0]], *q = b->shell.rest_position[blue->ends[k][1]];
        double x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1];
        double sign = y * (double)c - x * (double)s < 0 ? -1 : 1;
        sum[0] += sign * x, sum[1] += sign * y;
    }

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) free(pull[colour]);
    tear_plan_free(&b->memory, plan);
    return atan2(sum[1], sum[0]) / (double)degree - (double)(angle / degree) - 90;
}

TEST(tears_run_across_the_pull) {
    const float angles[] = {0, 15, 30, 45, 60, 75, 90};
    for (int k = 0; k < 7; k++) {
        double off = off_across(angles[k] * degree);
        print_message("pulled at %.0f degrees: %.2f off\n", (double)angles[k], off);
        assert_true(fabs(off) < 2);
    }
}

/// Splits in a step of a sheet that is pulled at with 0.4 of its strength, where two cells have gone that lie across a
/// vertex from each other, or one of them only.
static uint32_t splits_beside(bool both) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_spare_sheets(1, 6, 6, side, &material, 0, 20);
    float *strength = burning_sheet_vary(b, &b->shell.matter.strength), *pull[SINGE_COLOUR_COUNT];
    for (uint32_t i = 0; i < b->shell.particle_count; i++) strength[i] = 1, b->state.ablate.piece[i] = 0;
    b->state.ablate.cell_flags[cell_at(b, 2, 3)] &= (uint8_t)~SINGE_ALIVE;
    if (both) b->state.ablate.cell_flags[cell_at(b, 3, 2)] &= (uint8_t)~SINGE_ALIVE;

    TearPlan *plan;
    bool short_of_spares;
    assert_int_equal(tear_plan_create(&b->memory, &b->shell, 1e-3f, &plan), SINGE_OK);
    pull_evenly(b, 0.4f, 0, 0, pull);

    uint32_t splits = tear_step(plan, &b->shell, &b->state, (const float *const *)pull, NULL, 1, &short_of_spares);
    if (splits) assert_int_equal(b->state.tear.splits[0].vertex, corner_at(b, 3, 3));
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) free(pull[colour]);
    tear_plan_free(&b->memory, plan);
    return splits;
}

TEST(cells_that_hang_by_a_vertex_part) {
    assert_int_equal(splits_beside(false), 0);
    assert_int_equal(splits_beside(true), 1);
}
