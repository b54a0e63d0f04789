// Marching triangles over fine triangles, coarse ones, and fans between them.
//
// A split cell's triangle is k^2 fine ones. Another cell's triangle is one, or, where its side is split for the cell
// across, a fan of k from the cell's centre. Each is clipped as in surface.c, once to count and once to draw; a fine
// side's cut is made once and shared, on the sides of cells through `cuts`.
//
// A cell that has lost springs has corners that go their own ways and take its virtual centre along. What is drawn
// there has torn: a triangle of it is left out when it is pulled apart, with C and C' the metrics of its two sides from the
// centre at rest and now:
//
//   lambda^2 > TORN^2,   lambda^2 the larger eigenvalue of C^-1 C'
#include "ablate/surface_fine.h"

#include <string.h>

/// surface_cut of a fine side: a few micrometres, which floats tell apart some metres from the origin and nobody sees.
#define NEAREST 0.03125f

/// How many times as long as at rest it may be.
#define TORN 1.6f

typedef struct Marching {
    Fine *fine;
    bool drawing;
    uint64_t triangles, crossed; ///< counted
} Marching;

/// A triangle to clip. cut[i] belongs to the edge from corner i to the next one.
typedef struct Piece {
    uint32_t point[3];
    FinePlace place[3];
    uint32_t *cut[3];
} Piece;

static uint32_t add_vertex(Fine *fine, FinePlace place, float mass, uint32_t source) {
    fine->vertices[fine->vertex_count] = (FineVertex){place, mass, source};
    return ++fine->vertex_count;
}

static uint32_t point_vertex(Fine *fine, const Piece *piece, int corner) {
    uint32_t point = piece->point[corner];
    if (!fine->drawn[point])
        fine->drawn[point] = add_vertex(fine, piece->place[corner], fine->values[point].mass,
                                        point < fine->shell->vertex_count ? point : SHELL_NONE);
    return fine->drawn[point];
}

/// The vertex that cuts edge `edge`, of which one end is inside.
static uint32_t cut_vertex(Fine *fine, const Piece *piece, int edge) {
    int inside = edge, outside = edge == 2 ? 0 : edge + 1;
    if (fine->values[piece->point[inside]].level < 0) inside = outside, outside = edge;
    const FineValue *in = &fine->values[piece->point[inside]], *out = &fine->values[piece->point[outside]];
    float t = surface_cut(in->level, out->level, NEAREST);
    if (!(t > 0)) return point_vertex(fine, piece, inside);
    if (*piece->cut[edge]) return *piece->cut[edge];
    FinePlace place = piece->place[inside];
    for (int i = 0; i < 3; i++) place.weight[i] += t * (piece->place[outside].weight[i] - place.weight[i]);
    return *piece->cut[edge] = add_vertex(fine, place, in->mass + t * (out->mass - in->mass), SHELL_NONE);
}

static void draw(Fine *fine, const Piece *piece) {
    const float level[3] = {fine->values[piece->point[0]].level, fine->values[piece->point[1]].level,
                            fine->values[piece->point[2]].level};
    const int first = surface_fan(level, NEAREST);
    uint32_t polygon[4];
    int count = 0;
    for (int i = 0; i < 3; i++) {
        int a = (first + i) % 3, b = (a + 1) % 3;
        bool in = level[a] >= 0, next = level[b] >= 0;
        uint32_t vertex[2];
        int made = 0;
        if (in) vertex[made++] = point_vertex(fine, piece, a);
        if (in != next) vertex[made++] = cut_vertex(fine, piece, a);
        for (int m = 0; m < made; m++)
            if (!count || polygon[count - 1] != vertex[m]) polygon[count++] = vertex[m];
    }
    if (count > 1 && polygon[count - 1] == polygon[0]) count--;
    for (int k = 2; k < count; k++) {
        uint32_t *triangle = fine->surface->triangles[fine->surface->triangle_count++];
        triangle[0] = polygon[0] - 1, triangle[1] = polygon[k - 1] - 1, triangle[2] = polygon[k] - 1;
    }
}

static int inside_count(const Fine *fine, const uint32_t point[3]) {
    int inside = 0;
    for (int i = 0; i < 3; i++) inside += fine->values[point[i]].level >= 0;
    return inside;
}

static void count(Marching *march, int inside) {
    march->triangles += inside == 2 ? 2 : inside > 0;
    march->crossed += inside == 1 || inside == 2;
}

/// Entry of a cell's side in the cuts, for its i-th part of `parts`.
static uint32_t *side_cut(const Fine *fine, uint32_t cell, int side, int parts, int i) {
    const Shell *shell = fine->shell;
    uint32_t blue = shell->cell_springs[cell].blue[side];
    bool forwards = shell->springs[SINGE_BLUE].ends[blue][0] == shell->cells[cell][side];
    return &fine->cuts[fine->side_cut[blue] + (uint32_t)(forwards ? i : parts - 1 - i)];
}

static bool side_is_split(const Fine *fine, uint32_t cell, int side) {
    uint32_t blue = fine->shell->cell_springs[cell].blue[side];
    return fine->side_cut[blue + 1] - fine->side_cut[blue] > 1;
}

// ---- what has been torn

/// Products of a cell's triangle's sides from its virtual centre.
static void metric(const uint32_t at[4], int side, const float (*field)[4], float product[3]) {
    Vec centre = {0, 0, 0};
    for (int i = 0; i < 4; i++) centre = vec_mad(centre, vec_load(field[at[i]]), 0.25f);
    Vec a = vec_sub(vec_load(field[at[side]]), centre), b = vec_sub(vec_load(field[at[(side + 1) & 3]]), centre);
    product[0] = vec_dot(a, a), product[1] = vec_dot(a, b), product[2] = vec_dot(b, b);
}

static bool has_lost_a_spring(const Fine *fine, uint32_t cell) {
    const CellSprings *springs = &fine->shell->cell_springs[cell];
    uint8_t *const *flags = fine->state->ablate.spring_flags, left = SINGE_ALIVE;
    for (int i = 0; i < 4; i++) left &= flags[SINGE_BLUE][springs->blue[i]] & flags[SINGE_RED][springs->red[i]];
    return !left;
}

/// Whether a cell's triangle is left out.
static bool is_torn(const Fine *fine, uint32_t cell, int side) {
    if (!has_lost_a_spring(fine, cell)) return false;
    float rest[3], now[3];
    metric(fine->shell->cells[cell], side, (const float (*)[4])fine->shell->rest_position, rest);
    metric(fine->shell->cells[cell], side, (const float (*)[4])fine->state->dynamics.position, now);
    float det = rest[0] * rest[2] - rest[1] * rest[1];
    float half_trace = 0.5f * (rest[2] * now[0] - 2 * rest[1] * now[1] + rest[0] * now[2]) / det;
    float product = (now[0] * now[2] - now[1] * now[1]) / det;
    return half_trace + sqrtf(fmaxf(0, half_trace * half_trace - product)) > TORN * TORN;
}

// ---- a cell that is not split

static void march_coarse(Marching *march, uint32_t cell) {
    Fine *fine = march->fine;
    uint32_t line[4] = {0}; // cuts of the lines from the corners to the centre
    for (int side = 0; side < 4; side++) {
        int parts = side_is_split(fine, cell, side) ? fine_splits(fine, cell) : 1, next = (side + 1) & 3;
        uint32_t spoke[FINE_SPLITS_MAX] = {0}; // within a fan
        if (is_torn(fine, cell, side)) continue;
        for (int i = 0; i < parts; i++) {
            uint32_t point[3] = {fine_point(fine, cell, side, parts, i, 0),
                                 fine_point(fine, cell, side, parts, i + 1, 0), shell_centre(fine->shell, cell)};
            int inside = inside_count(fine, point);
            if (!march->drawing) count(march, inside);
            if (!march->drawing || inside == 0) continue;
            Piece piece = {.cut = {side_cut(fine, cell, side, parts, i), i == parts - 1 ? &line[next] : &spoke[i + 1],
                                   i == 0 ? &line[side] : &spoke[i]}};
            memcpy(piece.point, point, sizeof point);
            piece.place[0] = fine_point_place(cell, side, parts, i, 0);
            piece.place[1] = fine_point_place(cell, side, parts, i + 1, 0);
            piece.place[2] = (FinePlace){cell, (uint8_t)side, {0, 0, 1}};
            draw(fine, &piece);
        }
    }
}

// ---- a cell that is

/// Cuts of the fine sides of a triangle, each beginning at point (i, j): to (i + 1, j), to (i, j + 1), and from
/// (i + 1, j) to (i, j + 1).
typedef struct FineCuts {
    uint32_t along[FINE_SPLITS_MAX][FINE_SPLITS_MAX], inwards[FINE_SPLITS_MAX][FINE_SPLITS_MAX],
        across[FINE_SPLITS_MAX][FINE_SPLITS_MAX];
} FineCuts;

/// Draws the fine triangle with these points, given as pairs (i, j).
static void march_one(Marching *march, uint32_t cell, int side, int splits, const int at[3][2],
                      uint32_t *const cut[3]) {
    Fine *fine = march->fine;
    Piece piece;
    for (int k = 0; k < 3; k++) piece.point[k] = fine_point(fine, cell, side, splits, at[k][0], at[k][1]);
    int inside = inside_count(fine, piece.point);
    if (!march->drawing) count(march, inside);
    if (!march->drawing || inside == 0) return;
    for (int k = 0; k < 3; k++) {
        piece.place[k] = fine_point_place(cell, side, splits, at[k][0], at[k][1]);
        piece.cut[k] = cut[k];
    }
    draw(fine, &piece);
}

static void march_fine_side(Marching *march, uint32_t cell, int side, int splits, FineCuts *cuts) {
    for (int j = 0; j < splits; j++)
        for (int i = 0; i + j < splits; i++) {
            uint32_t *along = &cuts->along[j][i], *inwards = &cuts->inwards[j][i], *across = &cuts->across[j][i];
            march_one(march, cell, side, splits, (const int[3][2]){{i, j}, {i + 1, j}, {i, j + 1}},
                      (uint32_t *const[3]){along, across, inwards});
            if (i + j + 1 >= splits) continue;
            march_one(march, cell, side, splits, (const int[3][2]){{i + 1, j}, {i + 1, j + 1}, {i, j + 1}},
                      (uint32_t *const[3]){&cuts->inwards[j][i + 1], &cuts->along[j + 1][i], across});
        }
}

static void march_fine(Marching *march, uint32_t cell) {
    int splits = fine_splits(march->fine, cell);
    uint32_t line[4][FINE_SPLITS_MAX] = {{0}};
    FineCuts cuts;
    for (int side = 0; side < 4; side++) {
        int next = (side + 1) & 3;
        if (is_torn(march->fine, cell, side)) continue;
        memset(&cuts, 0, sizeof cuts);
        for (int i = 0; i < splits; i++) { // what the triangle shares with others goes in, and out again
            cuts.along[0][i] = *side_cut(march->fine, cell, side, splits, i);
            cuts.inwards[i][0] = line[side][i], cuts.across[i][splits - 1 - i] = line[next][i];
        }
        march_fine_side(march, cell, side, splits, &cuts);
        for (int i = 0; i < splits; i++) {
            *side_cut(march->fine, cell, side, splits, i) = cuts.along[0][i];
            line[side][i] = cuts.inwards[i][0], line[next][i] = cuts.across[i][splits - 1 - i];
        }
    }
}

// ---- all

static void march_cells(Marching *march) {
    const Fine *fine = march->fine;
    for (uint32_t c = 0; c < fine->shell->cell_count; c++) {
        if (fine->cell_triangle && march->drawing) fine->cell_triangle[c] = fine->surface->triangle_count;
        if (!(fine->state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;
        uint32_t before = fine->surface->triangle_count;
        if (!fine_is_split(fine, c)) march_coarse(march, c);
        else march_fine(march, c), fine->surface->fine_triangle_count += fine->surface->triangle_count - before;
    }
    if (fine->cell_triangle && march->drawing)
        fine->cell_triangle[fine->shell->cell_count] = fine->surface->triangle_count;
}

/// Lays out the cuts on the cells' sides: one where neither cell is split.
static void lay_cuts(Fine *fine) {
    const Shell *shell = fine->shell;
    uint32_t sides = shell->springs[SINGE_BLUE].count;
    for (uint32_t s = 0; s < sides; s++) fine->side_cut[s + 1] = 1;
    fine->side_cut[0] = 0;
    for (uint32_t n = 0; n < fine->near_count; n++)
        for (int i = 0; i < 4 && fine_is_split(fine, fine->near[n]); i++)
            fine->side_cut[shell->cell_springs[fine->near[n]].blue[i] + 1] = (uint32_t)fine_splits(fine, fine->near[n]);
    for (uint32_t s = 0; s < sides; s++) fine->side_cut[s + 1] += fine->side_cut[s];
    fine->cut_count = fine->side_cut[sides];
}

static uint64_t points_inside(const Fine *fine) {
    uint64_t inside = 0;
    for (uint32_t p = 0; p < fine->point_count; p++) inside += fine->values[p].level >= 0;
    return inside;
}

SingeResult fine_march(Fine *fine, SingeError *error) {
    Marching march = {.fine = fine};
    lay_cuts(fine);
    if (!NEW(fine->memory, fine->cuts, fine->cut_count) || !NEW(fine->memory, fine->drawn, fine->point_count))
        return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");
    march_cells(&march);
    TRY(surface_reserve_triangles(fine->surface, march.triangles, error));
    uint64_t most = points_inside(fine) + 2 * march.crossed; // a triangle has two cuts, and most share them
    if (most > INT32_MAX) return error_set(error, SINGE_ERROR_LIMIT, "surface", -1, "too many vertices");
    fine->vertex_capacity = (uint32_t)most;
    if (!NEW(fine->memory, fine->vertices, fine->vertex_capacity))
        return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");
    march.drawing = true;
    march_cells(&march);
    return SINGE_OK;
}
