// Plastic creases: what a fold is, what of it stays, and what does not.
#include "sample_sheets.h"

#include "dynamics/dynamics_plan.h"

static const double pi = 3.14159265358979323846;

/// Rolls a flat sheet of cells dx long about the y axis so that neighbouring cells along x meet at an angle, positive
/// away from the centres, which stay upright over their cells.
static void rig_roll(Bench *rig, double dx, double angle) {
    const Shell *shell = &rig->shell;
    float(*x)[4] = rig->state.dynamics.position;
    const double radius = angle == 0 ? 0 : dx / 2 / sin(angle / 2);

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        double along = (double)shell->rest_position[i][0] / dx * angle, rest = (double)shell->rest_position[i][2];
        bool centre = !shell_is_corner(shell, i);
        double r = (centre ? radius * cos(angle / 2) : radius) + rest; // cells are chords
        x[i][0] = (float)(angle == 0 ? (double)shell->rest_position[i][0] : r * sin(along));
        x[i][1] = shell->rest_position[i][1];
        x[i][2] = (float)(angle == 0 ? rest : r * cos(along) - radius);
    }
}

/// Rolls a flat sheet to a curvature about a line that is turned from the y axis by `turn`.
static void rig_roll_aslant(Bench *rig, double curvature, double turn) {
    const Shell *shell = &rig->shell;
    float(*x)[4] = rig->state.dynamics.position;
    const double c = cos(turn), s = sin(turn);

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        const float *rest = shell->rest_position[i];
        double along = c * (double)rest[0] + s * (double)rest[1], side = c * (double)rest[1] - s * (double)rest[0];
        double r = 1 / curvature + (double)rest[2], rolled = r * sin(along * curvature);
        x[i][0] = (float)(c * rolled - s * side), x[i][1] = (float)(s * rolled + c * side);
        x[i][2] = (float)(r * cos(along * curvature) - 1 / curvature);
    }
}

static void rig_pass(Bench *rig, int steps) {
    for (int s = 0; s < steps; s++)
        dynamics_crease(rig->plan, &rig->shell, STATE_INPUT(&rig->state), rig->pool, 1.0f / 480, &rig->state.dynamics);
}

/// Whether a green spring lies along x.
static bool along_x(const Shell *shell, uint32_t k) {
    const uint32_t *ends = shell->springs[SINGE_GREEN].ends[k];
    return fabsf(shell->rest_position[ends[0]][1] - shell->rest_position[ends[1]][1]) < 1e-5f;
}

static double distance(const float *a, const float *b) {
    return (double)float3_length(float3_sub(float3_load(b), float3_load(a)));
}

/// A rolled sheet has the length that the crease's formula gives: on it every spring of every colour is at rest.
TEST(lengths_fit_a_rolled_sheet) {
    const double dx = 0.004, angles[] = {0.5, 0.2, -0.3, -0.9};
    OwnBench rig = bench_open_creased(test_grid(12, 4, (float)dx, 0.003f), NULL, 1);
    const SpringSet *green = &rig.shell.springs[SINGE_GREEN];
    for (int a = 0; a < 4; a++) {
        rig_roll(&rig, dx, angles[a]);
        for (uint32_t k = 0; k < green->count; k++) {
            const float(*x)[4] = (const float(*)[4])rig.state.dynamics.position;
            double ratio = distance(x[green->ends[k][0]], x[green->ends[k][1]]) / (double)green->rest[k];
            float angle = along_x(&rig.shell, k) ? (float)angles[a] : 0;
            double expected = (double)crease_ratio(&rig.plan->hinges[k], angle, angle);
            assert_true(fabs(ratio - expected) < 1e-4);
        }
    }
}

/// From wherever it is seen, a creased spring bends as a flat sheet does: moment 4 t^2 a rad of alpha.
TEST(a_creased_spring_bends_as_a_flat_one) {
    OwnBench rig = bench_open_creased(test_grid(4, 4, 0.003f, 0.003f), NULL, 1);
    const Hinge *hinge = &rig.plan->hinges[0];
    const double rest = (double)rig.shell.springs[SINGE_GREEN].rest[0], thickness = 1e-3, step = 1e-2;
    const double pairs[][2] = {{0.2, 0.45}, {0.4, 0.2}, {-0.3, -0.7}, {-0.5, 0.1}};
    for (int p = 0; p < 4; p++) {
        double stays = pairs[p][0], now = pairs[p][1];
        double target = rest * (double)crease_ratio(hinge, (float)stays, (float)now);
        double length[3]; // of folds of now and a little more and less
        for (int k = 0; k < 3; k++) {
            float angle = (float)(now + step * (k - 1));
            length[k] = rest * (double)crease_ratio(hinge, angle, angle);
        }
        double moment = (length[1] - target) * (length[2] - length[0]) / step;
        assert_true(fabs(moment / (4 * thickness * thickness * (now - stays) / 2) - 1) < 0.01);
    }
}

/// The mesh holds no more than its greatest length, and at no crease a ratio of exactly 1, however it lies at rest.
TEST(a_mesh_bounds_its_creases) {
    const TestMesh meshes[] = {test_grid(6, 6, 0.004f, 0.004f), test_cylinder(24, 6, 0.02f, 0.03f),
                               test_torus(24, 12, 0.05f, 0.015f)};
    for (int m = 0; m < 3; m++) {
        OwnBench rig = bench_open_creased(meshes[m], NULL, 1);
        for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++) {
            const Hinge *hinge = &rig.plan->hinges[k];
            float max = 1 / cosf(hinge->lean), before = crease_ratio(hinge, -3, -3);
            assert_true(crease_ratio(hinge, 0, 0) == 1);
            assert_true(before > 0.01f);
            for (float angle = -2.9f; angle < 3; angle += 0.1f) {
                float ratio = crease_ratio(hinge, angle, angle);
                assert_true(ratio >= before && ratio <= max);
                before = ratio;
            }
        }
    }
}

/// Bent to the curvature k, share (k - 1/radius) stays, to both sides and on every mesh; bent less, nothing does.
TEST(a_share_of_the_curvature_stays) {
    SingeMaterialDef material = singe_default_material();
    material.curvature_max = singe_param(0); // no limit on bends
    const double yield = 1 / (double)material.crease_radius.value, share = (double)material.crease_share.value;
    const double bends[] = {150, -150, 0.95 * yield, -0.95 * yield};
    for (int fine = 0; fine < 2; fine++)
        for (int b = 0; b < 4; b++) {
            const double dx = fine ? 0.002 : 0.004, angle = bends[b] * dx;
            OwnBench rig = bench_open_creased(test_grid(fine ? 16 : 8, 4, (float)dx, 0.003f), &material, 1);
            rig_roll(&rig, dx, angle);
            rig_pass(&rig, 200);
            double expected = share * fmax(0, fabs(bends[b]) - yield);
            for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++) {
                bool along = along_x(&rig.shell, k);
                assert_true(fabs((double)rig.state.dynamics.bend[k] - (along ? bends[b] : 0)) < 0.3);
                double crease = (double)rig.state.dynamics.crease[k], signed_as = along && bends[b] < 0 ? -1 : 1;
                assert_true(fabs(signed_as * crease - (along ? expected : 0)) < 0.3);
            }

            // let go it keeps that; bent back a little less than it takes to yield again, too
            float kept = rig.state.dynamics.crease[0];
            rig_roll(&rig, dx, (double)kept * dx);
            rig_pass(&rig, 200);
            rig_roll(&rig, dx, ((double)kept - copysign(0.9 * yield, bends[b])) * dx);
            rig_pass(&rig, 200);
            assert_true(rig.state.dynamics.crease[0] == kept);
        }
}

/// A sheet that is rolled aslant keeps the same share of the curvature as one that is rolled along its mesh. Where k_y
/// counted in full at every edge, a roll of 150/m along the diagonals would leave 6.7/m there, not 33. Edges that the
/// fold bends by less than 2/5 of its curvature keep no more than that.
TEST(the_share_does_not_depend_on_direction) {
    const SingeMaterialDef material = singe_default_material();
    const double yield = 1 / (double)material.crease_radius.value, share = (double)material.crease_share.value;
    const double turns[] = {0, 15, 30, 45, 60}, bends[] = {150, -150, 0.95 * yield};

    for (int t = 0; t < 5; t++)
        for (int b = 0; b < 3; b++) {
            const double turn = turns[t] * pi / 180, k = bends[b];
            OwnBench rig = bench_open_creased(test_grid(12, 12, 0.001f, 0.001f), NULL, 1);
            rig_roll_aslant(&rig, k, turn);
            rig_pass(&rig, 200);
            for (uint32_t i = 0; i < rig.shell.springs[SINGE_GREEN].count; i++) {
                double part = along_x(&rig.shell, i) ? cos(turn) * cos(turn) : sin(turn) * sin(turn);
                double expected = part < 0.4 ? NAN : copysign(share * fmax(0, fabs(k) - yield) * part, k);
                double kept = (double)rig.state.dynamics.crease[i];
                if (!isnan(expected)) assert_true(fabs(kept - expected) < 0.03 * fabs(k) * part);
                else assert_true(kept * k >= 0 && fabs(kept) <= share * fabs(k) * part + 0.3);
            }
        }
}

/// A single edge that is bent keeps a third less than it would in an arc: 2/3 of 150/m count.
TEST(a_single_edge_keeps_less) {
    const SingeMaterialDef material = singe_default_material();
    const double yield = 1 / (double)material.crease_radius.value, share = (double)material.crease_share.value;
    const float dx = 0.004f, middle = 4 * dx, c = cosf(150 * dx), s = sinf(150 * dx);

    OwnBench rig = bench_open_creased(test_grid(8, 4, dx, 0.003f), NULL, 1);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) {
        const float *rest = rig.shell.rest_position[i];
        float *x = rig.state.dynamics.position[i], along = rest[0] - middle;
        if (along > 1e-5f) x[0] = middle + c * along + s * rest[2], x[2] = c * rest[2] - s * along;
    }

    rig_pass(&rig, 200);
    int creased = 0;
    for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++) {
        double crease = (double)rig.state.dynamics.crease[k];
        if (crease == 0) continue;
        assert_true(fabs(crease - share * (100 - yield)) < 0.5);
        creased++;
    }

    assert_int_equal(creased, 4);
}

/// Bending beyond the limit of curvature leaves no more than bending to the limit; below it, the limit has no effect.
TEST(no_crease_is_sharper_than_the_limit) {
    SingeMaterialDef material = singe_default_material();
    const double yield = 1 / (double)material.crease_radius.value, share = (double)material.crease_share.value;
    const double bends[] = {150, -150, 90}, dx = 0.004;
    material.curvature_max = singe_param(100);
    for (int b = 0; b < 3; b++) {
        OwnBench rig = bench_open_creased(test_grid(8, 4, (float)dx, 0.003f), &material, 1);
        rig_roll(&rig, dx, bends[b] * dx);
        rig_pass(&rig, 200);
        double expected = copysign(share * (fmin(fabs(bends[b]), 100) - yield), bends[b]);
        for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++)
            assert_true(fabs((double)rig.state.dynamics.crease[k] - (along_x(&rig.shell, k) ? expected : 0)) < 0.3);
    }
}

/// Sharp bends that last a step or two leave nothing.
TEST(trembling_leaves_no_crease) {
    OwnBench rig = bench_open_creased(test_grid(8, 4, 0.004f, 0.003f), NULL, 1);
    for (int s = 0; s < 400; s++) {
        rig_roll(&rig, 0.004, s & 2 ? 0.7 : -0.7); // 175 1/m, by 60 Hz and more
        rig_pass(&rig, 1);
    }
    for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++) assert_true(rig.state.dynamics.crease[k] == 0);
}

/// A sheet folded flat may look folded to the other side; its crease stays on the side it came from.
TEST(a_flat_fold_stays_on_its_side) {
    for (int side = -1; side <= 1; side += 2) {
        OwnBench rig = bench_open_creased(test_grid(2, 1, 0.004f, 0.004f), NULL, 1);
        for (int s = 0; s <= 100; s++) {
            rig_roll(&rig, 0.004, side * (s < 90 ? 3.0 * s / 90 : s & 1 ? 3.0 : 3.28));
            rig_pass(&rig, 8);
            assert_true(side * rig.state.dynamics.bend[0] >= 0 && side * rig.state.dynamics.crease[0] >= 0);
        }

        assert_true(side * rig.state.dynamics.bend[0] * 0.004f > 2.9f);
    }
}

/// Burnt paper forgets creases: half burnt, half of a crease counts; ash has none and takes none.
TEST(char_forgets_creases) {
    const double dx = 0.004;
    for (int ash = 0; ash < 2; ash++) {
        OwnBench rig = bench_open_creased(test_grid(8, 4, (float)dx, 0.003f), NULL, 1);
        rig_roll(&rig, dx, 0.7);
        if (!ash) rig_pass(&rig, 200);
        float crease = rig.state.dynamics.crease[0], min = singe_default_material().mass_min.value;
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.state.burn.mass[i] = min;
        rig.state.burn.mass_burnt = 1;
        assert_true(crease_kept(&rig.shell, STATE_INPUT(&rig.state), 0) == 0);
        rig_pass(&rig, 200);
        assert_true(rig.state.dynamics.crease[0] == crease && (crease == 0) == (ash == 1));
        for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.state.burn.mass[i] = 0.5f * (1 + min);
        assert_true(fabsf(crease_kept(&rig.shell, STATE_INPUT(&rig.state), 0) - 0.5f) < 1e-6f);
    }
}

/// Curling by unequal shrinkage of the layers is no bending: no crease stays.
TEST(curl_leaves_no_crease) {
    const double dx = 0.003, angle = -0.6; // 200 1/m
    OwnBench rig = bench_open_creased(test_grid(8, 4, (float)dx, 0.003f), NULL, 1);
    rig_roll(&rig, dx, angle);
    float *length = rig.state.burn.spring_length[SINGE_GREEN];
    for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++)
        if (along_x(&rig.shell, k)) length[k] *= crease_ratio(&rig.plan->hinges[k], (float)angle, (float)angle);
    for (uint32_t i = 0; i < rig.shell.particle_count; i++) rig.state.burn.mass[i] = 0.9f;
    rig.state.burn.mass_burnt = 1;
    rig_pass(&rig, 200);
    for (uint32_t k = 0; k < rig.shell.springs[SINGE_GREEN].count; k++) assert_true(rig.state.dynamics.crease[k] == 0);
}

/// A strip of 20 x 5 cells whose right half is turned over onto the left within 0.2 s.
static SingeSim *folding(int threads, bool creases, SingePinId *right) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = threads, def.solver.creases = creases;
    SingeSim *sim = test_sim(&def, test_grid(20, 5, 0.003f, 0.003f), NULL);
    SingePinDef pin = singe_default_pin();
    SingePoseKey path[9];
    uint32_t vertices[2][6];
    for (uint32_t j = 0; j < 6; j++) vertices[0][j] = 21 * j, vertices[1][j] = 21 * j + 20;
    for (int k = 0; k < 9; k++) {
        double turn = pi * k / 8;
        path[k] = test_key(0.025f * (float)k, (float)(0.03 + 0.03 * cos(turn)), 0, (float)(0.03 * sin(turn)));
        path[k].rotation[1] = (float)-sin(turn / 2), path[k].rotation[3] = (float)cos(turn / 2);
    }

    pin.sheet = (SingeSheetId){0, 1}, pin.vertex_count = 6, pin.vertices = vertices[0];
    test_add_pin(sim, &pin);
    pin.vertices = vertices[1], pin.path_count = 9, pin.path = path;
    test_ok(sim, singe_sim_add_pin(sim, &pin, right));
    return sim;
}

TEST(bytes_are_the_same_for_any_threads_and_after_loading) {
    SingePinId right, other;
    SingeSim *one = folding(1, true, &right), *three = folding(3, true, &other), *elastic = folding(1, false, &other);
    test_steps(one, 90), test_steps(three, 90), test_steps(elastic, 90);
    test_assert_same(one, three);
    SingeSim *copy;
    test_ok(one, singe_sim_clone(one, &copy)); // by save and load, in mid-fold
    test_steps(one, 60), test_steps(three, 60), test_steps(copy, 60), test_steps(elastic, 60);
    test_assert_same(one, three);
    test_assert_same(one, copy);

    // and there were creases
    SingeView creased = singe_sim_view(one), plain = singe_sim_view(elastic);
    assert_true(memcmp(creased.position, plain.position, creased.particle_count * sizeof *creased.position) != 0);
    singe_sim_destroy(one), singe_sim_destroy(three), singe_sim_destroy(copy), singe_sim_destroy(elastic);
}

/// A step that fails leaves creases and lengths as they were.
TEST(a_failed_step_changes_no_crease) {
    SingePinId right;
    SingeSim *sim = folding(1, true, &right), *twin;
    test_steps(sim, 90);
    float now = (float)singe_sim_view(sim).time;
    const SingePoseKey away[2] = {test_key(now, 0, 0, 0), test_key(now + 1e-3f, 1e8f, 0, 0)};
    const SingePoseKey still = test_key(0, 0.02f, 0, 0.02f);
    test_ok(sim, singe_sim_clone(sim, &twin));
    test_ok(sim, singe_sim_move_pin(sim, right, 2, away));
    test_refused(sim, SINGE_ERROR_DIVERGED, singe_sim_step(sim));
    test_ok(twin, singe_sim_move_pin(twin, right, 2, away));
    test_ok(sim, singe_sim_move_pin(sim, right, 1, &still));
    test_ok(twin, singe_sim_move_pin(twin, right, 1, &still));
    test_assert_same(sim, twin);
    test_steps(sim, 40), test_steps(twin, 40);
    test_assert_same(sim, twin);
    singe_sim_destroy(sim), singe_sim_destroy(twin);
}
