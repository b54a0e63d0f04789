#include "analysis/initial.h"

#include "analysis/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Of the longest side at rest of a triangle that crosses in the first frame, how far around it that counts: what
/// crosses slides, and is left alone until it has parted.
static const float reach_of_side = 2;

static float distance(const float *a, const float *b) {
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static bool has_rest(const CacheFrame *frame) {
    return frame->there[CACHE_REST] && frame->there[CACHE_REST + 1] && frame->there[CACHE_REST + 2];
}

static InitialPlace place_of(const CacheFrame *frame, uint32_t triangle) {
    const uint32_t *t = frame->triangles[triangle];
    const float bits = cache_value(frame, CACHE_SHEET, t[0]);
    InitialPlace place = {{0}, 0, 0};
    memcpy(&place.sheet, &bits, sizeof place.sheet);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) place.at[k] += frame->rest[t[i]][k] / 3;
        place.reach = fmaxf(place.reach, reach_of_side * distance(frame->rest[t[i]], frame->rest[t[(i + 1) % 3]]));
    }
    return place;
}

static int by_x(const void *a, const void *b) {
    const InitialPlace *p = a, *q = b;
    return (p->at[0] > q->at[0]) - (p->at[0] < q->at[0]);
}

bool initial_take(Initial *initial, const CacheFrame *frame, const uint32_t (*pairs)[2], size_t count) {
    if (!has_rest(frame)) return true;
    initial->places = malloc((2 * count + 1) * sizeof *initial->places);
    if (!initial->places) return false;
    initial->count = 2 * count;
    for (size_t i = 0; i < 2 * count; i++) {
        initial->places[i] = place_of(frame, pairs[i / 2][i % 2]);
        initial->reach = fmaxf(initial->reach, initial->places[i].reach);
    }
    qsort(initial->places, initial->count, sizeof *initial->places, by_x);
    return true;
}

void initial_free(Initial *initial) {
    free(initial->places);
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

static bool is_near(const Initial *initial, const InitialPlace *place) {
    size_t from = 0, to = initial->count;
    while (from < to) {
        size_t middle = from + (to - from) / 2;
        if (initial->places[middle].at[0] < place->at[0] - initial->reach) from = middle + 1;
        else to = middle;
    }
    for (; from < initial->count && initial->places[from].at[0] <= place->at[0] + initial->reach; from++) {
        const InitialPlace *other = &initial->places[from];
        if (other->sheet == place->sheet && distance(other->at, place->at) <= other->reach) return true;
    }
    return false;
}

bool initial_has(const Initial *initial, const CacheFrame *frame, uint32_t a, uint32_t b) {
    if (!initial->count || !has_rest(frame)) return false;
    const InitialPlace one = place_of(frame, a), other = place_of(frame, b);
    return is_near(initial, &one) && is_near(initial, &other);
}
