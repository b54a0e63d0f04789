// The validators that assertions call: a good shell and state pass, and each fault is named in words.
#include "ablate/burning_sheet.h"

#include "shell/shell_validate.h"

TEST(good_ones_pass) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(5, 4, 0.01f, &material);
    AblatePlan *plan;

    assert_int_equal(ablate_plan_create(&b->memory, &b->shell, &plan), SINGE_OK);
    sheet_ablate(b, plan);

    ShellFault fault;
    assert_true(shell_validate(&b->shell, &fault));
    assert_true(state_validate(&b->shell, &b->state, &fault));
    ablate_plan_free(&b->memory, plan);
}

/// Checks what a validator says while `target` has another value, and that it says nothing afterwards.
#define BREAKS(validate, target, value, words)  \
    do {                                        \
        __typeof__(target) kept_ = (target);    \
        (target) = (value);                     \
        assert_false(validate);                 \
        assert_string_equal(fault.text, words); \
        (target) = kept_;                       \
        assert_true(validate);                  \
    } while (0)

TEST(faults_are_named) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(5, 4, 0.01f, &material);
    AblatePlan *plan;

    assert_int_equal(ablate_plan_create(&b->memory, &b->shell, &plan), SINGE_OK);
    sheet_ablate(b, plan);

    ShellFault fault;
    Shell *shell = &b->shell;
    BREAKS(shell_validate(shell, &fault), shell->cells[3][1], shell->vertex_count,
           "cell 3 names corner 30 of 30 vertices");
    BREAKS(shell_validate(shell, &fault), shell->cells[3][1], shell->cells[3][0], "cell 3 names corner 3 twice");
    BREAKS(shell_validate(shell, &fault), shell->cell_springs[2].green[0], shell->springs[SINGE_GREEN].count,
           "cell 2 names green spring 31 of 31");
    BREAKS(shell_validate(shell, &fault), shell->springs[SINGE_RED].ends[1][0], shell->particle_count,
           "red spring 1 ends at particle 50 of 50");
    BREAKS(shell_validate(shell, &fault), shell->springs[SINGE_BLUE].rest[0], NAN,
           "blue spring 0 has length nan at rest");
    BREAKS(shell_validate(shell, &fault), shell->fan[0], shell->cell_count - 1,
           "cell 19 is in the fan of vertex 0, which is none of its corners");
    BREAKS(shell_validate(shell, &fault), shell->split_count, 1, "1 splits have used 0 spares");
    BREAKS(shell_validate(shell, &fault), shell->cell_family_first[1], shell->cell_count + 1,
           "family 1 of cells ends before it begins");

    State *state = &b->state;
    BREAKS(state_validate(shell, state, &fault), state->burn.mass[4], 1.5f, "particle 4 has mass fraction 1.5");
    BREAKS(state_validate(shell, state, &fault), state->heat.temperature[4], NAN, "particle 4 has temperature nan");
    BREAKS(state_validate(shell, state, &fault), state->dynamics.position[7][2], INFINITY,
           "particle 7 has a position or velocity that is not finite");
    BREAKS(state_validate(shell, state, &fault), state->ablate.degree[3], (uint16_t)(state->ablate.degree[3] + 1),
           "live springs have 400 ends, the particles' degrees sum to 401");
    BREAKS(state_validate(shell, state, &fault), state->ablate.piece[3], -1, "particle 3 has 7 springs in piece -1");
    BREAKS(state_validate(shell, state, &fault), state->dynamics.pinned[3], 1,
           "1 pins hold particle 3, whose flags say otherwise");
    BREAKS(state_validate(shell, state, &fault), state->ablate.spring_flags[SINGE_RED][0], 0,
           "live springs have 398 ends, the particles' degrees sum to 400");

    ablate_plan_free(&b->memory, plan);
}
