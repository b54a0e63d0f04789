// Marching triangles over fine triangles and coarse ones.
//
// A cell's triangle consists of k^2 fine triangles in k rows; k = 1 for a flat cell that is not split. The row at the
// cell's side has as many parts as both of its cells draw there. Each fine triangle is clipped as in surface.c, once to
// count and once to draw. A fine side is cut once and the triangles at it share the cut; on the sides of cells they do
// so through `cuts`.
//
// The corners of a cell that has lost springs move independently and drag its virtual centre along. The surface has
// torn there: a triangle of such a cell is omitted when it is stretched too far. With C and C' the metrics of its two
// sides from the centre, at rest and now:
//
//   lambda^2 > TORN^2,   lambda^2 the larger eigenvalue of C^-1 C'
#include "ablate/ablate.h"
#include "common/real.h"
#include "common/assertion.h"
#include "surface/surface_fine.h"

/// `nearest` of surface_cut for fine sides: a few micrometres, which floats still resolve some metres from the origin
/// and nobody sees.
#define NEAREST 0.03125f

/// Max stretch of such a triangle.
#define TORN 1.6f

typedef struct Marching {
    Fine *fine;
    bool drawing;
    uint64_t triangles, crossed; ///< counted
} Marching;

/// A triangle to clip. cut[i] belongs to the edge from corner i to the next one.
typedef struct Piece {
    uint32_t point[3];
    FineLocation location[3];
    uint32_t *cut[3];
} Piece;

static uint32_t add_vertex(Fine *fine, FineLocation location, float mass, uint32_t source) {
    fine->vertices[fine->vertex_count] = (FineVertex){location, mass, source, NULL};
    return ++fine->vertex_count;
}

static uint32_t point_vertex(Fine *fine, const Piece *piece, int corner) {
    uint32_t point = piece->point[corner];
    if (!fine->drawn[point])
        fine->drawn[point] = add_vertex(fine, piece->location[corner], fine->values[point].mass,
                                        point < fine->shell->vertex_count ? point : SHELL_NONE);
    return fine->drawn[point];
}

void fine_fan(Fine *fine, const uint32_t *polygon, int count) {
    if (count > 1 && polygon[count - 1] == polygon[0]) count--;
    for (int k = 2; k < count; k++) {
        uint32_t *triangle = fine->surface->triangles[fine->surface->triangle_count++];
        triangle[0] = polygon[0] - 1;
        triangle[1] = polygon[k - 1] - 1;
        triangle[2] = polygon[k] - 1;
    }
}

static void march_draw(Fine *fine, const Piece *piece) {
    const float level[3] = {fine->values[piece->point[0]].level, fine->values[piece->point[1]].level,
                            fine->values[piece->point[2]].level};
    const int first = surface_fan(level, NEAREST);
    uint32_t polygon[4];
    int count = 0;

    // corners inside and cuts, without repetitions
    for (int i = 0; i < 3; i++) {
        int a = (first + i) % 3, b = (a + 1) % 3;
        bool in = level[a] >= 0, next = level[b] >= 0;
        uint32_t vertex[2];
        int made = 0;
        if (in) vertex[made++] = point_vertex(fine, piece, a);

        // the cut of the edge from a to b
        if (in != next) {
            const int inside = level[a] < 0 ? b : a, outside = level[a] < 0 ? a : b;
            const FineValue *from = &fine->values[piece->point[inside]], *to = &fine->values[piece->point[outside]];
            float t = surface_cut(from->level, to->level, NEAREST);
            if (t > 0 && !*piece->cut[a]) {
                FineLocation location = piece->location[inside];
                for (int k = 0; k < 3; k++)
                    location.weight[k] += t * (piece->location[outside].weight[k] - location.weight[k]);
                *piece->cut[a] = add_vertex(fine, location, from->mass + t * (to->mass - from->mass), SHELL_NONE);
            }

            vertex[made++] = t > 0 ? *piece->cut[a] : point_vertex(fine, piece, inside);
        }

        for (int m = 0; m < made; m++)
            if (!count || polygon[count - 1] != vertex[m]) polygon[count++] = vertex[m];
    }

    fine_fan(fine, polygon, count);
}

/// The entry in `cuts` of part i of a cell's side that is in `parts` parts.
static uint32_t *side_cut(const Fine *fine, uint32_t cell, int side, int parts, int i) {
    const Shell *shell = fine->shell;
    uint32_t blue = shell->cell_springs[cell].blue[side];
    bool forwards = shell->springs[SINGE_BLUE].ends[blue][0] == shell->cells[cell][side];
    return &fine->cuts[fine->side_cut[blue] + (uint32_t)(forwards ? i : parts - 1 - i)];
}

// ---- torn triangles

/// Dot products of the two sides of a cell's triangle that begin at its virtual centre.
static void metric(const uint32_t at[4], int side, const float (*field)[4], float product[3]) {
    Float3 centre = {0, 0, 0};
    for (int i = 0; i < 4; i++) centre = float3_mad(centre, float3_load(field[at[i]]), 0.25f);
    Float3 a = float3_sub(float3_load(field[at[side]]), centre),
           b = float3_sub(float3_load(field[at[(side + 1) & 3]]), centre);
    product[0] = float3_dot(a, a);
    product[1] = float3_dot(a, b);
    product[2] = float3_dot(b, b);
}

bool fine_is_torn(const Fine *fine, uint32_t cell, int side) {
    // only a cell that has burnt
    if (fine->sound[cell] || ablate_level(fine->shell, fine->state, shell_centre(fine->shell, cell)) >= 0) return false;

    float rest[3], now[3];
    metric(fine->shell->cells[cell], side, (const float(*)[4])fine->shell->rest_position, rest);
    metric(fine->shell->cells[cell], side, (const float(*)[4])fine->state->dynamics.position, now);

    float det = rest[0] * rest[2] - rest[1] * rest[1];
    float half_trace = 0.5f * (rest[2] * now[0] - 2 * rest[1] * now[1] + rest[0] * now[2]) / det;
    float product = (now[0] * now[2] - now[1] * now[1]) / det;
    return half_trace + sqrtf(float_max(0, half_trace * half_trace - product)) > TORN * TORN;
}

// ---- a triangle of a cell

/// A row of fine triangles between line j, in `lower` parts, and line j + 1, in `upper` parts. Holds the cuts of both
/// lines' parts, and of the first and the last side between the lines.
typedef struct Row {
    uint32_t cell;
    int side, splits, j, lower, upper;
    uint32_t *lower_cut[FINE_SPLITS_MAX], *upper_cut[FINE_SPLITS_MAX], *first, *last;
} Row;

/// Makes corner k of a piece point i of the row's lower or upper line.
static void row_point(const Fine *fine, const Row *row, bool upper, int i, Piece *piece, int k) {
    int j = row->j + upper, parts = row->j == 0 && !upper ? row->lower : row->splits;
    piece->point[k] = j == 0 ? fine_side_point(fine, row->cell, row->side, parts, i)
                             : fine_point(fine, row->cell, row->side, row->splits, i, j);
    piece->location[k] = fine_point_location(row->cell, row->side, parts, i, j);
}

/// Position of a line's point i along the row, 0 to 1.
static float along_row(const Row *row, bool upper, int i) {
    int parts = upper ? row->upper : row->lower;
    float inset = upper ? 0.5f / (float)(row->splits - row->j) : 0;
    return parts == 0 ? 0.5f : inset + (1 - 2 * inset) * (float)i / (float)parts;
}

/// The rows of one of a cell's four triangles. `first` and `last` are the cuts of its two sides to the centre.
static void march_triangle(Marching *march, uint32_t cell, int side, uint32_t *first, uint32_t *last) {
    Fine *fine = march->fine;
    int splits = fine->splits[cell];
    uint32_t line[2][FINE_SPLITS_MAX]; // cuts of the lines between rows

    for (int j = 0; j < splits; j++) {
        Row row = {cell,
                   side,
                   splits,
                   j,
                   j == 0 ? fine_parts(fine, cell, side) : splits - j,
                   splits - j - 1,
                   .first = &first[j],
                   .last = &last[j]};

        // cuts of the row's lower and upper line
        for (int i = 0; i < row.lower; i++)
            row.lower_cut[i] = j == 0 ? side_cut(fine, cell, side, row.lower, i) : &line[(j + 1) & 1][i];
        for (int i = 0; i < row.upper; i++) {
            row.upper_cut[i] = &line[j & 1][i];
            *row.upper_cut[i] = 0;
        }

        // its triangles
        uint32_t rung[2 * FINE_SPLITS_MAX + 1]; // cuts of the sides between the lines
        int low = 0, high = 0, steps = row.lower + row.upper;
        Piece piece;
        row_point(fine, &row, false, 0, &piece, 0);
        row_point(fine, &row, true, 0, &piece, 2);

        for (int step = 0; step < steps; step++) {
            // the next triangle has its base on the lower line if that leaves the ends of the lines closer to each other
            bool on_lower = low < row.lower;
            if (low < row.lower && high < row.upper)
                on_lower = along_row(&row, false, low + 1) - along_row(&row, true, high) <=
                           along_row(&row, true, high + 1) - along_row(&row, false, low);
            row_point(fine, &row, !on_lower, on_lower ? low + 1 : high + 1, &piece, 1);

            uint32_t *back = step == 0 ? row.first : &rung[step], *on = step + 1 == steps ? row.last : &rung[step + 1];
            rung[step + 1] = 0;
            piece.cut[0] = on_lower ? row.lower_cut[low] : on;
            piece.cut[1] = on_lower ? on : row.upper_cut[high];
            piece.cut[2] = back;

            int inside = 0;
            for (int i = 0; i < 3; i++) inside += fine->values[piece.point[i]].level >= 0;
            if (march->drawing && inside > 0) march_draw(fine, &piece);

            if (!march->drawing) {
                march->triangles += inside == 2 ? 2 : inside > 0;
                march->crossed += inside == 1 || inside == 2;
            }

            // its new corner is the next one's on the same line
            const int kept = on_lower ? 0 : 2;
            piece.point[kept] = piece.point[1];
            piece.location[kept] = piece.location[1];
            if (on_lower) low++;
            else high++;
        }
    }
}

// ---- all cells

/// A cell's four triangles where nothing cuts or splits them; false if something does. Most cells are whole.
static bool march_whole(Marching *march, uint32_t cell) {
    Fine *fine = march->fine;
    const uint32_t *at = fine->shell->cells[cell], centre = shell_centre(fine->shell, cell);
    if (fine->splits[cell] != 1 || !(fine->values[centre].level >= 0)) return false;
    for (int side = 0; side < 4; side++)
        if (fine_parts(fine, cell, side) != 1 || !(fine->values[at[side]].level >= 0)) return false;

    for (int side = 0; side < 4; side++) {
        if (fine_is_torn(fine, cell, side)) continue;
        march->triangles += !march->drawing;
        if (!march->drawing) continue;

        const Piece piece = {.point = {at[side], at[(side + 1) & 3], centre},
                             .location = {fine_point_location(cell, side, 1, 0, 0),
                                          fine_point_location(cell, side, 1, 1, 0),
                                          fine_point_location(cell, side, 1, 0, 1)}};
        march_draw(fine, &piece);
    }

    return true;
}

static void march_cells(Marching *march) {
    const Fine *fine = march->fine;
    for (uint32_t c = 0; c < fine->shell->cell_count; c++) {
        if (fine->cell_triangle && march->drawing) fine->cell_triangle[c] = fine->surface->triangle_count;
        if (!(fine->state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;

        bool hidden = false;
        for (uint32_t m = 0; m < fine->mesh_count; m++) hidden |= render_hides(fine->meshes[m], c);
        if (hidden) continue;

        uint32_t before = fine->surface->triangle_count;
        if (!march_whole(march, c)) {                // its triangles are cut or split
            uint32_t line[4][FINE_SPLITS_MAX] = {0}; // cuts of the lines from the corners to the centre
            for (int side = 0; side < 4; side++)
                if (!fine_is_torn(fine, c, side)) march_triangle(march, c, side, line[side], line[(side + 1) & 3]);
        }

        if (fine_is_split(fine, c)) fine->surface->fine_triangle_count += fine->surface->triangle_count - before;
    }

    if (fine->cell_triangle && march->drawing)
        fine->cell_triangle[fine->shell->cell_count] = fine->surface->triangle_count;
}

SingeResult fine_march(Fine *fine, SingeError *error) {
    Marching march = {.fine = fine};
    const uint32_t sides = fine->shell->springs[SINGE_BLUE].count;

    // lay out the cuts on the cells' sides
    fine->side_cut[0] = 0;
    for (uint32_t s = 0; s < sides; s++) fine->side_cut[s + 1] = fine->side_cut[s] + fine->parts[s];
    fine->cut_count = fine->side_cut[sides];
    if (!NEW(fine->memory, fine->cuts, fine->cut_count) || !NEW(fine->memory, fine->drawn, fine->point_count))
        return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");

    // count; a crossed triangle has two cuts, most of which are shared
    march_cells(&march);
    TRY(surface_reserve_triangles(fine->surface, march.triangles + fine->extra_triangles, error));
    uint64_t max = 2 * march.crossed + fine->extra_vertices;
    for (uint32_t p = 0; p < fine->point_count; p++) max += fine->values[p].level >= 0;
    if (max > INT32_MAX) return error_set(error, SINGE_ERROR_LIMIT, "surface", -1, "too many vertices");

    fine->vertex_capacity = (uint32_t)max;
    if (!NEW(fine->memory, fine->vertices, fine->vertex_capacity))
        return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");

    // draw
    march.drawing = true;
    march_cells(&march);
    SINGE_ASSERT(fine->vertex_count <= fine->vertex_capacity && fine->surface->triangle_count <= march.triangles);
    return SINGE_OK;
}
