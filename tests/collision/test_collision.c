// Sheets that fall on themselves and each other.
#include "support/support.h"

#include "count_crossings.h"
#include "collision/narrow_phase.h"
#include "collision/feature_distance.h"

/// A flat sheet of n x n cells from `corner` along two sides.
typedef struct Flat {
    int n;
    float corner[3], u[3], v[3]; ///< m
} Flat;

static SingeSheetId add_flat(SingeSim *sim, const Flat *flat, float cells_thick, float wave, const float velocity[3]) {
    uint32_t n = (uint32_t)flat->n, row = n + 1;
    OwnTestMesh mesh = test_grid(n, n, 1, 1);
    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++) {
            float s = (float)i / (float)n, t = (float)j / (float)n, bend = wave * sinf(9 * t) + wave / 2 * sinf(7 * s);
            for (int k = 0; k < 3; k++)
                mesh.positions[3 * (j * row + i) + (uint32_t)k] =
                    flat->corner[k] + s * flat->u[k] + t * flat->v[k] + (k == 1 ? bend : 0);
        }
    SingeSheetDef def = test_sheet(&mesh);
    def.material.thickness = singe_param(
        cells_thick * sqrtf(flat->u[0] * flat->u[0] + flat->u[1] * flat->u[1] + flat->u[2] * flat->u[2]) / (float)n);
    for (int k = 0; k < 3; k++) def.velocity[k] = velocity ? velocity[k] : 0;
    const SingeSheetId id = test_add_sheet(sim, &def);
    return id;
}

static SingeSim *new_sim(int threads, bool contact) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = threads;
    def.contact.enabled = contact;
    def.solver.substeps = 3; // sheets stay soft, and fold
    SingeSim *sim = test_create(&def);
    return sim;
}

static void add_ground(SingeSim *sim) {
    SingeColliderDef ground = singe_default_collider();
    SingePoseKey key = {.rotation = {0, 0, 0, 1}};
    ground.path_count = 1, ground.path = &key, ground.friction = 0.3f, ground.offset = 1e-3f;
    test_add_collider(sim, &ground);
}

#ifdef SINGE_THREADS_ONLY
enum { HEAP = 16, HEAP_STEPS = 40 };
#else
enum { HEAP = 36, HEAP_STEPS = 100 };
#endif

/// A sheet on edge that falls into folds.
static SingeSim *heap(int threads, bool contact) {
    SingeSim *sim = new_sim(threads, contact);
    add_flat(sim, &(Flat){HEAP, {-0.1f, 0, 0.02f}, {0.2f, 0, 0}, {0, 0, 0.2f}}, 0.4f, 4e-3f, NULL);
    test_ok(sim, singe_sim_commit(sim));
    add_ground(sim);
    return sim;
}

TEST(a_heap_does_not_cross) {
    SingeSim *sim = heap(2, true), *without = heap(2, false);
    long crossed = 0;
    for (int frame = 0; frame < 24; frame++) {
        test_steps(sim, 20), test_steps(without, 20);
        assert_int_equal(crossings(sim), 0);
        crossed += crossings(without);
    }

    print_message("without contact: %ld crossings\n", crossed);
    assert_true(crossed > 100); // it would
    SingeTimers timers = singe_sim_timers(sim);
    assert_int_equal(timers.contact_unresolved, 0);
    assert_int_equal(timers.contact_dropped, 0);
    assert_true(timers.contact_repulsions > 1000);
    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.speed_rms_unburnt < 0.3f); // it lies there
    singe_sim_destroy(sim), singe_sim_destroy(without);
}

TEST(thrown_sheets_do_not_cross) {
    OwnSim *sim = new_sim(1, true);

    // two that fly into each other on edge, at 12 m/s: some ten thicknesses a substep
    add_flat(sim, &(Flat){14, {-0.05f, -0.03f, 1}, {0.1f, 0, 0.01f}, {0, 0.02f, 0.1f}}, 0.6f, 2e-3f,
             (float[3]){0, 6, 0});
    add_flat(sim, &(Flat){14, {0, 0.03f, 0.97f}, {0.08f, 0.06f, 0}, {0, 0, 0.1f}}, 0.6f, 2e-3f, (float[3]){0, -6, 0});
    test_ok(sim, singe_sim_commit(sim));
    for (int frame = 0; frame < 60; frame++) {
        test_steps(sim, 2);
        assert_int_equal(crossings(sim), 0);
    }
    assert_true(singe_sim_timers(sim).contact_stops > 0);
}

TEST(layers_keep_their_thickness) {
    OwnSim *sim = new_sim(1, true);
    for (int k = 0; k < 3; k++)
        add_flat(
            sim,
            &(Flat){
                12, {0.003f * (float)k, 0.002f * (float)k, 1.2e-3f + 2e-3f * (float)k}, {0.05f, 0, 0}, {0, 0.05f, 0}},
            0.6f, 0, NULL);
    test_ok(sim, singe_sim_commit(sim));
    add_ground(sim);
    test_steps(sim, 480);
    SingeView view = singe_sim_view(sim);
    double height[3] = {0};
    for (uint32_t v = 0; v < view.vertex_count; v++) height[v / 169] += (double)view.position[v][2] / 169;
    for (int k = 1; k < 3; k++) {
        double apart = height[k] - height[k - 1];
        assert_true(apart > 0.8 * 0.5e-3 && apart < 2 * 0.5e-3); // 0.5 mm is the default
    }
    assert_int_equal(crossings(sim), 0);
}

/// How far the upper of two sheets has slid in 0.2 s; the lower one lies on the ground.
static double slide(float friction) {
    SingeSimDef def = singe_default_sim();
    def.contact.enabled = true, def.contact.friction = friction, def.air_density = 0;
    OwnSim *sim = test_create(&def);
    add_flat(sim, &(Flat){20, {0, 0, 1.01e-3f}, {0.1f, 0, 0}, {0, 0.1f, 0}}, 0.6f, 0, NULL);
    add_flat(sim, &(Flat){8, {0.02f, 0.03f, 1.6e-3f}, {0.04f, 0, 0}, {0, 0.04f, 0}}, 0.6f, 0, (float[3]){0.2f, 0, 0});
    test_ok(sim, singe_sim_commit(sim));
    add_ground(sim);
    SingeView view = singe_sim_view(sim);
    double before = 0, after = 0;
    for (uint32_t v = 441; v < view.vertex_count; v++) before += (double)view.position[v][0] / 81;
    test_steps(sim, 96);
    for (uint32_t v = 441; v < view.vertex_count; v++) after += (double)view.position[v][0] / 81;
    return after - before;
}

TEST(friction_slows_sheets) {
    double slippery = slide(0), rough = slide(0.3f);
    print_message("slid %.4f m without friction, %.4f m with 0.3\n", slippery, rough);

    // free but for damping: 38 mm, as without gravity; at 0.3 g it stops after 68 ms and 6.8 mm
    assert_true(fabs(slippery - 0.038) < 0.004);
    assert_true(fabs(rough - 0.0068) < 0.0015);
}

TEST(crossing_input_is_left_alone) {
    OwnSim *sim = new_sim(1, true);
    add_flat(sim, &(Flat){10, {0, 0, 1}, {0.05f, 0, 0}, {0, 0.05f, 0}}, 0.6f, 0, NULL);
    add_flat(sim, &(Flat){10, {0.0112f, 0.0253f, 0.98f}, {0.04f, 0, 0}, {0, 0, 0.05f}}, 0.6f, 0, NULL);
    test_ok(sim, singe_sim_commit(sim));
    test_steps(sim, 1);
    assert_true(singe_sim_stats(sim).intersecting_cells > 8);
    test_steps(sim, 120);
    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.strain_max < 0.2 && stats.speed_rms_unburnt < 4);
}

/// Two cells that approach: each crossed by another cell, or both by a third. They still keep each other apart.
static void crossed_cells_stay_apart(bool one_between, int intersecting) {
    const float side = 0.02f, speed = 0.5f;
    SingeSimDef def = singe_default_sim();
    def.contact.enabled = true, def.air_density = 0, def.gravity[2] = 0;
    OwnSim *sim = test_create(&def);
    for (int upper = 0; upper < 2; upper++) {
        float z = upper ? 0.01f : 0, x = upper ? 0.013f : 0.006f, velocity[3] = {0, 0, upper ? -speed : speed};
        add_flat(sim, &(Flat){1, {0, 0, z}, {side, 0, 0}, {0, side, 0}}, 0.6f, 0, velocity);
        if (one_between) continue;

        // up to 1 mm through it, on the side of the other one
        float low = upper ? z - 1e-3f : z + 1e-3f - side;
        add_flat(sim, &(Flat){1, {x, 1e-3f, low}, {0, side - 2e-3f, 0}, {0, 0, side}}, 0.6f, 0, velocity);
    }
    if (one_between)
        add_flat(sim, &(Flat){1, {0.006f, 1e-3f, -5e-3f}, {0, side - 2e-3f, 0}, {0, 0, side}}, 0.6f, 0, NULL);

    test_ok(sim, singe_sim_commit(sim));
    test_steps(sim, 1);
    assert_int_equal(singe_sim_stats(sim).intersecting_cells, intersecting);
    test_steps(sim, 14); // unhindered they pass each other at the fifth, and are 19 mm beyond
    SingeView view = singe_sim_view(sim);
    const uint32_t second = one_between ? 4 : 8;
    float lower = 0, upper = 0;
    for (uint32_t v = 0; v < 4; v++) lower += view.position[v][2] / 4, upper += view.position[second + v][2] / 4;
    print_message("the upper cell is %.1f mm above the lower one\n", 1e3 * (double)(upper - lower));
    assert_true(upper > lower);
}

TEST(cells_crossed_by_others_are_kept_apart) { crossed_cells_stay_apart(false, 4); }

TEST(cells_crossed_by_one_cell_are_kept_apart) { crossed_cells_stay_apart(true, 3); }

TEST(coincident_sheets_are_left_alone) {
    OwnSim *sim = new_sim(1, true);
    for (int sheet = 0; sheet < 3; sheet++)
        add_flat(sim, &(Flat){10, {0, 0, 1}, {0.05f, 0, 0}, {0, 0.05f, 0}}, 0.6f, 0, NULL);

    // and one that lies next to them
    add_flat(sim, &(Flat){10, {0.2f, 0, 1}, {0.05f, 0, 0}, {0, 0.05f, 0}}, 0.6f, 0, NULL);
    test_ok(sim, singe_sim_commit(sim));
    test_steps(sim, 1);
    assert_int_equal(singe_sim_stats(sim).intersecting_cells, 300);
    test_steps(sim, 20);
    assert_int_equal(singe_sim_stats(sim).intersecting_cells, 300);
    assert_int_equal(singe_sim_timers(sim).contact_stops, 0);
}

TEST(any_number_of_threads_gives_the_same_bytes) {
    SingeSim *one = heap(1, true), *three = heap(3, true);
    test_steps(one, HEAP_STEPS), test_steps(three, HEAP_STEPS);

    // and from a snapshot between two searches
    SingeSim *again = test_reload(NULL, one);
    test_steps(one, 61), test_steps(three, 61), test_steps(again, 61);
    test_assert_same(one, three);
    test_assert_same(one, again);
    singe_sim_destroy(one), singe_sim_destroy(three), singe_sim_destroy(again);
}

// ---- the search against brute force

typedef struct Searched {
    Memory memory;
    SheetSource source;
    Shell shell;
    State state;
    CollisionPlan *plan;
} Searched;

/// A crumpled sheet of n x n cells: its vertices moved by noise of a wavelength of some cells.
static Searched *searched(uint32_t n) {
    Searched *s = calloc(1, sizeof *s);
    uint32_t row = n + 1, next = 1;
    OwnTestMesh mesh = test_grid(n, n, 1, 1);
    float *x = mesh.positions, cell = 2e-3f;
    for (uint32_t v = 0; v < row * row; v++) {
        float i = (float)(v % row), j = (float)(v / row);
        next = next * 1664525u + 1013904223u;
        x[3 * v] = cell * (i + 4 * sinf(0.5f * j) + 3 * sinf(0.9f * i)), x[3 * v + 1] = cell * (j + 5 * sinf(0.6f * i));
        x[3 * v + 2] = cell * (4 * sinf(0.4f * i + 0.7f * j) + 0.3f * (float)(next >> 8) / 16777216);
    }

    s->memory = memory_make((SingeAllocator){0});
    SingeSheetDef def = test_sheet(&mesh);
    assert_int_equal(sheet_source_create(&s->memory, &def, &s->source, NULL), SINGE_OK);
    assert_int_equal(shell_create(&s->memory, &s->source, 1, &s->shell, NULL), SINGE_OK);
    assert_int_equal(state_create(&s->memory, &s->shell, &s->state), SINGE_OK);
    SingeContactDef contact = singe_default_contact();
    assert_int_equal(collision_plan_create(&s->memory, &s->shell, &contact, 1.0f / 480, &s->plan), SINGE_OK);
    for (uint32_t v = 0; v < row * row; v++)
        for (int k = 0; k < 3; k++) s->state.dynamics.velocity[v][k] = 0.5f * sinf((float)(v * (uint32_t)(k + 3)));
    assert_int_equal(collision_open(&s->memory, s->plan, &s->shell, STATE_INPUT(&s->state), NULL, s->plan->time_step,
                                    true, &s->state.dynamics),
                     SINGE_OK);
    return s;
}

static void searched_free(Searched *s) {
    collision_plan_free(&s->memory, s->plan);
    state_free(&s->memory, &s->state);
    shell_free(&s->memory, &s->shell);
    sheet_source_free(&s->memory, &s->source);
    assert_int_equal(s->memory.held, 0);
    free(s);
}

static float at_most(float a, Float4 b) { return fminf(a, sqrtf(float4_dot(b, b))); }

/// Distance of two cells: the least of all their features', or of those that they own.
static float cell_distance(const Searched *s, uint32_t a, uint32_t b, bool owned) {
    const CollisionPlan *plan = s->plan;
    Float4 p[5], q[5], origin = float4_load(plan->position[s->shell.cells[a][0]]);
    float min = INFINITY, weight[3], u, t;

    collision_nodes(s->shell.cells[a], (const float(*)[4])plan->position, origin, p);
    collision_nodes(s->shell.cells[b], (const float(*)[4])plan->position, origin, q);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 4; j++) {
            const uint8_t *k = collision_triangle[j];
            Float4 first = feature_from_triangle(p[i], q[k[0]], q[k[1]], q[k[2]], weight);
            Float4 second = feature_from_triangle(q[i], p[k[0]], p[k[1]], p[k[2]], weight);
            if (!owned || collision_owns_node(plan, a, i)) min = at_most(min, first);
            if (!owned || collision_owns_node(plan, b, i)) min = at_most(min, second);
        }
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 8; j++) {
            Float4 apart = feature_from_segment(p[collision_edge[i][0]], p[collision_edge[i][1]],
                                                q[collision_edge[j][0]], q[collision_edge[j][1]], &u, &t);
            if (!owned || (collision_owns_edge(plan, a, i) && collision_owns_edge(plan, b, j)))
                min = at_most(min, apart);
        }
    return min;
}

TEST(the_search_finds_all) {
    Searched *s = searched(30);
    const CollisionPlan *plan = s->plan;
    uint32_t n = plan->cell_count, near = 0;
    uint8_t *listed = calloc((size_t)n * n, 1);

    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        assert_int_equal(listed[pair->a * n + pair->b] + listed[pair->b * n + pair->a], 0); // once
        listed[pair->a * n + pair->b] = 1;
    }

    for (uint32_t a = 0; a < n; a++)
        for (uint32_t b = a + 1; b < n; b++) {
            float distance = cell_distance(s, a, b, false);
            if (distance >= plan->reach) continue;
            near++;
            assert_true(listed[a * n + b] || listed[b * n + a]);
        }
    assert_true(near > 4 * n);

    // no bound exceeds the true distance of its pair, and pairs that are near are measured
    uint32_t measured = 0;
    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        if (pair->a == pair->b || pair->bridge != SHELL_NONE) continue;
        float distance = cell_distance(s, pair->a, pair->b, true);
        assert_true(pair->distance <= distance + 1e-6f);
        measured += fabsf(pair->distance - distance) < 1e-6f;
    }

    assert_true(measured > n / 2);
    free(listed);
    searched_free(s);
}

/// All features of listed pairs at once against one after another.
TEST(features_are_measured) {
    Searched *s = searched(20);
    const CollisionPlan *plan = s->plan;
    const float(*x)[4] = (const float(*)[4])plan->position;
    uint32_t found = 0;

    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        if (pair->a == pair->b || pair->bridge != SHELL_NONE) continue;
        Float4 origin = float4_load(x[s->shell.cells[pair->a][0]]);
        NarrowCell a, b;
        NearFeatures near[NARROW_MAX];
        narrow_cell_set(plan, &s->shell, pair->a, x, origin, &a);
        narrow_cell_set(plan, &s->shell, pair->b, x, origin, &b);
        float nearest, min = cell_distance(s, pair->a, pair->b, true);
        assert_true(narrow_slabs_distance(&a, &b) <= min + 1e-6f);
        FeatureRange far = {plan->reach, plan->reach, plan->reach, true};
        int count = narrow_features(&s->shell, pair, &a, &b, &far, near, &nearest);
        assert_true(fabsf(nearest - fminf(min, plan->reach)) < 1e-6f);
        for (int i = 0; i < count; i++) {
            const NearFeatures *n = &near[i];
            float weight[3], u, v;
            Float4 apart;
            if (n->kind == COLLISION_EDGES) {
                const uint8_t *e = collision_edge[n->first], *f = collision_edge[n->second];
                apart = feature_from_segment(a.node[e[0]], a.node[e[1]], b.node[f[0]], b.node[f[1]], &u, &v);
            } else {
                const NarrowCell *own = n->kind == COLLISION_NODE_OF_A ? &a : &b, *other = own == &a ? &b : &a;
                const uint8_t *t = collision_triangle[n->second];
                apart = feature_from_triangle(own->node[n->first], other->node[t[0]], other->node[t[1]],
                                              other->node[t[2]], weight);
                if (own == &b) apart = -apart;
                u = weight[1], v = weight[2];
            }

            Float4 off = apart - n->separation;
            assert_true(float4_dot(off, off) < 1e-12f && fabsf(n->distance - at_most(INFINITY, apart)) < 1e-6f);
            assert_true(fabsf(u - n->u) < 1e-3f && fabsf(v - n->v) < 1e-3f);
        }

        found += (uint32_t)count;
    }

    assert_true(found > 1000);
    searched_free(s);
}

/// Whether the regions that two cells pass over on their way from the step's start meet.
static bool displacements_meet(const Searched *s, const float (*x)[4], uint32_t a, uint32_t b) {
    for (int k = 0; k < 3; k++) {
        float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < 8; i++) {
            uint32_t v = s->shell.cells[i < 4 ? a : b][i & 3];
            low[i >> 2] = fminf(low[i >> 2], fminf(s->plan->start[v][k], x[v][k]));
            high[i >> 2] = fmaxf(high[i >> 2], fmaxf(s->plan->start[v][k], x[v][k]));
        }

        if (low[0] > high[1] || low[1] > high[0]) return false;
    }

    return true;
}

/// Cells that are thrown out of their boxes, and some `far` (m) beyond all others, against brute force.
static void check_outside(float far) {
    Searched *s = searched(30);
    CollisionPlan *plan = s->plan;
    uint32_t n = plan->cell_count, count = 0, met = 0;
    float(*x)[4] = malloc(plan->vertex_count * sizeof *x);

    memcpy(x, plan->start, plan->vertex_count * sizeof *x);
    for (uint32_t v = 0; v < plan->vertex_count; v += 17)
        for (int k = 0; k < 3; k++) x[v][k] += 4e-3f * sinf((float)(v * (uint32_t)(k + 2))); // two cells far
    for (int k = 0; k < 3; k++) x[17 * 20][k] += far;
    for (uint32_t c = 0; c < n; c++) {
        plan->is_outside[c] = 0;
        for (int i = 0; i < 4; i++) plan->is_outside[c] |= s->shell.cells[c][i] % 17 == 0;
        if (plan->is_outside[c]) plan->outside[count++] = c;
    }

    assert_int_equal(broad_search_outside(&s->memory, plan, &s->shell, NULL, count, (const float(*)[4])x), SINGE_OK);
    uint8_t *listed = calloc((size_t)n * n, 1);
    for (uint32_t k = 0; k < plan->pair_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        assert_int_equal(listed[pair->a * n + pair->b] + listed[pair->b * n + pair->a], 0); // once
        listed[pair->a * n + pair->b] = 1;
    }

    for (uint32_t k = 0; k < count; k++)
        for (uint32_t b = 0, a = plan->outside[k]; b < n; b++) {
            if (a == b || !displacements_meet(s, (const float(*)[4])x, a, b)) continue;
            met++;
            assert_true(listed[a * n + b] || listed[b * n + a]);
        }

    assert_true(count > n / 8 && met > 10 * count && plan->pair_count > plan->listed_count + count / 8);
    free(listed), free(x);
    searched_free(s);
}

TEST(cells_out_of_bounds_are_found) {
    check_outside(0);
    check_outside(1e4f); // through more cubes than can be counted
}

/// Cells of which some are thousands of cubes long, and what has no position at all.
TEST(the_grid_has_bounds) {
    Searched *s = searched(30);
    CollisionPlan *plan = s->plan;
    uint32_t n = plan->cell_count, listed = plan->listed_count;
    plan->position[500][0] += 200;
    assert_int_equal(broad_search(&s->memory, plan, &s->shell, NULL), SINGE_OK);
    assert_true(plan->listed_count >= listed / 2);

    uint8_t *seen = calloc((size_t)n * n, 1);
    for (uint32_t k = 0; k < plan->listed_count; k++) {
        uint8_t *at = &seen[plan->pairs[k].a * n + plan->pairs[k].b];
        assert_int_equal(*at, 0); // once
        *at = 1;
    }

    plan->position[500][1] = NAN, plan->speed[77][2] = INFINITY;
    assert_int_equal(broad_search(&s->memory, plan, &s->shell, NULL), SINGE_OK);
    assert_int_equal(broad_search_outside(&s->memory, plan, &s->shell, NULL, 3, (const float(*)[4])plan->position),
                     SINGE_OK);
    free(seen);
    searched_free(s);
}

TEST(the_search_is_linear) {
    Searched *small = searched(40), *large = searched(80);
    double pairs = (double)large->plan->listed_count / small->plan->listed_count;
    double entries = (double)large->plan->entry_count / small->plan->entry_count;
    assert_true(pairs < 5 && entries < 5); // four times the cells
    assert_int_equal(large->plan->counters.dropped, 0);
    searched_free(small), searched_free(large);
}
