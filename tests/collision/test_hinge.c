// Two cells that share two sides, with a corner in between that no other cell has (a side halved by mesh/pair.c): such
// a corner may pass through its own cell, and leave both cells sound by themselves, but crossing each other.

#include "count_crossings.h"
#include "sim/sim_internal.h"

#ifdef SINGE_THREADS_ONLY
enum { HINGES = 40, STEPS = 10, SCENES = 1 };
#else
enum { HINGES = 40, STEPS = 60, SCENES = 6 };
#endif

static float random_from(uint32_t *seed, float low, float high) {
    *seed = *seed * 1664525u + 1013904223u;
    return low + (high - low) * (float)(*seed >> 8) / 16777216.0f;
}

/// A cell of an edge of 4 mm, halved, and a corner close to it; and one across the edge, folded by up to a right angle,
/// whose own corner is far. All are turned and thrown at the ground.
static void add_hinge(SingeSim *sim, uint32_t *seed, int number) {
    static const uint32_t cells[8] = {0, 1, 2, 3, 2, 1, 0, 4};
    const float edge = 4e-3f, near = random_from(seed, 0.2f, 0.5f) * edge, far = random_from(seed, 1.5f, 4) * edge;
    float position[5][3] = {{0, 0, 0}, {edge / 2, 0, 0}, {edge, 0, 0}}, axes[3][3], x[5][3];
    position[3][0] = random_from(seed, 0, edge), position[3][1] = near * random_from(seed, 0, 1), position[3][2] = near;
    position[4][0] = random_from(seed, 0, edge), position[4][1] = -far;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) axes[k][i] = random_from(seed, -1, 1) + 2 * (float)(i == (k + number) % 3);

    for (int v = 0; v < 5; v++)
        for (int i = 0; i < 3; i++) {
            x[v][i] = i == 2 ? 0.02f : 0.05f * (float)(i == 0 ? number % 8 : number / 8);
            for (int k = 0; k < 3; k++) x[v][i] += position[v][k] * axes[k][i] / 2;
        }

    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;
    def.vertex_count = 5, def.positions = x[0], def.cell_count = 2, def.cells = cells;
    def.material.thickness = singe_param(1e-4f);
    def.velocity[2] = -random_from(seed, 2, 12);
    assert_int_equal(singe_sim_add_sheet(sim, &def, &id), SINGE_OK);
}

static SingeSim *hinges(uint32_t seed, int threads, bool contact) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    def.thread_count = threads;
    def.contact.enabled = contact;
    def.solver.substeps = 3; // coarse: more of them would cross
    assert_int_equal(singe_sim_create(&def, &sim, NULL), SINGE_OK);
    for (int i = 0; i < HINGES; i++) add_hinge(sim, &seed, i);
    assert_int_equal(singe_sim_commit(sim), SINGE_OK);

    SingeColliderDef ground = singe_default_collider();
    SingePoseKey key = {.rotation = {0, 0, 0, 1}};
    ground.path_count = 1, ground.path = &key, ground.friction = 0.3f;
    SingeColliderId id;
    assert_int_equal(singe_sim_add_collider(sim, &ground, &id), SINGE_OK);
    return sim;
}

/// Steps on one thread, on two, and without contact. Counts crossings with and without it; all positions are the same
/// on one thread and on two.
static void step_all(SingeSim *const sims[3], long *with, long *without) {
    SingeSurface surface[3] = {{0}, {0}, {0}};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(singe_sim_step(sims[i]), SINGE_OK);
        assert_int_equal(singe_sim_surface(sims[i], &surface[i]), SINGE_OK);
    }

    *with += surface_crossings(&surface[0]);
    *without += surface_crossings(&surface[2]);
    assert_int_equal(surface[0].vertex_count, surface[1].vertex_count);
    assert_memory_equal(surface[0].position, surface[1].position,
                        surface[0].vertex_count * sizeof *surface[0].position);
    for (int i = 0; i < 3; i++) singe_surface_free(&surface[i]);
}

TEST(hinges_do_not_cross) {
    long crossed = 0, with = 0;
    for (uint32_t seed = 1; seed <= SCENES; seed++) {
        SingeSim *one = hinges(seed, 1, true), *two = hinges(seed, 2, true), *without = hinges(seed, 1, false);
        for (int step = 0; step < STEPS; step++) step_all((SingeSim *const[3]){one, two, without}, &with, &crossed);
        assert_int_equal(singe_sim_timers(one).contact_unresolved, 0);
        singe_sim_destroy(one), singe_sim_destroy(two), singe_sim_destroy(without);
    }
    print_message("crossings: %ld with contact, %ld without\n", with, crossed);
    assert_int_equal(with, 0);
    // it would: 1003 pairs in all steps; a quarter of them where cells that face one way at the end were left out of the sweep
#ifndef SINGE_THREADS_ONLY
    assert_true(crossed > 500);
#endif
}

/// Sheets of one cell that all but meet at one line, like the pages of a book.
static SingeSim *pages(int count) {
    static const uint32_t cell[4] = {0, 1, 2, 3};
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;
    uint32_t seed = 1;

    def.contact.enabled = true;
    assert_int_equal(singe_sim_create(&def, &sim, NULL), SINGE_OK);
    for (int i = 0; i < count; i++) {
        const float angle = 6.2831853f * (float)i / (float)count, x = 0.1f * cosf(angle), y = 0.1f * sinf(angle);
        const float in = 5e-3f; // next to the line
        const float position[4][3] = {{in * x, in * y, 0.3f}, {x, y, 0.32f}, {x, y, 0.38f}, {in * x, in * y, 0.4f}};
        SingeSheetDef sheet = singe_default_sheet();
        SingeSheetId id;

        sheet.vertex_count = 4, sheet.positions = position[0], sheet.cell_count = 1, sheet.cells = cell;
        sheet.material.thickness = singe_param(1e-4f);
        sheet.velocity[0] = random_from(&seed, -1, 1), sheet.velocity[1] = random_from(&seed, -1, 1);
        assert_int_equal(singe_sim_add_sheet(sim, &sheet, &id), SINGE_OK);
    }

    assert_int_equal(singe_sim_commit(sim), SINGE_OK);
    return sim;
}

/// Each page meets many others, and each impact makes others: there impacts soon give way to zones. Pairs are looked at
/// again 5.5 times a step, and 31 times with as many rounds of impacts as are made elsewhere.
TEST(a_book_is_soon_parted) {
    for (int count = 50; count <= 100; count += 50) {
        SingeSim *sim = pages(count);
        for (int step = 0; step < 4; step++) assert_int_equal(singe_sim_step(sim), SINGE_OK);
        const CollisionCounters touches = dynamics_plan_contacts(sim->dynamics);
        const double looks = (double)touches.looks / (double)touches.pairs;
        print_message("%d pages: pairs are looked at again %.1f times a step\n", count, looks);
        assert_int_equal(touches.unresolved, 0);
        assert_true(looks > 1 && looks < 20);
        singe_sim_destroy(sim);
    }
}
