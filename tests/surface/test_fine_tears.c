// Tear edges part without crossing each other, however crumpled the sheet is there.
#include "ablate/burning_sheet.h"
#include "shell/cross.h"
#include "tear/tear_plan.h"

enum { TRIALS = 4000, MIDDLE = 4 }; // the vertex in the middle of 2 by 2 cells

static float any(uint32_t *random) {
    *random = *random * 1664525u + 1013904223u;
    return (float)(*random >> 8) / 16777216.0f - 0.5f;
}

static bool any_cross(const BurningSheet *b) {
    const float(*x)[4] = (const float(*)[4])b->state.dynamics.position;
    bool cross = false;
    for (uint32_t c = 0; c < 4; c++)
        for (uint32_t d = 0; d < c; d++) cross |= cross_cells(&b->shell, x, c, d);
    return cross;
}

/// Where the middle tear edge would go if nothing were in its way: a little towards the mean of its cells' corners.
static Float3 mean_displacement(const BurningSheet *b, uint32_t vertex) {
    const Shell *shell = &b->shell;
    uint32_t first = shell->fan_first[vertex], last = shell->fan_first[vertex + 1];
    Float3 location = float3_load(b->state.dynamics.position[MIDDLE]), sum = {0, 0, 0};

    for (uint32_t f = first; f < last; f++)
        for (int i = 0; i < 4; i++) {
            uint32_t corner = shell->cells[shell->fan[f]][i];
            sum = float3_add(sum, corner == vertex ? location : float3_load(b->state.dynamics.position[corner]));
        }

    return float3_sub(float3_scale(sum, 0.25f / (float)(last - first)), location);
}

TEST(tear_edges_do_not_cross) {
    SingeMaterialDef material = plain_material();
    uint32_t random = 3, torn = 0, otherwise = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        OwnBurningSheet *b = burning_spare_sheets(1, 2, 2, 1, &material, 0, 6);
        for (uint32_t v = 0; v < 9; v++)
            for (int k = 0; k < 3; k++) b->state.dynamics.position[v][k] += 3 * any(&random);

        Float3 before = float3_load(b->state.dynamics.position[MIDDLE]);
        ShellSplit split = {.vertex = MIDDLE, .cells = trial % 2 ? 3 : 5};
        Fan fan;
        SplitResult result;

        split_fan(&b->shell, MIDDLE, &fan);
        if (!any_cross(b) && split_is_possible(&b->shell, &fan, &split)) {
            tear_split(&b->shell, &b->state, &fan, &split, &result);
            Float3 after = float3_load(b->state.dynamics.position[MIDDLE]);
            float3_store(b->state.dynamics.position[MIDDLE], before);

            Float3 displacement = float3_sub(float3_mad(before, mean_displacement(b, MIDDLE), 0.002f), after);
            float3_store(b->state.dynamics.position[MIDDLE], after);
            otherwise += float3_length(displacement) > 1e-5f;
            torn++;
            assert_false(any_cross(b));
            assert_true(float3_length(float3_sub(after, float3_load(b->state.dynamics.position[result.spare]))) >
                        1e-4f);
        }
    }

    assert_true(torn > 300 && otherwise > 3);
}
