#include "analysis/initial.h"

#include "analysis/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Reach of an initial crossing around its triangle, in longest sides of the triangle at rest: parts that cross slide,
/// and are ignored until they have separated.
static const float reach_of_side = 2;

static float initial_distance(const float *a, const float *b) {
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static bool has_rest(const CacheFrame *frame) {
    return frame->there[CACHE_REST] && frame->there[CACHE_REST + 1] && frame->there[CACHE_REST + 2];
}

static InitialTriangle entry_of(const CacheFrame *frame, uint32_t triangle) {
    const uint32_t *t = frame->triangles[triangle];
    const float bits = cache_value(frame, CACHE_SHEET, t[0]);
    InitialTriangle entry = {{0}, 0, 0};
    memcpy(&entry.sheet, &bits, sizeof entry.sheet);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) entry.at[k] += frame->rest[t[i]][k] / 3;
        entry.reach =
            fmaxf(entry.reach, reach_of_side * initial_distance(frame->rest[t[i]], frame->rest[t[(i + 1) % 3]]));
    }
    return entry;
}

static int by_x(const void *a, const void *b) {
    const InitialTriangle *p = a, *q = b;
    return (p->at[0] > q->at[0]) - (p->at[0] < q->at[0]);
}

bool initial_take(Initial *initial, const CacheFrame *frame, const uint32_t (*pairs)[2], size_t count) {
    if (!has_rest(frame)) return true;
    initial->triangles = malloc((2 * count + 1) * sizeof *initial->triangles);
    if (!initial->triangles) return false;
    initial->count = 2 * count;
    for (size_t i = 0; i < 2 * count; i++) {
        initial->triangles[i] = entry_of(frame, pairs[i / 2][i % 2]);
        initial->reach = fmaxf(initial->reach, initial->triangles[i].reach);
    }
    qsort(initial->triangles, initial->count, sizeof *initial->triangles, by_x);
    return true;
}

void initial_free(Initial *initial) {
    free(initial->triangles);
    *initial = (Initial){0};
}

bool initial_count(const SingeSurface *surface, uint64_t *pairs, float at[3]) {
    const float(*p)[3] = (const float(*)[3])surface->position;
    uint32_t(*sound)[3] = malloc(((size_t)surface->triangle_count + 1) * sizeof *sound), count = 0;
    CrossingList list = {0};
    if (!sound) return false;
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *v = surface->triangles[t];
        if (!exact_collinear(p[v[0]], p[v[1]], p[v[2]])) memcpy(sound[count++], v, sizeof *sound);
    }
    const bool good = crossings_find(p, (const uint32_t(*)[3])sound, count, &list);
    *pairs = list.count;
    if (good && list.count) memcpy(at, p[sound[list.pairs[0][0]][0]], 3 * sizeof *at);
    crossings_free(&list);
    free(sound);
    return good;
}

static bool is_near(const Initial *initial, const InitialTriangle *entry) {
    size_t from = 0, to = initial->count;
    while (from < to) {
        size_t middle = from + (to - from) / 2;
        if (initial->triangles[middle].at[0] < entry->at[0] - initial->reach) from = middle + 1;
        else to = middle;
    }
    for (; from < initial->count && initial->triangles[from].at[0] <= entry->at[0] + initial->reach; from++) {
        const InitialTriangle *other = &initial->triangles[from];
        if (other->sheet == entry->sheet && initial_distance(other->at, entry->at) <= other->reach) return true;
    }
    return false;
}

bool initial_has(const Initial *initial, const CacheFrame *frame, uint32_t a, uint32_t b) {
    if (!initial->count || !has_rest(frame)) return false;
    const InitialTriangle one = entry_of(frame, a), other = entry_of(frame, b);
    return is_near(initial, &one) && is_near(initial, &other);
}
