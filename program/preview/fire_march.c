// Marches rays through flame and smoke.
//
//     dL/ds = j - (a + k) L + k S,   front to back in steps, with j, a of the flame and k, S of the smoke
//                                    (fire_shade.c)

#include "preview/internal.h"

#include <string.h>

#define FIRE_SHORT 0.35f  ///< step near an edge, relative to the usual one: longer ones miss thin sheets
#define FIRE_NEAR 4.0f    ///< short steps from an edge, in usual ones: with 2, arcs are seen inside of tongues
#define SMOKE_STEP 0.010f ///< m, distance at most between the places of a ray where its smoke is looked up
#define FIRE_SOFT 6.0f    ///< pixels, over which the edges of flames begin: rays are two apart, depths rough
#define FIRE_EVEN 0.020f  ///< difference of light, as l / (1 + l), that may be interpolated

/// Smoke has no detail as fine as a flame's steps: it is looked up at multiples of a length, and linear between them.
typedef struct SmokeLine {
    float length, first; ///< m; number of the place of the nearer of `ends`
    Matter ends[2];
} SmokeLine;

static Matter smoke_along(const Fire *fire, Float3 eye, Float3 d, float t, SmokeLine *line) {
    const float first = floorf(t / line->length);
    if (first != line->first) {
        line->ends[0] =
            first == line->first + 1 ? line->ends[1] : fire_smoke_at(fire, float3_mad(eye, d, first * line->length));
        line->ends[1] = fire_smoke_at(fire, float3_mad(eye, d, (first + 1) * line->length));
        line->first = first;
    }

    const Matter *a = &line->ends[0], *b = &line->ends[1];
    const float part = t / line->length - first;
    return (Matter){float3_mix(a->light, b->light, part), mixf(a->dense, b->dense, part)};
}

static void see_ray(const Preview *preview, Float3 eye, Float3 d, FireView *view) {
    const Fire *fire = &preview->fire;
    const float from[3] = {eye.x, eye.y, eye.z}, ray[3] = {d.x, d.y, d.z};
    const float low[3] = {fire->low.x, fire->low.y, fire->low.z}, high[3] = {fire->high.x, fire->high.y, fire->high.z};

    // where the ray enters and leaves the bounds
    float t = 0, far = INFINITY;
    for (int c = 0; c < 3; c++) {
        float inverse = 1 / (fabsf(ray[c]) > 1e-9f ? ray[c] : 1e-9f);
        float a = (low[c] - from[c]) * inverse, b = (high[c] - from[c]) * inverse;
        t = maxf(t, minf(a, b));
        far = minf(far, maxf(a, b));
    }

    view->count = 0;
    if (!(t < far)) return;

    Float3 light = {0, 0, 0};
    float clear = 1;

    // far away a step must still change a float
    float fine = minf(0.17f * fire->cell, 0.0016f), min = maxf((far - t) / (16 * FIRE_STEPS), 1e-5f * far);
    bool dark = true;   // long steps until there is flame, longer far from it, and short ones at its edges
    bool known = false; // whether `here` is the point at t
    FirePoint here;
    const float blur = FIRE_SOFT * preview->camera.pixel;
    SmokeLine line = {.length = maxf(minf(fire->cell, SMOKE_STEP), min), .first = -2};

    while (t < far && clear > 0.02f) {
        // what is in the brick here, and the length of the ray in it from here
        float side = FIRE_BRICK * fire->cell, run = INFINITY;
        Float3 g = float3_scale(float3_sub(float3_mad(eye, d, t + 1e-5f), fire->origin), 1 / side);
        const float at[3] = {g.x, g.y, g.z};
        size_t brick[3];
        for (int c = 0; c < 3; c++) {
            float f;
            int i = noise_floor(at[c], &f);
            brick[c] = (size_t)(i < 0 ? 0 : i < fire->bricks[c] ? i : fire->bricks[c] - 1);
            if (fabsf(ray[c]) > 1e-9f) run = minf(run, ((ray[c] > 0 ? 1 : 0) - f) * side / ray[c]);
        }

        int what = fire->seen[brick[0] + (size_t)fire->bricks[0] * (brick[1] + (size_t)fire->bricks[1] * brick[2])];
        if (!what) {
            t += maxf(minf(run, far - t), 0) + 2e-5f + 1e-6f * t;
            known = false;
            continue;
        }

        // steps begin at multiples of their length: neighbouring rays then look at neighbouring positions
        const FirePoint outside = {.depth = FIRE_OUTSIDE};
        const bool flame = what & FIRE_FLAME;
        if (!known) here = flame ? fire_at_point(fire, float3_mad(eye, d, t), blur * t) : outside;
        known = true;
        bool seek = dark && flame;
        const float away = here.depth > FIRE_OUTSIDE ? 2 * fine : 3 * fine;
        float length = dark ? away : fabsf(here.depth) < FIRE_NEAR * fine ? FIRE_SHORT * fine : fine;
        float step = maxf(flame ? length : fire->cell, min);
        float next = maxf((floorf(t / step + 1e-3f) + 1) * step, t + 0.1f * step);
        step = next - t;
        const FirePoint there = flame ? fire_at_point(fire, float3_mad(eye, d, next), blur * next) : outside;
        dark = there.depth < -2 * fine;
        if (seek && !dark) continue; // the same distance again in short steps
        Matter m = {{0, 0, 0}, 0};
        if (what & FIRE_SMOKE) m = smoke_along(fire, eye, d, t + 0.5f * step, &line);
        fire_between(&here, &there, step, &m);
        here = there;

        // light of the step, absorbed within the step: (1 - exp(-d)) / d
        float depth = m.dense * step, kept = expf(-depth), mean = depth > 1e-3f ? (1 - kept) / depth : 1 - 0.5f * depth;
        light = float3_mad(light, m.light, clear * step * mean);
        clear *= kept;

        // the last step is the remaining length
        int k = view->count < FIRE_STEPS ? view->count++ : FIRE_STEPS - 1;
        view->from[k] = t;
        t = next;
        view->distance[k] = t;
        view->light[k] = light;
        view->clear[k] = clear;
    }
}

/// Traces the ray of a tile's corner `k`.
static void see_corner(const Preview *preview, int x, int y, int k, FireTile *tile) {
    const float disc[2] = {0, 0};
    float u = 2 * (float)(x + 2 * (k % FIRE_ACROSS)) / (float)preview->def.width - 1;
    float v = 1 - 2 * (float)(y + 2 * (k / FIRE_ACROSS)) / (float)preview->def.height;
    Float3 origin, direction;
    camera_ray(&preview->camera, u, v, disc, &origin, &direction);
    see_ray(preview, origin, direction, &tile->views[k]);
    tile->empty = tile->empty && !tile->views[k].count;
}

/// Whether the rays that are known in a square of 4 x 4 pixels, the first of which is `k`, see nearly the same.
static bool is_even(const FireTile *tile, const bool *known, int k) {
    float low[2] = {INFINITY, INFINITY}, high[2] = {0, 0};
    for (int m = 0; m < 9; m++) {
        const int i = k + m / 3 * FIRE_ACROSS + m % 3;
        if (!known[i]) continue;
        const FireView *view = &tile->views[i];
        float light = view->count ? float3_luminance(view->light[view->count - 1]) : 0;
        float value[2] = {light / (1 + light), view->count ? 1 - view->clear[view->count - 1] : 0};
        for (int c = 0; c < 2; c++) {
            low[c] = minf(low[c], value[c]);
            high[c] = maxf(high[c], value[c]);
        }
    }

    return high[0] - low[0] < FIRE_EVEN && high[1] - low[1] < 2 * FIRE_EVEN;
}

void fire_see(const Preview *preview, int x, int y, FireTile *tile) {
    bool known[FIRE_ACROSS * FIRE_ACROSS] = {false};
    tile->empty = true;
    memset(tile->fine, 0, sizeof tile->fine);
    for (int i = 0; i < FIRE_ACROSS; i += 2)
        for (int j = 0; j < FIRE_ACROSS; j += 2) {
            see_corner(preview, x, y, i * FIRE_ACROSS + j, tile);
            known[i * FIRE_ACROSS + j] = true;
        }

    // a ray between two corners may meet what both miss: then the square beyond it is looked at, too, and so on along a
    // tongue that is thinner than the corners are apart
    for (bool again = true; again;) {
        again = false;
        for (int square = 0; square < FIRE_COARSE * FIRE_COARSE; square++) {
            const int first = 2 * (square / FIRE_COARSE) * FIRE_ACROSS + 2 * (square % FIRE_COARSE);
            if (tile->fine[square] || is_even(tile, known, first)) continue;
            again = tile->fine[square] = true;
            for (int m = 0; m < 9; m++) {
                const int k = first + m / 3 * FIRE_ACROSS + m % 3;
                if (!known[k]) see_corner(preview, x, y, k, tile);
                known[k] = true;
            }
        }
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

void fire_along(const Preview *preview, Float3 origin, Float3 direction, float distance, Float3 *light, float *clear) {
    FireView view;
    see_ray(preview, origin, direction, &view);
    *light = float3(0, 0, 0);
    *clear = 0;
    add_view(&view, distance, 1, light, clear);
}

void fire_until(const FireTile *tile, int x, int y, float distance, Float3 *light, float *clear) {
    bool fine = tile->fine[y / 4 * FIRE_COARSE + x / 4];
    int apart = fine ? 1 : 2, side = 2 * apart; // in rays and in pixels
    const FireView *view = &tile->views[y / side * apart * FIRE_ACROSS + x / side * apart];
    float right = ((float)(x % side) + 0.5f) / (float)side, down = ((float)(y % side) + 0.5f) / (float)side;
    *light = float3(0, 0, 0);
    *clear = 0;
    add_view(view, distance, (1 - right) * (1 - down), light, clear);
    add_view(view + apart, distance, right * (1 - down), light, clear);
    add_view(view + apart * FIRE_ACROSS, distance, (1 - right) * down, light, clear);
    add_view(view + apart * FIRE_ACROSS + apart, distance, right * down, light, clear);
}
