// The validators that assertions call: a good shell and state pass, and each broken invariant is named.
#include "ablate/burning_sheet.h"

#include "shell/shell_validate.h"

static void good_ones_pass(void **unused) {
    (void)unused;
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheet(5, 4, 0.01f, &material);
    AblatePlan *plan;
    assert_int_equal(ablate_plan_create(&b->memory, &b->shell, &plan), SINGE_OK);
    sheet_ablate(b, plan);
    assert_null(shell_validate(&b->shell));
    assert_null(state_validate(&b->shell, &b->state));
    ablate_plan_free(&b->memory, plan);
    burning_sheet_free(b);
}

#define BREAKS(validate, target, value)      \
    do {                                     \
        __typeof__(target) kept_ = (target); \
        (target) = (value);                  \
        assert_non_null(validate);           \
        (target) = kept_;                    \
        assert_null(validate);               \
    } while (0)

static void broken_ones_are_named(void **unused) {
    (void)unused;
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheet(5, 4, 0.01f, &material);
    AblatePlan *plan;
    assert_int_equal(ablate_plan_create(&b->memory, &b->shell, &plan), SINGE_OK);
    sheet_ablate(b, plan);
    Shell *shell = &b->shell;
    BREAKS(shell_validate(shell), shell->cells[3][1], shell->vertex_count);
    BREAKS(shell_validate(shell), shell->cells[3][1], shell->cells[3][0]);
    BREAKS(shell_validate(shell), shell->cell_springs[2].green[0], shell->springs[SINGE_GREEN].count);
    BREAKS(shell_validate(shell), shell->springs[SINGE_RED].ends[1][0], shell->particle_count);
    BREAKS(shell_validate(shell), shell->springs[SINGE_BLUE].rest[0], NAN);
    BREAKS(shell_validate(shell), shell->fan[0], shell->cell_count - 1);
    BREAKS(shell_validate(shell), shell->split_count, 1);
    BREAKS(shell_validate(shell), shell->cell_family_first[1], shell->cell_count + 1);
    State *state = &b->state;
    BREAKS(state_validate(shell, state), state->burn.mass[4], 1.5f);
    BREAKS(state_validate(shell, state), state->heat.temperature[4], NAN);
    BREAKS(state_validate(shell, state), state->dynamics.position[7][2], INFINITY);
    BREAKS(state_validate(shell, state), state->ablate.degree[3], (uint16_t)(state->ablate.degree[3] + 1));
    BREAKS(state_validate(shell, state), state->ablate.piece[3], -1);
    BREAKS(state_validate(shell, state), state->dynamics.pinned[3], 1);
    BREAKS(state_validate(shell, state), state->ablate.spring_flags[SINGE_RED][0], 0);
    ablate_plan_free(&b->memory, plan);
    burning_sheet_free(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(good_ones_pass), cmocka_unit_test(broken_ones_are_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
