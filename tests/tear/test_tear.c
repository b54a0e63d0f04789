// Sheets that tear: where, into what, and that nothing is lost by it.
#include "common/real.h"
#include "common/order.h"
#include "sim/sim_internal.h"
#include "support/support.h"
#include "tear/tear_plan.h"

enum { ALONG = 24, ACROSS = 10, WEAK = 9, GRIP = 2, STEPS = 120 };
static const float side = 5e-3f;

static SingeSimDef pull_def(void) {
    SingeSimDef def = singe_default_sim();
    def.solver.tearing = true;
    def.solver.substeps = 16;
    def.gravity[2] = 0;
    return def;
}

/// A vertex off the grid by up to a fifth of a cell, so that tears find no straight way.
static void jitter(TestMesh *mesh) {
    uint32_t random = 7;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 2; k++) {
            random = random * 1664525u + 1013904223u;
            mesh->positions[3 * v + (uint32_t)k] += 0.3f * side * ((float)(random >> 8) / 16777216.0f - 0.5f);
        }
}

/// Holds what lies within GRIP cells of an end of the strip, and moves it.
static void grip(SingeSim *sim, bool right, float by) {
    uint32_t held[(GRIP + 1) * (ACROSS + 1)], count = 0;
    for (uint32_t j = 0; j <= ACROSS; j++)
        for (uint32_t i = 0; i <= GRIP; i++) held[count++] = j * (ALONG + 1) + (right ? ALONG - i : i);
    const SingePoseKey path[2] = {test_key(0, 0, 0, 0), test_key(0.25f, by, 0, 0)};
    SingePinDef pin = singe_default_pin();
    pin.vertex_count = count, pin.vertices = held, pin.path_count = 2, pin.path = path, pin.sheet.generation = 1;
    test_add_pin(sim, &pin);
}

/// A strip of this strength that is pulled apart; where `line` is not 1, a row of vertices across has that share of it.
static SingeSim *pulled(const SingeSimDef *def, float strength, float line, const SingeMaterialDef *from, float by) {
    OwnTestMesh mesh = test_grid(ALONG, ACROSS, side, side);
    float weak[(ALONG + 1) * (ACROSS + 1)];
    for (uint32_t v = 0; v < mesh.vertex_count; v++) weak[v] = v % (ALONG + 1) == WEAK;
    const SingeAttribute attribute = {"weak", weak};
    SingeSheetDef sheet = test_sheet(&mesh);
    jitter(&mesh);
    if (from) sheet.material = *from;
    sheet.attribute_count = 1, sheet.attributes = &attribute;
    sheet.material.strength =
        singe_param_field(strength, strength * line, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "weak"});
    SingeSim *sim = test_create(def);
    test_add_sheet(sim, &sheet);
    test_ok(sim, singe_sim_commit(sim));
    grip(sim, false, 0);
    grip(sim, true, by);
    return sim;
}

// ---- the drawn surface

typedef struct Edge {
    uint32_t low, high;
} Edge;

/// No edge has more than two triangles, none is a spike, and vertices are where their uv and their input say.
static void check_surface(SingeSim *sim) {
    OwnSurface surface = {0};
    OwnTestMesh mesh = test_grid(ALONG, ACROSS, side, side);
    test_ok(sim, singe_sim_surface(sim, &surface));
    size_t count = 3 * (size_t)surface.triangle_count;
    Edge *edges = malloc(count * sizeof *edges);
    assert_non_null(edges);
    for (uint32_t t = 0; t < surface.triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
            edges[3 * t + (uint32_t)k] = (Edge){a < b ? a : b, a < b ? b : a};
            float square = 0;
            for (int d = 0; d < 3; d++) {
                float displacement = surface.position[a][d] - surface.position[b][d];
                square += displacement * displacement;
            }

            assert_true(sqrtf(square) < 2.5f * side);
        }
    qsort(edges, count, sizeof *edges, order_by_two);
    for (size_t e = 2; e < count; e++) assert_true(order_by_two(&edges[e], &edges[e - 2]) != 0);
    for (uint32_t v = 0; v < surface.vertex_count; v++) {
        int32_t source = surface.source_vertex[v];
        if (source < 0) continue;
        assert_true((uint32_t)source < mesh.vertex_count);
        assert_true(surface.uv[v][0] == mesh.uv[2 * source] && surface.uv[v][1] == mesh.uv[2 * source + 1]);
    }

    free(edges);
}

/// Every particle's springs are counted as its degree says, and what hangs together has one piece.
static void check_view(SingeSim *sim) {
    SingeView view = singe_sim_view(sim);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < view.spring_count[colour]; k++) {
            if (!(view.spring_flags[colour][k] & SINGE_ALIVE)) continue;
            uint32_t a = view.springs[colour][k][0], b = view.springs[colour][k][1];
            assert_true(view.particle_flags[a] & view.particle_flags[b] & SINGE_ALIVE);
            assert_int_equal(view.piece[a], view.piece[b]);
        }
    for (uint32_t c = 0; c < view.cell_count; c++)
        for (int i = 0; i < 4 && view.cell_flags[c] & SINGE_ALIVE; i++)
            assert_int_equal(view.piece[view.cells[c][i]], view.piece[view.vertex_count + c]);
}

// ---- tests

TEST(pulled_apart_it_tears_at_its_weakest_line) {
    SingeSimDef def = pull_def();
    OwnSim *sim = pulled(&def, 4, 0.5f, NULL, 9e-3f);
    size_t freed = 0, events;

    for (int k = 0; k < STEPS; k++) {
        test_steps(sim, 1);
        const SingeEvent *event = singe_sim_events(sim, &events);
        for (size_t e = 0; e < events; e++) freed += event[e].kind == SINGE_EVENT_PIECE_FREED;
    }

    SingeStats stats = singe_sim_stats(sim);
    assert_int_equal(stats.pieces, 2);
    assert_int_equal(freed, 1);
    assert_int_equal(stats.tears, ACROSS + 1);
    assert_true(stats.mass_ledger_error < 1e-6);
    assert_int_equal(stats.cells, ALONG * ACROSS);
    assert_true(stats.strain_mean < 0.002);
    SingeView view = singe_sim_view(sim);
    uint32_t left = view.piece[0] == view.piece[ALONG] ? 1 : 0;
    assert_int_equal(left, 0);
    check_surface(sim);
    check_view(sim);

    // each tear edge of the tear has the weak line's vertices
    for (uint32_t v = (ALONG + 1) * (ACROSS + 1); v < view.vertex_count; v++)
        if (view.particle_flags[v] & SINGE_ALIVE)
            assert_true(fabsf(view.rest_position[v][0] - WEAK * side) < 0.5f * side);
}

/// Where it is soaked it has a tenth of its strength, and tears there.
TEST(it_tears_where_it_is_wet) {
    SingeSimDef def = pull_def();
    SingeMaterialDef material = singe_default_material();
    material.moisture = singe_param_field(0, 1, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "weak"});
    OwnSim *sim = pulled(&def, 4, 1, &material, 9e-3f);
    test_steps(sim, STEPS);
    const SingeView view = singe_sim_view(sim);
    assert_true(singe_sim_stats(sim).tears > ACROSS / 2);
    for (uint32_t v = (ALONG + 1) * (ACROSS + 1); v < view.vertex_count; v++)
        if (view.particle_flags[v] & SINGE_ALIVE)
            assert_true(fabsf(view.rest_position[v][0] - WEAK * side) < 0.5f * side);
}

/// Where a sheet that can tear is pulled apart slowly, its attachments leave it to its springs without a jerk.
TEST(springs_take_over_smoothly) {
    SingeSimDef def = pull_def();
    OwnSim *sim = pulled(&def, 40, 1, NULL, 0.3e-3f);
    float fastest = 0, before = 0, added = 0;
    for (int k = 0; k < STEPS; k++) {
        float now = 0;
        test_steps(sim, 1);
        SingeView view = singe_sim_view(sim);
        for (uint32_t v = 0; v < view.vertex_count; v++) {
            const float *u = view.velocity[v];
            if (!(view.particle_flags[v] & SINGE_PINNED))
                now = fmaxf(now, sqrtf(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
        }

        added = fmaxf(added, now - before);
        fastest = fmaxf(fastest, now);
        before = now;
    }

    print_message("the end moves at %.4f m/s, the fastest vertex at %.4f, which was %.4f more than a step before\n",
                  0.3e-3 / 0.25, (double)fastest, (double)added);
    assert_int_equal(singe_sim_stats(sim).tears, 0);
    assert_true(fastest < 0.03f); // .52 if they let go at once
    assert_true(added < 0.01f);
}

/// In a strip that hangs at rest the line force is the weight of what hangs below, over the width.
TEST(line_force_of_a_hanging_strip_equals_its_weight) {
    enum { WIDE = 6, LONG = 16 };
    SingeSimDef def = pull_def();
    def.gravity[1] = -9.81f, def.air_density = 0, def.solver.attachments = false;
    SingeMaterialDef material = singe_default_material();
    material.damping = singe_param(20), material.strength = singe_param(INFINITY);
    TestMesh mesh = test_grid(WIDE, LONG, side, side);
    OwnSim *sim = test_sim(&def, mesh, &material);
    uint32_t top[WIDE + 1];
    for (uint32_t i = 0; i <= WIDE; i++) top[i] = LONG * (WIDE + 1) + i;
    SingePinDef pin = singe_default_pin();
    pin.vertex_count = WIDE + 1, pin.vertices = top, pin.sheet.generation = 1;
    test_add_pin(sim, &pin);
    test_steps(sim, 300);

    const SingeView view = singe_sim_view(sim);
    for (uint32_t row = 4; row < 12; row++) {
        double force = 0;
        for (uint32_t i = 0; i < WIDE; i++) force += (double)view.line_force[row * WIDE + i][1] / WIDE;
        const double weight = 0.08 * 9.81 * (row + 0.5) * (double)side;
        print_message("row %2u: %.5f N/m, weight %.5f N/m\n", row, force, weight);
        assert_true(fabs(force / weight - 1) < 0.1);
    }
}

TEST(uniform_sheets_tear_too) {
    SingeSimDef def = pull_def();
    OwnSim *sim = pulled(&def, 2, 1, NULL, 9e-3f);
    test_steps(sim, STEPS);
    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.tears > ACROSS / 2 && stats.pieces >= 2);
    assert_true(stats.mass_ledger_error < 1e-6);
    check_surface(sim);
    check_view(sim);
}

/// A tube, whose strands are rings, tears around.
TEST(tubes_tear_around) {
    enum { AROUND = 20, LONG = 16 };
    SingeSimDef def = pull_def();
    SingeMaterialDef material = singe_default_material();
    material.strength = singe_param_field(1, 1.4f, &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.03f, 3, 5}});
    OwnSim *sim = test_sim(&def, test_cylinder(AROUND, LONG, 0.016f, LONG * side), &material);
    for (int k = 0; k < 2; k++) {
        uint32_t held[2 * AROUND];
        for (uint32_t i = 0; i < 2 * AROUND; i++) held[i] = (k ? (LONG - 1) * AROUND : 0) + i;
        const SingePoseKey path[2] = {test_key(0, 0, 0, 0), test_key(0.25f, 0, 0, k ? 9e-3f : 0)};
        SingePinDef pin = singe_default_pin();
        pin.vertex_count = 2 * AROUND, pin.vertices = held, pin.sheet.generation = 1;
        pin.path_count = 2, pin.path = path;
        test_add_pin(sim, &pin);
    }

    test_steps(sim, STEPS);
    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.tears >= AROUND && stats.pieces >= 2 && stats.strain_mean < 0.003);
    check_view(sim);
}

/// The tear edges of a strip that has torn across, as they are drawn: mean distance at rest in sides of cells, and how
/// far their middle leaves the weak line, root mean square.
typedef struct TearEdges {
    double apart, wanders, min, area;
} TearEdges;

static TearEdges drawn_tear_edges(float raggedness) {
    enum { ROWS = 6 * ACROSS };
    SingeSimDef def = pull_def();
    def.surface_detail = 0.4e-3f, def.surface_raggedness = raggedness;
    OwnSim *sim = pulled(&def, 4, 0.5f, NULL, 9e-3f);
    test_steps(sim, STEPS);
    assert_int_equal(singe_sim_stats(sim).pieces, 2);
    check_surface(sim);
    OwnSurface surface = {0};
    test_ok(sim, singe_sim_surface(sim, &surface));
    float left[ROWS], right[ROWS];
    for (int r = 0; r < ROWS; r++) left[r] = -INFINITY, right[r] = INFINITY;
    TearEdges tear_edges = {0, 0, INFINITY, 0};
    for (uint32_t t = 0; t < surface.triangle_count; t++) {
        const float *p[3];
        for (int i = 0; i < 3; i++) p[i] = surface.rest_position[surface.triangles[t][i]];
        tear_edges.area +=
            0.5 * (double)((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]));
        for (int i = 0; i < 3; i++) {
            int row = (int)(p[i][1] / side * 6);
            if (row < 0 || row >= ROWS) continue;
            if (surface.piece[surface.triangles[t][i]] != 0) left[row] = fmaxf(left[row], p[i][0]);
            else right[row] = fminf(right[row], p[i][0]);
        }
    }

    for (int r = 2; r < ROWS - 2; r++) {
        double apart = ((double)right[r] - (double)left[r]) / (double)side;
        double middle = 0.5 * ((double)right[r] + (double)left[r]) / (double)side - WEAK;
        tear_edges.apart += apart / (ROWS - 4), tear_edges.wanders += middle * middle / (ROWS - 4);
        tear_edges.min = fmin(tear_edges.min, apart);
    }

    tear_edges.wanders = sqrt(tear_edges.wanders);
    return tear_edges;
}

TEST(tear_edges_wander_and_fit) {
    const double whole = (double)(ALONG * side * ACROSS * side);
    TearEdges smooth = drawn_tear_edges(0), ragged = drawn_tear_edges(2e-3f);
    print_message("edges %.3f sides apart, %.3f to the side; ragged ones %.3f (%.3f at least) and %.3f\n", smooth.apart,
                  smooth.wanders, ragged.apart, ragged.min, ragged.wanders);
    assert_true(smooth.apart > 0.15 && smooth.apart < 0.4);
    assert_true(ragged.apart > 0.15 && ragged.apart < 0.5); // as far as smooth ones: they fit
    assert_true(ragged.min > 0);
    assert_true(ragged.wanders > smooth.wanders + 0.05);
    assert_true(ragged.area < whole && ragged.area > whole - 0.5 * (double)side * ACROSS * (double)side);
}

TEST(without_tearing_it_stays_whole) {
    SingeSimDef def = pull_def();
    def.solver.tearing = false;
    OwnSim *sim = pulled(&def, 2, 0.5f, NULL, 9e-3f);
    test_steps(sim, 30);
    assert_int_equal(singe_sim_stats(sim).tears, 0);
    assert_int_equal(singe_sim_view(sim).vertex_count, (ALONG + 1) * (ACROSS + 1));
}

/// Runs a strip that burns at one end while it tears.
static SingeSim *burning(int threads, SingeInstructions instructions) {
    SingeSimDef def = pull_def();
    SingeMaterialDef material = singe_default_material();
    def.thread_count = threads, def.instructions = instructions;
    def.contact.enabled = true;
    def.pace = 8;
    def.surface_detail = 0.5e-3f;
    material.char_strength = singe_param(0.5f);
    SingeSim *sim = pulled(&def, 4, 0.5f, &material, 9e-3f);
    test_spot(sim, 14 * side, 0, 0, 0.01f, 1200, 400);
    return sim;
}

TEST(tears_are_the_same_from_a_snapshot) {
    SingeSim *one = burning(1, SINGE_INSTRUCTIONS_BEST), *three = burning(3, SINGE_INSTRUCTIONS_PLAIN), *resumed;
    int half = 0;
    for (; half < STEPS && singe_sim_stats(one).tears < 3; half++) test_steps(one, 1);
    test_steps(three, half);
    uint32_t tears = singe_sim_stats(one).tears;
    test_assert_same(one, three);
    test_ok(one, singe_sim_clone(one, &resumed));
    test_assert_same(one, resumed);
    test_steps(one, STEPS - half);
    test_steps(three, STEPS - half);
    test_steps(resumed, STEPS - half);
    test_assert_same(one, three);
    test_assert_same(one, resumed);
    SingeStats stats = singe_sim_stats(one);
    assert_true(stats.tears > tears); // it was torn half
    assert_true(stats.burnt_fraction > 0 && stats.mass_ledger_error < 1e-6 && stats.ledger_error < 1e-3);
    check_surface(one);
    check_view(one);
    singe_sim_destroy(one);
    singe_sim_destroy(three);
    singe_sim_destroy(resumed);
}

/// A square metre that falls from the horizontal, held at two corners, a side apart.
static SingeSim *swinging(int cells, float time_step, int substeps, bool tearing) {
    SingeSimDef def = singe_default_sim();
    TestMesh mesh = test_grid(cells, cells, 1 / (float)cells, 1 / (float)cells);
    SingePinDef pin = singe_default_pin();
    SingeMaterialDef material = singe_default_material();
    material.grammage = singe_param(0.1f), material.drag = material.damping = singe_param(0);
    def.time_step = time_step, def.solver.tearing = tearing, def.solver.substeps = substeps, def.solver.smoothing = 0;
    SingeSim *sim = test_sim(&def, mesh, &material);
    const uint32_t held[2] = {0, (uint32_t)cells};
    pin.vertex_count = 2, pin.vertices = held, pin.sheet.generation = 1;
    test_add_pin(sim, &pin);
    return sim;
}

/// It does not tear, however coarse its substeps.
TEST(cold_sheets_swing_whole) {
    const int substeps[] = {1, 7, 20};
    for (int k = 0; k < 3; k++) {
        OwnSim *sim = swinging(20, singe_default_sim().time_step, substeps[k], true);
        test_steps(sim, 480);
        assert_int_equal(singe_sim_stats(sim).tears, 0);
    }
}

/// Edges of sheets that may tear are projected as often as others. Once, they had 2.5 times the strain.
TEST(sheets_that_may_tear_stretch_little_more) {
    enum { SWING = 20 };
    double strain[2] = {0, 0};
    for (int tearing = 0; tearing < 2; tearing++) {
        OwnSim *sim = swinging(60, 1 / 24.0f, 38, tearing);
        for (int step = 0; step < SWING; step++) {
            test_steps(sim, 1);
            strain[tearing] += singe_sim_stats(sim).strain_mean / SWING;
        }
    }

    print_message("strain %.2g, and %.2g where it may tear\n", strain[0], strain[1]);
    assert_true(strain[1] < 2 * strain[0]);
}

/// Vertices in reserve lie behind each sheet's own; the drawn mesh and the pins number them as they were given.
TEST(several_sheets_keep_their_numbers) {
    SingeSimDef def = pull_def();
    SingeSheetId id[2];

    OwnSim *sim = test_create(&def);
    for (int k = 0; k < 2; k++) {
        OwnTestMesh mesh = test_grid(6, 4, side, side);
        test_mesh_move(&mesh, 0, 0, (float)k);
        SingeSheetDef sheet = test_sheet(&mesh);
        test_ok(sim, singe_sim_add_sheet(sim, &sheet, &id[k]));
    }

    test_ok(sim, singe_sim_commit(sim));
    const uint32_t last = 7 * 5 - 1, beyond = 7 * 5;
    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    pin.sheet = id[1], pin.vertex_count = 1, pin.vertices = &beyond;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_pin(sim, &pin, &pin_id));
    pin.vertices = &last;
    test_ok(sim, singe_sim_add_pin(sim, &pin, &pin_id));
    SingeView view = singe_sim_view(sim);
    uint32_t own = 0;
    for (uint32_t v = 0; v < view.vertex_count; v++) {
        if (view.source_vertex[v] < 0) continue;
        assert_int_equal(view.source_vertex[v], own++);
        bool second = view.source_vertex[v] >= 7 * 5;
        assert_true(view.rest_position[v][2] == (float)second);
        assert_int_equal(view.particle_flags[v] & SINGE_PINNED, v && own == 2 * 7 * 5 ? SINGE_PINNED : 0);
    }

    assert_int_equal(own, 2 * 7 * 5);
    OwnSurface surface = {0};
    test_ok(sim, singe_sim_surface(sim, &surface));
    for (uint32_t v = 0; v < surface.vertex_count; v++)
        if (surface.source_vertex[v] >= 0)
            assert_true(surface.rest_position[v][2] == (float)(surface.source_vertex[v] >= 7 * 5));
}

/// When the vertices in reserve are used up nothing more tears, and the log says so once.
static void count_lines(void *context, SingeLogLevel level, const char *line) {
    if (level == SINGE_LOG_WARNING && strstr(line, "reserve")) ++*(int *)context;
}

TEST(without_reserve_it_tears_no_further) {
    SingeSimDef def = pull_def();
    int lines = 0;
    def.log = (SingeLog){count_lines, &lines};
    def.solver.substeps = 60;
    SingeMaterialDef material = singe_default_material();
    material.strength = singe_param(0.02f);
    material.char_strength = singe_param(0.01f);
    OwnSim *sim = test_sim(&def, test_grid(12, 8, side, side), &material);
    const float wide = 12 * side;
    for (int k = 0; k < 2; k++) { // everything is torn at, all around
        const float points[6] = {k * wide, 0, 0, k * wide, 8 * side, 0};
        const SingePoseKey path[2] = {test_key(0, 0, 0, 0), test_key(0.5f, k ? 0.05f : -0.05f, k ? 0.05f : -0.05f, 0)};
        SingePinDef pin = singe_default_pin();
        pin.points = points, pin.point_count = 2, pin.sheet.generation = 1, pin.path_count = 2, pin.path = path;
        test_add_pin(sim, &pin);
    }

    test_steps(sim, 300);
    assert_true(singe_sim_stats(sim).tears <= 13 * 9 / 2 + 16);
    assert_int_equal(lines, 1);
    check_view(sim);
}

/// Every allocation of the making fails once, and nothing is lost.
TEST(a_tear_without_memory_fails_cleanly) { test_allocations_fail(100, test_life(pull_def(), allocator), (void)0); }

/// Stretched beyond what it reaches, a sheet tears though its substeps carry less than its strength.
TEST(strong_sheets_tear_when_held_too_far_apart) {
    SingeSimDef def = pull_def();
    def.solver.substeps = 2;
    OwnSim *sim = pulled(&def, 500, 0.5f, NULL, 9e-3f);
    test_steps(sim, STEPS);
    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.tears > 0 && stats.pieces == 2);
    assert_true(stats.strain_mean < 0.002);
}

/// In a sheet that must tear, what is charred gives way, not fresh paper at its grips.
TEST(char_tears_before_paper_that_must_tear) {
    SingeSimDef def = pull_def();
    def.solver.substeps = 2;
    def.pace = 9;
    OwnSim *sim = pulled(&def, 500, 1, NULL, 0);
    for (int j = 0; j <= ACROSS; j++) test_spot(sim, 0.5f * ALONG * side, (float)j * side, 0, 6e-3f, 800, 40);
    test_steps(sim, STEPS);
    uint32_t fresh = 0, charred = 0;
    grip(sim, true, 9e-3f);
    test_steps(sim, STEPS);

    const SingeView view = singe_sim_view(sim);
    for (uint32_t v = (ALONG + 1) * (ACROSS + 1); v < view.vertex_count; v++) {
        if (!(view.particle_flags[v] & SINGE_ALIVE)) continue;
        if (view.mass[v] < 0.8f) charred++;
        else fresh++;
    }
    print_message("%u vertices torn in char, %u in paper\n", charred, fresh);
    assert_true(charred > 0);
    assert_int_equal(fresh, 0);
}

/// No vertex is ever weaker than what a step skips unseen: burnt to any mass, soaked, and in a sheet that must tear.
TEST(nothing_is_weaker_than_what_is_skipped) {
    for (int wet = 0; wet < 2; wet++)
        for (int ash = 0; ash < 2; ash++) {
            SingeSimDef def = pull_def();
            def.solver.substeps = 2;
            SingeMaterialDef material = singe_default_material();
            material.char_strength = singe_param(ash ? 0.2f : 20);
            if (!ash) material.char_yield = material.mass_min;
            if (wet) material.moisture = singe_param(0.5f);
            OwnSim *sim = pulled(&def, 500, 0.1f, &material, 0);
            State *state = &sim->state;
            TearPlan *plan = sim->tear;
            float least = INFINITY;

            for (int must = 0; must < 2; must++) {
                tear_stretched(plan, 0, must ? 2 : 1);
                for (uint32_t v = 0; v < (ALONG + 1) * (ACROSS + 1); v++)
                    for (int step = 0; step < 25; step++) {
                        state->burn.fuel[v] = 0.25f * (float)(step % 5);
                        const float min = material.mass_min.value * (1 - state->burn.fuel[v]) + state->burn.fuel[v];
                        state->burn.mass[v] = min + (1 - min) * 0.25f * (float)(step / 5);
                        if (wet) state->heat.water[v] = step % 2 ? 1 : 0;
                        least = float_min(least, tear_strength(plan, &sim->shell, state, v));
                    }
            }

            print_message("%s%s: %.4f N/m, skipped below %.4f\n", wet ? "wet, " : "", ash ? "with ash" : "char", least,
                          plan->safe_ash);
            assert_true(least >= plan->safe_ash * (1 - 1e-5f));
            assert_true(least < plan->safe_ash * 1.01f); // and no lower: each vertex that is examined costs time
        }
}

/// A strip whose middle is ash parts there under what hangs from it, though char would carry that four times.
TEST(ash_parts_under_what_char_carries) {
    for (int ash = 0; ash < 2; ash++) {
        SingeSimDef def = pull_def();
        def.gravity[0] = 9.81f, def.air_density = 0, def.solver.attachments = false;
        SingeMaterialDef material = singe_default_material();
        material.char_strength = singe_param(0.4f), material.mass_loss = singe_param(0);
        material.damping = singe_param(20);
        TestMesh mesh = test_grid(ALONG, ACROSS, side, side);
        OwnSim *sim = test_sim(&def, mesh, &material);
        grip(sim, false, 0);
        for (uint32_t v = 0; v < (ALONG + 1) * (ACROSS + 1); v++) {
            if (v % (ALONG + 1) != ALONG / 2) continue;
            sim->state.burn.fuel[v] = 0;
            sim->state.burn.mass[v] = ash ? material.mass_min.value : material.char_yield.value;
        }

        test_steps(sim, STEPS);
        const SingeStats stats = singe_sim_stats(sim);
        print_message("%s: %u tears\n", ash ? "ash" : "char", (unsigned)stats.tears);
        if (ash) assert_true(stats.tears > ACROSS / 2 && stats.pieces == 2);
        else assert_int_equal(stats.tears, 0);
    }
}

/// A disc: a hub of SPOKES / 2 cells, more than a split knows, in rings of SPOKES vertices.
enum { SPOKES = 56, RINGS = 6 };

static TestMesh make_disc(void) {
    TestMesh mesh = {.vertex_count = 1 + SPOKES * RINGS, .cell_count = SPOKES / 2 + SPOKES * (RINGS - 1)};
    mesh.positions = calloc(3 * mesh.vertex_count, sizeof *mesh.positions);
    mesh.uv = calloc(2 * mesh.vertex_count, sizeof *mesh.uv);
    mesh.cells = calloc(4 * mesh.cell_count, sizeof *mesh.cells);
    assert_true(mesh.positions && mesh.uv && mesh.cells);
    for (uint32_t v = 1; v < mesh.vertex_count; v++) {
        float angle = 6.2831853f * (float)((v - 1) % SPOKES) / SPOKES;
        float radius = side * (float)(8 + (v - 1) / SPOKES);
        mesh.positions[3 * v] = radius * cosf(angle), mesh.positions[3 * v + 1] = radius * sinf(angle);
    }

    uint32_t *cell = mesh.cells;
    for (uint32_t k = 0; k < SPOKES; k += 2, cell += 4)
        cell[1] = 1 + k, cell[2] = 2 + k, cell[3] = 1 + (k + 2) % SPOKES;
    for (uint32_t ring = 1; ring < RINGS; ring++)
        for (uint32_t k = 0; k < SPOKES; k++, cell += 4) {
            uint32_t next = (k + 1) % SPOKES, in = 1 + SPOKES * (ring - 1), out = in + SPOKES;
            cell[0] = in + k, cell[1] = out + k, cell[2] = out + next, cell[3] = in + next;
        }
    return mesh;
}

/// Spare vertices in use that lie where vertex `of` lies at rest.
static uint32_t twins(const SingeView *view, uint32_t input_count, uint32_t of) {
    uint32_t count = 0;
    for (uint32_t v = input_count; v < view->vertex_count; v++)
        count += (view->particle_flags[v] & SINGE_ALIVE) &&
                 !memcmp(view->rest_position[v], view->rest_position[of], sizeof view->rest_position[v]);
    return count;
}

/// A tear that runs into a vertex of more cells than can be split ends there.
TEST(tears_end_at_vertices_of_many_cells) {
    SingeSimDef def = pull_def();
    OwnTestMesh mesh = make_disc();
    float weak[1 + SPOKES * RINGS];

    for (uint32_t v = 0; v < mesh.vertex_count; v++) weak[v] = v > 0 && (v - 1) % (SPOKES / 2) == SPOKES / 4;
    const SingeAttribute attribute = {"weak", weak};
    SingeSheetDef sheet = test_sheet(&mesh);
    sheet.attribute_count = 1, sheet.attributes = &attribute;
    sheet.material.strength =
        singe_param_field(20, 1, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "weak"});
    OwnSim *sim = test_create(&def);
    SingeSheetId id = test_add_sheet(sim, &sheet);
    test_ok(sim, singe_sim_commit(sim));
    for (int right = 0; right < 2; right++) {
        uint32_t held[SPOKES], count = 0;
        for (uint32_t v = 1 + SPOKES * (RINGS - 1); v < mesh.vertex_count; v++)
            if (right ? mesh.positions[3 * v] > 6 * side : mesh.positions[3 * v] < -6 * side) held[count++] = v;
        const SingePoseKey path[2] = {test_key(0, 0, 0, 0), test_key(0.25f, right ? 9e-3f : 0, 0, 0)};
        SingePinDef pin = singe_default_pin();
        pin.vertex_count = count, pin.vertices = held, pin.path_count = 2, pin.path = path, pin.sheet = id;
        test_add_pin(sim, &pin);
    }

    test_steps(sim, STEPS);
    SingeView view = singe_sim_view(sim);
    assert_true(twins(&view, mesh.vertex_count, 1 + SPOKES / 4) > 0); // beside the hub
    assert_int_equal(twins(&view, mesh.vertex_count, 0), 0);
    check_view(sim);
}

static void flux_fails(void *context, const SingeView *view, float *flux, float *conductance, float *temperature) {
    (void)conductance, (void)temperature;
    for (uint32_t i = 0; i < view->particle_count && *(bool *)context; i++) flux[i] = NAN;
}

TEST(failed_steps_change_nothing) {
    OwnSim *sim = burning(1, SINGE_INSTRUCTIONS_BEST);
    SingeSourceDef source = singe_default_source();
    bool fails = false;

    source.kind = SINGE_SOURCE_CALLBACK, source.callback = flux_fails, source.callback_context = &fails;
    test_add_source(sim, &source);
    test_steps(sim, 75);
    assert_true(singe_sim_stats(sim).tears > 0);
    OwnTestBytes before = test_save(sim);
    SingeSim *other;
    test_ok(sim, singe_sim_clone(sim, &other));
    fails = true;
    test_refused(sim, SINGE_ERROR_DIVERGED, singe_sim_step(sim));
    test_assert_saved(sim, &before);
    fails = false;
    test_steps_alike(sim, other, 20);
    singe_sim_destroy(other);
}
