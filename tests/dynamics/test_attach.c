// Long-range attachments: what they hold, what they leave alone, and when they let go.
#include "sample_sheets.h"

#include "common/random.h"
#include "dynamics/dynamics_plan.h"
#include "sim/scenes.h"

enum { SIDE = 20, ROW = SIDE + 1 };
static const float cell = 0.01f;
static const SingeSheetId the_sheet = {0, 1}; // of test_sim

static uint32_t vertex(uint32_t i, uint32_t j) { return j * ROW + i; }

/// A sheet of 20 cm, flat, held at `count` vertices and ready for a projection.
static Bench hold(const SingeMaterialDef *material, int count, const uint32_t *held) {
    Bench b = bench_open(quads_grid(SIDE, SIDE, cell, cell, false), material, 1);
    for (int k = 0; k < count; k++) b.state.dynamics.pinned[held[k]] = 1;
    dynamics_plan_hold(b.plan, &b.shell, &b.state);
    bench_prepare(&b);
    return b;
}

/// Displaces all free particles at random, by up to 10 cm.
static void scatter(Bench *b) {
    for (uint32_t i = 0; i < b->shell.particle_count; i++)
        for (int k = 0; k < 3; k++)
            if (!b->state.dynamics.pinned[i])
                b->state.dynamics.position[i][k] += 0.2f * (random_unit(random_hash(i, (uint32_t)k, 1, 2)) - 0.5f);
}

static void project(Bench *b) {
    attach_project(&b->plan->attachments, &b->shell, b->plan->kernels->hold, b->pool, &b->state.dynamics);
}

/// How much farther than it may be a vertex is from a source, at most.
static double excess(const Bench *b, int source) {
    const Attachments *attachments = &b->plan->attachments;
    const float *anchor = b->state.dynamics.position[attachments->source[0][source]];
    double max = 0;
    for (uint32_t v = 0; v < b->shell.vertex_count; v++) {
        Float3 away = float3_sub(float3_load(b->state.dynamics.position[v]), float3_load(anchor));
        max = fmax(max, (double)(float3_length(away) - attachments->length[v][source]));
    }
    return max;
}

static double far_from_start(const Bench *b, uint32_t i) {
    return (double)float3_length(
        float3_sub(float3_load(b->state.dynamics.position[i]), float3_load(b->shell.rest_position[i])));
}

TEST(no_vertex_is_too_far_from_a_pin) {
    const uint32_t corners[] = {vertex(0, 0), vertex(SIDE, 0)};
    for (int count = 1; count <= 2; count++) {
        OwnBench bench = hold(NULL, count, corners);
        scatter(&bench);
        float(*before)[4] = malloc(bench.shell.particle_count * sizeof *before);
        assert_non_null(before);
        memcpy(before, bench.state.dynamics.position, bench.shell.particle_count * sizeof *before);
        assert_true(excess(&bench, 0) > 0.01);
        project(&bench);
        assert_true(excess(&bench, count - 1) < 1e-6); // the last source's is exact
        for (int pass = 0; pass < 30; pass++) project(&bench);
        for (int k = 0; k < count; k++) assert_true(excess(&bench, k) < 1e-3); // spheres that touch: slow
        for (int k = 0; k < count; k++) assert_true(far_from_start(&bench, corners[k]) == 0);

        // centres are off the mesh: left alone
        const uint32_t first = bench.shell.vertex_count;
        assert_memory_equal(before[first], bench.state.dynamics.position[first],
                            bench.shell.cell_count * sizeof *before);
        free(before);
    }
}

/// Vertices within reach keep their position to the bit.
TEST(slack_is_left_alone) {
    const uint32_t corner = vertex(0, 0);
    OwnBench bench = hold(NULL, 1, &corner);
    for (uint32_t i = 0; i < bench.shell.particle_count; i++)
        if (i != corner)
            bench.state.dynamics.position[i][2] = 0.3f * bench.state.dynamics.position[i][0],
            bench.state.dynamics.position[i][0] *= 0.9f;
    float(*before)[4] = malloc(bench.shell.particle_count * sizeof *before);
    assert_non_null(before);
    memcpy(before, bench.state.dynamics.position, bench.shell.particle_count * sizeof *before);
    project(&bench);
    assert_memory_equal(before, bench.state.dynamics.position, bench.shell.particle_count * sizeof *before);
    free(before);
}

TEST(a_loose_piece_is_free) {
    const uint32_t corner = vertex(0, 0);
    OwnBench bench = hold(NULL, 1, &corner);
    for (uint32_t v = vertex(0, 10); v < bench.shell.vertex_count; v++) bench.state.ablate.piece[v] = 7;
    bench.state.ablate.topology_version++;
    attach_update(&bench.plan->attachments, &bench.shell, STATE_INPUT(&bench.state), false);
    for (uint32_t v = 1; v < bench.shell.vertex_count; v++) bench.state.dynamics.position[v][2] = -1;
    project(&bench);
    for (uint32_t v = 1; v < bench.shell.vertex_count; v++)
        assert_true((bench.state.dynamics.position[v][2] == -1) == (v >= vertex(0, 10)));

    // nor is it held again by a later measurement, though its cells still touch: after a pin, or while it burns
    dynamics_plan_hold(bench.plan, &bench.shell, &bench.state);
    bench.state.burn.mass_burnt = 1e-6, bench.state.step = ATTACH_PERIOD - 1;
    for (int step = 0; step < 3; step++, bench.state.step++) {
        attach_update(&bench.plan->attachments, &bench.shell, STATE_INPUT(&bench.state), false);
        for (uint32_t v = 0; v < bench.shell.vertex_count; v++) {
            float length = bench.plan->attachments.length[v][0];
            assert_true(v >= vertex(0, 10) ? isinf(length) && length > 0 : isfinite(length));
        }
    }
}

/// Neither a pin that was removed nor a vertex that is gone holds anything.
TEST(removed_pins_and_burnt_particles_hold_nothing) {
    const uint32_t corner = vertex(0, 0);
    for (int burnt = 0; burnt < 2; burnt++) {
        OwnBench bench = hold(NULL, 1, &corner);
        if (burnt) {
            bench.state.ablate.particle_flags[corner] = 0, bench.state.ablate.piece[corner] = -1;
            bench.state.ablate.topology_version++;
            attach_update(&bench.plan->attachments, &bench.shell, STATE_INPUT(&bench.state), false);
        } else {
            bench.state.dynamics.pinned[corner] = 0;
            dynamics_plan_hold(bench.plan, &bench.shell, &bench.state);
            assert_int_equal(bench.plan->attachments.source[0][0], SHELL_NONE);
        }

        bench_prepare(&bench);
        for (uint32_t v = 1; v < bench.shell.vertex_count; v++) bench.state.dynamics.position[v][2] = -1;
        project(&bench);
        for (uint32_t v = 1; v < bench.shell.vertex_count; v++) assert_true(bench.state.dynamics.position[v][2] == -1);
    }
}

/// Up to four sources, far apart; none where the sheet may stretch.
TEST(up_to_four_sources_are_far_apart) {
    uint32_t edge[ROW];
    for (uint32_t i = 0; i < ROW; i++) edge[i] = vertex(i, SIDE);
    OwnBench across = hold(NULL, ROW, edge);
    const uint32_t *source = across.plan->attachments.source[0];
    assert_int_equal(source[0], edge[0]);
    assert_int_equal(source[1], edge[SIDE]);
    assert_int_equal(source[2], edge[SIDE / 2]);
    assert_int_not_equal(source[3], SHELL_NONE);
    const uint32_t close[] = {vertex(0, 0), vertex(SIDE, 0), vertex(1, 0)};
    OwnBench near = hold(NULL, 3, close); // the third is nearer than a tenth
    assert_int_equal(near.plan->attachments.source[0][2], SHELL_NONE);
    SingeMaterialDef gives = singe_default_material();
    gives.compliance[SINGE_BLUE] = singe_param(1e-3f);
    OwnBench soft = hold(&gives, ROW, edge);
    assert_int_equal(soft.plan->attachments.source[0][0], SHELL_NONE);
}

/// Updates the attachments as at the end of a step, for which a measurement may be due.
static void end_step(Bench *b, uint64_t step) {
    b->state.step = step - 1;
    attach_update(&b->plan->attachments, &b->shell, STATE_INPUT(&b->state), false);
}

/// A fire eats a disc from its middle: distances around the hole grow at once, and none becomes shorter.
TEST(lengths_grow_at_once) {
    const uint32_t corners[] = {vertex(0, 0), vertex(SIDE, 0)};
    OwnBench bench = hold(NULL, 2, corners);
    const Attachments *attachments = &bench.plan->attachments;
    float before[ROW * ROW][ATTACH_SOURCES];
    int grown = 0;
    memcpy(before, attachments->length, sizeof before);
    for (uint64_t ring = 1; ring <= 7; ring++) {
        for (uint32_t c = 0; c < bench.shell.cell_count; c++) {
            const float *r = bench.shell.rest_position[shell_centre(&bench.shell, c)];
            if (hypotf(r[0] - 0.1f, r[1] - 0.1f) < 0.0101f * (float)ring) bench.state.ablate.cell_flags[c] = 0;
        }

        bench.state.burn.mass_burnt += 1e-6;
        end_step(&bench, ATTACH_PERIOD * ring - 1); // not yet
        assert_memory_equal(before, attachments->length, sizeof before);
        end_step(&bench, ATTACH_PERIOD * ring);
        for (uint32_t v = 0; v < bench.shell.vertex_count; v++)
            for (int k = 0; k < 2; k++) {
                assert_true(attachments->length[v][k] >= before[v][k] * (1 - 1e-4f));
                grown += attachments->length[v][k] > before[v][k] * 1.01f;
            }
        memcpy(before, attachments->length, sizeof before);
    }

    assert_true(grown > 100);
}

/// Lengths that shrink to 0.8 get there in equal steps by the time of the next measurement.
TEST(lengths_shorten_in_steps) {
    const uint32_t corner = vertex(0, 0), far = vertex(SIDE, SIDE);
    OwnBench bench = hold(NULL, 1, &corner);
    const float *length = bench.plan->attachments.length[far];
    const float start = *length;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < bench.shell.springs[colour].count; k++)
            bench.state.burn.spring_length[colour][k] *= 0.8f;
    bench.state.burn.mass_burnt = 1e-6;
    for (uint64_t step = 1; step <= 2 * ATTACH_PERIOD; step++) {
        end_step(&bench, step);
        float done = step <= ATTACH_PERIOD ? 0 : (float)(step - ATTACH_PERIOD) / ATTACH_PERIOD;
        assert_true(fabsf(*length - start * (1 - 0.2f * done)) < 1e-4f * start);
    }
}

static double farthest_moved(const Bench *b, float (*before)[4]) {
    double max = 0;
    for (uint32_t v = 0; v < b->shell.vertex_count; v++) {
        Float3 displacement = float3_sub(float3_load(b->state.dynamics.position[v]), float3_load(before[v]));
        max = fmax(max, (double)float3_length(displacement));
    }
    return max;
}

/// A taut sheet that may tear is left to its springs. When a held vertex burns and the sheet becomes slack, vertices
/// that are too far away return gradually, without a jerk.
TEST(rest_ends_without_a_jerk) {
    const uint32_t corners[] = {vertex(0, 0), vertex(SIDE, 0), vertex(0, SIDE)};
    static float before[ROW * ROW][4];

    OwnBench bench = hold(NULL, 3, corners);
    float(*x)[4] = bench.state.dynamics.position;
    bench.shell.spare_count = 1; // it may tear
    for (uint32_t v = 0; v < bench.shell.vertex_count; v++)
        if (!bench.state.dynamics.pinned[v] || v == corners[1]) x[v][0] *= 1.5f, x[v][1] *= 1.2f;
    memcpy(before, x, sizeof before);
    project(&bench);
    assert_true(farthest_moved(&bench, before) == 0);
    end_step(&bench, 90);
    bench.state.ablate.particle_flags[corners[1]] = 0, bench.state.ablate.piece[corners[1]] = -1;
    bench.state.ablate.topology_version++;
    end_step(&bench, 91);
    const double start = (double)x[vertex(SIDE, SIDE)][0];
    for (uint64_t step = 92; step < 500; step++) {
        memcpy(before, x, sizeof before);
        project(&bench);
        assert_true(farthest_moved(&bench, before) < 2e-3); // of 6 cm
        end_step(&bench, step);
    }

    assert_true(excess(&bench, 0) < 1e-4 && (double)x[vertex(SIDE, SIDE)][0] < start - 0.02);
    bench.shell.spare_count = 0;
}

/// A sheet held at two corners; the second goes `away` m within half a second.
static SingeSim *hung(const SingeSimDef *def, uint32_t cells, const SingeMaterialDef *material, float away) {
    SingeSim *sim = test_sim(def, test_grid(cells, cells, 0.2f / (float)cells, 0.2f / (float)cells), material);
    const uint32_t corners[] = {0, cells};
    const SingePoseKey keys[] = {test_key(0, 0, 0, 0), test_key(0.5f, away, 0, 0)};

    for (int k = 0; k < 2; k++) {
        SingePinDef pin = singe_default_pin();
        pin.sheet = the_sheet, pin.vertex_count = 1, pin.vertices = &corners[k];
        if (k) pin.path_count = 2, pin.path = keys;
        test_add_pin(sim, &pin);
    }

    return sim;
}

/// The sheet cannot follow: it stretches between the pins and trembles a little, by about the same distance in a substep
/// however short.
TEST(a_sheet_pulled_apart_trembles_little) {
    const float side = 0.2f, aways[] = {0.02f, 0.05f, 0.1f};
    const struct {
        int substeps;
        double fastest; ///< allowed, m/s
    } cases[] = {{3, 10}, {8, 20}};
    for (int run = 0; run < 6; run++) {
        SingeSimDef def = singe_default_sim();
        def.solver.substeps = cases[run / 3].substeps;
        OwnSim *sim = hung(&def, 24, NULL, aways[run % 3]);
        double fastest = 0, farthest = 0;
        for (int step = 0; step < 720; step++) {
            test_steps(sim, 1);
            SingeView view = singe_sim_view(sim);
            for (uint32_t i = 0; i < view.particle_count; i++) {
                double speed = (double)float3_length(float3_load(view.velocity[i]));
                double reach = (double)float3_length(float3_load(view.position[i]));
                assert_true(isfinite(speed) && isfinite(reach));
                fastest = fmax(fastest, speed), farthest = fmax(farthest, reach);
            }
        }

        print_message("pulled to %.2f of its side, %d substeps: up to %.1f m/s, %.3f m from a pin\n",
                      1 + (double)(aways[run % 3] / side), def.solver.substeps, fastest, farthest);
        assert_true(fastest < cases[run / 3].fastest && farthest < 1.5 * sqrt(2.0) * (double)side);
    }
}

#ifdef SINGE_THREADS_ONLY
enum { BURNING = 16 };
#else
enum { BURNING = 44 };
#endif

static SingeSim *burning(int threads) {
    SingeSimDef def = scene_def();
    def.thread_count = threads;
    SingeMaterialDef material = scene_quick_material();
    SingeSim *sim = hung(&def, BURNING, &material, 0);
    test_spot(sim, 0.1f, 0.1f, 0, 0.02f, 1500, 1000);
    return sim;
}

TEST(bytes_do_not_depend_on_the_thread_count) {
    OwnSim *one = burning(1);
    test_steps(one, 70);
    assert_true(singe_sim_stats(one).mass_removed > 0);
    for (int threads = 2; threads <= 4; threads += 2) {
        OwnSim *more = burning(threads);
        test_steps(more, 70);
        test_assert_same(one, more);
    }
}

/// Lengths are those of an earlier step: a snapshot must have them.
TEST(a_run_resumes_between_measurements) {
    OwnSim *sim = burning(1);
    test_steps(sim, 45);
    OwnSim *resumed = test_reload(NULL, sim);
    for (int part = 0; part < 3; part++) {
        test_steps(sim, 12), test_steps(resumed, 12);
        test_assert_same(sim, resumed);
    }
    assert_true(singe_sim_stats(sim).mass_removed > 0);
}

/// In the step after a pin is removed the sheet falls freely.
TEST(a_removed_pin_lets_go) {
    SingeMaterialDef material = singe_default_material();
    material.drag = material.damping = singe_param(0);
    OwnSim *sim = test_sim(NULL, test_grid(SIDE, SIDE, cell, cell), &material);
    const uint32_t corner = 0;
    SingePinDef pin = singe_default_pin();
    pin.sheet = the_sheet, pin.vertex_count = 1, pin.vertices = &corner;
    SingePinId id = test_add_pin(sim, &pin);
    test_steps(sim, 200);
    double momentum[3] = {0};
    test_ok(sim, singe_sim_remove_pin(sim, id));
    for (int step = 0; step < 3; step++) {
        test_steps(sim, 1);
        SingeView view = singe_sim_view(sim);
        momentum[step] = 0;
        double area = 0;
        for (uint32_t i = 0; i < view.particle_count; i++)
            momentum[step] += (double)(view.area[i] * view.velocity[i][2]), area += (double)view.area[i];
        momentum[step] /= area;
    }

    for (int step = 1; step < 3; step++)
        assert_true(fabs((momentum[step] - momentum[step - 1]) * 480 / -9.81 - 1) < 1e-2);
}
