// The paper's solver and its relatives: the matrix and its solution against dense ones, the same bytes for any threads
// and instructions, what fails and how, the mass-spring model's period, and the paper beside the strands.
#include "reference/spring_network.h"

#include "common/random.h"
#include "support/dense_solve.h"
#include "support/support.h"

// ---- free networks

enum { SIDE = 7, PARTICLES = SIDE * SIDE + 1, SPRINGS_MAX = 2 * SIDE * SIDE + SIDE };

/// A crumpled grid of springs, and a hub that is tied to a row of it: rows of all lengths, some springs not there, some
/// particles held and some without motion.
typedef struct Random {
    double positions[3 * PARTICLES], inverse_masses[PARTICLES], lengths[SPRINGS_MAX], weights[SPRINGS_MAX];
    double compliances[SPRINGS_MAX];
    uint8_t held[PARTICLES];
    uint32_t ends[SPRINGS_MAX][2];
    SingeNetworkDef def;
} Random;

static double noise(uint32_t a, uint32_t b) { return (double)random_unit(random_hash(a, b, 3, 9)); }

static void random_make(Random *random) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < PARTICLES; i++) {
        random->positions[3 * i] = i % SIDE + 0.2 * noise(i, 0);
        random->positions[3 * i + 1] = (double)(i / SIDE) + 0.2 * noise(i, 1);
        random->positions[3 * i + 2] = 0.4 * noise(i, 2);
        random->inverse_masses[i] = i % 11 == 0 ? 0 : 0.5 + noise(i, 3);
        random->held[i] = i % 13 == 5;
        if (i == PARTICLES - 1) break;

        if (i % SIDE + 1 < SIDE) random->ends[count][0] = i, random->ends[count++][1] = i + 1;
        if (i + SIDE < SIDE * SIDE) random->ends[count][0] = i + SIDE, random->ends[count++][1] = i;
        if (i < SIDE) random->ends[count][0] = i, random->ends[count++][1] = PARTICLES - 1;
    }

    for (uint32_t k = 0; k < count; k++) {
        random->lengths[k] = 0.8 + 0.4 * noise(k, 4);
        random->weights[k] = k % 9 == 2 ? 0 : 0.5 + 0.5 * noise(k, 5);
        random->compliances[k] = k % 3 == 0 ? 1e-3 * noise(k, 6) : 0;
    }

    random->def = singe_default_network();
    random->def.particle_count = PARTICLES, random->def.positions = random->positions;
    random->def.inverse_masses = random->inverse_masses, random->def.held = random->held;
    random->def.spring_count = count, random->def.ends = random->ends[0], random->def.lengths = random->lengths;
    random->def.weights = random->weights, random->def.compliances = random->compliances;
    random->def.time_step = 0.1, random->def.regularisation = 0.01, random->def.tolerance = 1e-13;
}

static SingeNetwork *network_make(const SingeNetworkDef *def) {
    SingeNetwork *network;
    SingeError error = {0};
    SingeResult result = singe_network_create(def, &network, &error);
    if (result) fail_msg("%s", error.message);
    return network;
}

/// Row k of the dense system, from the definition: its gradient, right-hand side and softness.
static void dense_row(const Random *random, uint32_t k, double *gradient, double *right, double *soft) {
    const SingeNetworkDef *def = &random->def;
    const uint32_t *e = random->ends[k];
    const double *w = random->inverse_masses, *x = random->positions;
    double d[3], length = 0, l = random->lengths[k];

    memset(gradient, 0, 3 * PARTICLES * sizeof *gradient);
    *right = *soft = 0;
    if (random->weights[k] == 0 || w[e[0]] + w[e[1]] == 0) return;

    for (uint32_t c = 0; c < 3; c++) d[c] = x[3 * e[1] + c] - x[3 * e[0] + c], length += d[c] * d[c];
    length = sqrt(length);
    for (uint32_t c = 0; c < 3; c++) {
        gradient[3 * e[0] + c] = -(def->literal ? 2 / l : 1 / length) * d[c];
        gradient[3 * e[1] + c] = -gradient[3 * e[0] + c];
    }

    *right = random->weights[k] * (def->literal ? length * length / l - l : (length * length - l * l) / (2 * length));
    if (!def->literal)
        *soft = def->regularisation * 0.5 * (w[e[0]] + w[e[1]]) +
                random->compliances[k] / (def->time_step * def->time_step);
}

static void check_dense(Random *random) {
    uint32_t n = random->def.spring_count, columns = 3 * PARTICLES;
    double *g = calloc((size_t)n * columns, sizeof *g), *a = calloc((size_t)n * n, sizeof *a);
    double *matrix = calloc((size_t)n * n, sizeof *matrix), *jacobian = calloc((size_t)n * columns, sizeof *jacobian);
    double *right = calloc(n, sizeof *right), *soft = calloc(n, sizeof *soft);

    for (uint32_t k = 0; k < n; k++) dense_row(random, k, g + k * columns, &right[k], &soft[k]);
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            for (uint32_t c = 0; c < columns; c++)
                a[i * n + j] += g[i * columns + c] * g[j * columns + c] * random->inverse_masses[c / 3];
            if (i == j) a[i * n + j] += soft[i];
        }

    SingeNetwork *network = network_make(&random->def);
    singe_network_matrix(network, 0, matrix);
    singe_network_jacobian(network, 0, jacobian);
    for (uint32_t i = 0; i < n * n; i++) assert_true(fabs(matrix[i] - a[i]) < 1e-12 * (1 + fabs(a[i])));
    for (uint32_t i = 0; i < n * columns; i++)
        assert_true(fabs(jacobian[i] - g[i] * sqrt(random->inverse_masses[i % columns / 3])) < 1e-12);
    dense_solve(a, right, n);

    SingeNetworkReport report;
    assert_int_equal(singe_network_project(network, 0, &report), SINGE_OK);
    assert_true(report.iterations > 0 && report.residual <= random->def.tolerance);

    const double *x = singe_network_positions(network);
    for (uint32_t c = 0; c < columns; c++) {
        double expected = random->positions[c];
        for (uint32_t k = 0; k < n && !random->held[c / 3]; k++)
            expected -= random->inverse_masses[c / 3] * g[k * columns + c] * right[k];
        assert_true(fabs(x[c] - expected) < 1e-9);
    }

    singe_network_destroy(network);
    free(g), free(a), free(matrix), free(jacobian), free(right), free(soft);
}

TEST(projection_matches_a_dense_solver) {
    Random random;
    random_make(&random);
    check_dense(&random);
    random.def.literal = true;
    check_dense(&random);
}

/// In exact arithmetic conjugate gradients end after as many iterations as there are unknowns. Steepest descent, which
/// they are without their beta, takes hundreds.
TEST(conjugate_gradients_end_after_as_many_iterations_as_unknowns) {
    enum { CHAIN = 24 };
    SingeNetworkDef def = singe_default_network();
    double positions[3 * (CHAIN + 1)] = {0}, lengths[CHAIN];
    uint32_t ends[2 * CHAIN];

    for (uint32_t i = 0; i <= CHAIN; i++) positions[3 * i] = i;
    for (uint32_t k = 0; k < CHAIN; k++) {
        ends[2 * k] = k, ends[2 * k + 1] = k + 1;
        lengths[k] = 0.9 + 0.2 * noise(k, 7);
    }

    def.particle_count = CHAIN + 1, def.positions = positions;
    def.spring_count = CHAIN, def.ends = ends, def.lengths = lengths;
    def.regularisation = 0, def.tolerance = 1e-10;
    SingeNetwork *network = network_make(&def);
    SingeNetworkReport report;
    assert_int_equal(singe_network_project(network, 0, &report), SINGE_OK);
    print_message("%d springs in a chain: %d iterations\n", CHAIN, (int)report.iterations);
    assert_true(report.iterations <= CHAIN);
    singe_network_destroy(network);
}

/// Fig 9 and Table 1, whose digits are cut.
TEST(table_1_is_reproduced) {
    static const double table[] = {0.4306, 0.4401, 0.5527, 0.4954, 0.5767, 0.5038, 0.5804, 0.5050, 0.5810, 0.5052};
    SingeNetworkDef def = singe_default_network();
    const double positions[] = {-1, 0, 0, 0, 0, 0, 1, 0, 0}, lengths[] = {1.65, 0.55};
    const uint32_t ends[] = {0, 1, 1, 2}, sets[] = {0, 1};
    const uint8_t held[] = {1, 0, 1};

    def.particle_count = 3, def.positions = positions, def.held = held;
    def.spring_count = 2, def.ends = ends, def.lengths = lengths, def.set_count = 2, def.sets = sets;
    def.regularisation = 0;
    for (int literal = 0; literal < 2; literal++) { // both constraints have the same Newton step
        def.literal = literal;
        SingeNetwork *network = network_make(&def);
        for (uint32_t i = 0; i < 10; i++) {
            assert_int_equal(singe_network_project(network, i % 2, NULL), SINGE_OK);
            double x = singe_network_positions(network)[3];
            assert_true(x >= table[i] && x < table[i] + 1e-4);
        }

        singe_network_destroy(network);
    }
}

/// Puts a value into a network that is good without it: does it stand?
#define STANDS(field, value)                                                                  \
    (random_make(&random), (random.field) = (value), error = (SingeError){0}, network = NULL, \
     singe_network_create(&random.def, &network, &error) == SINGE_OK && (singe_network_destroy(network), true))

/// Both ends of each range in singe/network.def, and what lies just beyond them.
TEST(networks_have_the_ranges_of_the_table) {
    Random random;
    SingeNetwork *network;
    SingeError error;
    int rows = 0;
#define WITHIN(low, high) low, high, false
#define OVER_UP_TO(low, high) low, high, true
#define BEYOND_INT(end) 1
#define BEYOND_DOUBLE(end) (1e-9 * (1 + fabs((double)(end))))
#define TRY_ENDS(TYPE, name, field, last, low, high, open)                                                \
    assert_true(STANDS(field, low) == !(open) && STANDS(field, high));                                    \
    assert_false(STANDS(field, (low)-BEYOND_##TYPE(low)) || STANDS(field, (high) + BEYOND_##TYPE(high))); \
    assert_int_equal(error.element, last);                                                                \
    assert_non_null(strstr(error.message, #name " must be ")), rows++;
#define TRY_ROW(...) TRY_ENDS(__VA_ARGS__)
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    TRY_ROW(TYPE, name, def.name, -1, range)
#define SINGE_NUMBERS(each, count, name, dimension, range, text) \
    TRY_ROW(DOUBLE, name, name[each * 9 + each - 1], 9, range)
#include "singe/network.def"
    assert_int_equal(rows, 10);
}

TEST(bad_networks_are_refused) {
    Random random;
    SingeNetwork *network;
    SingeError error;

    random_make(&random);
    random.ends[5][1] = PARTICLES;
    assert_int_equal(singe_network_create(&random.def, &network, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(error.element, 5);
    random_make(&random);
    random.lengths[7] = 0;
    assert_int_equal(singe_network_create(&random.def, &network, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(error.element, 7);

    random_make(&random);
    random.positions[4] = NAN;
    assert_int_equal(singe_network_create(&random.def, &network, &error), SINGE_ERROR_ARGUMENT);
    assert_null(network);
    random_make(&random);
    random.def.tolerance = 0;
    assert_int_equal(singe_network_create(&random.def, &network, NULL), SINGE_ERROR_ARGUMENT);

    // memory that fails at every place in turn
    random_make(&random);
    test_allocations_fail(3, (random.def.allocator = allocator, singe_network_create(&random.def, &network, &error)),
                          singe_network_destroy(network));
}

// ---- sheets

static SingeSim *swing(SingeSimDef *def, uint32_t cells, float side) {
    SingeMaterialDef material = singe_default_material();
    material.grammage = singe_param(0.1f);

    TestMesh mesh = test_grid(cells, cells, side / (float)cells, side / (float)cells);
    SingeSim *sim = test_sim(def, mesh, &material);
    SingePinDef pin = singe_default_pin();
    const uint32_t corners[] = {0, cells};
    pin.sheet = (SingeSheetId){0, 1}, pin.vertex_count = 2, pin.vertices = corners;
    test_add_pin(sim, &pin);
    return sim;
}

static SingeSimDef method_def(SingeSolverMethod method) {
    SingeSimDef def = singe_default_sim();
    singe_init_solver_method(&def.solver, sizeof def.solver, method);
    def.time_step = 0.002f;
    return def;
}

TEST(bytes_do_not_depend_on_threads) {
    const SingeSolverMethod methods[] = {SINGE_SOLVER_PAPER, SINGE_SOLVER_MASS_SPRING};
    for (int m = 0; m < 2; m++) {
        SingeSimDef def = method_def(methods[m]);
        def.solver.projections = 2, def.solver.substeps = m ? 60 : 2;
        OwnSim *one = swing(&def, 32, 0.5f);
        test_steps(one, 3);

        for (int i = 0; i < 3; i++) {
            SingeSimDef other = def;
            if (i < 2) other.thread_count = i ? 4 : 2;
            else other.instructions = SINGE_INSTRUCTIONS_PLAIN;
            OwnSim *sim = swing(&other, 32, 0.5f);
            test_steps(sim, 3);

            SingeView a = singe_sim_view(one), b = singe_sim_view(sim);
            assert_memory_equal(a.position, b.position, a.particle_count * sizeof *a.position);
            assert_memory_equal(a.velocity, b.velocity, a.particle_count * sizeof *a.velocity);
        }
    }
}

TEST(projections_end_early) {
    SingeSimDef def = method_def(SINGE_SOLVER_PAPER);
    uint64_t iterations[2];
    double height[2] = {0, 0};

    for (int early = 0; early < 2; early++) {
        def.solver.early_exit = early;
        OwnSim *sim = swing(&def, 10, 1);
        test_steps(sim, 50);

        SingeTimers timers = singe_sim_timers(sim);
        SingeView view = singe_sim_view(sim);
        for (uint32_t i = 0; i < view.particle_count; i++) height[early] += (double)view.position[i][2];
        iterations[early] = timers.projection_iterations;
        assert_true(timers.projection_flops > 0 && timers.projection_bytes > 0);
    }

    assert_true(iterations[1] < iterations[0]);
    assert_true(fabs(height[1] / height[0] - 1) < 1e-3);

    // at rest there is nothing to solve, and the early exit takes the first projection as the last
    def.gravity[2] = 0, def.solver.early_exit = true;
    OwnSim *sim = swing(&def, 10, 1);
    test_steps(sim, 2);

    SingeTimers timers = singe_sim_timers(sim);
    assert_int_equal(timers.projection_iterations, 0);
    assert_int_equal(timers.springs_projected, 2 * 1000);
}

/// To the letter it blows up, since eq 9 lacks its h; that is an error like any other, and takes the step back.
TEST(the_literal_method_diverges) {
    SingeSimDef def = method_def(SINGE_SOLVER_PAPER_LITERAL);
    OwnSim *sim = swing(&def, 8, 1);
    SingeResult result = SINGE_OK;
    int steps = 0;

    for (; steps < 100 && !result; steps++) result = singe_sim_step(sim);
    assert_int_equal(result, SINGE_ERROR_DIVERGED);
    assert_string_equal(singe_sim_error(sim)->stage, "dynamics");
    assert_true(strlen(singe_sim_error(sim)->message) > 10);

    SingeView view = singe_sim_view(sim);
    assert_int_equal(view.step, steps - 1);
    for (uint32_t i = 0; i < view.particle_count; i++) assert_true(isfinite(view.position[i][2]));
}

TEST(all_methods_run_or_give_a_reason) {
    for (int method = SINGE_SOLVER_STRAND; method <= SINGE_SOLVER_MASS_SPRING; method++) {
        SingeSimDef def = method_def((SingeSolverMethod)method);
        if (method == SINGE_SOLVER_ALL_AT_ONCE) def.solver.projections = 1;
        OwnSim *sim = swing(&def, 4, 0.4f);
        SingeResult result = SINGE_OK;
        for (int step = 0; step < 5 && !result; step++) result = singe_sim_step(sim);
        assert_true(result == SINGE_OK || result == SINGE_ERROR_DIVERGED);
        if (method == SINGE_SOLVER_PAPER || method == SINGE_SOLVER_MASS_SPRING) assert_int_equal(result, SINGE_OK);
    }
}

/// Mean strain of a colour's springs against their targets.
static double strain_of(const SingeView *view, SingeColour colour) {
    double sum = 0;
    for (uint32_t s = 0; s < view->spring_count[colour]; s++) {
        const float *a = view->position[view->springs[colour][s][0]], *b = view->position[view->springs[colour][s][1]];
        const double x = (double)(a[0] - b[0]), y = (double)(a[1] - b[1]), z = (double)(a[2] - b[2]);
        sum += fabs(sqrt(x * x + y * y + z * z) / (double)view->spring_length[colour][s] - 1);
    }
    return sum / view->spring_count[colour];
}

/// The strain of blue springs in a sheet whose blue layer shrinks by a tenth, so that its colours contradict each other.
static double strain_by_order(SingeSolverMethod method, const SingeColour order[SINGE_COLOUR_COUNT]) {
    SingeSimDef def = method_def(method);
    SingeMaterialDef material = singe_default_material();
    material.temperature = singe_param(600), material.ignition_temperature = singe_param(500);
    material.rate_ceiling = singe_param(1e6f), material.mass_rate = singe_param(0.02f);
    material.air_supply = singe_param(INFINITY);
    material.ash_exponent = material.heat_share = singe_param(0), material.ash_density = singe_param(1);
    material.shrink_front = singe_param(0), material.shrink_back = material.fibre_shrink = singe_param(1);
    material.mass_min = singe_param(0.9f), material.mass_loss = material.char_yield = singe_param(0);

    memcpy(def.solver.order, order, sizeof def.solver.order);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) material.compliance[c] = singe_param(0);

    TestMesh mesh = test_grid(8, 8, 0.005f, 0.005f);
    OwnSim *sim = test_sim(&def, mesh, &material);
    test_steps(sim, 40);

    SingeView view = singe_sim_view(sim);
    const double strain = strain_of(&view, SINGE_BLUE);
    return strain;
}

TEST(the_last_colour_of_the_order_is_satisfied_best) {
    static const SingeColour first[] = {SINGE_BLUE, SINGE_RED, SINGE_GREEN, SINGE_YELLOW};
    static const SingeColour last[] = {SINGE_RED, SINGE_GREEN, SINGE_YELLOW, SINGE_BLUE};
    for (int method = SINGE_SOLVER_STRAND; method <= SINGE_SOLVER_PAPER; method++) {
        const double early = strain_by_order((SingeSolverMethod)method, first);
        const double late = strain_by_order((SingeSolverMethod)method, last);
        print_message("method %d: strain of blue %.3f %% as the first, %.3f %% as the last\n", method, 100 * early,
                      100 * late);
        assert_true(late > 0 && early / late > 2);
    }
}

TEST(contact_is_inside_projections) {
    SingeSimDef def = method_def(SINGE_SOLVER_PAPER);
    OwnSim *sim = swing(&def, 8, 0.2f);
    SingeColliderDef plane = singe_default_collider();
    SingePoseKey position = test_key(0, 0, 0, -0.05f);

    plane.path_count = 1, plane.path = &position;
    test_add_collider(sim, &plane);
    for (int step = 0; step < 150; step++) {
        test_steps(sim, 1);
        SingeView view = singe_sim_view(sim);
        for (uint32_t i = 0; i < view.particle_count; i++)
            assert_true(view.position[i][2] >= -0.05f + plane.offset - 1e-6f);
    }

    SingeTimers timers = singe_sim_timers(sim);
    assert_true(timers.contacts > 0);
}

/// Both end where the sheet hangs at rest.
TEST(paper_and_strand_end_alike) {
    float last[2][200][3];
    uint32_t count = 0;
    for (int method = SINGE_SOLVER_STRAND; method <= SINGE_SOLVER_PAPER; method++) {
        SingeSimDef def = method_def((SingeSolverMethod)method);
        def.solver.substeps = 1, def.solver.projections = 40;
        def.solver.smoothing = def.solver.height_min = 0;
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) def.solver.regularisation[c] = 1e-2f;

        OwnSim *sim = swing(&def, 6, 0.06f);
        SingeWindDef wind = singe_default_wind();
        test_ok(sim, singe_sim_set_wind(sim, &wind));
        test_steps(sim, 1500);

        SingeView view = singe_sim_view(sim);
        count = view.particle_count;
        assert_true(count <= 200);
        for (uint32_t i = 0; i < count; i++) memcpy(last[method][i], view.position[i], sizeof last[method][i]);
    }

    double worst = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) worst = fmax(worst, fabs((double)last[0][i][c] - (double)last[1][i][c]));
    print_message("largest distance of paper and strand at rest: %.2e m of 0.06\n", worst);
    assert_true(worst < 3e-4);
}

TEST(commits_fail_cleanly_without_memory) {
    test_allocations_fail(50, test_life(method_def(SINGE_SOLVER_PAPER), allocator), (void)0);
    test_allocations_fail(50, test_life(method_def(SINGE_SOLVER_ALL_AT_ONCE), allocator), (void)0);
}

// ---- mass-spring

/// Two masses and a spring: omega^2 = k (w_a + w_b) (1 - zeta^2), zeta = 0.1.
TEST(a_spring_has_its_period) {
    Memory memory = memory_make((SingeAllocator){0});
    const uint32_t ends[1][2] = {{0, 1}};
    NetworkSprings springs = {1, ends};
    Network network;

    assert_int_equal(network_create(&memory, 2, 1, &springs, false, &network), SINGE_OK);
    const double stiffness = 50, h = 1e-4;
    float velocity[2][4] = {{0}};
    network.inverse_mass[0] = 20, network.inverse_mass[1] = 70;
    network.groups[0].length[0] = 1, network.groups[0].weight[0] = 1;
    network.position[1][0] = 1.01;

    double before = 0.01, first = 0, last = 0;
    int crossings = 0;
    for (int step = 1; step <= 4000; step++) {
        double predicted[2];
        for (int i = 0; i < 2; i++) predicted[i] = network.position[i][0] += h * (double)velocity[i][0];
        mass_spring_project(&network, stiffness, (const float(*)[4])velocity, h, NULL);
        for (int i = 0; i < 2; i++) velocity[i][0] += (float)((network.position[i][0] - predicted[i]) / h);

        double now = network.position[1][0] - network.position[0][0] - 1;
        if (before > 0 && now <= 0) {
            last = step - now / (now - before);
            if (crossings++ == 0) first = last;
        }

        before = now;
    }

    assert_true(crossings > 3);
    double period = h * (last - first) / (crossings - 1);
    double expected = 2 * 3.14159265358979 / sqrt(stiffness * 90 * (1 - 0.01));
    print_message("period %.5f s, by the formula %.5f s\n", period, expected);
    assert_true(fabs(period / expected - 1) < 1e-3);
    network_free(&memory, &network);
    assert_int_equal(memory.held, 0);
}

TEST(too_long_a_step_is_an_error) {
    SingeSimDef def = method_def(SINGE_SOLVER_MASS_SPRING);
    def.solver.substeps = 1, def.solver.stiffness = 1e5f;
    OwnSim *sim = swing(&def, 8, 0.2f);
    SingeResult result = SINGE_OK;
    for (int step = 0; step < 200 && !result; step++) result = singe_sim_step(sim);
    assert_int_equal(result, SINGE_ERROR_DIVERGED);
    assert_string_equal(singe_sim_error(sim)->stage, "dynamics");
}
