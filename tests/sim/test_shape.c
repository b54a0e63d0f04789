// What a step costs follows the number of cells and not their shape. In processor time, of one thread.
#include "support/support.h"

enum { SHAPES = 3, ROUNDS = 6, STEPS = 5, FALLEN = 60 };

/// A sheet that falls, with contact, and is lit at its centre.
static SingeSim *sheet(const uint32_t cells[2], const float size[2]) {
    SingeGridDef grid = singe_default_grid();
    SingeSimDef def = singe_default_sim();
    SingeMesh *mesh;

    def.thread_count = 1, def.contact.enabled = true;
    for (int k = 0; k < 2; k++) grid.cells[k] = cells[k], grid.size[k] = size[k];
    assert_int_equal(singe_mesh_create_grid(&grid, &mesh, NULL), SINGE_OK);

    SingeSim *sim = test_create(&def);
    SingeSheetDef sheet = singe_default_sheet();
    singe_mesh_fill_sheet(mesh, &sheet);
    test_add_sheet(sim, &sheet);
    test_ok(sim, singe_sim_commit(sim));
    singe_mesh_destroy(mesh);
    test_spot(sim, 0, 0, 0, 0.05f, 1200, 150);
    return sim;
}

/// Each shape's fastest step: the machine may be busy, and a turn's first step finds the caches full of another shape.
TEST(strips_cost_as_squares) {
    static const struct {
        const char *name;
        uint32_t cells[2];
        float size[2];
    } shapes[SHAPES] = {{"a square of squares", {141, 141}, {1, 1}},
                        {"a strip of squares", {5000, 4}, {35, 0.028f}},
                        {"a square of strips", {5000, 4}, {1, 1}}};
    double cost[SHAPES];
    SingeSim *sims[SHAPES];
    for (int k = 0; k < SHAPES; k++) {
        sims[k] = sheet(shapes[k].cells, shapes[k].size);
        test_steps(sims[k], FALLEN); // as fast as the air lets it
        cost[k] = INFINITY;
    }

    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < SHAPES; k++)
            for (int step = 0; step < STEPS; step++) {
                double begun = test_seconds();
                test_steps(sims[k], 1);
                cost[k] = fmin(cost[k], test_seconds() - begun);
            }

    for (int k = 0; k < SHAPES; k++) {
        print_message("%s: %.1f ms a step, %.2f times squares\n", shapes[k].name, 1e3 * cost[k], cost[k] / cost[0]);
        singe_sim_destroy(sims[k]);
    }

    assert_true(cost[1] <= 1.3 * cost[0]);
    assert_true(cost[2] <= 1.6 * cost[0]);
}
