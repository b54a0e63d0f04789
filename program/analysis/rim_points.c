// An edge is open if no second triangle has the same two rest positions, so neither tear edges nor seams of the uv are
// taken for a rim. A grid of cells finds the nearest point.
#include "analysis/rim_points.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/// m
static const double point_spacing = 0.25e-3, grid_cell = 5e-3;

/// Burn progress above which an open edge counts as burnt. Where sheets are removed it is .8 and more.
static const float burnt_min = 0.4f;

enum { GRID_SIDE_MAX = 128 };

static double rim_points_dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// ---- open edges

typedef struct Corner {
    float position[3]; ///< at rest
    uint32_t vertex;
} Corner;

/// An edge by the numbers of its rest positions, the lower first, and by its vertices.
typedef struct Edge {
    uint32_t low, high, from, to;
} Edge;

static int corner_by_position(const void *a, const void *b) {
    const float *x = ((const Corner *)a)->position, *y = ((const Corner *)b)->position;
    for (int k = 0; k < 3; k++)
        if (x[k] < y[k] || x[k] > y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

static int by_ends(const void *a, const void *b) {
    const Edge *x = a, *y = b;
    if (x->low != y->low) return x->low < y->low ? -1 : 1;
    return (x->high > y->high) - (x->high < y->high);
}

/// Gives vertices at the same rest position the same number. False when out of memory.
static bool number_positions(const SingeSurface *surface, uint32_t *number) {
    Corner *corners = malloc(((size_t)surface->vertex_count + 1) * sizeof *corners);
    if (!corners) return false;
    for (uint32_t v = 0; v < surface->vertex_count; v++) {
        memcpy(corners[v].position, surface->rest_position[v], sizeof corners[v].position);
        corners[v].vertex = v;
    }
    qsort(corners, surface->vertex_count, sizeof *corners, corner_by_position);

    for (uint32_t i = 0; i < surface->vertex_count; i++) {
        bool same = i && corner_by_position(&corners[i], &corners[i - 1]) == 0;
        number[corners[i].vertex] = same ? number[corners[i - 1].vertex] : corners[i].vertex;
    }
    free(corners);
    return true;
}

/// The edges of the piece that are open and burnt. *edges is to be freed; NULL when out of memory.
static Edge *find_edges(const SingeSurface *surface, int32_t piece, size_t *count) {
    Edge *edges = malloc((3 * (size_t)surface->triangle_count + 1) * sizeof *edges);
    uint32_t *number = malloc(((size_t)surface->vertex_count + 1) * sizeof *number);
    if (!edges || !number || !number_positions(surface, number)) {
        free(edges);
        free(number);
        return NULL;
    }

    size_t all = 0;
    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        if (surface->piece[surface->triangles[f][0]] != piece) continue;
        for (int i = 0; i < 3; i++) {
            uint32_t from = surface->triangles[f][i], to = surface->triangles[f][(i + 1) % 3];
            uint32_t a = number[from], b = number[to];
            edges[all++] = (Edge){a < b ? a : b, a < b ? b : a, from, to};
        }
    }
    free(number);
    qsort(edges, all, sizeof *edges, by_ends);

    *count = 0;
    for (size_t i = 0; i < all;) {
        size_t end = i + 1;
        while (end < all && by_ends(&edges[i], &edges[end]) == 0) end++;
        const float *burn = surface->burn;
        if (end == i + 1 && burn[edges[i].from] > burnt_min && burn[edges[i].to] > burnt_min)
            edges[(*count)++] = edges[i];
        i = end;
    }
    return edges;
}

// ---- points along the rim, in a grid

void rim_points_free(RimPoints *points) {
    free(points->position);
    free(points->near);
    free(points->normal);
    free(points->first);
    free(points->order);
    *points = (RimPoints){0};
}

static int steps_along(const SingeSurface *surface, const Edge *edge) {
    double square = 0;
    for (int k = 0; k < 3; k++)
        square += pow((double)surface->rest_position[edge->to][k] - (double)surface->rest_position[edge->from][k], 2);
    double steps = ceil(sqrt(square) / point_spacing);
    return steps < 1 ? 1 : steps > 1000 ? 1000 : (int)steps;
}

static void fill_points(const SingeSurface *surface, const Edge *edges, size_t count, RimPoints *points) {
    for (size_t e = 0; e < count; e++) {
        const int steps = steps_along(surface, &edges[e]);
        for (int i = 0; i < steps; i++, points->count++)
            for (int k = 0; k < 3; k++) {
                double from = (double)surface->rest_position[edges[e].from][k];
                double to = (double)surface->rest_position[edges[e].to][k];
                points->position[points->count][k] = from + (i + 0.5) / steps * (to - from);
            }
    }
}

/// The cell of a position along an axis; may lie outside.
static int cell_along(const RimPoints *points, double position, int axis) {
    return (int)floor((position - points->low[axis]) / points->cell);
}

static size_t cell_at(const RimPoints *points, const int *at) {
    return ((size_t)at[2] * (size_t)points->size[1] + (size_t)at[1]) * (size_t)points->size[0] + (size_t)at[0];
}

static size_t cell_of(const RimPoints *points, const double *position) {
    int at[3];
    for (int k = 0; k < 3; k++) at[k] = cell_along(points, position[k], k);
    return cell_at(points, at);
}

static bool sort_points(RimPoints *points) {
    double high[3], side = 0;
    for (int k = 0; k < 3; k++) {
        points->low[k] = high[k] = points->position[0][k];
        for (size_t p = 1; p < points->count; p++) {
            points->low[k] = fmin(points->low[k], points->position[p][k]);
            high[k] = fmax(high[k], points->position[p][k]);
        }
        side = fmax(side, high[k] - points->low[k]);
    }
    points->cell = fmax(grid_cell, side / (GRID_SIDE_MAX - 1));
    size_t cells = 1;
    for (int k = 0; k < 3; k++) {
        points->size[k] = (int)((high[k] - points->low[k]) / points->cell) + 1;
        cells *= (size_t)points->size[k];
    }

    points->first = calloc(cells + 2, sizeof *points->first);
    points->order = malloc(points->count * sizeof *points->order);
    if (!points->first || !points->order) return false;
    for (size_t p = 0; p < points->count; p++) points->first[cell_of(points, points->position[p]) + 2]++;
    for (size_t c = 2; c < cells + 2; c++) points->first[c] += points->first[c - 1];
    for (size_t p = 0; p < points->count; p++)
        points->order[points->first[cell_of(points, points->position[p]) + 1]++] = (uint32_t)p;
    return true;
}

bool rim_points_make(const SingeSurface *surface, int32_t piece, RimPoints *points) {
    size_t edge_count = 0, count = 0;
    Edge *edges = find_edges(surface, piece, &edge_count);
    for (size_t e = 0; edges && e < edge_count; e++) count += (size_t)steps_along(surface, &edges[e]);
    bool good = edges != NULL;
    if (good && count) {
        points->position = malloc(count * sizeof *points->position);
        points->near = calloc(count, sizeof *points->near);
        points->normal = calloc(count, sizeof *points->normal);
        good = points->position && points->near && points->normal;
        if (good) fill_points(surface, edges, edge_count, points);
        good = good && sort_points(points);
    }
    free(edges);
    return good;
}

/// m, a lower bound on the distance of cell `at` from a position along an axis; `slack` is for points rounded to cells.
static double gap_along(const RimPoints *points, const double *position, int at, int axis) {
    const double low = points->low[axis] + at * points->cell, slack = 1e-6 * points->cell;
    const double below = low - position[axis] - slack, above = position[axis] - low - points->cell - slack;
    return below > 0 ? below : above > 0 ? above : 0;
}

/// Searches the points of a cell for one nearer than *square.
static void look_at_cell(const RimPoints *points, const double *position, size_t cell, double *square,
                         uint32_t *nearest) {
    for (uint32_t i = points->first[cell]; i < points->first[cell + 1]; i++) {
        const double *point = points->position[points->order[i]];
        double d[3] = {point[0] - position[0], point[1] - position[1], point[2] - position[2]},
               found = rim_points_dot(d, d);
        if (found < *square) {
            *square = found;
            *nearest = points->order[i];
        }
    }
}

/// Searches the cells that are `ring` cells from that of a position, except those farther than *square.
static void look_at_ring(const RimPoints *points, const double *position, const int *centre, int ring, double *square,
                         uint32_t *nearest) {
    int low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = centre[k] - ring < 0 ? 0 : centre[k] - ring;
        high[k] = centre[k] + ring >= points->size[k] ? points->size[k] - 1 : centre[k] + ring;
    }
    int at[3];
    for (at[2] = low[2]; at[2] <= high[2]; at[2]++) {
        const double z = gap_along(points, position, at[2], 2);
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++) {
            const double y = gap_along(points, position, at[1], 1), row = y * y + z * z;
            if (row >= *square) continue;
            // rows inside the ring have only its two ends
            const bool whole = abs(at[2] - centre[2]) == ring || abs(at[1] - centre[1]) == ring;
            const int step = whole ? 1 : 2 * ring, begin = whole ? low[0] : centre[0] - ring;
            for (at[0] = begin; at[0] <= high[0]; at[0] += step) {
                const double x = gap_along(points, position, at[0], 0);
                if (at[0] >= 0 && x * x + row < *square)
                    look_at_cell(points, position, cell_at(points, at), square, nearest);
            }
        }
    }
}

double rim_points_distance(const RimPoints *points, const double position[3], double reach, uint32_t *nearest) {
    const int rings = (int)ceil(reach / points->cell);
    double square = reach * reach;
    int centre[3];
    for (int k = 0; k < 3; k++) {
        centre[k] = cell_along(points, position[k], k);
        if (centre[k] < -rings || centre[k] >= points->size[k] + rings) return INFINITY;
    }

    // no farther than the hinted point; a little more, so that this point itself is found
    if (*nearest < points->count) {
        const double *point = points->position[*nearest];
        double d[3] = {point[0] - position[0], point[1] - position[1], point[2] - position[2]};
        square = fmin(square, (1 + 1e-9) * rim_points_dot(d, d) + 1e-30);
    }
    bool found = false;
    for (int ring = 0; ring <= rings; ring++) {
        if (ring > 0 && square <= pow((ring - 1) * points->cell, 2)) break; // the remaining cells are farther
        double before = square;
        look_at_ring(points, position, centre, ring, &square, nearest);
        found = found || square < before;
    }
    return found ? sqrt(square) : (double)INFINITY;
}

/// Adds the normals near the points of a cell to a point's normal.
static void add_near(RimPoints *points, size_t p, size_t cell, double reach) {
    for (uint32_t i = points->first[cell]; i < points->first[cell + 1]; i++) {
        const double *at = points->position[p], *other = points->position[points->order[i]];
        double d[3] = {other[0] - at[0], other[1] - at[1], other[2] - at[2]};
        if (rim_points_dot(d, d) > reach * reach) continue;
        for (int k = 0; k < 3; k++) points->normal[p][k] += points->near[points->order[i]][k];
    }
}

void rim_points_normals(RimPoints *points, double reach) {
    for (size_t p = 0; p < points->count; p++) {
        int low[3], high[3], at[3];
        for (int k = 0; k < 3; k++) {
            low[k] = cell_along(points, points->position[p][k] - reach, k);
            high[k] = cell_along(points, points->position[p][k] + reach, k);
            if (low[k] < 0) low[k] = 0;
            if (high[k] >= points->size[k]) high[k] = points->size[k] - 1;
        }
        for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
            for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
                for (at[0] = low[0]; at[0] <= high[0]; at[0]++) add_near(points, p, cell_at(points, at), reach);
        double length = sqrt(rim_points_dot(points->normal[p], points->normal[p]));
        for (int k = 0; k < 3 && length > 0; k++) points->normal[p][k] /= length;
    }
}
