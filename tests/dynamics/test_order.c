// Layers stay in order: after every step each centre is in front of its cell's corners.
#include "sample_sheets.h"

#include "dynamics/dynamics_plan.h"

/// A number from -1 to 1 that looks random.
static float scatter(uint32_t i) { return 2 * (float)((i * 2654435761u >> 8) % 65536) / 65535 - 1; }

/// A sheet whose particles have been thrown about by more than a cell and a thickness.
static Bench open_jumble(int threads) {
    Bench bench = bench_open(quads_grid(24, 20, 0.005f, 0.004f, false), NULL, threads);
    DynamicsState *dynamics = &bench.state.dynamics;
    dynamics->pinned[shell_centre(&bench.shell, 7)] = dynamics->pinned[bench.shell.cells[7][1]] = 1;
    dynamics_prepare(bench.plan, &bench.shell, STATE_INPUT(&bench.state), &bench.wind, NULL, bench.pool, dynamics);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            dynamics->position[i][k] += 0.006f * scatter(3 * i + k);
            dynamics->velocity[i][k] = scatter(7 * i + k);
        }
    return bench;
}

static void order(Bench *bench) {
    dynamics_order(bench->plan, &bench->shell, &bench->state.ablate, bench->pool, &bench->state.dynamics);
}

/// m/s, of a cell's centre away from its corners.
static double parting(const Bench *bench, uint32_t c) {
    const uint32_t *corner = bench->shell.cells[c];
    const float(*x)[4] = (const float(*)[4])bench->state.dynamics.position;
    const float(*v)[4] = (const float(*)[4])bench->state.dynamics.velocity;
    Float3 normal = float3_unit(float3_cross(float3_sub(float3_load(x[corner[2]]), float3_load(x[corner[0]])),
                                             float3_sub(float3_load(x[corner[3]]), float3_load(x[corner[1]]))));
    Float3 away = float3_load(v[shell_centre(&bench->shell, c)]);
    for (int i = 0; i < 4; i++) away = float3_mad(away, float3_load(v[corner[i]]), -0.25f);
    return (double)float3_dot(away, normal);
}

TEST(only_centres_move) {
    OwnBench bench = open_jumble(1);
    const uint32_t vertices = bench.shell.vertex_count, cells = bench.shell.cell_count;
    size_t size = bench.shell.particle_count * sizeof *bench.state.dynamics.position;
    float(*x)[4] = malloc(size), (*v)[4] = malloc(size);
    memcpy(x, bench.state.dynamics.position, size), memcpy(v, bench.state.dynamics.velocity, size);
    double *before = malloc(cells * sizeof *before), min = 0.1 * 0.3 * 1e-3;
    uint32_t low = 0;
    for (uint32_t c = 0; c < cells; c++) low += (before[c] = bench_height(&bench, c)) < min;
    assert_true(low > cells / 4 && low < 3 * cells / 4);
    order(&bench);
    assert_memory_equal(x, bench.state.dynamics.position, vertices * sizeof *x);
    assert_memory_equal(v, bench.state.dynamics.velocity, vertices * sizeof *v);
    for (uint32_t c = 0; c < cells; c++) {
        uint32_t centre = shell_centre(&bench.shell, c);
        bool same = memcmp(x[centre], bench.state.dynamics.position[centre], sizeof *x) == 0;
        assert_true(same == (before[c] >= min));
        assert_true(bench_height(&bench, c) > 0.99 * min);
        if (same) assert_memory_equal(v[centre], bench.state.dynamics.velocity[centre], sizeof *v);
        else if (c != 7) assert_true(parting(&bench, c) > -1e-5); // cell 7's is pinned
    }

    free(x), free(v), free(before);
}

/// Positions after one projection of all heights, some cells of which are gone.
static void lift(Bench *bench, SingeInstructions instructions, const float (*start)[4], float (*result)[4]) {
    const size_t size = bench->shell.particle_count * sizeof *result;
    float(*x)[4] = bench->state.dynamics.position;
    bench->plan->kernels = kernels_choose(instructions);
    memset(bench->plan->height_wait, 0, height_wait_count(&bench->shell));
    memcpy(x, start, size);
    height_project(bench->plan, &bench->shell, &bench->state.ablate, bench->pool, &bench->state.dynamics);
    memcpy(result, x, size);
}

TEST(heights_are_the_same_in_lanes_of_every_width) {
    OwnBench bench = open_jumble(2);
    const size_t size = bench.shell.particle_count * sizeof *bench.state.dynamics.position;
    float(*start)[4] = malloc(size), (*four)[4] = malloc(size), (*lanes)[4] = malloc(size);
    memcpy(start, bench.state.dynamics.position, size);
    for (uint32_t c = 0; c < bench.shell.cell_count; c += 9) bench.state.ablate.cell_flags[c] = 0;
    lift(&bench, SINGE_INSTRUCTIONS_PLAIN, (const float(*)[4])start, four);
    for (int i = SINGE_INSTRUCTIONS_X86_V2; i <= SINGE_INSTRUCTIONS_X86_V4; i++) {
        if (!kernels_choose((SingeInstructions)i)) continue;
        lift(&bench, (SingeInstructions)i, (const float(*)[4])start, lanes);
        assert_memory_equal(four, lanes, size);
    }

    // what was low has risen, unless it is held; what is gone has not
    for (uint32_t c = 0; c < bench.shell.cell_count; c++) {
        const uint32_t centre = shell_centre(&bench.shell, c);
        const bool moved = memcmp(start[centre], four[centre], sizeof *start) != 0, gone = c % 9 == 0;
        assert_true(!(moved && (gone || bench.state.dynamics.pinned[centre])));
    }
    assert_memory_not_equal(start, four, size);
    free(start), free(four), free(lanes);
}

TEST(bytes_do_not_depend_on_threads) {
    OwnBench one = open_jumble(1), three = open_jumble(3);
    order(&one), order(&three);
    assert_memory_equal(one.state.arena, three.state.arena, one.state.arena_size);
}

/// A pinned centre gives way as well. A cell crushed to a line has no front: its centre stays where it is.
TEST(pinned_and_crushed_cells_stay_ordered) {
    OwnBench bench = bench_open(quads_grid(3, 3, 0.005f, 0.005f, false), NULL, 1);
    float(*x)[4] = bench.state.dynamics.position, *pinned = x[shell_centre(&bench.shell, 0)];
    float *crushed = x[shell_centre(&bench.shell, 8)];
    bench.state.dynamics.pinned[shell_centre(&bench.shell, 0)] = 1;
    bench_prepare(&bench);
    pinned[2] = -0.002f;
    for (int i = 0; i < 4; i++) x[bench.shell.cells[8][i]][1] = x[bench.shell.cells[8][i]][2] = 0;
    crushed[2] = -0.002f;
    order(&bench);
    assert_true(bench_height(&bench, 0) > 0);
    assert_true(crushed[2] == -0.002f);
}

static uint32_t step_and_count(SingeSim *sim, int steps) {
    uint32_t max = 0;
    for (int s = 0; s < steps; s++) {
        test_steps(sim, 1);
        uint32_t inverted = singe_sim_stats(sim).inverted_cells;
        if (inverted > max) max = inverted;
    }

    return max;
}

/// A box comes down on a rumpled sheet on the ground, front up or down, and shoves it aside.
TEST(a_sheet_pressed_on_the_ground_stays_ordered) {
    for (int down = 0; down < 2; down++) {
        TestMesh mesh = test_grid(30, 30, 0.004f, 0.004f);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            float *p = mesh.positions + 3 * v;
            p[2] = 0.02f + 0.006f * sinf(170 * p[0]) * cosf(140 * p[1] + 90 * p[0]);
        }

        for (uint32_t c = 0; down && c < mesh.cell_count; c++) {
            uint32_t *cell = mesh.cells + 4 * c, swap = cell[1];
            cell[1] = cell[3], cell[3] = swap;
        }

        SingeSimDef def = singe_default_sim();
        def.time_step = 1.0f / 240;
        OwnSim *sim = test_sim(&def, mesh, NULL);
        SingeColliderDef ground = singe_default_collider(), box = singe_default_collider();
        const SingePoseKey floor = test_key(0, 0, 0, 0);
        const SingePoseKey displacement[] = {test_key(0, 0.06f, 0.06f, 0.08f), test_key(0.3f, 0.06f, 0.06f, 0.032f),
                                             test_key(0.5f, 0.10f, 0.07f, 0.032f)};
        ground.path_count = 1, ground.path = &floor;
        box.kind = SINGE_COLLIDER_BOX, box.friction = 0.8f, box.path_count = 3, box.path = displacement;
        box.half_size[0] = box.half_size[1] = 0.05f, box.half_size[2] = 0.03f;
        test_add_collider(sim, &ground);
        test_add_collider(sim, &box);
        assert_int_equal(step_and_count(sim, 140), 0);
    }
}

/// A sheet that burns without ablation, held at one side, shrinks to half its size within half a second.
TEST(a_shrinking_sheet_stays_ordered) {
    SingeMaterialDef material = singe_default_material();
    material.ablate = false, material.temperature = singe_param(600), material.mass_rate = singe_param(0.04f);
    material.ash_exponent = material.convection = material.emissivity = material.heat_share = singe_param(0);
    material.fibre_shrink = singe_param(1), material.shrink_front = material.shrink_back = singe_param(1);
    material.char_yield = singe_param(0), material.ash_density = singe_param(0.3f);
    material.air_supply = singe_param(INFINITY);
    TestMesh mesh = test_grid(30, 30, 0.01f, 0.01f);
    test_mesh_raise(&mesh);
    SingeSimDef def = singe_default_sim();
    def.time_step = 1.0f / 240;
    OwnSim *sim = test_sim(&def, mesh, &material);
    SingePinDef pin = singe_default_pin();
    const float corner[3] = {0, 0, 0.3f};
    pin.sheet = (SingeSheetId){0, 1}, pin.point_count = 1, pin.points = corner, pin.radius = 0.02f;
    test_add_pin(sim, &pin);
    assert_int_equal(step_and_count(sim, 180), 0);
    SingeView view = singe_sim_view(sim); // yellow, the first of the middle's cells
    assert_true(view.spring_length[SINGE_YELLOW][view.spring_count[SINGE_YELLOW] / 2] < 0.6f * 0.01414f);
}
