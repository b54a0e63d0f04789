// Triangles are sampled about every 0.75 mm. A sample belongs to a band by its straight distance at rest from the
// nearest point of the rim. The ratio of its area to that at rest is its triangle's.
//
// Curl is the angle between a sample's normal 10 mm inland and the mean normal of the samples within 1.5 mm of the rim
// and within 2 mm of the nearest point on it: a ragged rim has no other useful normal.
#include "analysis/rim.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/rim_points.h"

const double rim_band_limits[RIM_BANDS + 1] = {0, 1e-3, 2e-3, 4e-3, 7e-3, 11e-3, 20e-3, 40e-3};

/// m
static const double sample_spacing = 0.75e-3, normal_depth = 1.5e-3, normal_reach = 2e-3;
static const double curl_distance = 10e-3, curl_width = 0.5e-3;

enum { SAMPLES_A_SIDE_MAX = 64 };

// ---- vectors

static double rim_dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void rim_cross(const double *a, const double *b, double *c) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static bool rim_unit(double *a) {
    double length = sqrt(rim_dot(a, a));
    if (!(length > 0)) return false;
    for (int k = 0; k < 3; k++) a[k] /= length;
    return true;
}

/// Twice the vector area of a triangle.
static void twice_area(float (*position)[3], const uint32_t *t, double *normal) {
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)position[t[1]][k] - (double)position[t[0]][k];
        b[k] = (double)position[t[2]][k] - (double)position[t[0]][k];
    }
    rim_cross(a, b, normal);
}

static double area_of(float (*position)[3], const uint32_t *t) {
    double normal[3];
    twice_area(position, t, normal);
    return 0.5 * sqrt(rim_dot(normal, normal));
}

static double degrees_between(const double *a, const double *b) {
    double c = rim_dot(a, b);
    return acos(c < -1 ? -1 : c > 1 ? 1 : c) * 180 / acos(-1);
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

static int by_id(const void *a, const void *b) {
    int32_t x = ((const PieceArea *)a)->id, y = ((const PieceArea *)b)->id;
    return (x > y) - (x < y);
}

/// False when out of memory. A surface of no triangles has no piece, and no rim.
static bool find_largest(const SingeSurface *surface, int32_t *id) {
    PieceArea *areas = malloc(((size_t)surface->triangle_count + 1) * sizeof *areas);
    if (!areas) return false;
    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        const uint32_t *t = surface->triangles[f];
        areas[f] = (PieceArea){surface->piece[t[0]], area_of(surface->rest_position, t)};
    }
    qsort(areas, surface->triangle_count, sizeof *areas, by_id);

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
        twice_area(surface->rest_position, t, normal);
        for (int k = 0; k < 3; k++) {
            piece->normal[k] += normal[k];
            for (int i = 0; i < 3; i++) piece->origin[k] += area * (double)surface->rest_position[t[i]][k] / 3;
        }
        total += area;
    }
    for (int k = 0; k < 3 && total > 0; k++) piece->origin[k] /= total;
    return total > 0 && rim_unit(piece->normal);
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

static bool inland_add(Work *work, const Sample *sample, uint32_t nearest) {
    if (work->inland_count == work->inland_room) {
        size_t room = work->inland_room ? 2 * work->inland_room : 1024;
        Inland *larger = realloc(work->inland, room * sizeof *larger);
        if (!larger) return false;
        work->inland = larger;
        work->inland_room = room;
    }
    Inland *inland = &work->inland[work->inland_count++];
    inland->nearest = nearest;
    inland->area = sample->rest_area;
    memcpy(inland->normal, sample->normal, sizeof inland->normal);
    return true;
}

static int angle_bin(double degrees) {
    int bin = (int)(degrees / 180 * RIM_ANGLES);
    return bin < RIM_ANGLES ? bin : RIM_ANGLES - 1;
}

/// False when out of memory.
static bool take_sample(Work *work, const Sample *sample) {
    const double distance =
        rim_points_distance(&work->points, sample->rest, rim_band_limits[RIM_BANDS], &work->nearest);
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
    if (fabs(distance - curl_distance) <= curl_width) return inland_add(work, sample, work->nearest);
    return true;
}

/// The number of samples along a triangle's sides.
static int samples_along(const SingeSurface *surface, const uint32_t *t) {
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++)
            square +=
                pow((double)surface->rest_position[t[i]][k] - (double)surface->rest_position[t[(i + 1) % 3]][k], 2);
        longest = fmax(longest, sqrt(square));
    }
    double count = ceil(longest / sample_spacing);
    return count < 1 ? 1 : count > SAMPLES_A_SIDE_MAX ? SAMPLES_A_SIDE_MAX : (int)count;
}

/// Fills in a sample at these weights of the triangle's corners; false if it has no normal.
static bool sample_at(const SingeSurface *surface, const uint32_t *t, const double *weight, Sample *sample) {
    sample->mass = 0;
    memset(sample->rest, 0, sizeof sample->rest);
    memset(sample->position, 0, sizeof sample->position);
    memset(sample->normal, 0, sizeof sample->normal);
    for (int i = 0; i < 3; i++) {
        sample->mass += weight[i] * (double)surface->mass[t[i]];
        for (int k = 0; k < 3; k++) {
            sample->rest[k] += weight[i] * (double)surface->rest_position[t[i]][k];
            sample->position[k] += weight[i] * (double)surface->position[t[i]][k];
            sample->normal[k] += weight[i] * (double)surface->normal[t[i]][k];
        }
    }
    return rim_unit(sample->normal);
}

/// Cuts a triangle into n by n similar ones, and samples the centroid of each.
static bool take_triangle(Work *work, const uint32_t *t) {
    const SingeSurface *surface = work->piece.surface;
    const int n = samples_along(surface, t);
    Sample sample = {.rest_area = area_of(surface->rest_position, t) / n / n,
                     .area = area_of(surface->position, t) / n / n};
    for (int i = 0; i < n; i++)
        for (int j = 0; j < 2 * (n - i) - 1; j++) {
            // every second triangle of a row is upside down
            double third = j % 2 ? 2.0 / 3 : 1.0 / 3;
            double weight[3] = {0, (i + third) / n, (j / 2 + third) / n};
            weight[0] = 1 - weight[1] - weight[2];
            if (sample_at(surface, t, weight, &sample) && !take_sample(work, &sample)) return false;
        }
    return true;
}

static void add_curl(Work *work) {
    rim_points_normals(&work->points, normal_reach);
    for (size_t i = 0; i < work->inland_count; i++) {
        const Inland *inland = &work->inland[i];
        const double *normal = work->points.normal[inland->nearest];
        if (!(rim_dot(normal, normal) > 0)) continue;
        double angle = degrees_between(inland->normal, normal);
        work->rim->curl[angle_bin(angle)] += inland->area;
        work->rim->curl_max = fmax(work->rim->curl_max, angle);
    }
}

bool rim_add(const SingeSurface *surface, Rim *rim) {
    Work work = {.piece = {.surface = surface, .id = -1}, .rim = rim};
    if (!find_largest(surface, &work.piece.id)) return false;
    if (!find_plane(&work.piece)) return true;
    bool good = rim_points_make(surface, work.piece.id, &work.points);
    for (uint32_t f = 0; good && work.points.count && f < surface->triangle_count; f++)
        if (is_of(&work.piece, f)) good = take_triangle(&work, surface->triangles[f]);
    if (good) add_curl(&work);
    free(work.inland);
    rim_points_free(&work.points);
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
