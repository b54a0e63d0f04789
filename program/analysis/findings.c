#include "analysis/findings.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "analysis/crossings.h"
#include "analysis/exact.h"
#include "common/float3.h"
#include "common/order.h"

enum { REPORTED = 3 };
/// Reach of an initial crossing around its triangle, in longest sides of the triangle at rest: parts that cross slide,
/// and are ignored until they have separated.
static const float reach_of_side = 2;
static const double fold_cosine = -0.984807753; // triangles that enclose less than 10 degrees

static void findings_say(const Findings *findings, bool fault, const char *format, ...) SINGE_PRINTF(3, 4);

static void findings_say(const Findings *findings, bool fault, const char *format, ...) {
    char message[1200];
    va_list list;
    va_start(list, format);
    vsnprintf(message, sizeof message, format, list);
    va_end(list);
    findings->report(findings->context, fault, message);
}

void findings_add(Findings *findings, Fault fault, const char *format, ...) {
    char text[300];
    va_list list;

    findings->count[fault]++;
    if (findings->reported[fault]++ >= REPORTED) return;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);

    const char *more = findings->reported[fault] == REPORTED ? "; further ones are only counted" : "";
    findings_say(findings, true, "%s: %s%s", findings->file, text, more);
}

// ---- values

void check_values(const CacheFrame *frame, Findings *findings) {
    for (int c = 0; c < CACHE_COLUMNS; c++) {
        const SurfaceField *column = &surface_columns[c];
        if (!frame->there[c])
            findings_add(findings, FAULT_MISSING, "vertices have no property \"%s %s\"",
                         column->integer ? "int" : "float", column->name);
        if (!frame->there[c] || column->integer) continue;
        for (uint32_t v = 0; v < frame->vertex_count; v++)
            if (!isfinite(cache_value(frame, c, v)))
                findings_add(findings, FAULT_NOT_FINITE, "%s of vertex %u is not finite", column->name, v);
    }

    if (isnan(frame->time)) findings_add(findings, FAULT_MISSING, "the header has no \"comment singe ... time ...\"");
    for (uint32_t t = 0; t < frame->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t vertex = frame->triangles[t][k];
            if (vertex < frame->vertex_count) continue;
            findings_add(findings, FAULT_INDEX, "triangle %u names vertex %d of %u", t, (int)vertex,
                         frame->vertex_count);
            break;
        }
}

static bool is_finite_point(const float p[3]) { return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]); }

// ---- crossings

static bool is_rest_known(const CacheFrame *frame) {
    return frame->there[CACHE_REST] && frame->there[CACHE_REST + 1] && frame->there[CACHE_REST + 2];
}

static int32_t sheet_of(const CacheFrame *frame, uint32_t triangle) {
    int32_t sheet;
    const float bits = cache_value(frame, CACHE_SHEET, frame->triangles[triangle][0]);
    memcpy(&sheet, &bits, sizeof sheet);
    return sheet;
}

static float initial_distance(const float *a, const float *b) {
    return float3_length(float3_sub(float3_load(a), float3_load(b)));
}

static InitialTriangle entry_of(const CacheFrame *frame, uint32_t triangle) {
    const uint32_t *t = frame->triangles[triangle];
    InitialTriangle entry = {{0}, 0, sheet_of(frame, triangle)};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) entry.at[k] += frame->rest[t[i]][k] / 3;
        entry.reach =
            fmaxf(entry.reach, reach_of_side * initial_distance(frame->rest[t[i]], frame->rest[t[(i + 1) % 3]]));
    }

    return entry;
}

void initial_free(Initial *initial) {
    free(initial->triangles);
    *initial = (Initial){0};
}

/// Whether a triangle is near an initial crossing.
static bool is_near(const Initial *initial, const CacheFrame *frame, uint32_t triangle) {
    if (!initial->count || !is_rest_known(frame)) return false;

    const InitialTriangle entry = entry_of(frame, triangle);
    size_t from = 0, to = initial->count;
    while (from < to) {
        size_t middle = from + (to - from) / 2;
        if (initial->triangles[middle].at[0] < entry.at[0] - initial->reach) from = middle + 1;
        else to = middle;
    }

    for (; from < initial->count && initial->triangles[from].at[0] <= entry.at[0] + initial->reach; from++) {
        const InitialTriangle *other = &initial->triangles[from];
        if (other->sheet == entry.sheet && initial_distance(other->at, entry.at) <= other->reach) return true;
    }

    return false;
}

/// Counts a pair that crosses, from the start or as a fault.
static void add_crossing(const CacheFrame *frame, uint32_t a, uint32_t b, Findings *findings) {
    const uint32_t *s = frame->triangles[a], *t = frame->triangles[b];
    const float *p = frame->position[s[0]];

    if (is_near(&findings->initial, frame, a) && is_near(&findings->initial, frame, b)) {
        findings->from_start++;
        return;
    }

    // the distance between their nearest corners at rest, and the longest of their sides
    double gap = (double)INFINITY, side = 0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) gap = fmin(gap, distance_of(frame->rest[s[i]], frame->rest[t[k]]));
        side = fmax(side, distance_of(frame->rest[s[i]], frame->rest[s[(i + 1) % 3]]));
        side = fmax(side, distance_of(frame->rest[t[i]], frame->rest[t[(i + 1) % 3]]));
    }

    const int32_t one = sheet_of(frame, a), other = sheet_of(frame, b);
    char where[64];
    if (one != other) snprintf(where, sizeof where, "of sheets %d and %d", (int)one, (int)other);
    else snprintf(where, sizeof where, "%.3g mm apart at rest", 1e3 * gap);
    findings->near += one == other && gap <= side;
    findings_add(findings, FAULT_CROSSING, "triangles %u and %u, %s, cross near (%.4g, %.4g, %.4g) m", a, b, where,
                 (double)p[0], (double)p[1], (double)p[2]);
}

static bool check_crossings(const CacheFrame *frame, const uint32_t *sound, uint32_t count, Findings *findings) {
    uint32_t(*triangles)[3] = malloc(((size_t)count + 1) * sizeof *triangles);
    CrossingList list = {0};
    if (!triangles) return false;

    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) triangles[i][k] = frame->triangles[sound[i]][k];

    const float(*position)[3] = (const float(*)[3])frame->position;
    bool good = crossings_find(position, (const uint32_t(*)[3])triangles, count, &list);
    free(triangles);
    for (size_t i = 0; i < list.count; i++)
        for (int k = 0; k < 2; k++) list.pairs[i][k] = sound[list.pairs[i][k]];

    // those of the first frame are remembered
    Initial *initial = &findings->initial;
    if (good && findings->begins && is_rest_known(frame)) {
        initial->triangles = malloc((2 * list.count + 1) * sizeof *initial->triangles);
        good = initial->triangles != NULL;
        initial->count = good ? 2 * list.count : 0;
        for (size_t i = 0; i < initial->count; i++) {
            initial->triangles[i] = entry_of(frame, list.pairs[i / 2][i % 2]);
            initial->reach = fmaxf(initial->reach, initial->triangles[i].reach);
        }

        if (good) qsort(initial->triangles, initial->count, sizeof *initial->triangles, order_by_float);
    }

    for (size_t i = 0; i < list.count; i++) add_crossing(frame, list.pairs[i][0], list.pairs[i][1], findings);
    if (findings->begins && findings->from_start) {
        // one warning for all: sheets that lie in one place have thousands
        const uint32_t *pair = list.pairs[0];
        const float *p = frame->position[frame->triangles[pair[0]][0]];
        findings_say(findings, false,
                     "%s: pairs of triangles that cross from the start: %" PRIu64
                     ", the first of them %u and %u, near (%.4g, %.4g, %.4g) m",
                     findings->file, findings->from_start, pair[0], pair[1], (double)p[0], (double)p[1], (double)p[2]);
    }

    crossings_free(&list);
    return good;
}

// ---- duplicates

typedef struct Triple {
    uint32_t vertex[3], triangle; ///< vertices ascending
} Triple;

static bool check_duplicates(const CacheFrame *frame, const uint32_t *sound, uint32_t count, Findings *findings) {
    Triple *triples = malloc(((size_t)count + 1) * sizeof *triples);
    if (!triples) return false;

    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *v = frame->triangles[sound[i]];
        Triple *t = &triples[i];
        *t = (Triple){{v[0], v[1], v[2]}, sound[i]};
        for (int k = 0; k < 3; k++) { // three exchanges sort three
            const int low = k == 1, high = low + 1;
            const uint32_t kept = t->vertex[low];
            if (kept <= t->vertex[high]) continue;
            t->vertex[low] = t->vertex[high];
            t->vertex[high] = kept;
        }
    }

    qsort(triples, count, sizeof *triples, order_by_four);
    for (uint32_t i = 1; i < count; i++) {
        const Triple *one = &triples[i - 1], *other = &triples[i];
        if (one->vertex[0] == other->vertex[0] && one->vertex[1] == other->vertex[1] &&
            one->vertex[2] == other->vertex[2])
            findings_add(findings, FAULT_DUPLICATE, "triangles %u and %u have the same vertices %u, %u, %u",
                         one->triangle, other->triangle, one->vertex[0], one->vertex[1], one->vertex[2]);
    }

    free(triples);
    return true;
}

// ---- edges

typedef struct Side {
    uint32_t low, high, triangle, opposite; ///< vertices of the edge, and the triangle's third
    bool forward;                           ///< the triangle runs from low to high
} Side;

/// Cosine between the normals of the triangles of an edge, both with the winding of the first.
static double findings_bend(float (*const at)[3], const Side *one, const Side *other) {
    const float *low = at[one->low], *high = at[one->high];
    double along[3], back[3], u[3], v[3], m[3], n[3];
    for (int k = 0; k < 3; k++) {
        along[k] = (double)high[k] - (double)low[k];
        back[k] = (double)low[k] - (double)high[k];
        u[k] = (double)at[one->opposite][k] - (double)low[k];
        v[k] = (double)at[other->opposite][k] - (double)high[k];
    }

    cross3(along, u, m);
    cross3(back, v, n);
    const double mm = dot3(m, m), nn = dot3(n, n);
    return mm > 0 && nn > 0 ? dot3(m, n) / sqrt(mm * nn) : 1;
}

static bool has_rest(const CacheFrame *frame, const Side *side) {
    return is_rest_known(frame) && is_finite_point(frame->rest[side->low]) &&
           is_finite_point(frame->rest[side->high]) && is_finite_point(frame->rest[side->opposite]);
}

/// Max error of the length of an edge because its ends are stored as floats, half a last bit each.
static double rounding(const float from[3], const float to[3]) {
    double squares = 0;
    for (int k = 0; k < 3; k++) {
        const double bits = 0.5 * FLT_EPSILON * (fabs((double)from[k]) + fabs((double)to[k]));
        squares += bits * bits;
    }
    return sqrt(squares);
}

static bool check_edges(const CacheFrame *frame, const uint32_t *sound, uint32_t count, Findings *findings) {
    const size_t side_count = 3 * (size_t)count;
    Side *sides = malloc((side_count + 1) * sizeof *sides);
    if (!sides) return false;

    for (size_t i = 0; i < side_count; i++) {
        const uint32_t triangle = sound[i / 3], *v = frame->triangles[triangle];
        const uint32_t from = v[i % 3], to = v[(i + 1) % 3], opposite = v[(i + 2) % 3];
        const bool forward = from < to;
        sides[i] = (Side){forward ? from : to, forward ? to : from, triangle, opposite, forward};
    }

    qsort(sides, side_count, sizeof *sides, order_by_three);
    for (size_t i = 0, end; i < side_count; i = end) {
        for (end = i + 1; end < side_count && sides[end].low == sides[i].low && sides[end].high == sides[i].high;)
            end++;

        const Side *at = &sides[i]; // the triangles at one edge
        const uint32_t near = (uint32_t)(end - i), low = at->low, high = at->high;
        if (near > 2)
            findings_add(findings, FAULT_NON_MANIFOLD, "edge %u-%u has %u triangles: %u, %u, %u%s", low, high, near,
                         at[0].triangle, at[1].triangle, at[2].triangle, near > 3 ? ", ..." : "");
        if (near == 2 && at[0].forward == at[1].forward)
            findings_add(findings, FAULT_WINDING, "triangles %u and %u run the same way along edge %u-%u",
                         at[0].triangle, at[1].triangle, low, high);
        if (!has_rest(frame, at)) continue;

        const double length = distance_of(frame->position[low], frame->position[high]);
        const double rest = distance_of(frame->rest[low], frame->rest[high]);
        const double shortest = length - rounding(frame->position[low], frame->position[high]);
        const double longest = rest + rounding(frame->rest[low], frame->rest[high]);
        if (shortest > findings->stretch * longest)
            findings_add(findings, FAULT_STRETCHED, "edge %u-%u of triangle %u is %.4g mm long, %.4g mm at rest", low,
                         high, at->triangle, 1e3 * length, 1e3 * rest);
        if (near == 2 && has_rest(frame, &at[1]) && findings_bend(frame->position, &at[0], &at[1]) < fold_cosine &&
            findings_bend(frame->rest, &at[0], &at[1]) > 0)
            findings->folded++;
    }

    free(sides);
    return true;
}

bool check_surface(const CacheFrame *frame, Findings *findings) {
    uint32_t *sound = malloc(((size_t)frame->triangle_count + 1) * sizeof *sound), count = 0;
    if (!sound) return false;

    // triangles of finite vertices, and with an area
    for (uint32_t t = 0; t < frame->triangle_count; t++) {
        const uint32_t *v = frame->triangles[t];
        bool whole = true;
        for (int k = 0; k < 3 && whole; k++)
            whole = v[k] < frame->vertex_count && is_finite_point(frame->position[v[k]]);
        if (!whole) continue;

        const float *a = frame->position[v[0]];
        if (exact_collinear(a, frame->position[v[1]], frame->position[v[2]]))
            findings_add(findings, FAULT_DEGENERATE,
                         "triangle %u (vertices %u, %u, %u) at (%.4g, %.4g, %.4g) m has no area", t, v[0], v[1], v[2],
                         (double)a[0], (double)a[1], (double)a[2]);
        else sound[count++] = t;
    }

    const bool good = check_crossings(frame, sound, count, findings) &&
                      check_duplicates(frame, sound, count, findings) && check_edges(frame, sound, count, findings);
    free(sound);
    return good;
}

static void say_nothing(void *context, bool fault, const char *message) { (void)context, (void)fault, (void)message; }

bool check_start(const CacheFrame *frame, Findings *findings) {
    Findings quiet = *findings;
    quiet.report = say_nothing;
    quiet.begins = true;
    const bool good = check_surface(frame, &quiet);
    findings->initial = quiet.initial;
    return good;
}
