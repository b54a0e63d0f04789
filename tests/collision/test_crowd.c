// Sheets that lie thicker on each other than the lists of contact have room for.
#include "support/support.h"

#include "count_crossings.h"
#include "collision/collision_plan.h"
#include "dynamics/dynamics_plan.h"
#include "sim/sim_internal.h"

// ---- a list

enum { BLOCKS = 90 };

/// Items of a block: none, one, some chunks and their edges.
static uint32_t block_items(int block) {
    const uint32_t items[] = {0, 1, BLOCK_CHUNK - 1, BLOCK_CHUNK, BLOCK_CHUNK + 1, 5 * BLOCK_CHUNK, 3, 0, 200};
    return items[block % 9];
}

static void write_items(void *unused, BlockList *list, int block) {
    (void)unused;
    BlockWriter writer = block_list_begin(list, block);
    for (uint32_t k = 0; k < block_items(block); k++) {
        uint32_t *item = block_list_add(&writer);
        if (item) *item = (uint32_t)block << 16 | k;
    }
    block_list_end(&writer);
}

static void read_item(void *context, const void *item, uint32_t number) {
    memcpy((uint32_t *)context + number, item, sizeof(uint32_t));
}

/// Writes the list and grows it when it reports that it is full; checks that it has the first items and no others.
static void check_list(uint32_t capacity, uint32_t grown, Pool *pool) {
    Memory memory = memory_make((SingeAllocator){0});
    BlockItems items = {0};
    BlockList list;
    uint64_t all = 0;
    for (int b = 0; b < BLOCKS; b++) all += block_items(b);

    assert_true(block_list_create(&memory, &list, &items, sizeof(uint32_t), capacity, BLOCKS));
    for (int turn = 0; turn < 2; turn++) { // the second turn finds what the first has left
        uint64_t count = block_list_write(&list, pool, BLOCKS, UINT32_MAX / 2, write_items, NULL);
        assert_int_equal(count, all);
        if (grown && turn == 0) assert_true(block_list_grow(&memory, &list, grown, BLOCKS + 7));
        uint32_t kept = block_list_settle(&list, pool, BLOCKS, count, list.capacity, write_items, NULL);
        assert_int_equal(kept, all < list.capacity ? all : list.capacity);
        uint32_t *read = malloc((all + 1) * sizeof *read), number = 0;
        memset(read, 0xff, (all + 1) * sizeof *read);
        block_list_read(&list, pool, BLOCKS, kept, read_item, read);
        for (uint32_t b = 0; b < BLOCKS; b++)
            for (uint32_t k = 0; k < block_items((int)b); k++, number++)
                assert_int_equal(read[number], number < kept ? b << 16 | k : UINT32_MAX);
        free(read);
    }

    block_list_free(&memory, &list);
    block_items_free(&memory, &items);
    assert_int_equal(memory.held, 0);
}

TEST(full_lists_keep_the_first_entries) {
    Memory memory = memory_make((SingeAllocator){0});
    for (int threads = 1; threads <= 4; threads++) {
        Pool *pool;
        assert_int_equal(pool_create(&memory, (SingeTasks){0}, threads, &pool), SINGE_OK);

        const uint32_t capacities[] = {0, 1, 63, 64, 65, 127, 128, 1000, 5000, 100000};
        for (size_t k = 0; k < sizeof capacities / sizeof *capacities; k++) {
            check_list(capacities[k], 0, pool);
            check_list(capacities[k], capacities[k] + 1, pool);
            check_list(capacities[k], 200000, pool);
        }
        pool_destroy(&memory, pool);
    }
}

/// A block stops counting where no list could have room: what crowds without bounds is given up early.
TEST(a_block_counts_up_to_the_most) {
    Memory memory = memory_make((SingeAllocator){0});
    BlockItems items = {0};
    BlockList list;
    assert_true(block_list_create(&memory, &list, &items, sizeof(uint32_t), 100, BLOCKS));
    uint64_t count = block_list_write(&list, NULL, BLOCKS, 10, write_items, NULL), expected = 0;
    for (int b = 0; b < BLOCKS; b++) expected += block_items(b) < 11 ? block_items(b) : 11;
    assert_int_equal(count, expected);
    block_list_free(&memory, &list);
    block_items_free(&memory, &items);
}

// ---- scenes

typedef struct Crowd {
    int sheets, cells; ///< cells: along a side
    float apart;       ///< m
    bool soup;         ///< cells on their own, anywhere
} Crowd;

static const Crowd stack = {8, 6, 0.5e-3f, false}, soup = {1, 12, 0, true};

static void add_soup(SingeSim *sim, uint32_t count) {
    OwnTestMesh mesh = {.vertex_count = 4 * count, .cell_count = count};
    mesh.positions = malloc(12 * count * sizeof *mesh.positions);
    mesh.cells = malloc(4 * count * sizeof *mesh.cells);

    uint32_t next = 7;
    for (uint32_t v = 0; v < 4 * count; v++) {
        mesh.cells[v] = v;
        for (uint32_t k = 0; k < 3; k++) {
            next = next * 1664525u + 1013904223u;
            float side = k == 0 ? (v % 4 == 1 || v % 4 == 2) : k == 1 ? v % 4 > 1 : 0;
            mesh.positions[3 * v + k] = 0.02f * side + 0.005f * sinf((float)(v / 4 * (5 * k + 7))) +
                                        0.01f * (float)(next >> 8) / 16777216 + (k == 2 ? 0.05f : 0);
        }
    }

    SingeSheetDef def = test_sheet(&mesh);
    test_add_sheet(sim, &def);
}

static SingeSim *crowd(const Crowd *crowd, int threads, const SingeAllocator *allocator) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = threads, def.contact.enabled = true;
    def.time_step = 1.0f / 96, def.solver.substeps = 3; // coarse: sheets press on each other
    if (allocator) def.allocator = *allocator;

    SingeSim *sim = test_create(&def);
    for (int s = 0; s < crowd->sheets && !crowd->soup; s++) {
        OwnTestMesh mesh = test_grid((uint32_t)crowd->cells, (uint32_t)crowd->cells, 5e-3f, 5e-3f);
        test_mesh_move(&mesh, 1e-3f * sinf((float)s), 1e-3f * cosf((float)(3 * s)), 1e-3f + crowd->apart * (float)s);
        SingeSheetDef sheet = test_sheet(&mesh);
        test_add_sheet(sim, &sheet);
    }

    if (crowd->soup) add_soup(sim, (uint32_t)(crowd->cells * crowd->cells));
    test_ok(sim, singe_sim_commit(sim));

    SingeColliderDef ground = singe_default_collider();
    SingePoseKey key = test_key(0, 0, 0, 0);
    ground.path_count = 1, ground.path = &key;
    test_add_collider(sim, &ground);
    return sim;
}

static const CollisionPlan *collision(const SingeSim *sim) { return sim->dynamics->collision; }

/// Replaces the lists of a simulation by lists of other sizes.
static void resize(SingeSim *sim, const CollisionSizes *sizes) {
    collision_plan_free(&sim->memory, sim->dynamics->collision);
    assert_int_equal(collision_plan_create_sized(&sim->memory, &sim->shell, &sim->def.contact, sim->def.time_step,
                                                 sizes, &sim->dynamics->collision),
                     SINGE_OK);
}

/// No room to begin with: everything has to grow.
static CollisionSizes tiny(const SingeSim *sim) {
    CollisionSizes sizes = collision_sizes(&sim->shell);
    sizes.entry_max = 8 * sim->shell.cell_count, sizes.pairs = sim->shell.cell_count, sizes.repulsions = 1;
    return sizes;
}

// ---- tests

/// Lists of the usual size grow: in a stack those of repulsions, in a soup, which crosses from the start, those of
/// pairs.
static void check_growth(const Crowd *scene, bool pairs) {
    SingeSim *one = crowd(scene, 1, NULL), *three = crowd(scene, 3, NULL), *resumed;
    test_steps(one, 6), test_steps(three, 6);

    // a run that goes on begins with small lists again
    test_ok(one, singe_sim_clone(one, &resumed));
    for (int k = 0; k < 3; k++) {
        test_steps(one, 3), test_steps(three, 3), test_steps(resumed, 3);
        assert_true(scene->soup || crossings(one) == 0);
    }

    const CollisionSizes *sizes = &collision(one)->sizes;
    print_message("%u pairs where %u are usual, %u repulsions where %u are\n", collision(one)->pair_capacity,
                  sizes->pairs, collision(one)->repulsion_capacity, sizes->repulsions);
    assert_true(pairs ? collision(one)->pair_capacity > sizes->pairs
                      : collision(one)->repulsion_capacity > sizes->repulsions);
    assert_int_equal(singe_sim_timers(one).contact_dropped, 0);
    test_assert_same(one, three);
    test_assert_same(one, resumed);
    singe_sim_destroy(one), singe_sim_destroy(three), singe_sim_destroy(resumed);
}

TEST(crowds_grow_the_lists) {
    check_growth(&stack, false);
    check_growth(&soup, true);
}

/// Threads share a wide stack by stripes. Two of them share vertices only if they are neighbours.
TEST(stripes_share_no_vertex) {
    const Crowd wide = {6, 20, 0.5e-3f, false};
    SingeSim *sims[3] = {crowd(&wide, 1, NULL), crowd(&wide, 3, NULL)};
    test_steps(sims[0], 6), test_steps(sims[1], 6);
    test_ok(sims[0], singe_sim_clone(sims[0], &sims[2]));
    for (int k = 0; k < 3; k++) test_steps(sims[k], 3);
    test_assert_same(sims[0], sims[1]);
    test_assert_same(sims[0], sims[2]);

    CollisionPlan *plan = sims[0]->dynamics->collision;
    const Shell *shell = &sims[0]->shell;
    print_message("%u repulsions in %u stripes\n", plan->repulsion_count, plan->stripe_count);
    assert_true(plan->stripe_count > 4);
    assert_int_equal(plan->stripe_first[plan->stripe_count], plan->repulsion_count);

    uint32_t *lowest = malloc(shell->vertex_count * sizeof *lowest);
    memset(lowest, 0xff, shell->vertex_count * sizeof *lowest);

    for (uint32_t s = 0; s < plan->stripe_count; s++)
        for (uint32_t k = plan->stripe_first[s]; k < plan->stripe_first[s + 1]; k++) {
            const Repulsion *repulsion = &plan->repulsions[k];
            for (int i = 0; i < 8; i++) {
                uint32_t *low = &lowest[shell->cells[i < 4 ? repulsion->a : repulsion->b][i & 3]];
                if (*low == UINT32_MAX) *low = s;
                assert_true(s - *low <= 1);
            }
        }
    free(lowest);
    for (int k = 0; k < 3; k++) singe_sim_destroy(sims[k]);
}

TEST(list_sizes_do_not_affect_results) {
    const Crowd *scenes[] = {&stack, &soup};
    for (int k = 0; k < 2; k++) {
        SingeSim *usual = crowd(scenes[k], 1, NULL), *small = crowd(scenes[k], 1, NULL);
        SingeSim *threads = crowd(scenes[k], 3, NULL);
        CollisionSizes sizes = tiny(small), same = collision_sizes(&usual->shell);
        same.entry_max = sizes.entry_max; // the order of pairs follows the grid
        resize(small, &sizes), resize(threads, &sizes), resize(usual, &same);

        test_steps(usual, 8), test_steps(small, 8), test_steps(threads, 8);
        assert_true(collision(small)->pair_capacity > sizes.pairs);
        assert_int_equal(singe_sim_timers(small).contact_dropped, 0);
        test_assert_same(usual, small);
        test_assert_same(usual, threads);
        singe_sim_destroy(usual), singe_sim_destroy(small), singe_sim_destroy(threads);
    }
}

/// Where a list may not grow, what is lost is counted, and is the same for any number of threads.
TEST(dropped_pairs_are_counted) {
    const struct {
        const Crowd *scene;
        bool pairs, repulsions;
    } cases[] = {{&stack, true, false}, {&stack, false, true}, {&stack, true, true}, {&soup, true, false}};

    for (int full = 0; full < 4; full++) {
        SingeSim *sims[3];
        for (int k = 0; k < 3; k++) {
            sims[k] = crowd(cases[full].scene, k + 1, NULL);
            CollisionSizes sizes = tiny(sims[k]);
            uint32_t cells = sims[k]->shell.cell_count;
            if (cases[full].pairs) sizes.pair_max = sizes.pairs = sizes.pair_budget = cells + cells / 2;
            if (cases[full].repulsions) sizes.repulsion_max = sizes.repulsions = cells / 3;
            resize(sims[k], &sizes);
            test_steps(sims[k], 10);
        }

        SingeTimers timers = singe_sim_timers(sims[0]);
        print_message("%llu dropped\n", (unsigned long long)timers.contact_dropped);
        assert_true(timers.contact_dropped > 10);

        for (int k = 1; k < 3; k++) {
            assert_int_equal(singe_sim_timers(sims[k]).contact_dropped, timers.contact_dropped);
            test_assert_same(sims[0], sims[k]);
        }
        for (int k = 0; k < 3; k++) singe_sim_destroy(sims[k]);
    }
}

/// A sheet of n x n cells of 1.7 mm, held at two corners in a wind along it.
static SingeSim *flag(uint32_t n, float wind, int threads) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = threads;
    def.contact.enabled = true;
    def.time_step = 1.0f / 240;
    def.wind.velocity[0] = def.wind.gust = wind;

    SingeSim *sim = test_sim(&def, test_grid(n, n, 1.7e-3f, 1.7e-3f), NULL);
    const uint32_t corners[] = {0, n};
    SingePinDef pin = singe_default_pin();
    assert_int_equal(singe_sim_sheets(sim, &pin.sheet, 1), 1);
    pin.vertices = corners;
    pin.vertex_count = 2;
    test_add_pin(sim, &pin);
    return sim;
}

/// In a storm of 1,000 m/s cells meet all others in a step. The bound of the work ends it, at the same place for any
/// number of threads, and nothing crosses.
TEST(steps_that_would_take_minutes_halt) {
    SingeSim *sims[2];
    for (int k = 0; k < 2; k++) {
        sims[k] = flag(36, 1000, 1 + 2 * k);
        test_steps(sims[k], 3);

        const CollisionPlan *plan = collision(sims[k]);
        const SingeTimers timers = singe_sim_timers(sims[k]);
        print_message("%d of 3 steps halted, the last with %.0f units of work a cell\n", (int)timers.contact_halts,
                      (double)plan->work / plan->cell_count);
        assert_true(timers.contact_halts > 0);
        assert_true(plan->work < 2 * plan->work_max);
        assert_int_equal(crossings(sims[k]), 0);
    }

    test_assert_same(sims[0], sims[1]);
    singe_sim_destroy(sims[0]), singe_sim_destroy(sims[1]);
}

/// A flag in 15 m/s turns its cells by about their width in 1/240 s: such steps have parts, and neither halt nor stretch
/// it. The parts depend on what a snapshot holds alone.
TEST(flags_in_the_wind_keep_their_shape) {
    SingeSim *sims[3] = {flag(28, 15, 1), flag(28, 15, 3)};
    test_steps(sims[0], 8), test_steps(sims[1], 8);
    sims[2] = test_reload(NULL, sims[0]);
    test_steps(sims[2], 12);

    double searches = 0;
    for (int k = 0; k < 2; k++) {
        const double before = (double)singe_sim_timers(sims[k]).contact_searches;
        test_steps(sims[k], 12);
        searches = (double)singe_sim_timers(sims[k]).contact_searches - before;
        test_assert_same(sims[k], sims[2]);
    }

    const SingeStats stats = singe_sim_stats(sims[0]);
    print_message("%.1f parts a step; p99 strain %.3f, max %.3f\n", searches / 12, stats.strain_p99, stats.strain_max);
    assert_true(searches > 2 * 12); // else the wind is too weak for this test
    assert_int_equal(singe_sim_timers(sims[0]).contact_halts, 0);
    assert_true(stats.strain_p99 < 0.15);
    assert_int_equal(crossings(sims[0]), 0);
    for (int k = 0; k < 3; k++) singe_sim_destroy(sims[k]);
}

/// Two vertices that tremble at 2 m/s, as at burnt edges, do not split the next step of a whole sheet, nor do all of them,
/// as in a strained sheet, whose velocities are those of its last substep: they stay where they are. Parts would take the
/// strain out at a blow, whose speeds would ask for more of them. A sheet that turns by .4 in a step has parts.
TEST(only_what_moves_splits_the_step) {
    enum { FEW, ALL, TURNS, MOTIONS };
    int parts[MOTIONS];
    for (int motion = 0; motion < MOTIONS; motion++) {
        OwnSim *sim = flag(28, 0, 1);
        const float spin = 0.4f / sim->def.time_step;
        float(*velocity)[4] = sim->state.dynamics.velocity;
        for (uint32_t v = 0; v < sim->shell.particle_count; v++) {
            const float *x = sim->state.dynamics.position[v];
            if (motion == TURNS) velocity[v][0] = -spin * x[1], velocity[v][1] = spin * x[0];
            else if (motion == ALL || v % 300 == 100) velocity[v][2] = v & 1 ? -2 : 2;
        }

        test_steps(sim, 1);
        parts[motion] = collision_parts(collision(sim));
    }

    print_message("%d part if two vertices tremble, %d if all do, %d if all turn\n", parts[FEW], parts[ALL],
                  parts[TURNS]);
    assert_int_equal(parts[FEW], 1);
    assert_int_equal(parts[ALL], 1);
    assert_in_range(parts[TURNS], 4, 8);
}

/// Pairs of boxes that the search compares, per cell, of a flat sheet in one of three positions.
static double compared(uint32_t nx, uint32_t ny, float dx, float dy, int position) {
    SingeSimDef def = singe_default_sim();
    def.contact.enabled = true;

    TestMesh mesh = test_grid(nx, ny, dx, dy);
    if (position == 1) test_mesh_raise(&mesh);
    for (uint32_t v = 0; position == 2 && v < mesh.vertex_count; v++) { // y becomes x, x becomes z
        float *p = mesh.positions + 3 * (size_t)v, x = p[0];
        p[0] = p[1], p[1] = p[2], p[2] = x;
    }

    OwnSim *sim = test_sim(&def, mesh, NULL);
    test_steps(sim, 1);

    const CollisionPlan *plan = collision(sim);
    double sum = 0;
    for (uint32_t b = 0; b < plan->bucket_count; b++) {
        double count = plan->bucket_first[b + 1] - plan->bucket_first[b];
        sum += count * (count - 1) / 2;
    }

    sum /= plan->cell_count;
    return sum;
}

/// The search costs by cells, not by their shape: slim ones are not all in the same few cubes.
TEST(slim_cells_cost_as_squares) {
    const double squares = compared(71, 71, 7e-3f, 7e-3f, 0);
    for (int position = 0; position < 3; position++) {
        double slim = compared(1250, 4, 0.4e-3f, 0.125f, position);
        print_message("boxes compared, per cell: %.1f of squares, %.1f of slim cells\n", squares, slim);
        assert_true(slim <= 3 * squares);
    }
}

/// A step that has no memory to grow fails and can be repeated.
TEST(a_step_without_memory_to_grow_is_repeated) {
    int failures = 0;
    for (long fail = 1; fail < 40; fail++) {
        TestAllocator hook = {0};
        SingeAllocator allocator = test_allocator(&hook);
        SingeSim *sim = crowd(&stack, 1, &allocator);
        CollisionSizes sizes = tiny(sim);
        resize(sim, &sizes);
        hook.fail_at = hook.calls + fail, hook.once = true;

        SingeResult result = SINGE_OK;
        for (int step = 0; step < 8; step++) {
            float before[3];
            uint32_t last = singe_sim_view(sim).particle_count - 1;
            memcpy(before, singe_sim_view(sim).position[last], sizeof before);
            result = singe_sim_step(sim);
            if (!result) continue;

            test_refused(sim, SINGE_ERROR_MEMORY, result);
            assert_string_equal(singe_sim_error(sim)->stage, "contact");
            assert_memory_equal(before, singe_sim_view(sim).position[last], sizeof before);
            failures++;
        }

        assert_int_equal(crossings(sim), 0);
        assert_int_equal(singe_sim_timers(sim).contact_dropped, 0);
        bool over = hook.calls < hook.fail_at;
        singe_sim_destroy(sim);
        test_allocator_check(&hook);
        if (over) break;
    }

    print_message("%d steps failed\n", failures);
    assert_true(failures > 8);
}

/// A simulation that was rebuilt counts the memory by which its lists grow.
TEST(a_rebuilt_crowd_counts_its_memory) {
    TestAllocator hook = {0};
    SingeAllocator allocator = test_allocator(&hook);
    SingeSim *sim = crowd(&stack, 1, &allocator);
    test_ok(sim, singe_sim_set_ambient_temperature(sim, 350));
    size_t uncounted = hook.bytes - singe_sim_counts(sim).memory;

    test_steps(sim, 15);
    assert_true(collision(sim)->repulsion_capacity > collision(sim)->sizes.repulsions);
    assert_int_equal(hook.bytes - singe_sim_counts(sim).memory, uncounted);

    singe_sim_destroy(sim);
    test_allocator_check(&hook);
}
