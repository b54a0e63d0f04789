// Triangles are sampled about every 0.75 mm. A sample belongs to a band by its straight distance at rest from the
// nearest point of the rim. The ratio of its area to that at rest is its triangle's.
//
// Curl is the angle between a sample's normal 10 mm inland and the mean normal of the samples within 1.5 mm of the rim
// and within 2 mm of the nearest point on it: a ragged rim has no other useful normal.
//
// The rim is the piece's open edges that have burnt, as points. An edge is open if no second triangle has the same two
// rest positions, so neither tear edges nor seams of the uv are taken for a rim. A grid of cells finds the nearest point.
#include "analysis/rim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/float3.h"
#include "common/order.h"

const double rim_band_limits[RIM_BANDS + 1] = {0, 1e-3, 2e-3, 4e-3, 7e-3, 11e-3, 20e-3, 40e-3};

/// m
static const double sample_spacing = 0.75e-3, normal_depth = 1.5e-3, normal_reach = 2e-3;
static const double curl_distance = 10e-3, curl_width = 0.5e-3;

static const double point_spacing = 0.25e-3, grid_cell = 5e-3;

/// Burn progress above which an open edge counts as burnt. Where sheets are removed it is .8 and more.
static const float burnt_min = 0.4f;

enum { SAMPLES_A_SIDE_MAX = 64, GRID_SIDE_MAX = 128 };

/// Points in a grid. An empty one has count 0.
typedef struct RimPoints {
    size_t count;
    double (*position)[3]; ///< m, at rest
    double (*near)[3];     ///< sums of the normals near the rim, each in the sum of its nearest point
    double (*normal)[3];   ///< unit, of the rim; 0 if it is not known
    double low[3], cell;   ///< m, of the grid
    int size[3];
    uint32_t *first; ///< [cells + 1] of `order`
    uint32_t *order; ///< points by their cell
} RimPoints;

// ---- triangles

static double area_of(float (*position)[3], const uint32_t *t) {
    double normal[3];
    area3(position[t[0]], position[t[1]], position[t[2]], normal);
    return 0.5 * sqrt(dot3(normal, normal));
}

static double degrees_between(const double *a, const double *b) {
    double c = dot3(a, b);
    return acos(c < -1 ? -1 : c > 1 ? 1 : c) * 180 / acos(-1);
}

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

/// The edges of the piece that are open and burnt. *edges is to be freed; NULL when out of memory.
static Edge *find_edges(const SingeSurface *surface, int32_t piece, size_t *count) {
    Edge *edges = malloc((3 * (size_t)surface->triangle_count + 1) * sizeof *edges);
    Corner *corners = malloc(((size_t)surface->vertex_count + 1) * sizeof *corners);
    uint32_t *number = malloc(((size_t)surface->vertex_count + 1) * sizeof *number);

    if (!edges || !corners || !number) {
        free(edges);
        free(corners);
        free(number);
        return NULL;
    }

    // vertices at the same rest position get the same number
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
    qsort(edges, all, sizeof *edges, order_by_two);

    *count = 0;
    for (size_t i = 0, end; i < all; i = end) {
        const float *burn = surface->burn;
        for (end = i + 1; end < all && order_by_two(&edges[i], &edges[end]) == 0;) end++;
        if (end == i + 1 && burn[edges[i].from] > burnt_min && burn[edges[i].to] > burnt_min)
            edges[(*count)++] = edges[i];
    }

    return edges;
}

// ---- points along the rim, in a grid

static int steps_along(const SingeSurface *surface, const Edge *edge) {
    const double length = distance_of(surface->rest_position[edge->to], surface->rest_position[edge->from]);
    const double steps = ceil(length / point_spacing);
    return steps < 1 ? 1 : steps > 1000 ? 1000 : (int)steps;
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

/// Sorts the points into the cells of a grid. False when out of memory.
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

/// Makes points every quarter of a millimetre along the piece's open edges that have burnt, if there are any. False
/// when out of memory. Free them, after failure too.
static bool points_make(const SingeSurface *surface, int32_t piece, RimPoints *points) {
    size_t edge_count = 0, count = 0;
    Edge *edges = find_edges(surface, piece, &edge_count);
    if (!edges) return false;

    for (size_t e = 0; e < edge_count; e++) count += (size_t)steps_along(surface, &edges[e]);
    if (count) {
        points->position = malloc(count * sizeof *points->position);
        points->near = calloc(count, sizeof *points->near);
        points->normal = calloc(count, sizeof *points->normal);
    }

    const bool room = points->position && points->near && points->normal;
    for (size_t e = 0; e < edge_count && room; e++) {
        const int steps = steps_along(surface, &edges[e]);
        for (int i = 0; i < steps; i++, points->count++)
            for (int k = 0; k < 3; k++) {
                double from = (double)surface->rest_position[edges[e].from][k];
                double to = (double)surface->rest_position[edges[e].to][k];
                points->position[points->count][k] = from + (i + 0.5) / steps * (to - from);
            }
    }

    free(edges);
    return !count || (room && sort_points(points));
}

/// m, a lower bound on the distance of cell `at` from a position along an axis; `slack` is for points rounded to cells.
static double gap_along(const RimPoints *points, const double *position, int at, int axis) {
    const double low = points->low[axis] + at * points->cell, slack = 1e-6 * points->cell;
    const double below = low - position[axis] - slack, above = position[axis] - low - points->cell - slack;
    return below > 0 ? below : above > 0 ? above : 0;
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
                if (at[0] < 0 || !(x * x + row < *square)) continue;
                const uint32_t *first = &points->first[cell_at(points, at)];
                for (uint32_t i = first[0]; i < first[1]; i++) {
                    double d[3];
                    sub3(points->position[points->order[i]], position, d);
                    const double found = dot3(d, d);
                    if (!(found < *square)) continue;
                    *square = found;
                    *nearest = points->order[i];
                }
            }
        }
    }
}

/// m from a rest position to the nearest point, or INFINITY if it is not below `reach`. *nearest gets that point.
/// Before the call it is a hint: any number, best that of a nearby point.
static double points_distance(const RimPoints *points, const double position[3], double reach, uint32_t *nearest) {
    const int rings = (int)ceil(reach / points->cell);
    double square = reach * reach;
    int centre[3];

    for (int k = 0; k < 3; k++) {
        centre[k] = cell_along(points, position[k], k);
        if (centre[k] < -rings || centre[k] >= points->size[k] + rings) return INFINITY;
    }

    // no farther than the hinted point; a little more, so that this point itself is found
    if (*nearest < points->count) {
        double d[3];
        sub3(points->position[*nearest], position, d);
        square = fmin(square, (1 + 1e-9) * dot3(d, d) + 1e-30);
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

// ---- the largest piece

typedef struct Piece {
    const SingeSurface *surface;
    int32_t id;
    double origin[3], normal[3]; ///< of its plane at rest
} Piece;

static bool is_of(const Piece *piece, uint32_t f) {
    return piece->surface->piece[piece->surface->triangles[f][0]] == piece->id;
}

typedef struct PieceArea {
    int32_t id;
    double area;
} PieceArea;

/// False when out of memory. A surface of no triangles has no piece, and no rim.
static bool find_largest(const SingeSurface *surface, int32_t *id) {
    PieceArea *areas = malloc(((size_t)surface->triangle_count + 1) * sizeof *areas);
    if (!areas) return false;

    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        const uint32_t *t = surface->triangles[f];
        areas[f] = (PieceArea){surface->piece[t[0]], area_of(surface->rest_position, t)};
    }

    qsort(areas, surface->triangle_count, sizeof *areas, order_by_int);

    double largest = -1, area = 0;
    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        area = f && areas[f].id == areas[f - 1].id ? area + areas[f].area : areas[f].area;
        if (area > largest) {
            largest = area;
            *id = areas[f].id;
        }
    }

    free(areas);
    return true;
}

/// Finds the plane through the piece at rest; false if it has no area.
static bool find_plane(Piece *piece) {
    const SingeSurface *surface = piece->surface;
    double total = 0;
    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        if (!is_of(piece, f)) continue;
        const uint32_t *t = surface->triangles[f];
        double normal[3], area = area_of(surface->rest_position, t);
        area3(surface->rest_position[t[0]], surface->rest_position[t[1]], surface->rest_position[t[2]], normal);
        for (int k = 0; k < 3; k++) {
            piece->normal[k] += normal[k];
            for (int i = 0; i < 3; i++) piece->origin[k] += area * (double)surface->rest_position[t[i]][k] / 3;
        }
        total += area;
    }

    for (int k = 0; k < 3 && total > 0; k++) piece->origin[k] /= total;
    return total > 0 && unit3(piece->normal);
}

// ---- samples

typedef struct Sample {
    double rest[3], position[3], normal[3]; ///< m, m, unit
    double rest_area, area, mass;           ///< m2, m2, fraction
} Sample;

/// A sample 10 mm inland, to be compared with the rim once its normals are known.
typedef struct Inland {
    uint32_t nearest;
    double normal[3], area;
} Inland;

typedef struct Work {
    Piece piece;
    RimPoints points;
    Inland *inland;
    size_t inland_count, inland_room;
    Rim *rim;
    uint32_t nearest; ///< rim point to the last sample: that to the next is not far
} Work;

static int angle_bin(double degrees) {
    int bin = (int)(degrees / 180 * RIM_ANGLES);
    return bin < RIM_ANGLES ? bin : RIM_ANGLES - 1;
}

/// Adds a sample to its band. False when out of memory.
static bool take_sample(Work *work, const Sample *sample) {
    const double distance = points_distance(&work->points, sample->rest, rim_band_limits[RIM_BANDS], &work->nearest);
    if (!(distance < rim_band_limits[RIM_BANDS])) return true;
    int b = 0;
    while (distance >= rim_band_limits[b + 1]) b++;

    const Piece *piece = &work->piece;
    RimBand *band = &work->rim->band[b];
    band->rest_area += sample->rest_area;
    band->area += sample->area;
    band->mass += sample->mass * sample->rest_area;
    for (int k = 0; k < 3; k++)
        band->height += (sample->position[k] - piece->origin[k]) * piece->normal[k] * sample->rest_area;
    band->slope[angle_bin(degrees_between(sample->normal, piece->normal))] += sample->rest_area;

    if (distance <= normal_depth)
        for (int k = 0; k < 3; k++) work->points.near[work->nearest][k] += sample->normal[k] * sample->rest_area;
    if (fabs(distance - curl_distance) > curl_width) return true;

    if (work->inland_count == work->inland_room) {
        size_t room = work->inland_room ? 2 * work->inland_room : 1024;
        Inland *larger = realloc(work->inland, room * sizeof *larger);
        if (!larger) return false;
        work->inland = larger;
        work->inland_room = room;
    }

    Inland *inland = &work->inland[work->inland_count++];
    inland->nearest = work->nearest;
    inland->area = sample->rest_area;
    memcpy(inland->normal, sample->normal, sizeof inland->normal);
    return true;
}

/// Cuts a triangle into n by n similar ones, and samples the centroid of each. False when out of memory.
static bool take_triangle(Work *work, const uint32_t *t) {
    const SingeSurface *surface = work->piece.surface;
    double longest = 0;
    for (int i = 0; i < 3; i++)
        longest = fmax(longest, distance_of(surface->rest_position[t[i]], surface->rest_position[t[(i + 1) % 3]]));

    const int n = (int)fmax(1, fmin(SAMPLES_A_SIDE_MAX, ceil(longest / sample_spacing)));
    const double rest_area = area_of(surface->rest_position, t) / n / n, area = area_of(surface->position, t) / n / n;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < 2 * (n - i) - 1; j++) {
            // every second triangle of a row is upside down
            double third = j % 2 ? 2.0 / 3 : 1.0 / 3;
            double weight[3] = {0, (i + third) / n, (j / 2 + third) / n};
            weight[0] = 1 - weight[1] - weight[2];

            Sample sample = {.rest_area = rest_area, .area = area};
            for (int c = 0; c < 3; c++) {
                sample.mass += weight[c] * (double)surface->mass[t[c]];
                for (int k = 0; k < 3; k++) {
                    sample.rest[k] += weight[c] * (double)surface->rest_position[t[c]][k];
                    sample.position[k] += weight[c] * (double)surface->position[t[c]][k];
                    sample.normal[k] += weight[c] * (double)surface->normal[t[c]][k];
                }
            }

            if (unit3(sample.normal) && !take_sample(work, &sample)) return false;
        }
    return true;
}

bool rim_add(const SingeSurface *surface, Rim *rim) {
    Work work = {.piece = {.surface = surface, .id = -1}, .rim = rim};
    if (!find_largest(surface, &work.piece.id)) return false;
    if (!find_plane(&work.piece)) return true;
    bool good = points_make(surface, work.piece.id, &work.points);
    for (uint32_t f = 0; good && work.points.count && f < surface->triangle_count; f++)
        if (is_of(&work.piece, f)) good = take_triangle(&work, surface->triangles[f]);

    // the rim's normal at each point, from `near` of all points within `normal_reach`
    RimPoints *points = &work.points;
    for (size_t p = 0; good && p < points->count; p++) {
        double *normal = points->normal[p];
        int low[3], high[3], at[3];
        for (int k = 0; k < 3; k++) {
            low[k] = cell_along(points, points->position[p][k] - normal_reach, k);
            high[k] = cell_along(points, points->position[p][k] + normal_reach, k);
            if (low[k] < 0) low[k] = 0;
            if (high[k] >= points->size[k]) high[k] = points->size[k] - 1;
        }

        for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
            for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
                for (at[0] = low[0]; at[0] <= high[0]; at[0]++) {
                    const uint32_t *first = &points->first[cell_at(points, at)];
                    for (uint32_t i = first[0]; i < first[1]; i++) {
                        double d[3];
                        sub3(points->position[points->order[i]], points->position[p], d);
                        if (dot3(d, d) > normal_reach * normal_reach) continue;
                        for (int k = 0; k < 3; k++) normal[k] += points->near[points->order[i]][k];
                    }
                }
        unit3(normal);
    }

    // curl
    for (size_t i = 0; good && i < work.inland_count; i++) {
        const Inland *inland = &work.inland[i];
        const double *normal = work.points.normal[inland->nearest];
        if (!(dot3(normal, normal) > 0)) continue;
        double angle = degrees_between(inland->normal, normal);
        rim->curl[angle_bin(angle)] += inland->area;
        rim->curl_max = fmax(rim->curl_max, angle);
    }

    free(work.inland);
    free(work.points.position);
    free(work.points.near);
    free(work.points.normal);
    free(work.points.first);
    free(work.points.order);
    return good;
}

void rim_sum(const Rim *rim, Rim *sum) {
    for (int b = 0; b < RIM_BANDS; b++) {
        const RimBand *band = &rim->band[b];
        RimBand *to = &sum->band[b];
        to->rest_area += band->rest_area;
        to->area += band->area;
        to->mass += band->mass;
        to->height += band->height;
        for (int a = 0; a < RIM_ANGLES; a++) to->slope[a] += band->slope[a];
    }

    for (int a = 0; a < RIM_ANGLES; a++) sum->curl[a] += rim->curl[a];
    sum->curl_max = fmax(sum->curl_max, rim->curl_max);
}

double rim_percentile(const double histogram[RIM_ANGLES], double share) {
    double total = 0, below = 0;
    for (int a = 0; a < RIM_ANGLES; a++) total += histogram[a];
    if (!(total > 0)) return (double)NAN;
    for (int a = 0; a < RIM_ANGLES; a++) {
        below += histogram[a];
        if (below >= share * total) return (a + 1 - (below - share * total) / histogram[a]) * 180 / RIM_ANGLES;
    }
    return 180;
}
