// The light of flames, embers and hot shapes, with shadows.
//
// The unoccluded light U = sum_k U_k over the lamps k is exact. Visibility is tested by one ray per sample, to a random
// point of a lamp chosen with probability U_k / U: its mean, V, has no noise where all lamps or none are visible. All
// noise is in V, so V is smoothed over the pixels that show the same face, and the picture gets V U: print and edges
// remain sharp.

#include "preview/block.h"

#include <string.h>

enum { LAMP_SAMPLES = 4 }; ///< samples of a pixel that trace rays; the rest only add light
static const float too_faint = 4e-3f;

/// Four lamps at a time.
typedef float Four __attribute__((vector_size(16)));

static inline Four four(const float *p) {
    Four f;
    memcpy(&f, p, sizeof f);
    return f;
}

static inline Four four_max(Four a, Four b) {
    for (int k = 0; k < 4; k++) a[k] = maxf(a[k], b[k]);
    return a;
}

static inline float four_sum(Four a) { return a[0] + a[1] + (a[2] + a[3]); }

/// The reflection by white paper at the point of all lights, and the luminance of each. A surface that faces away from
/// a light is lit through the sheet.
static Float3 lamps_gather(const EmberLights *l, const Point *point, int count, float weight[LIGHT_LIMIT]) {
    Float3 p = point->position, n = point->normal;
    Four r = {0, 0, 0, 0}, g = r, b = r, zero = r;
    for (int k = 0; k < count; k += 4) {
        Four x = four(l->x + k) - p.x, y = four(l->y + k) - p.y, z = four(l->z + k) - p.z;
        Four d2 = x * x + y * y + z * z + four(l->softness + k), cosine = n.x * x + n.y * y + n.z * z;
        for (int i = 0; i < 4; i++) cosine[i] /= sqrtf(d2[i]);
        // wrapped: clusters have an extent that points do not, and their own sheet must be lit, too
        Four seen = four_max(four_max((cosine + 0.2f) * (1 / 1.2f), -point->transmission * cosine), zero) / d2;
        r += seen * four(l->strength[0] + k);
        g += seen * four(l->strength[1] + k);
        b += seen * four(l->strength[2] + k);
        seen *= four(l->power + k);
        memcpy(weight + k, &seen, sizeof seen);
    }
    return float3(four_sum(r), four_sum(g), four_sum(b));
}

/// The lamp in which a random number in [0, 1) falls.
static int choose(const float weight[LIGHT_LIMIT], int count, float random) {
    float total = 0, sum = 0;
    for (int k = 0; k < count; k++) total += weight[k];
    for (int k = 0; k < count - 1; k++)
        if ((sum += weight[k]) > random * total) return k;
    return count - 1;
}

/// Aims at a random point of a lamp; objects within it do not occlude it.
static void lamps_aim(const Preview *preview, Block *block, int lane, int sample, int lamp) {
    const EmberLights *l = &preview->scene.lights;
    const Point *point = &block->point[lane];
    float square[2], extent = l->extent[lamp];
    sample_square((uint32_t)sample, block->turn[lane][1], block->turn[lane][0], square);
    float z = 1.6f * square[0] - 0.8f, disc[2];
    sample_disc((const float[2]){0.6f, square[1]}, disc);
    Float3 to = float3_add(float3(l->x[lamp], l->y[lamp], l->z[lamp]),
                           float3_scale(float3(disc[0], disc[1], z), 0.8f * extent));
    Float3 centre = float3_sub(float3(l->x[lamp], l->y[lamp], l->z[lamp]), point->position),
           to_light = float3_sub(to, point->position);
    float distance = float3_length(to_light), free = float3_length(centre) - extent;
    if (free < 0.1f * extent || distance < 1e-6f) return; // at it, or in it
    float side = float3_dot(point->geometric, to_light) > 0 ? preview->scene.epsilon : -preview->scene.epsilon;
    aim_ray(&block->shadow, lane, float3_mad(point->position, point->geometric, side),
            float3_scale(to_light, 1 / distance), 0, minf(free, distance), block->time[lane]);
    block->valid[lane] = -1;
}

static void ask(const Preview *preview, Block *block, const float wanted[LANES], float (*weight)[LIGHT_LIMIT],
                int sample) {
    const float golden = 0.61803399f;
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (wanted[i] <= 0) continue;
        float random = hash_unit(block->key[i] ^ 0x5bd1e995u) + golden * (float)sample;
        lamps_aim(preview, block, i, sample, choose(weight[i], preview->scene.light_count, random - floorf(random)));
    }
    tracer_occlude(preview, block->valid, &block->shadow, block->clear);
    for (int i = 0; i < LANES; i++)
        if (wanted[i] > 0) block->lamp_asked[i] += wanted[i], block->lamp_seen[i] += wanted[i] * block->clear[i];
}

/// The reflection by white paper at the lane's point. The last result is reused if its point was nearby with the same
/// normal, or if it hardly matters, on char.
static Float3 white_light(const Preview *preview, Block *block, int lane, bool ask, float weight[LIGHT_LIMIT]) {
    const Point *point = &block->point[lane];
    Float3 moved = float3_sub(point->position, block->lamp_position[lane]);
    if (!ask && float3_dot(moved, moved) < 4 * point->footprint * point->footprint &&
        (float3_dot(point->normal, block->lamp_normal[lane]) > 0.99f || float3_luminance(point->albedo) < 0.08f))
        return block->lamp_white[lane];
    block->lamp_position[lane] = point->position;
    block->lamp_normal[lane] = point->normal;
    return block->lamp_white[lane] = lamps_gather(&preview->scene.lights, point, preview->scene.light_count, weight);
}

void lamps_add(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES]) {
    if (!preview->scene.light_count) return;
    float weight[LANES][LIGHT_LIMIT], wanted[LANES];
    bool any = false, ask_now = sample < LAMP_SAMPLES;
    for (int i = 0; i < LANES; i++) {
        wanted[i] = 0;
        if (!light_reaches(block, active, i)) continue;
        Float3 light = float3_mul(white_light(preview, block, i, ask_now, weight[i]), block->point[i].albedo);
        light = float3_scale(float3(minf(light.x, 40), minf(light.y, 40), minf(light.z, 40)), through[i]);
        block->lamp[i] = float3_add(block->lamp[i], light);
        float luminance = float3_luminance(light);
        if (luminance > too_faint) {
            wanted[i] = luminance;
            any = true;
        }
    }
    if (!any || !ask_now) return;
    int rays = sample == SAMPLE_CENTRE ? LAMP_SAMPLES : 1;
    for (int k = 0; k < rays; k++) ask(preview, block, wanted, weight, sample == SAMPLE_CENTRE ? k : sample);
}

void lamps_write(const Preview *preview, size_t pixel, const Block *block, int lane, int samples) {
    const Point *point = &block->point[lane];
    preview->lamps[pixel] =
        (Lamp){.light = float3_scale(block->lamp[lane], 1 / (float)samples),
               .normal = point->geometric,
               .distance = point->distance,
               .sheet = point->sheet,
               .seen = block->lamp_asked[lane] > 0 ? block->lamp_seen[lane] / block->lamp_asked[lane] : 1};
}

// ---- smoothed

/// Whether two pixels show one face.
static bool is_same(const Lamp *a, const Lamp *b) {
    return a->sheet == b->sheet && fabsf(a->distance - b->distance) < 0.02f * a->distance &&
           float3_dot(a->normal, b->normal) > 0.8f;
}

/// Mean of `values` along a line of pixels `stride` apart, from `before` to `after`, weighted by nearness.
static float lamps_smooth_line(const Lamp *lamp, const float *values, size_t values_stride, ptrdiff_t stride,
                               int before, int after, int reach) {
    float sum = 0, total = 0;
    for (int k = -before; k <= after; k++) {
        if (!is_same(lamp, lamp + k * stride)) continue;
        float weight = (float)(reach + 1 - (k < 0 ? -k : k));
        sum += weight * *(const float *)(const void *)((const char *)values + k * stride * (ptrdiff_t)values_stride);
        total += weight;
    }
    return total > 0 ? sum / total : *values;
}

static int lamps_lesser(int a, int b) { return a < b ? a : b; }

static int smooth_reach(const Preview *preview) { return 2 + preview->def.height / 180; }

void lamps_smooth(Preview *preview, Block *block) {
    int w = preview->def.width, h = preview->def.height, reach = smooth_reach(preview);
    for (int i = 0; i < LANES; i++) {
        int x = block->x[i], y = block->y[i];
        if (x >= w || y >= h) continue;
        size_t pixel = (size_t)y * (size_t)w + (size_t)x;
        const Lamp *lamp = &preview->lamps[pixel];
        preview->seen[pixel] = lamps_smooth_line(lamp, &lamp->seen, sizeof *lamp, 1, lamps_lesser(x, reach),
                                                 lamps_lesser(w - 1 - x, reach), reach);
    }
}

void lamps_finish(Preview *preview, Block *block) {
    int w = preview->def.width, h = preview->def.height, reach = smooth_reach(preview);
    for (int i = 0; i < LANES; i++) {
        int x = block->x[i], y = block->y[i];
        if (x >= w || y >= h) continue;
        size_t pixel = (size_t)y * (size_t)w + (size_t)x;
        const Lamp *lamp = &preview->lamps[pixel];
        if (lamp->light.x + lamp->light.y + lamp->light.z <= 0) continue;
        float seen = lamps_smooth_line(lamp, &preview->seen[pixel], sizeof(float), w, lamps_lesser(y, reach),
                                       lamps_lesser(h - 1 - y, reach), reach);
        preview->picture[pixel] = float3_mad(preview->picture[pixel], lamp->light, seen);
    }
}
