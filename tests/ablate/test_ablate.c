// Removal by colour, ledgers, pieces and holes.
#include "burning_sheet.h"

#include "sim/sim_internal.h"

enum { AMBIENT = 293 };

static AblatePlan *plan_for(BurningSheet *b) {
    AblatePlan *plan;
    assert_int_equal(ablate_plan_create(&b->memory, &b->shell, &plan), SINGE_OK);
    return plan;
}

static void finish(BurningSheet *b, AblatePlan *plan) {
    ablate_plan_free(&b->memory, plan);
    burning_sheet_free(b);
}

/// Lets a particle burn to nothing at the present time.
static void burn_out(BurningSheet *b, uint32_t particle) {
    b->state.burn.mass[particle] = 0;
    b->state.burn.time_burnt[particle] = (float)b->state.time;
}

static void burn_out_cell(BurningSheet *b, uint32_t i, uint32_t j) {
    for (int k = 0; k < 4; k++) burn_out(b, b->shell.cells[cell_at(b, i, j)][k]);
    burn_out(b, centre_at(b, i, j));
}

static uint32_t alive_springs(const BurningSheet *b, SingeColour colour) {
    uint32_t count = 0;
    for (uint32_t s = 0; s < b->shell.springs[colour].count; s++)
        count += b->state.ablate.spring_flags[colour][s] & SINGE_ALIVE;
    return count;
}

static void expect_springs(const BurningSheet *b, uint32_t red, uint32_t green, uint32_t blue, uint32_t yellow) {
    assert_int_equal(alive_springs(b, SINGE_RED), red);
    assert_int_equal(alive_springs(b, SINGE_GREEN), green);
    assert_int_equal(alive_springs(b, SINGE_BLUE), blue);
    assert_int_equal(alive_springs(b, SINGE_YELLOW), yellow);
}

/// Degrees, flags and piece ids agree with the springs.
static void expect_consistent(const BurningSheet *b) {
    const AblateState *state = &b->state.ablate;
    uint16_t *degree = calloc(b->shell.particle_count, sizeof *degree);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t s = 0; s < b->shell.springs[colour].count; s++)
            if (state->spring_flags[colour][s] & SINGE_ALIVE)
                for (int k = 0; k < 2; k++) degree[b->shell.springs[colour].ends[s][k]]++;
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        assert_int_equal(degree[i], state->degree[i]);
        assert_int_equal(state->particle_flags[i] & SINGE_ALIVE, degree[i] > 0);
        assert_int_equal(state->piece[i] >= 0, degree[i] > 0);
    }

    for (uint32_t c = 0; c < b->shell.cell_count; c++) {
        const CellSprings *springs = &b->shell.cell_springs[c];
        bool alive = state->cell_flags[c] & SINGE_ALIVE;
        for (int k = 0; k < 2; k++)
            assert_int_equal(state->spring_flags[SINGE_YELLOW][springs->yellow[k]] & SINGE_ALIVE, alive);
        for (int k = 0; k < 4; k++) {
            const uint32_t other = shell_neighbour(&b->shell, c, k);
            const bool any = alive || (other != SHELL_NONE && state->cell_flags[other] & SINGE_ALIVE);
            assert_int_equal(state->spring_flags[SINGE_RED][springs->red[k]] & SINGE_ALIVE, alive);
            assert_int_equal(state->spring_flags[SINGE_BLUE][springs->blue[k]] & SINGE_ALIVE, any);
            if (other == SHELL_NONE) continue;
            bool both = alive && state->cell_flags[other] & SINGE_ALIVE;
            assert_int_equal(state->spring_flags[SINGE_GREEN][springs->green[k]] & SINGE_ALIVE, both);
        }
    }

    free(degree);
}

TEST(level_is_mass_above_loss) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheet(1, 1, 0.01f, &material);
    assert_float_equal(ablate_level(&b->shell, &b->state, 0), 0.75, 0);
    b->state.burn.mass[4] = 0.125f;
    assert_float_equal(ablate_level(&b->shell, &b->state, 4), -0.125, 0);
    burning_sheet_free(b);
    material.ablate = false;
    b = burning_sheet(1, 1, 0.01f, &material);
    b->state.burn.mass[4] = 0;
    assert_float_equal(ablate_level(&b->shell, &b->state, 4), 1, 0);
    burning_sheet_free(b);
}

static BurningSheet *three_by_three(void) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheet(3, 3, 0.01f, &material);
    expect_springs(b, 36, 12, 24, 18);
    return b;
}

TEST(burnt_centre_removes_nothing) {
    BurningSheet *b = three_by_three();
    AblatePlan *plan = plan_for(b);
    burn_out(b, centre_at(b, 1, 1));
    sheet_ablate(b, plan);
    expect_springs(b, 36, 12, 24, 18);
    assert_int_equal(b->state.ablate.topology_version, 0);
    burn_out(b, corner_at(b, 1, 1)); // of its four triangles each has a corner left
    burn_out(b, corner_at(b, 2, 2));
    sheet_ablate(b, plan);
    expect_springs(b, 36, 12, 24, 18);
    finish(b, plan);
}

/// Burns a corner of a cell and its neighbours in the cell; the corner opposite is left.
static void burn_but_a_corner(BurningSheet *b, uint32_t i, uint32_t j) {
    burn_out(b, corner_at(b, i + 1, j)), burn_out(b, corner_at(b, i + 1, j + 1)), burn_out(b, corner_at(b, i, j + 1));
    burn_out(b, centre_at(b, i, j));
}

TEST(blue_goes_with_the_last_of_its_cells) {
    BurningSheet *b = three_by_three();
    AblatePlan *plan = plan_for(b);
    uint32_t spring = b->shell.cell_springs[cell_at(b, 1, 1)].blue[0];

    burn_out_cell(b, 1, 1);
    sheet_ablate(b, plan);
    expect_springs(b, 32, 8, 24, 16); // the cell below is still there
    burn_out_cell(b, 1, 0);
    sheet_ablate(b, plan);
    expect_springs(b, 28, 6, 22, 14); // of the sides of that cell one is at the boundary
    assert_int_equal(b->state.ablate.spring_flags[SINGE_BLUE][spring] & SINGE_ALIVE, 0);
    assert_int_equal(b->state.ablate.topology_version, 2);
    expect_consistent(b);
    sheet_ablate(b, plan);
    assert_int_equal(b->state.ablate.topology_version, 2);
    finish(b, plan);
}

TEST(blue_goes_with_its_cell_at_the_boundary) {
    BurningSheet *b = three_by_three();
    AblatePlan *plan = plan_for(b);
    burn_out_cell(b, 1, 0);
    sheet_ablate(b, plan);
    expect_springs(b, 32, 9, 23, 16);
    assert_int_equal(b->state.ablate.spring_flags[SINGE_BLUE][b->shell.cell_springs[1].blue[0]] & SINGE_ALIVE, 0);
    finish(b, plan);
}

/// A burnt corner of a cell that is left moves with it: its springs stay till the cell goes.
TEST(a_cell_keeps_its_springs_till_it_goes) {
    BurningSheet *b = three_by_three();
    AblatePlan *plan = plan_for(b);
    burn_but_a_corner(b, 2, 2);
    sheet_ablate(b, plan);
    expect_springs(b, 36, 12, 24, 18);
    burn_out(b, corner_at(b, 2, 2));
    sheet_ablate(b, plan);
    expect_springs(b, 32, 10, 22, 16);
    expect_consistent(b);
    finish(b, plan);
}

/// A strip of four cells, held at one end, whose last cell has lost all but one corner: the burnt corners stay in place
/// beside those that are left.
TEST(burnt_corners_do_not_swing) {
    const SingeSimDef def = singe_default_sim();
    OwnSim *sim = test_sim(&def, test_grid(4, 1, 2.5e-3f, 2.5e-3f), NULL);
    const uint32_t held[] = {0, 1, 5, 6}, burnt[] = {3, 4, 9};
    SingePinDef pin = singe_default_pin();
    assert_int_equal(singe_sim_sheets(sim, &pin.sheet, 1), 1);
    pin.vertices = held;
    pin.vertex_count = 4;
    test_add_pin(sim, &pin);
    test_steps(sim, 1);

    const Shell *shell = &sim->shell;
    for (int k = 0; k < 3; k++) sim->state.burn.mass[burnt[k]] = 0.1f;
    sim->state.burn.mass[shell_centre(shell, 3)] = 0.1f;

    float longest = 0;
    for (int step = 0; step < 60; step++) {
        test_steps(sim, 1);
        assert_true(sim->state.ablate.cell_flags[3] & SINGE_ALIVE);
        for (int i = 0; i < 4; i++) {
            const uint32_t blue = shell->cell_springs[3].blue[i], *ends = shell->springs[SINGE_BLUE].ends[blue];
            const Float3 a = float3_load(sim->state.dynamics.position[ends[0]]);
            const float length = float3_length(float3_sub(float3_load(sim->state.dynamics.position[ends[1]]), a));
            longest = fmaxf(longest, length / shell->springs[SINGE_BLUE].rest[blue]);
        }
    }

    print_message("sides up to %.2f of their length\n", (double)longest);
    assert_true(longest < 1.1f);
}

TEST(yellow_and_green_go_with_the_cell) {
    BurningSheet *b = three_by_three();
    AblatePlan *plan = plan_for(b);
    uint32_t centre = centre_at(b, 1, 1);
    b->state.burn.mass[centre] = 0.125f, b->state.heat.temperature[centre] = 900;
    for (int k = 0; k < 4; k++) b->state.burn.mass[b->shell.cells[4][k]] = 0.125f;
    sheet_ablate(b, plan);
    expect_springs(b, 32, 8, 24, 16); // blue: the surrounding triangles remain
    expect_consistent(b);
    assert_int_equal(b->state.ablate.cell_flags[4] & SINGE_ALIVE, 0);
    assert_int_equal(b->state.ablate.particle_flags[centre] & SINGE_ALIVE, 0);
    assert_int_equal(b->state.ablate.piece_count, 1);

    double mass = (double)b->shell.matter.mass[centre], capacity = (double)b->shell.matter.capacity[centre];
    assert_true(fabs(b->state.ablate.mass_removed - 0.125 * mass) < 1e-12 * mass);
    assert_true(fabs(b->state.ablate.heat_removed - capacity * (900 - AMBIENT)) < 1e-12 * capacity * 900);
    finish(b, plan);
}

TEST(all_can_go) {
    BurningSheet *b = three_by_three();
    AblatePlan *plan = plan_for(b);
    for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.burn.mass[i] = 0.2f;

    double mass = mass_left(b);
    sheet_ablate(b, plan);
    expect_springs(b, 0, 0, 0, 0);
    expect_consistent(b);
    assert_int_equal(b->state.ablate.piece_count, 0);
    assert_int_equal(b->state.ablate.topology_version, 1);
    assert_true(fabs(b->state.ablate.mass_removed - mass) < 1e-12 * mass);
    sheet_ablate(b, plan);
    assert_int_equal(b->state.ablate.topology_version, 1);
    finish(b, plan);
}

TEST(no_springs_break_without_ablation) {
    SingeMaterialDef material = plain_material();
    material.ablate = false;
    BurningSheet *b = burning_sheet(3, 3, 0.01f, &material);
    AblatePlan *plan = plan_for(b);

    for (uint32_t i = 0; i < b->shell.particle_count; i++) burn_out(b, i);
    sheet_ablate(b, plan);
    expect_springs(b, 36, 12, 24, 18);
    assert_int_equal(b->state.ablate.topology_version, 0);
    assert_int_equal(b->events.count, 0);
    finish(b, plan);
}

/// Where m_loss lies under m_min the sheet burns to ash and stays whole.
TEST(ash_stays_where_loss_is_below_min) {
    SingeMaterialDef material = plain_material();
    material.mass_min = singe_param(0.3f), material.mass_loss = singe_param(0.2f);
    BurningSheet *b = burning_sheet(3, 3, 0.01f, &material);
    AblatePlan *plan = plan_for(b);
    double partial[1];
    float thickening = 1;

    for (uint32_t i = 0; i < b->shell.particle_count; i++) b->state.heat.temperature[i] = 900;
    for (int n = 0; n < 50; n++) { // 0.04 of the mass a step: ash after 18
        assert_int_equal(sheet_burn(b, NULL, 0.1f, 1, &thickening, partial), SINGE_OK);
        sheet_ablate(b, plan);
    }

    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        assert_true(b->state.burn.mass[i] == 0.3f);
        assert_true(b->state.burn.time_burnt[i] == -1);
    }

    expect_springs(b, 36, 12, 24, 18);
    assert_true(b->state.ablate.mass_removed == 0);
    assert_int_equal(b->state.ablate.piece_count, 1);
    assert_int_equal(b->state.ablate.topology_version, 0);
    finish(b, plan);
}

static void burn_out_column(BurningSheet *b, uint32_t i) {
    for (uint32_t j = 0; j < b->ny; j++) burn_out_cell(b, i, j);
}

static void count_freed(const BurningSheet *b, size_t expected) {
    size_t freed = 0;
    for (size_t k = 0; k < b->events.count; k++) freed += b->events.items[k].kind == SINGE_EVENT_PIECE_FREED;
    assert_int_equal(freed, expected);
}

TEST(pieces_split_and_keep_ids) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheets(2, 9, 3, 0.01f, &material, 0);
    AblatePlan *plan = plan_for(b);
    const int32_t *piece = b->state.ablate.piece;

    sheet_ablate(b, plan);
    assert_int_equal(b->state.ablate.piece_count, 2);
    assert_int_equal(b->events.count, 0);
    assert_int_equal(piece[0], 0);
    assert_int_equal(piece[40], 1); // the second sheet's first corner
    assert_int_equal(piece[80], 0);
    assert_int_equal(piece[80 + 27], 1);

    burn_out_column(b, 2); // left 2 columns, right 6: the right is larger and keeps the id
    sheet_ablate(b, plan);
    assert_int_equal(b->state.ablate.piece_count, 3);
    assert_int_equal(piece[corner_at(b, 0, 0)], 2);
    assert_int_equal(piece[corner_at(b, 2, 3)], 2);
    assert_int_equal(piece[centre_at(b, 1, 2)], 2);
    assert_int_equal(piece[centre_at(b, 2, 1)], -1);
    assert_int_equal(piece[corner_at(b, 3, 0)], 0);
    assert_int_equal(piece[centre_at(b, 8, 2)], 0);
    assert_int_equal(piece[40], 1);
    count_freed(b, 1);

    const SingeEvent *event = &b->events.items[b->events.count - 1];
    assert_int_equal(event->element, 2);
    assert_float_equal(event->position[0], 0, 0); // of its smallest particle, corner 0

    b->events.count = 0;
    burn_out_column(b, 5); // columns 3, 4 and 6, 7, 8: the larger one keeps
    burn_out_column(b, 7); // 6 and 8: now columns 3, 4 are the largest
    sheet_ablate(b, plan);
    assert_int_equal(b->state.ablate.piece_count, 5);
    assert_int_equal(piece[centre_at(b, 3, 0)], 0);
    assert_int_equal(piece[centre_at(b, 6, 0)], 3);
    assert_int_equal(piece[centre_at(b, 8, 0)], 4);
    count_freed(b, 2);
    assert_int_equal(b->events.items[b->events.count - 2].element, 3);
    assert_float_equal(b->events.items[b->events.count - 2].position[0], 0.06f, 1e-7);
    assert_int_equal(b->events.items[b->events.count - 1].element, 4);
    expect_consistent(b);
    finish(b, plan);
}

TEST(of_equal_parts_the_first_particle_keeps_the_number) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheet(7, 3, 0.01f, &material);
    AblatePlan *plan = plan_for(b);

    burn_out_column(b, 3); // in the first step of all
    sheet_ablate(b, plan);
    assert_int_equal(b->state.ablate.piece[centre_at(b, 0, 0)], 0);
    assert_int_equal(b->state.ablate.piece[centre_at(b, 6, 0)], 1);
    count_freed(b, 1);
    assert_float_equal(b->events.items[b->events.count - 1].position[0], 0.04f, 1e-7);
    finish(b, plan);
}

/// Burns the last column but one of 7 by 3 cells; the piece cut off has 4.5 cells of corner area.
static BurningSheet *cut_off(float drop_below_cells, bool pinned, AblatePlan **plan) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheets(2, 7, 3, 0.01f, &material, drop_below_cells * 1e-4f);
    *plan = plan_for(b);
    if (pinned) b->state.dynamics.pinned[corner_at(b, 7, 2)] = 1;
    burn_out_column(b, 5);
    sheet_ablate(b, *plan);
    expect_consistent(b);
    return b;
}

TEST(small_loose_pieces_are_dropped) {
    const struct {
        float below;
        bool pinned;
        uint32_t pieces;
    } cases[] = {
        {0, false, 3}, {4.4f, false, 3}, {4.6f, false, 2}, {4.6f, true, 3}, {1e6f, false, 2},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        AblatePlan *plan;
        BurningSheet *b = cut_off(cases[k].below, cases[k].pinned, &plan);
        bool dropped = cases[k].pieces == 2;

        assert_int_equal(b->state.ablate.piece_count, cases[k].pieces);
        assert_int_equal(b->state.ablate.cell_flags[cell_at(b, 6, 1)] & SINGE_ALIVE, !dropped);
        assert_int_equal(b->state.ablate.particle_flags[corner_at(b, 7, 1)] & SINGE_ALIVE, !dropped);
        assert_int_equal(b->state.ablate.piece[0], 0);
        assert_int_equal(b->state.ablate.topology_version, 1);
        count_freed(b, dropped ? 0 : 1);

        double mass = 0;
        for (uint32_t i = 0; i < b->shell.particle_count; i++)
            mass += (double)b->state.burn.mass[i] * (double)b->shell.matter.mass[i];
        assert_true(fabs(mass - mass_left(b) - b->state.ablate.mass_removed) < 1e-12 * mass);
        if (dropped) assert_true(b->state.ablate.mass_removed > 0);
        finish(b, plan);
    }
}

static void expect_hole(BurningSheet *b, AblatePlan *plan, int64_t particle) {
    b->events.count = 0;
    sheet_ablate(b, plan);
    assert_int_equal(b->events.count, particle >= 0);
    if (particle < 0) return;
    assert_int_equal(b->events.items[0].kind, SINGE_EVENT_HOLE_OPENED);
    assert_int_equal(b->events.items[0].element, particle);
    assert_float_equal(b->events.items[0].time, b->state.time, 0);
    assert_memory_equal(b->events.items[0].position, b->state.dynamics.position[particle], 12);
}

TEST(holes_open_once) {
    SingeMaterialDef material = plain_material();
    BurningSheet *b = burning_sheet(8, 8, 0.01f, &material);
    AblatePlan *plan = plan_for(b);

    b->state.time = 1, burn_out(b, centre_at(b, 2, 2));
    expect_hole(b, plan, centre_at(b, 2, 2));
    b->state.time = 2; // nothing new
    expect_hole(b, plan, -1);
    b->state.time = 3, burn_out(b, corner_at(b, 2, 2)); // the hole grows
    expect_hole(b, plan, -1);
    b->state.time = 4, burn_out(b, corner_at(b, 0, 5)); // a notch
    expect_hole(b, plan, -1);
    b->state.time = 5, burn_out_cell(b, 6, 6); // five at once are one hole
    expect_hole(b, plan, corner_at(b, 6, 6));
    b->state.time = 6, burn_out(b, corner_at(b, 6, 2));
    expect_hole(b, plan, corner_at(b, 6, 2));
    b->state.time = 7, burn_out(b, centre_at(b, 6, 2)), burn_out(b, centre_at(b, 4, 0));
    expect_hole(b, plan, centre_at(b, 4, 0)); // the other one touches the hole at corner (6, 2)
    finish(b, plan);
}

/// A flame front with noise crosses the sheet: many pieces, everything checked at every step.
TEST(the_ledger_closes_as_a_sheet_burns_to_pieces) {
    SingeMaterialDef material = plain_material();
    material.ash_exponent = singe_param(1);
    material.mass_rate = singe_param(1e-3f);
    material.mass_rate = singe_param_field(
        material.mass_rate.value, 2e-2f,
        &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {.scale = 0.004f, .octaves = 2, .seed = 3}});
    BurningSheet *b = burning_sheets(1, 50, 30, 0.001f, &material, 3e-6f);
    AblatePlan *plan = plan_for(b);
    double partial[8], initial = mass_left(b), heat = 0;
    float thickening = 1;
    uint32_t max = 0, count = b->shell.particle_count;
    size_t freed = 0;
    for (int n = 0; n < 150; n++) {
        b->state.time = 0.05 * n;
        b->events.count = 0;
        for (uint32_t i = 0; i < count; i++) {
            float away = b->shell.rest_position[i][0] - 0.0004f * (float)n;
            b->state.heat.temperature[i] = 300 + 700 * expf(-away * away * 2e4f);
        }

        assert_int_equal(sheet_burn(b, NULL, 0.05f, 1, &thickening, partial), SINGE_OK);
        uint8_t *before = malloc(count);
        memcpy(before, b->state.ablate.particle_flags, count);
        sheet_ablate(b, plan);
        for (uint32_t i = 0; i < count; i++)
            if (before[i] != b->state.ablate.particle_flags[i])
                heat += (double)b->shell.matter.capacity[i] * ((double)b->state.heat.temperature[i] - AMBIENT);
        free(before);
        expect_consistent(b);
        for (size_t k = 0; k < b->events.count; k++) freed += b->events.items[k].kind == SINGE_EVENT_PIECE_FREED;
        if (b->state.ablate.piece_count > max) max = b->state.ablate.piece_count;

        double gone = b->state.burn.mass_burnt + b->state.ablate.mass_removed;
        assert_true(fabs(initial - mass_left(b) - gone) < 1e-12 * initial);
    }

    assert_true(max >= 4);
    assert_true(b->state.ablate.mass_removed > 0.02 * initial);
    assert_true(fabs(heat - b->state.ablate.heat_removed) < 1e-12 * heat);
    assert_int_equal(b->state.ablate.next_piece, 1 + freed);

    // pieces are what hangs together: one id along every spring, and as many parts as ids in use
    uint32_t *part = calloc(count, sizeof *part), parts = 0;
    for (uint32_t i = 0; i < count; i++) part[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
            for (uint32_t s = 0; s < b->shell.springs[colour].count; s++) {
                uint32_t x = b->shell.springs[colour].ends[s][0], y = b->shell.springs[colour].ends[s][1];
                if (!(b->state.ablate.spring_flags[colour][s] & SINGE_ALIVE) || part[x] == part[y]) continue;
                part[x] = part[y] = part[x] < part[y] ? part[x] : part[y];
                changed = true;
            }
    }

    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(b->state.ablate.piece[i], b->state.ablate.degree[i] ? b->state.ablate.piece[part[i]] : -1);
        parts += part[i] == i && b->state.ablate.degree[i];
        for (uint32_t j = 0; j < i; j++)
            if (part[i] == i && part[j] == j && b->state.ablate.degree[i] && b->state.ablate.degree[j])
                assert_int_not_equal(b->state.ablate.piece[i], b->state.ablate.piece[j]);
    }

    assert_int_equal(parts, b->state.ablate.piece_count);
    free(part);
    finish(b, plan);
}

TEST(plan_survives_lack_of_memory) {
    SingeMaterialDef material = plain_material();
    OwnBurningSheet *b = burning_sheet(3, 3, 0.01f, &material);
    Memory memory;
    AblatePlan *plan;
    test_allocations_fail(3, (memory = memory_make(allocator), ablate_plan_create(&memory, &b->shell, &plan)),
                          ablate_plan_free(&memory, plan));
}
