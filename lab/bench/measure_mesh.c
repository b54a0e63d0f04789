// The swinging sheet made from triangles: the quads that mesh_make makes, and whether the result is as inextensible as
// a sheet of quads.
//
// The triangles are those of a grid with equal, alternating or random diagonals; the same with shuffled numbers; rows
// of nearly equilateral ones; and the Delaunay triangles of a grid whose vertices are moved by up to a third of a cell.
// The quads of the same vertices show the effect of the vertices alone. The correct motion and the bars are those of
// `swing`.
#include "mesh/to_quads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "bench/trajectory.h"

typedef enum Triangles { QUADS, MOVED, ORDERED, TURNS, RANDOM, SHUFFLED, EQUILATERAL, DELAUNAY, TRIANGLES } Triangles;
static const char *const names[TRIANGLES] = {"quads",  "moved-quads", "ordered",     "turns",
                                             "random", "shuffled",    "equilateral", "delaunay"};

enum { SUBSTEPS = 60 };

enum { NAME, BECOME, TRI, CELLS, HALVED, IRREGULAR, STRAND, CPU, BLUE, YELLOW, FALL, OFF, RESULT, COLUMNS };
static const BenchColumn columns[COLUMNS] = {
    [NAME] = {"mesh", NULL, 12, NULL},
    [BECOME] = {"quads", NULL, 6, NULL},
    [TRI] = {"triangles", "%.0f", 9, NULL},
    [CELLS] = {"cells", "%.0f", 7, NULL},
    [HALVED] = {"halved", "%.0f", 7, NULL},
    [IRREGULAR] = {"irregular_pct", "%.1f", 13, NULL},
    [STRAND] = {"strand", "%.1f", 7, NULL},
    [CPU] = {"cpu_ms", "%.1f", 8, NULL},
    [BLUE] = {"blue_pct", "%.3g", 20, "max/p99/mean"},
    [YELLOW] = {"yellow_pct", "%.3g", 20, "max/p99/mean"},
    [FALL] = {"fall_m", "%.3f", 20, "0.33/0.50/0.67"},
    [OFF] = {"off_cm", "%.1f", 6, NULL},
    [RESULT] = {"result", NULL, 8, NULL},
};

/// A triangulation, with the half-edge on the other side of each side, or UINT32_MAX.
typedef struct Plane {
    uint32_t vertex_count, triangle_count;
    float (*position)[3];
    uint32_t (*corner)[3];
    uint32_t *twin;
} Plane;

static uint32_t random_next(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}
static float random_share(uint32_t *state) { return (float)random_next(state) / 16777216.0f * 2 - 1; }

// ---- Delaunay triangles by flips (Lawson 1977)

static uint32_t mesh_next3(uint32_t h) { return h - h % 3 + (h + 1) % 3; }
static uint32_t mesh_last3(uint32_t h) { return h - h % 3 + (h + 2) % 3; }
static uint32_t *corner_of(Plane *plane, uint32_t h) { return &plane->corner[h / 3][h % 3]; }

static int compare_sides(const void *a, const void *b) { return memcmp(a, b, 2 * sizeof(uint32_t)); }

static void mesh_join_halves(Plane *plane, uint32_t h, uint32_t twin) {
    plane->twin[h] = twin;
    if (twin != UINT32_MAX) plane->twin[twin] = h;
}

static bool flip(Plane *plane, uint32_t h) {
    uint32_t g = plane->twin[h];
    if (g == UINT32_MAX || g < h) return false;
    uint32_t a = *corner_of(plane, h), b = *corner_of(plane, mesh_next3(h)), c = *corner_of(plane, mesh_last3(h));
    uint32_t d = *corner_of(plane, mesh_last3(g)), t = 3 * (h / 3), s = 3 * (g / 3);

    // whether d lies within the circle through a, b and c
    double m[3][3];
    const float *last = plane->position[d], *corner[3] = {plane->position[a], plane->position[b], plane->position[c]};
    for (int i = 0; i < 3; i++) {
        m[i][0] = (double)corner[i][0] - (double)last[0], m[i][1] = (double)corner[i][1] - (double)last[1];
        m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
    }

    bool inside = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                      m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                      m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) >
                  1e-18;
    if (!inside) return false;

    const uint32_t outer[4] = {plane->twin[mesh_last3(h)], plane->twin[mesh_next3(g)], plane->twin[mesh_last3(g)],
                               plane->twin[mesh_next3(h)]};
    const uint32_t first[3] = {c, a, d}, second[3] = {d, b, c};
    memcpy(plane->corner[t / 3], first, sizeof first);
    memcpy(plane->corner[s / 3], second, sizeof second);
    mesh_join_halves(plane, t, outer[0]), mesh_join_halves(plane, t + 1, outer[1]),
        mesh_join_halves(plane, s, outer[2]), mesh_join_halves(plane, s + 1, outer[3]);
    mesh_join_halves(plane, t + 2, s + 2);
    return true;
}

static bool make_delaunay(Plane *plane) {
    // the half-edges on the other side
    const uint32_t sides = 3 * plane->triangle_count;
    uint32_t(*side)[3] = malloc(sides * sizeof *side);
    if (!side) return false;
    for (uint32_t h = 0; h < sides; h++) {
        uint32_t a = *corner_of(plane, h), b = *corner_of(plane, mesh_next3(h));
        side[h][0] = a < b ? a : b;
        side[h][1] = a < b ? b : a;
        side[h][2] = h;
        plane->twin[h] = UINT32_MAX;
    }

    qsort(side, sides, sizeof *side, compare_sides);
    for (uint32_t k = 0; k + 1 < sides; k++)
        if (compare_sides(side[k], side[k + 1]) == 0)
            plane->twin[side[k][2]] = side[k + 1][2], plane->twin[side[k + 1][2]] = side[k][2];
    free(side);

    // flip until none is left
    bool flipped = true;
    for (int sweep = 0; flipped && sweep < 100; sweep++) {
        flipped = false;
        for (uint32_t h = 0; h < 3 * plane->triangle_count; h++) flipped = flip(plane, h) || flipped;
    }
    return true;
}

static bool plane_make(Triangles kind, uint32_t n, Plane *plane) {
    uint32_t state = 7;
    *plane = (Plane){.vertex_count = (n + 1) * (n + 1), .triangle_count = 2 * n * n};
    plane->position = malloc(plane->vertex_count * sizeof *plane->position);
    plane->corner = malloc(plane->triangle_count * sizeof *plane->corner);
    plane->twin = malloc(3 * (size_t)plane->triangle_count * sizeof *plane->twin);
    if (!plane->position || !plane->corner || !plane->twin) return false;

    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++) {
            float x = (float)i, y = (float)j, *p = plane->position[j * (n + 1) + i];
            float dx = random_share(&state) / 3, dy = random_share(&state) / 3;
            bool moved = kind == DELAUNAY || kind == MOVED;
            if (moved && i > 0 && i < n) x += dx;
            if (moved && j > 0 && j < n) y += dy;
            if (kind == EQUILATERAL && i > 0 && i < n) x += j & 1 ? 0.25f : -0.25f;
            p[0] = x / (float)n, p[1] = y / (float)n, p[2] = 0;
        }

    for (uint32_t c = 0; c < n * n; c++) {
        uint32_t i = c % n, j = c / n,
                 at[4] = {j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i};
        bool other = kind == TURNS ? (i + j) & 1 : kind == EQUILATERAL ? !(j & 1) : random_next(&state) & 1;
        uint32_t turn = kind != ORDERED && other;
        const uint32_t first[3] = {at[turn], at[turn + 1], at[turn + 2]};
        const uint32_t second[3] = {at[turn], at[turn + 2], at[(turn + 3) & 3]};
        memcpy(plane->corner[2 * c], first, sizeof first);
        memcpy(plane->corner[2 * c + 1], second, sizeof second);
    }

    if (kind == SHUFFLED) {
        // numbers vertices and triangles at random
        uint32_t *to = malloc(plane->vertex_count * sizeof *to);
        float(*position)[3] = malloc(plane->vertex_count * sizeof *position);
        if (to && position) {
            for (uint32_t v = 0; v < plane->vertex_count; v++) {
                uint32_t other = random_next(&state) % (v + 1);
                to[v] = to[other], to[other] = v;
            }

            for (uint32_t v = 0; v < plane->vertex_count; v++)
                memcpy(position[to[v]], plane->position[v], sizeof *position);
            memcpy(plane->position, position, plane->vertex_count * sizeof *position);
            for (uint32_t t = 0; t < plane->triangle_count; t++) {
                uint32_t other = random_next(&state) % (t + 1), corner[3];
                for (int k = 0; k < 3; k++) plane->corner[t][k] = to[plane->corner[t][k]];
                memcpy(corner, plane->corner[t], sizeof corner);
                memcpy(plane->corner[t], plane->corner[other], sizeof corner);
                memcpy(plane->corner[other], corner, sizeof corner);
            }
        }

        bool good = to && position;
        free(to);
        free(position);
        return good;
    }

    return kind != DELAUNAY || make_delaunay(plane);
}

// ---- measuring

static SingeResult make_quads(const Plane *plane, MeshQuads quads, Mesh *mesh, MeshReport *report, SingeError *error) {
    MeshOptions options = mesh_default_options();
    uint32_t *first = malloc(((size_t)plane->triangle_count + 1) * sizeof *first);
    if (!first) return SINGE_ERROR_MEMORY;
    for (uint32_t t = 0; t <= plane->triangle_count; t++) first[t] = 3 * t;
    const Polygons polygons = {.vertex_count = plane->vertex_count,
                               .face_count = plane->triangle_count,
                               .corner_count = 3 * plane->triangle_count,
                               .positions = plane->position[0],
                               .first = first,
                               .corners = plane->corner[0]};
    options.quads = quads;
    SingeResult result = mesh_make("bench", &polygons, &options, (SingeAllocator){0}, mesh, report, error);
    free(first);
    return result;
}

static bool mesh_add_row(BenchTable *table, const BenchSetup *setup, Triangles kind, MeshQuads quads, const Mesh *mesh,
                         const MeshReport *report, const Trajectory *t) {
    // vertices inside the square, and those of them whose number of cells is not four
    uint32_t *cells = calloc(mesh->vertex_count, sizeof *cells), inside = 0, irregular = 0;
    for (size_t i = 0; cells && i < 4 * (size_t)mesh->cell_count; i++) cells[mesh->cells[i]]++;
    for (uint32_t v = 0; cells && v < mesh->vertex_count; v++) {
        const float *p = mesh->positions + 3 * (size_t)v;
        if (p[0] <= 0 || p[0] >= 1 || p[1] <= 0 || p[1] >= 1) continue;
        inside++, irregular += cells[v] != 4;
    }

    free(cells);

    BenchValue row[COLUMNS] = {
        [NAME] = bench_text(names[kind]),
        [BECOME] = bench_text(kind <= MOVED               ? "-"
                              : quads == MESH_QUADS_SPLIT ? "split"
                                                          : "pair"),
        [TRI] = bench_number(report->triangles),
        [CELLS] = bench_number(mesh->cell_count),
        [HALVED] = bench_number(report->count[MESH_HALVED]),
        [IRREGULAR] = bench_number(inside ? 100.0 * irregular / inside : 0),
        [STRAND] = bench_number(t->strand_length),
        [CPU] = bench_number(t->cpu_median),
        [BLUE] = strain_percent(&t->strain[SINGE_BLUE]),
        [YELLOW] = strain_percent(&t->strain[SINGE_YELLOW]),
        [FALL] = {.number = {t->fall[0], t->fall[1], t->fall[2]}},
        [OFF] = bench_number(trajectory_off(setup, t)),
        [RESULT] = bench_text(t->diverged ? "diverged" : "ok"),
    };
    return table_add(table, row);
}

static SingeResult mesh_measure(BenchSetup setup, Triangles kind, MeshQuads quads, int frames, BenchTable *table,
                                SingeError *error) {
    Plane plane;
    Mesh mesh = {0};
    MeshReport report = {0};
    SingeSheetDef shape = singe_default_sheet();
    SingeResult result = SINGE_OK;
    bool made = plane_make(kind, (uint32_t)setup.cells, &plane);

    if (!made) result = SINGE_ERROR_MEMORY;
    else if (kind <= MOVED) {
        // the grid's quads on the plane's vertices
        const uint32_t n = (uint32_t)setup.cells;
        result = mesh_grid(1, 1, n, n, (SingeAllocator){0}, &mesh, error);
        if (!result) memcpy(mesh.positions, plane.position, plane.vertex_count * sizeof *plane.position);
    } else result = make_quads(&plane, quads, &mesh, &report, error);

    free(plane.position);
    free(plane.corner);
    free(plane.twin);

    shape.vertex_count = mesh.vertex_count;
    shape.positions = mesh.positions;
    shape.cell_count = mesh.cell_count;
    shape.cells = mesh.cells;
    setup.shape = &shape;
    Trajectory *trajectory = result ? NULL : trajectory_run(&setup, frames, 1, INFINITY, error);
    if (!result && !trajectory) result = error->code;
    if (!result && !mesh_add_row(table, &setup, kind, quads, &mesh, &report, trajectory)) result = SINGE_ERROR_MEMORY;
    trajectory_free(trajectory);
    mesh_free(&mesh);
    return result;
}

SingeResult bench_mesh(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList cells = bench_list(&options->cells, 1, (const double[]){100});
    BenchSetup setup = sheet_setup(options, BENCH_SWING, 1);
    const int frames = (int)fmax(1, round((options->time > 0 ? options->time : 1) * BENCH_FPS));

    if (!options->substeps) setup.solver.substeps = SUBSTEPS;
    if (options->smoothing < 0) setup.solver.smoothing = 0;
    if (options->thickness.count) setup.thickness = (float)options->thickness.values[0];
    setup.pins = options->pins ? options->pins : 2;
    *table = table_begin("mesh", columns, COLUMNS, table->text);
    SingeResult result = SINGE_OK;
    for (int c = 0; c < cells.count && !result; c++) {
        setup.cells = (int)cells.values[c];
        for (int kind = 0; kind < TRIANGLES && !result; kind++)
            result = mesh_measure(setup, (Triangles)kind, MESH_QUADS_PAIR, frames, table, error);
        for (int kind = EQUILATERAL; kind < TRIANGLES && !result && !options->quick; kind++)
            result = mesh_measure(setup, (Triangles)kind, MESH_QUADS_SPLIT, frames, table, error);
    }

    return result;
}
