// The gas: its heat is kept, it rises as plumes do, sheets and colliders stop it, and it heats what it flows past.
#include "heat/rig.h"

#include "gas/gas_plan.h"

/// A level sheet of 8 x 8 cells of 5 mm with gas above it, in steps of 1/72 s.
typedef struct Air {
    Rig rig;
    GasPlan *plan;
    SingeWindDef wind;
} Air;

static GasSettings settings_default(void) {
    GasSettings settings = {.def = singe_default_gas(),
                            .gravity = {0, 0, -9.81f},
                            .ambient_temperature = 293,
                            .time_step = 1.0f / 72,
                            .pace = 1};
    settings.def.cell_size = 0.01f, settings.def.height = 0.5f, settings.def.radiated = 0, settings.def.conductance = 0;
    return settings;
}

static Air air_open(const GasSettings *settings) {
    RigDef def = rig_default(8, 8, 0.005f, 0.005f);
    Air a = {.rig = rig_open(&def), .wind = singe_default_wind()};
    SingeResult result = gas_plan_create(&a.rig.memory, &a.rig.shell, settings, &a.plan, &a.rig.state.gas);
    assert_int_equal(result, SINGE_OK);
    return a;
}

static void air_close(Air *a) {
    gas_plan_free(&a->rig.memory, a->plan);
    rig_close(&a->rig);
}
#define OwnAir OWNED(air_close) Air

static void air_step(Air *a) {
    Rig *rig = &a->rig;
    StepContext context = {.shell = &rig->shell,
                           .state = state_input(&rig->state),
                           .colliders = &rig->colliders,
                           .sources = &rig->sources,
                           .wind = &a->wind,
                           .pool = rig->pool};

    context.state.gas = NULL;
    gas_step(a->plan, &context, &rig->state.gas);
    rig->state.step++;
    rig->state.time = (double)rig->state.step / 72;
}

/// Burns as much as brings the gas `heat` J, evenly; of one layer only.
static void air_burn(Air *a, double heat, bool corners) {
    const Shell *shell = &a->rig.shell;
    double mass = 0;
    for (uint32_t i = 0; i < shell->particle_count; i++)
        if (shell_is_corner(shell, i) == corners)
            mass += (double)(shell->matter.mass[i] * field_at(shell->matter.gas_heat, i)) *
                    (1 - (double)field_at(shell->matter.char_yield, i));
    for (uint32_t i = 0; i < shell->particle_count; i++)
        if (shell_is_corner(shell, i) == corners) a->rig.state.burn.fuel[i] -= (float)(heat / mass);
}

static const GasTurn *air_turn(const Air *a) { return &a->plan->turn[a->rig.state.gas.turn]; }

/// J of heat and fuel in the gas.
static double air_heat(const Air *a) {
    const GasGrid *grid = &a->plan->grid;
    const GasTurn *turn = air_turn(a);
    double sum = 0, volume = pow((double)a->plan->cell, 3);
    for (size_t c = 0; c < grid->cells; c++)
        sum += (double)turn->field[GAS_FUEL][c] + (double)GAS_HEAT * (double)turn->field[GAS_LIGHTNESS][c];
    return sum * volume;
}

static double air_max(const Air *a, GasField field) {
    double max = 0;
    for (size_t c = 0; c < a->plan->grid.cells; c++) max = fmax(max, (double)air_turn(a)->field[field][c]);
    return max;
}

/// Burnt mass is in the gas, as fuel or as heat, until it reaches the border.
TEST(heat_is_kept) {
    GasSettings settings = settings_default();
    OwnAir air = air_open(&settings);
    double brought = 0;
    for (int step = 0; step < 24; step++) {
        if (step < 6) air_burn(&air, 1.5, false), brought += 1.5;
        air_step(&air);
    }
    print_message("%.3f J brought, %.3f J there\n", brought, air_heat(&air));
    CHECK_NEAR(air_heat(&air), brought, 0.02 * brought);
    print_message("fuel %.0f J/m3, L %.3f at most\n", air_max(&air, GAS_FUEL), air_max(&air, GAS_LIGHTNESS));
}

/// The part that is radiated is not in the gas, and a fire shown `pace` times as fast has the power of the real one.
TEST(power_is_the_real_fires) {
    double heat[3];
    for (int k = 0; k < 3; k++) {
        GasSettings settings = settings_default();
        settings.def.radiated = k == 1 ? 0.25f : 0, settings.pace = k == 2 ? 4 : 1;
        OwnAir air = air_open(&settings);
        air_burn(&air, 4, false);
        air_step(&air);
        heat[k] = air_heat(&air);
    }

    CHECK_NEAR(heat[0], 4, 0.01);
    CHECK_NEAR(heat[1], 3, 0.01);
    CHECK_NEAR(heat[2], 1, 0.01);
}

/// A source's flame brings its power to the gas at its centre, at any pace, from its start to its end.
TEST(a_source_with_power_has_a_flame) {
    const float centre[3] = {0.05f, -0.02f, 0.1f};
    for (int pace = 1; pace <= 5; pace += 4) {
        GasSettings settings = settings_default();
        settings.def.radiated = 0.25f, settings.pace = (float)pace;
        OwnAir air = air_open(&settings);
        SingeSourceDef match = singe_default_source();
        match.power = 60, match.start = 1.5f / 72, match.end = 3.5f / 72;
        memcpy(match.position, centre, sizeof centre);
        rig_source(&air.rig, &match);

        double heat[6];
        for (int step = 0; step < 6; step++) {
            air_step(&air);
            heat[step] = air_heat(&air);
            if (step != 2) continue;
            const GasPlan *plan = air.plan;
            const float *fuel = air_turn(&air)->field[GAS_FUEL];
            double sum = 0, moment[3] = {0, 0, 0};
            for (int k = 0; k < plan->grid.n[2]; k++)
                for (int j = 0; j < plan->grid.n[1]; j++)
                    for (int i = 0; i < plan->grid.n[0]; i++) {
                        double there = (double)fuel[gas_at(&plan->grid, i, j, k)];
                        const double at[3] = {i + 0.5, j + 0.5, k + 0.5};
                        sum += there;
                        for (int d = 0; d < 3; d++) moment[d] += there * at[d];
                    }

            for (int d = 0; d < 3; d++)
                CHECK_NEAR((double)plan->origin[d] + (double)plan->cell * moment[d] / sum, (double)centre[d], 0.002);
        }

        const double lit = 60.0 * 0.75 / 72; // J a step
        assert_true(heat[0] == 0 && heat[1] == 0);
        CHECK_NEAR(heat[2], lit, 0.01 * lit);
        CHECK_NEAR(heat[3], 2 * lit, 0.02 * lit);
        CHECK_NEAR(heat[5], 2 * lit, 0.05 * lit);
    }
}

/// What a jet makes of a steady fire: J/m3 of fuel and K where there is most, and how far along x its heat is, m.
static void blow(float speed, double found[3]) {
    GasSettings settings = settings_default();
    OwnAir air = air_open(&settings);
    SingeSourceDef jet = singe_default_source();
    jet.kind = SINGE_SOURCE_JET;
    jet.position[0] = -0.08f, jet.position[1] = 0.02f, jet.position[2] = 0.03f;
    jet.direction[0] = 1, jet.direction[1] = jet.direction[2] = 0;
    jet.radius = 0.03f, jet.speed = speed, jet.start = 60.5f / 72;
    rig_source(&air.rig, &jet);
    for (int step = 0; step < 100; step++) {
        air_burn(&air, 60.0 / 72, false);
        air_step(&air);
    }

    const GasGrid *grid = &air.plan->grid;
    double sum = 0, moment = 0;
    for (int k = 0; k < grid->n[2]; k++)
        for (int j = 0; j < grid->n[1]; j++)
            for (int i = 0; i < grid->n[0]; i++) {
                const double hot = (double)air_turn(&air)->field[GAS_LIGHTNESS][gas_at(grid, i, j, k)];
                sum += hot, moment += hot * (i + 0.5);
            }
    found[0] = air_max(&air, GAS_FUEL);
    found[1] = 293 / (1 - air_max(&air, GAS_LIGHTNESS));
    found[2] = (double)air.plan->origin[0] + (double)air.plan->cell * moment / sum;
}

TEST(jets_thin_fuel_cool_and_bend_flames) {
    double calm[3], breath[3], blown[3];
    blow(0, calm), blow(1, breath), blow(8, blown);
    for (int k = 0; k < 3; k++) {
        static const char *const names[] = {"fuel, J/m3", "hottest, K", "heat at x, m"};
        print_message("%s: %.4g calm, %.4g at 1 m/s, %.4g at 8 m/s\n", names[k], calm[k], breath[k], blown[k]);
    }
    assert_true(blown[0] < 0.4 * calm[0] && blown[0] < breath[0] && breath[0] < 0.8 * calm[0]);
    assert_true(blown[1] - 293 < 0.2 * (calm[1] - 293) && breath[1] - 293 < 0.7 * (calm[1] - 293));
    assert_true(breath[2] > calm[2] + 0.006); // faster, most of it has left the grid
}

/// Speed up on the axis of the mean plume at a height over the middle of a steady fire of `power` W.
static double plume_speed(double power, double height) {
    enum { FIRST = 200, LAST = 440, PLANE_MAX = 1000 };
    GasSettings settings = settings_default();
    OwnAir air = air_open(&settings);
    double sum[PLANE_MAX] = {0}, max = 0;
    for (int step = 0; step < LAST; step++) {
        air_burn(&air, power / 72, false); // more mass than there is: it only counts here
        air_step(&air);
        SingeGas gas = gas_view(air.plan);
        uint32_t k = (uint32_t)((height - (double)gas.origin[2]) / (double)gas.cell), plane = gas.size[0] * gas.size[1];
        assert_true(plane <= PLANE_MAX);
        for (uint32_t c = 0; step >= FIRST && c < plane; c++) sum[c] += (double)gas.velocity[c + (size_t)plane * k][2];
    }

    for (int c = 0; c < PLANE_MAX; c++) max = fmax(max, sum[c]);
    return max / (LAST - FIRST);
}

/// On the axis of a plume w = 3.4 (B/z)^(1/3) with B = g Q/(rho cp Ta) (Morton, Taylor & Turner 1956 with the constants
/// of Rouse, Yih & Humphreys 1952).
TEST(plumes_rise_by_their_law) {
    const double z = 0.4, low = 12.5, high = 100;
    double a = plume_speed(low, z), b = plume_speed(high, z);
    double law = 3.4 * cbrt(9.81 * low / (double)GAS_HEAT / z);
    print_message("%.1f W: %.3f m/s, law %.3f; %.0f W: %.3f m/s, law %.3f\n", low, a, law, high, b, 2 * law);
    assert_true(a > 0.7 * law && a < 1.5 * law);
    assert_true(b > 0.7 * 2 * law && b < 1.5 * 2 * law);
    assert_true(b / a > 1.5 && b / a < 2.6); // 2 if turbulent, 2.8 if laminar
}

/// A mesh and heights shut the cells that a box of the same shape shuts.
TEST(solids_shut_cells) {
    static float vertices[24];
    static const uint32_t triangles[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    static const float heights[4] = {0, 0, 0, 0};
    const float half[3] = {0.033f, 0.027f, 0.0301f};

    for (int k = 0; k < 24; k++) vertices[k] = (k / 3 >> k % 3 & 1 ? 1 : -1) * half[k % 3];
    static uint8_t expected[1 << 20];
    const SingeColliderKind kinds[3] = {SINGE_COLLIDER_BOX, SINGE_COLLIDER_MESH, SINGE_COLLIDER_HEIGHTFIELD};
    for (int q = 0; q < 3; q++) {
        GasSettings settings = settings_default();
        OwnAir air = air_open(&settings);
        SingePoseKey key = {.position = {0.02f, 0.02f, 0.18f}, .rotation = {0, 0, 0.3827f, 0.9239f}};
        SingeColliderDef def = singe_default_collider();
        def.kind = kinds[q], def.path_count = 1, def.path = &key;
        memcpy(def.half_size, half, sizeof half);
        def.vertex_count = 8, def.vertices = vertices, def.triangle_count = 12, def.triangles = triangles;
        def.columns = def.rows = 2, def.heights = heights, def.size[0] = 2 * half[0], def.size[1] = 2 * half[1];
        if (q == 2) key.position[2] += half[2];
        assert_int_equal(collider_create(&air.rig.memory, &def, &air.rig.colliders.items[0], NULL), SINGE_OK);
        air.rig.colliders.items[0].generation = 1;
        air.rig.colliders.count = 1;
        air_burn(&air, 1, true); // wakes it
        air_step(&air);
        const GasPlan *plan = air.plan;
        size_t solid = 0;
        assert_true(plan->grid.cells < sizeof expected);
        for (int k = 0; k < plan->grid.n[2]; k++)
            for (int j = 0; j < plan->grid.n[1]; j++)
                for (int i = 0; i < plan->grid.n[0]; i++) {
                    size_t c = gas_at(&plan->grid, i, j, k);
                    float z = plan->origin[2] + plan->cell * ((float)k + 0.5f);
                    if (q == 0) expected[c] = plan->solid[c];
                    else if (q == 1 || z > 0.18f - half[2]) assert_int_equal(plan->solid[c], expected[c]);
                    solid += plan->solid[c];
                }
        assert_true(solid > 20);
        collider_free(&air.rig.memory, &air.rig.colliders.items[0]);
    }
}

/// The flow's divergence is that of the expansion, nothing passes where the sheet is whole, and nothing enters a
/// collider.
TEST(flow_goes_around) {
    GasSettings settings = settings_default();
    OwnAir air = air_open(&settings);
    SingePoseKey key = {.position = {0, 0, 0.18f}, .rotation = {0, 0, 0, 1}};
    Collider *ball = &air.rig.colliders.items[0];
    *ball = (Collider){.generation = 1, .def = singe_default_collider()};
    ball->def.kind = SINGE_COLLIDER_SPHERE, ball->def.radius = 0.03f;
    key.position[0] = key.position[1] = 0.02f;
    assert_int_equal(path_set(&ball->path, &air.rig.memory, 1, &key, "collider", NULL), SINGE_OK);
    air.rig.colliders.count = 1;
    for (int step = 0; step < 40; step++) {
        air_burn(&air, 1, true);
        air_step(&air);
    }

    const GasPlan *plan = air.plan;
    const float *const *through = (const float *const *)&air_turn(&air)->field[GAS_THROUGH];
    double worst = 0, fastest = 0, covered = 0;
    for (int k = 0; k < plan->grid.n[2]; k++)
        for (int j = 0; j < plan->grid.n[1]; j++)
            for (int i = 0; i < plan->grid.n[0]; i++) {
                size_t c = gas_at(&plan->grid, i, j, k);
                double spread = 0;
                for (int d = 0; d < 3; d++) {
                    spread += (double)through[d][c + plan->grid.stride[d]] - (double)through[d][c];
                    fastest = fmax(fastest, fabs((double)through[d][c]));
                    if (plan->open[d][c] == 0) assert_true(through[d][c] == 0), covered++;
                }

                spread -= (double)(plan->expansion[c] * plan->cell / plan->dt);
                if (!plan->solid[c]) worst = fmax(worst, fabs(spread));
            }
    print_message("fastest %.3f m/s, divergence off by %.4f m/s at most, %.0f faces closed\n", fastest, worst, covered);
    assert_true(fastest > 0.2 && worst < 0.05 * fastest && covered > 20);

    // the sheet lies across the way up
    int level = (int)(0.01f - plan->origin[2] / plan->cell);
    size_t middle = gas_at(&plan->grid, plan->grid.n[0] / 2, plan->grid.n[1] / 2, level);
    assert_true(plan->open[2][middle] < 0.2f);
}

/// A sheet that stands over the fire is heated from where the gas comes, by no more than the gas is hot, and takes that
/// heat from it.
TEST(gas_heats_what_it_flows_past) {
    double left[2];
    for (int k = 0; k < 2; k++) {
        GasSettings settings = settings_default();
        settings.def.conductance = k ? 20 : 0;
        settings.gravity[2] = 0, settings.gravity[1] = -9.81f; // y is up: the sheet hangs
        OwnAir air = air_open(&settings);
        const Shell *shell = &air.rig.shell;
        for (int step = 0; step < 10; step++) {
            for (int column = 0; column < 8; column++)
                air.rig.state.burn.fuel[rig_centre(&air.rig, column, 3)] -= 0.02f;
            air_step(&air);
        }

        left[k] = air_heat(&air);
        const GasState *gas = &air.rig.state.gas;
        double above = 0, below = 0;
        for (uint32_t i = 0; i < shell->particle_count; i++) {
            float y = shell->rest_position[i][1], excess = gas->conductance[i] * (gas->temperature[i] - 293);
            assert_true(gas->temperature[i] >= 293 && gas->temperature[i] <= GAS_HOTTEST + 1);
            assert_true(gas->conductance[i] >= 0 && gas->conductance[i] <= settings.def.conductance);
            if (y > 0.022f) above += (double)excess;
            if (y < 0.012f) below += (double)excess;
        }

        assert_int_equal(gas->warm, k);
        if (k) assert_true(above > 10 * below && above > 0);
    }

    assert_true(left[1] < 0.99 * left[0]);
}

/// When all is over it rests, and wakes when something burns again.
TEST(the_gas_comes_to_rest) {
    GasSettings settings = settings_default();
    OwnAir air = air_open(&settings);
    assert_false(air.rig.state.gas.awake);
    air_step(&air);
    assert_false(air.rig.state.gas.awake);
    air_burn(&air, 0.5, false);
    air_step(&air);
    assert_true(air.rig.state.gas.awake);
    for (int step = 0; step < 3000 && air.rig.state.gas.awake; step++) air_step(&air);
    assert_false(air.rig.state.gas.awake);
    CHECK_NEAR(air_heat(&air), 0, 0);
    SingeGas gas = gas_view(air.plan);
    for (size_t c = 0; c < (size_t)gas.size[0] * gas.size[1] * gas.size[2]; c++) assert_true(gas.temperature[c] == 293);
    air_burn(&air, 0.5, false);
    air_step(&air);
    assert_true(air.rig.state.gas.awake && air_heat(&air) > 0.4);
}

/// Positions far away, at the border and not finite, and powers that no fire has.
TEST(copes_with_anything) {
    GasSettings settings = settings_default();
    settings.def.conductance = 20;
    OwnAir air = air_open(&settings);
    air.wind.velocity[0] = 300;
    float(*x)[4] = air.rig.state.dynamics.position;
    x[3][0] = 4000, x[4][2] = -900, x[5][0] = NAN, x[6][1] = INFINITY;
    x[7][0] = air.plan->origin[0], x[8][2] = air.plan->origin[2] + air.plan->cell * (float)air.plan->grid.n[2];
    for (int step = 0; step < 30; step++) {
        air_burn(&air, step % 3 ? 1 : 1e5, step % 2);
        if (step == 15) air.wind.velocity[0] = 0;
        air_step(&air);
        SingeGas gas = gas_view(air.plan);
        for (size_t c = 0; c < (size_t)gas.size[0] * gas.size[1] * gas.size[2]; c++) {
            assert_true(gas.temperature[c] >= 293 && gas.temperature[c] < 3000);
            assert_true(gas.smoke[c] >= 0 && isfinite(gas.smoke[c]) && gas.flame[c] >= 0 && isfinite(gas.flame[c]));
            for (int d = 0; d < 3; d++) assert_true(isfinite(gas.velocity[c][d]));
        }
    }
}

/// The grid holds the sheets with room above, and keeps to its budget.
TEST(grid_suits_the_sheets) {
    const float cells[] = {0, 0.005f, 1e-5f, 0.2f};
    for (int k = 0; k < 4; k++) {
        GasSettings settings = settings_default();
        settings.def.cell_size = cells[k];
        OwnAir air = air_open(&settings);
        SingeGas gas = gas_view(air.plan);
        double count = 1;
        for (int d = 0; d < 3; d++) {
            double low = (double)gas.origin[d], high = low + (double)gas.cell * gas.size[d];
            count *= gas.size[d];
            assert_true(low < -0.04 && high > (d == 2 ? 0.5 : 0.08));
        }

        assert_true(count <= 2e6);
        if (k == 1) assert_true(gas.cell == 0.005f);
    }
}
