// Marches rays through flame and smoke.
//
//     dL/ds = j - (a + k) L + k S,   front to back in steps, with j, a of the flame and k, S of the smoke
//                                    (fire_shade.c)

#include "preview/internal.h"

typedef struct Gathered {
    Float3 light;
    float clear;
} Gathered;

static void add_step(Gathered *g, const Matter *m, float step) {
    float depth = m->dense * step;
    // light of the step, absorbed within the step: (1 - exp(-d)) / d
    float kept = expf(-depth), mean = depth > 1e-3f ? (1 - kept) / depth : 1 - 0.5f * depth;
    g->light = float3_mad(g->light, m->light, g->clear * step * mean);
    g->clear *= kept;
}

// ---- along the ray

/// Where the ray enters and leaves the bounds. False if it misses them.
static bool fire_clip(const Fire *fire, Float3 eye, Float3 d, float *near, float *far) {
    const float from[3] = {eye.x, eye.y, eye.z}, ray[3] = {d.x, d.y, d.z};
    const float low[3] = {fire->low.x, fire->low.y, fire->low.z}, high[3] = {fire->high.x, fire->high.y, fire->high.z};
    *near = 0;
    *far = INFINITY;
    for (int c = 0; c < 3; c++) {
        float inverse = 1 / (fabsf(ray[c]) > 1e-9f ? ray[c] : 1e-9f);
        float a = (low[c] - from[c]) * inverse, b = (high[c] - from[c]) * inverse;
        *near = maxf(*near, minf(a, b));
        *far = minf(*far, maxf(a, b));
    }
    return *near < *far;
}

/// The contents of the brick at p, and the length of the ray in it from there.
static int look_ahead(const Fire *fire, Float3 p, Float3 d, float *run) {
    float side = FIRE_BRICK * fire->cell;
    Float3 g = float3_scale(float3_sub(p, fire->origin), 1 / side);
    const float at[3] = {g.x, g.y, g.z}, ray[3] = {d.x, d.y, d.z};
    int brick[3];
    *run = INFINITY;
    for (int c = 0; c < 3; c++) {
        float f;
        int i = noise_floor(at[c], &f);
        brick[c] = i < 0 ? 0 : i < fire->bricks[c] ? i : fire->bricks[c] - 1;
        if (fabsf(ray[c]) > 1e-9f) *run = minf(*run, ((ray[c] > 0 ? 1 : 0) - f) * side / ray[c]);
    }
    return fire->seen[(size_t)brick[0] +
                      (size_t)fire->bricks[0] * ((size_t)brick[1] + (size_t)fire->bricks[1] * (size_t)brick[2])];
}

static void see_ray(const Preview *preview, Float3 d, FireView *view) {
    const Fire *fire = &preview->fire;
    Float3 eye = preview->camera.eye;
    float t, far, run;
    view->count = 0;
    if (!fire_clip(fire, eye, d, &t, &far)) return;
    Gathered g = {{0, 0, 0}, 1};
    // far away a step must still change a float
    float fine = minf(0.35f * fire->cell, 0.0028f), min = maxf((far - t) / (4 * FIRE_STEPS), 1e-5f * far);
    bool dark = true; // long steps until there is flame
    while (t < far && g.clear > 0.02f) {
        int what = look_ahead(fire, float3_mad(eye, d, t + 1e-5f), d, &run);
        if (!what) {
            t += maxf(minf(run, far - t), 0) + 2e-5f + 1e-6f * t;
            continue;
        }
        bool seek = dark && (what & FIRE_FLAME);
        // steps begin at multiples of their length: neighbouring rays then look at neighbouring positions
        float step = maxf(what & FIRE_FLAME ? (dark ? 2 : 1) * fine : fire->cell, min);
        float next = maxf((floorf(t / step + 1e-3f) + 1) * step, t + 0.1f * step);
        step = next - t;
        Matter m = fire_matter(preview, float3_mad(eye, d, t + 0.5f * step), what);
        dark = !m.flame;
        if (seek && m.flame) continue; // the same distance again in short steps
        add_step(&g, &m, step);
        // the last step is the remaining length
        int k = view->count < FIRE_STEPS ? view->count++ : FIRE_STEPS - 1;
        view->from[k] = t;
        t = next;
        view->distance[k] = t;
        view->light[k] = g.light;
        view->clear[k] = g.clear;
    }
}

void fire_see(const Preview *preview, int x, int y, FireTile *tile) {
    const float disc[2] = {0, 0};
    tile->empty = true;
    for (int k = 0; k < FIRE_ACROSS * FIRE_ACROSS; k++) {
        float u = 2 * (float)(x + 2 * (k % FIRE_ACROSS)) / (float)preview->def.width - 1;
        float v = 1 - 2 * (float)(y + 2 * (k / FIRE_ACROSS)) / (float)preview->def.height;
        Float3 origin, direction;
        camera_ray(&preview->camera, u, v, disc, &origin, &direction);
        see_ray(preview, direction, &tile->views[k]);
        tile->empty = tile->empty && !tile->views[k].count;
    }
}

/// Adds a ray's light and transmittance, times a weight.
static void add_view(const FireView *view, float distance, float weight, Float3 *light, float *clear) {
    int low = 0, high = view->count;
    if (high && view->distance[high - 1] <= distance) low = high;
    while (low < high) {
        int mid = (low + high) / 2;
        if (view->distance[mid] <= distance) low = mid + 1;
        else high = mid;
    }
    // `low` steps are wholly in front, the next one partly
    Float3 sum = low ? view->light[low - 1] : float3(0, 0, 0);
    float left = low ? view->clear[low - 1] : 1;
    if (low < view->count && view->from[low] < distance) {
        float part = (distance - view->from[low]) / (view->distance[low] - view->from[low]);
        sum = float3_mix(sum, view->light[low], part);
        left = mixf(left, view->clear[low], part);
    }
    *light = float3_mad(*light, sum, weight);
    *clear += weight * left;
}

void fire_until(const FireTile *tile, int x, int y, float distance, Float3 *light, float *clear) {
    const float near = 0.75f, far = 0.25f; // a pixel's centre lies at a quarter of the distance between two rays
    float right = x % 2 ? near : far, down = y % 2 ? near : far;
    const FireView *view = &tile->views[y / 2 * FIRE_ACROSS + x / 2];
    *light = float3(0, 0, 0);
    *clear = 0;
    add_view(view, distance, (1 - right) * (1 - down), light, clear);
    add_view(view + 1, distance, right * (1 - down), light, clear);
    add_view(view + FIRE_ACROSS, distance, (1 - right) * down, light, clear);
    add_view(view + FIRE_ACROSS + 1, distance, right * down, light, clear);
}
