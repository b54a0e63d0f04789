// singe_mesh_create and its sister for grids refuse what singe/mesh.def and grid.def say, and so the headers and scenes,
// and nothing else.
#include "common/def_table.h"
#include "support/support.h"

// the ranges of the tables' rows
typedef struct Row {
    const char *name;
    bool whole;
    size_t offset;
    int length;
    FieldRange range;
} Row;

#define FLOAT false
#define VECTOR false
#define UINT32 true
#define UINTS true
#define ENUM(name) true
#define SINGE_ROWS_STAY
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    {#name, TYPE, offsetof(OF, name), length, range},
#define SINGE_NEEDED SINGE_FIELD
#define SINGE_HIDDEN SINGE_FIELD
#define OF SingeGridDef
static const Row grid_rows[] = {
#include "singe/grid.def"
};
#undef OF
#define OF SingeMeshDef
static const Row mesh_rows[] = {
#include "singe/mesh.def"
};

typedef SingeResult MakeFn(const void *def, SingeMesh **mesh, SingeError *error);
static SingeResult make_grid(const void *def, SingeMesh **mesh, SingeError *error) {
    return singe_mesh_create_grid(def, mesh, error);
}
static SingeResult make_mesh(const void *def, SingeMesh **mesh, SingeError *error) {
    return singe_mesh_create(def, mesh, error);
}

/// Tries each element of a row at the ends of its range, just beyond them, and as no number.
static void try_row(const Row *row, const void *standard, size_t size, MakeFn *make) {
    const float low = row->range.low, high = row->range.high;
    const float values[] = {low, high, row->whole ? low - 1 : nextafterf(low, -INFINITY),
                            row->whole ? high + 1 : nextafterf(high, INFINITY), NAN};
    for (int k = 0; k < row->length; k++)
        for (int v = row->whole ? 2 : 0; v < (row->whole ? 4 : 5); v++) { // a grid of 20000 cells a side takes long
            union {
                SingeGridDef grid;
                SingeMeshDef mesh;
            } def;
            SingeMesh *mesh;
            SingeError error = {0};
            const bool fits = range_has(&row->range, values[v]);
            const uint32_t whole = row->whole ? (uint32_t)values[v] : 0;
            memcpy(&def, standard, size);
            memcpy((char *)&def + row->offset + 4 * (size_t)k, row->whole ? (const void *)&whole : &values[v], 4);

            assert_int_equal(make(&def, &mesh, &error), fits ? SINGE_OK : SINGE_ERROR_ARGUMENT);
            if (!fits && !(strstr(error.message, row->name) && strstr(error.message, row->range.words)))
                fail_msg("%s of %g: \"%s\"", row->name, (double)values[v], error.message);
            singe_mesh_destroy(mesh);
        }
}

TEST(ranges_match_the_tables) {
    const SingeGridDef grid = singe_default_grid();
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t corners[] = {0, 1, 2};
    SingeMeshDef mesh = singe_default_mesh();
    mesh.vertex_count = 3, mesh.positions = positions;
    mesh.face_count = 1, mesh.corners = corners;
    for (size_t i = 0; i < sizeof grid_rows / sizeof *grid_rows; i++)
        if (grid_rows[i].range.words) try_row(&grid_rows[i], &grid, sizeof grid, make_grid);
    for (size_t i = 0; i < sizeof mesh_rows / sizeof *mesh_rows; i++)
        if (mesh_rows[i].range.words) try_row(&mesh_rows[i], &mesh, sizeof mesh, make_mesh);
}
