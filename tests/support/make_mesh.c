#include "support.h"

static const double pi = 3.14159265358979323846;

static TestMesh mesh_make(uint32_t vertices, uint32_t cells) {
    TestMesh mesh = {vertices, cells, calloc(3 * (size_t)vertices, sizeof(float)),
                     calloc(2 * (size_t)vertices, sizeof(float)), calloc(4 * (size_t)cells, sizeof(uint32_t))};
    assert_true(mesh.positions && mesh.uv && mesh.cells);
    return mesh;
}

static void mesh_vertex(TestMesh *mesh, uint32_t v, double x, double y, double z, double u, double w) {
    float *p = mesh->positions + 3 * (size_t)v, *t = mesh->uv + 2 * (size_t)v;
    p[0] = (float)x, p[1] = (float)y, p[2] = (float)z;
    t[0] = (float)u, t[1] = (float)w;
}

static void mesh_cell(TestMesh *mesh, uint32_t c, uint32_t v0, uint32_t v1, uint32_t v2, uint32_t float3) {
    uint32_t *cell = mesh->cells + 4 * (size_t)c;
    cell[0] = v0, cell[1] = v1, cell[2] = v2, cell[3] = float3;
}

TestMesh test_grid(uint32_t nx, uint32_t ny, float dx, float dy) {
    TestMesh mesh = mesh_make((nx + 1) * (ny + 1), nx * ny);
    for (uint32_t j = 0; j <= ny; j++)
        for (uint32_t i = 0; i <= nx; i++)
            mesh_vertex(&mesh, j * (nx + 1) + i, (double)i * (double)dx, (double)j * (double)dy, 0, (double)i / nx,
                        (double)j / ny);

    for (uint32_t j = 0; j < ny; j++)
        for (uint32_t i = 0; i < nx; i++) {
            uint32_t v = j * (nx + 1) + i;
            mesh_cell(&mesh, j * nx + i, v, v + 1, v + nx + 2, v + nx + 1);
        }

    return mesh;
}

TestMesh test_cylinder(uint32_t around, uint32_t along, float radius, float length) {
    TestMesh mesh = mesh_make(around * (along + 1), around * along);
    for (uint32_t j = 0; j <= along; j++)
        for (uint32_t i = 0; i < around; i++) {
            double a = 2 * pi * i / around;
            mesh_vertex(&mesh, j * around + i, (double)radius * cos(a), (double)radius * sin(a),
                        (double)length * j / along, (double)i / around, (double)j / along);
        }

    for (uint32_t j = 0; j < along; j++)
        for (uint32_t i = 0; i < around; i++) {
            uint32_t next = (i + 1) % around;
            mesh_cell(&mesh, j * around + i, j * around + i, j * around + next, (j + 1) * around + next,
                      (j + 1) * around + i);
        }

    return mesh;
}

TestMesh test_torus(uint32_t around, uint32_t tube, float radius, float tube_radius) {
    TestMesh mesh = mesh_make(around * tube, around * tube);
    for (uint32_t j = 0; j < tube; j++)
        for (uint32_t i = 0; i < around; i++) {
            double a = 2 * pi * i / around, b = 2 * pi * j / tube, r = (double)radius + (double)tube_radius * cos(b);
            mesh_vertex(&mesh, j * around + i, r * cos(a), r * sin(a), (double)tube_radius * sin(b), (double)i / around,
                        (double)j / tube);
        }

    for (uint32_t j = 0; j < tube; j++)
        for (uint32_t i = 0; i < around; i++) {
            uint32_t next = (i + 1) % around, up = (j + 1) % tube;
            mesh_cell(&mesh, j * around + i, j * around + i, j * around + next, up * around + next, up * around + i);
        }

    return mesh;
}

void test_mesh_add_vertex(TestMesh *mesh, float x, float y, float z) {
    uint32_t v = mesh->vertex_count++;
    mesh->positions = realloc(mesh->positions, 3 * sizeof(float) * mesh->vertex_count);
    mesh->uv = realloc(mesh->uv, 2 * sizeof(float) * mesh->vertex_count);
    assert_true(mesh->positions && mesh->uv);
    mesh_vertex(mesh, v, (double)x, (double)y, (double)z, 0, 0);
}

void test_mesh_move(TestMesh *mesh, float x, float y, float z) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *p = mesh->positions + 3 * (size_t)v;
        p[0] += x, p[1] += y, p[2] += z;
    }
}

void test_mesh_raise(TestMesh *mesh) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *p = mesh->positions + 3 * (size_t)v, y = p[1];
        p[1] = -p[2], p[2] = y;
    }
}

void test_mesh_free(TestMesh *mesh) {
    free(mesh->positions);
    free(mesh->uv);
    free(mesh->cells);
    memset(mesh, 0, sizeof *mesh);
}
