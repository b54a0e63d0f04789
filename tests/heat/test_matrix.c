// The heat matrix where two springs join the same two particles: each is ablated by itself.
//
// Two cells share both edges of a vertex that only they have, so that the diagonals between the other two corners they
// share are two springs, as are the green ones between their centres:
//
//   cells a x b y and a y b z
#include "rig.h"

#include "heat/heat_plan.h"

/// Values of row's entries in a column that are not 0, up to two.
static int entries(const HeatMatrix *matrix, uint32_t row, uint32_t column, float found[2]) {
    int count = 0;
    for (uint32_t k = 0; k < heat_row_width(matrix, row); k++) {
        uint32_t entry = heat_entry(matrix, row, k);
        if (matrix->column[entry] != column || matrix->value[entry] == 0) continue;
        assert_in_range(count, 0, 1);
        found[count++] = matrix->value[entry];
    }

    return count;
}

TEST(twins_go_one_by_one) {
    enum { A, X, B, Y, Z };
    const float positions[] = {0, 0, 0, 0.5f, -1.2f, 0, 1, 0, 0, 0.5f, 0.1f, 0.9f, 0.5f, 1.5f, -0.2f};
    const uint32_t cells[] = {A, X, B, Y, A, Y, B, Z};
    SingeSheetDef def = singe_default_sheet();
    def.vertex_count = 5, def.positions = positions, def.cell_count = 2, def.cells = cells;
    def.material.thickening = 1;
    for (uint32_t lost = 0; lost < 2; lost++) {
        Memory memory = memory_make((SingeAllocator){0});
        SheetSource source;
        Shell shell;
        State state;
        HeatPlan *plan;
        HeatSettings settings = {.ambient_temperature = 293, .tolerance = 1e-7f, .pace = 1};

        assert_int_equal(sheet_source_create(&memory, &def, &source, NULL), SINGE_OK);
        assert_int_equal(shell_create(&memory, &source, 1, &shell, NULL), SINGE_OK);
        assert_int_equal(state_create(&memory, &shell, &state), SINGE_OK);
        assert_int_equal(heat_plan_create(&memory, &shell, &settings, &plan, NULL), SINGE_OK);
        heat_matrix_follow(plan, &shell, &state.ablate, 1e-3f);

        float whole[2], left[2], back[2];
        assert_int_equal(entries(&plan->matrix, A, B, whole), 2);
        assert_true(whole[0] != whole[1] && whole[0] > 0 && whole[1] > 0);

        // entries lie in order of their springs
        uint32_t yellow[2] = {shell.cell_springs[0].yellow[0], shell.cell_springs[1].yellow[0]};
        uint32_t first = yellow[0] < yellow[1] ? 0 : 1;
        state.ablate.spring_flags[SINGE_YELLOW][yellow[lost]] = 0;
        heat_matrix_follow(plan, &shell, &state.ablate, 1e-3f);

        assert_int_equal(entries(&plan->matrix, A, B, left), 1);
        assert_int_equal(entries(&plan->matrix, B, A, back), 1);
        assert_true(left[0] == whole[lost == first] && back[0] == left[0]);
        state.ablate.spring_flags[SINGE_YELLOW][yellow[!lost]] = 0;
        heat_matrix_follow(plan, &shell, &state.ablate, 1e-3f);
        assert_int_equal(entries(&plan->matrix, A, B, left), 0);
        assert_int_equal(entries(&plan->matrix, A, X, left), 1);

        heat_plan_free(&memory, plan);
        state_free(&memory, &state);
        shell_free(&memory, &shell);
        sheet_source_free(&memory, &source);
        assert_int_equal(memory.held, 0);
    }
}
