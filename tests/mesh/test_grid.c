// Grids: exact where they are plain, and with their outline where they are worn.

#include "mesh/to_quads.h"
#include "support/support.h"

TEST(grid_is_exact) {
    Mesh mesh;
    SingeError error;
    assert_int_equal(mesh_grid(2, 1, 2, 1, (SingeAllocator){0}, &mesh, &error), SINGE_OK);

    static const float positions[] = {-1, -0.5f, 0, 0, -0.5f, 0, 1, -0.5f, 0, -1, 0.5f, 0, 0, 0.5f, 0, 1, 0.5f, 0};
    static const float uv[] = {0, 0, 0.5f, 0, 1, 0, 0, 1, 0.5f, 1, 1, 1};
    static const uint32_t cells[] = {0, 1, 4, 3, 1, 2, 5, 4};

    assert_int_equal(mesh.vertex_count, 6);
    assert_int_equal(mesh.cell_count, 2);
    assert_memory_equal(mesh.positions, positions, sizeof positions);
    assert_memory_equal(mesh.uv, uv, sizeof uv);
    assert_memory_equal(mesh.cells, cells, sizeof cells);

    mesh_free(&mesh);
    assert_int_equal(mesh_grid(0, 1, 2, 1, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(mesh_grid(1, NAN, 2, 1, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(mesh_grid(1, INFINITY, 2, 1, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(mesh_grid(1, 1, 0, 1, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(mesh_grid(1, 1, 4294967295u, 4294967295u, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_LIMIT);
    test_allocations_fail(3, mesh_grid(1, 1, 3, 3, allocator, &mesh, &error), mesh_free(&mesh));
}

static double cell_area(const Mesh *mesh, uint32_t cell, int corner) {
    const float *p[3];
    for (int k = 0; k < 3; k++) p[k] = mesh->positions + 3 * mesh->cells[4 * cell + (uint32_t)((corner + k) % 4)];
    return (double)((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]));
}

TEST(worn_grid_keeps_its_outline) {
    enum { NX = 40, NY = 60 };
    Mesh mesh, plain;
    assert_int_equal(mesh_grid(0.2f, 0.3f, NX, NY, (SingeAllocator){0}, &mesh, NULL), SINGE_OK);
    assert_int_equal(mesh_grid(0.2f, 0.3f, NX, NY, (SingeAllocator){0}, &plain, NULL), SINGE_OK);
    mesh_grid_wear(&mesh, NX, NY, &(GridWear){.seed = 5});
    assert_memory_equal(mesh.positions, plain.positions, 12 * mesh.vertex_count);
    mesh_grid_wear(&mesh, NX, NY, &(GridWear){.jitter = 0.3f, .displacement = 2e-3f, .seed = 5});

    double moved = 0, height = 0, mean = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        const float *p = mesh.positions + 3 * v, *q = plain.positions + 3 * v;
        uint32_t i = v % (NX + 1), j = v / (NX + 1);
        if (i == 0 || i == NX) assert_true(p[0] == q[0]);
        if (j == 0 || j == NY) assert_true(p[1] == q[1]);
        moved = fmax(moved, fmax(fabs((double)(p[0] - q[0])), fabs((double)(p[1] - q[1]))));
        height += (double)(p[2] * p[2]) / mesh.vertex_count, mean += (double)p[2] / mesh.vertex_count;
        assert_true(fabsf(mesh.uv[2 * v] - (p[0] / 0.2f + 0.5f)) < 1e-5f);
    }

    assert_true(moved > 0.15 * 0.005 && moved < 0.301 * 0.005);
    assert_true(sqrt(height) > 1e-3 && sqrt(height) < 3e-3 && fabs(mean) < 1e-3);
    for (uint32_t c = 0; c < mesh.cell_count; c++)
        for (int k = 0; k < 4; k++) assert_true(cell_area(&mesh, c, k) > 0.2 * 0.5 * 0.005 * 0.005);
    mesh_free(&mesh), mesh_free(&plain);
}

/// The jitter follows a cell's width: slim cells keep their shape, whichever side is the longer one.
TEST(slim_cells_stay_slim) {
    enum { LONG = 500, SHORT = 4 };
    for (int turn = 0; turn < 2; turn++) {
        const uint32_t nx = turn ? SHORT : LONG, ny = turn ? LONG : SHORT;
        const double side[2] = {1.0 / nx, 1.0 / ny}, width = fmin(side[0], side[1]), length = fmax(side[0], side[1]);
        OWNED(mesh_free) Mesh mesh;
        assert_int_equal(mesh_grid(1, 1, nx, ny, (SingeAllocator){0}, &mesh, NULL), SINGE_OK);
        mesh_grid_wear(&mesh, nx, ny, &(GridWear){.jitter = 0.15f, .seed = 1});

        double widest = 0, longest = 0;
        for (uint32_t c = 0; c < mesh.cell_count; c++)
            for (int k = 0; k < 4; k++) {
                const float *p = mesh.positions + 3 * mesh.cells[4 * c + (uint32_t)k];
                const float *q = mesh.positions + 3 * mesh.cells[4 * c + (uint32_t)((k + 1) % 4)];
                double edge = hypot((double)(p[0] - q[0]), (double)(p[1] - q[1]));
                bool across = (k % 2 == 0) == (nx == LONG);
                if (across) widest = fmax(widest, edge);
                else longest = fmax(longest, edge);
            }

        print_message("cells of %g by %g: sides up to %g by %g\n", width, length, widest, longest);
        assert_true(widest < 1.7 * width && longest < 1.01 * length);
    }
}
