// What a ray sees of flame and smoke on its way.
//
//     dL/ds = j - (a + k) L + k S,   front to back in steps, with j, a of the flame and k, S of the smoke
//
// The gas comes in cells of several millimetres and is interpolated by quadratic B-splines, so its cells do not
// show. What is finer is added: the place that is looked up is shifted by noise (domain warping), the edge of the
// flame lies where the flame's share passes a threshold that noise moves, and inside it shines in folded sheets. The
// noise is stretched upwards and rises with the gas, so flames have tongues and streaks and flicker.
//
// A flame is soot that glows: its colour is that of a black body between FLAME_COOL and FLAME_HOT, by how much of it
// burns around; it is clear and faintly blue in its first millimetres, where there is no soot yet, and cools and
// breaks up towards its tip.

#include "preview/internal.h"

#include <string.h>

#define RISE 0.75f ///< m/s, how fast the eddies go up

#define FLAME_COOL 1350.0f ///< K
#define FLAME_HOT 2050.0f
#define FLAME_DIM 0.4f     ///< radiance of a thick flame at its coolest and its hottest
#define FLAME_BRIGHT 3.7f
#define FLAME_DENSE 100.0f ///< 1/m: radiance gathered a metre over that of a thick flame
#define FLAME_OPAQUE 42.0f ///< 1/m, extinction
#define EDGE_LOW 0.20f     ///< share of burning at which a flame begins, and is whole
#define EDGE_HIGH 0.34f
#define FLAME_DARK 0.002f  ///< m above the root, where soot begins
#define FLAME_FULL 0.018f
#define FLAME_LONG 0.14f   ///< m, where it has cooled

typedef struct Gathered { V3 light; float clear; } Gathered;

// ---- looking up

/// Four numbers that are interpolated together.
typedef float Four __attribute__((vector_size(16)));

static inline Four four_load(const float *p) {
    Four four;
    memcpy(&four, p, sizeof four);
    return four;
}

/// Quadratic B-spline over 3 x 3 x 3 cells at g, in cells from the middle of cell (0, 0, 0).
static FireCell look_up(const Fire *fire, V3 g) {
    float f[3], w[3][3];
    int base[3];
    const float at[3] = {g.x, g.y, g.z};
    for (int c = 0; c < 3; c++) {
        float bounded = clampf(at[c], 1, (float)(fire->size[c] - 2));
        base[c] = (int)(bounded + 0.5f) - 1;
        base[c] = base[c] > fire->size[c] - 3 ? fire->size[c] - 3 : base[c];
        f[c] = bounded - (float)(base[c] + 1);
        w[c][0] = 0.5f * (0.5f - f[c]) * (0.5f - f[c]), w[c][1] = 0.75f - f[c] * f[c];
        w[c][2] = 0.5f * (0.5f + f[c]) * (0.5f + f[c]);
    }
    Four sum = {0, 0, 0, 0};
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++) {
            size_t row = (size_t)base[0] + (size_t)fire->size[0] * ((size_t)(base[1] + y) +
                         (size_t)fire->size[1] * (size_t)(base[2] + z));
            const FireCell *cells = &fire->cells[row];
            Four across = four_load(&cells[0].flame) * w[0][0] + four_load(&cells[1].flame) * w[0][1] +
                          four_load(&cells[2].flame) * w[0][2];
            sum += across * (w[2][z] * w[1][y]);
        }
    return (FireCell){sum[0], sum[1], sum[2], sum[3]};
}

typedef struct Noise { float a, b, c, d; } Noise;

/// The whole number below x, and what is left. Places lie within some kilometres, so that it is an int.
static inline int split(float x, float *rest) {
    int whole = (int)x - (x < (float)(int)x);
    *rest = x - (float)whole;
    return whole;
}

/// Four smooth noises from -1 to 1 at q, lattice size 1.
static inline Noise noise_at(const Fire *fire, V3 q) {
    float fx, fy, fz;
    int x = split(q.x, &fx), y = split(q.y, &fy), z = split(q.z, &fz);
    fx = fx * fx * (3 - 2 * fx), fy = fy * fy * (3 - 2 * fy), fz = fz * fz * (3 - 2 * fz);
    Four layer[2];
    for (int k = 0; k < 2; k++) {
        Four a = four_load(fire->noise[fire_noise_at(x, y, z + k)]);
        Four b = four_load(fire->noise[fire_noise_at(x, y + 1, z + k)]);
        a += (four_load(fire->noise[fire_noise_at(x + 1, y, z + k)]) - a) * fx;
        b += (four_load(fire->noise[fire_noise_at(x + 1, y + 1, z + k)]) - b) * fx;
        layer[k] = a + (b - a) * fy;
    }
    Four n = layer[0] + (layer[1] - layer[0]) * fz;
    return (Noise){n[0], n[1], n[2], n[3]};
}

/// Noise of eddies `width` across and `stretch` times as long, that rise; turned so that it lies along no axis.
static inline Noise eddies(const Fire *fire, V3 p, float time, float width, float stretch) {
    const float c = 0.829f, s = 0.559f, tilt = 0.21f; // 34 degrees about the vertical
    float across = 1 / width, z = p.z - RISE * time;
    return noise_at(fire, v3((c * p.x - s * p.y + tilt * z / stretch) * across,
                             (s * p.x + c * p.y) * across + 1.3f * time, z * across / stretch));
}

// ---- what is there

void fire_fill_colours(Preview *preview) {
    for (int i = 0; i < FIRE_COLOURS; i++) {
        float hot = (float)i / (FIRE_COLOURS - 1);
        V3 glow = blackbody_glow(preview->blackbody, mixf(FLAME_COOL, FLAME_HOT, hot));
        float brightness = mixf(FLAME_DIM, FLAME_BRIGHT, hot * hot);
        preview->fire.colours[i] = v3_scale(glow, brightness / maxf(v3_luminance(glow), 1e-6f));
    }
}

static V3 flame_colour(const Fire *fire, float hot) {
    float x = hot * (FIRE_COLOURS - 1);
    int i = (int)minf(x, FIRE_COLOURS - 2);
    return v3_mix(fire->colours[i], fire->colours[i + 1], x - (float)i);
}

V3 fire_emission(const Preview *preview) { return v3_scale(flame_colour(&preview->fire, 1), FLAME_DENSE); }

float fire_share(const FireCell *cell) {
    if (cell->flame <= 0.05f) return 0;
    return stepf(0.1f, 0.6f, cell->flame) * stepf(FLAME_DARK, FLAME_FULL, cell->rise / cell->flame);
}

/// Light that a metre of flame adds and the share that it keeps back.
static V3 shade_flame(const Fire *fire, const FireCell *cell, Noise wide, Noise fine, float *opaque) {
    float rise = cell->rise / cell->flame, torn = stepf(0, 0.08f, rise), present = minf(5 * cell->flame, 1);
    float edge = cell->flame + present * ((0.06f + 0.20f * torn) * wide.c + (0.05f + 0.12f * torn) * fine.c);
    float body = stepf(EDGE_LOW, EDGE_HIGH, edge);
    if (body <= 0) return v3(0, 0, 0);
    float soot = stepf(FLAME_DARK, FLAME_FULL, rise), cooling = stepf(0.035f, FLAME_LONG, rise);
    float hot = stepf(EDGE_LOW, 0.85f, edge) * (1 - 0.5f * cooling) + 0.15f * fine.d;
    float fold = wide.d * 0.75f + 0.25f * fine.c, sheet = maxf(1 - 11 * fold * fold, 0);
    body *= 0.16f + 1.25f * sheet * sheet;
    *opaque = FLAME_OPAQUE * body * soot;
    V3 glow = v3_scale(flame_colour(fire, clampf(hot, 0, 1)), FLAME_DENSE * body * soot);
    return v3_mad(glow, v3(0.45f, 0.9f, 2.2f), body * (1 - soot) * cell->flame);
}

static V3 smoke_colour(const Preview *preview, float glow) {
    // soot and tar send back about a third, to all sides
    return v3_mad(v3_scale(preview->fire.daylight, 0.35f), v3(1, 0.5f, 0.16f), 0.35f * glow);
}

static FireCell cell_at(const Fire *fire, V3 p) {
    return look_up(fire, v3_scale(v3_sub(p, fire->origin), 1 / fire->cell));
}

/// Whether the small eddies can bring flame to p.
static bool may_burn(const Fire *fire, V3 p) {
    V3 g = v3_scale(v3_sub(p, fire->origin), 1 / fire->cell);
    int x = (int)clampf(g.x + 0.5f, 0, (float)(fire->size[0] - 1));
    int y = (int)clampf(g.y + 0.5f, 0, (float)(fire->size[1] - 1));
    int z = (int)clampf(g.z + 0.5f, 0, (float)(fire->size[2] - 1));
    return fire->burns[(size_t)x + (size_t)fire->size[0] * ((size_t)y + (size_t)fire->size[1] * (size_t)z)];
}

/// Flame and smoke at p, as the eddies have shifted them.
static FireCell sample(const Fire *fire, V3 p, float time, int what, V3 *light, float *opaque) {
    Noise wide = eddies(fire, p, time, 0.021f, 2.4f);
    V3 shifted = v3_mad(p, v3(wide.a, wide.b, 0), 0.7f * FIRE_WARP_WIDE);
    if (!may_burn(fire, shifted)) {
        FireCell cell = {0, 0, 0, 0};
        if (what & FIRE_SMOKE) cell = cell_at(fire, shifted), cell.smoke *= maxf(1 + 0.9f * wide.d, 0);
        return cell;
    }
    Noise fine = eddies(fire, shifted, time, 0.0075f, 3.0f);
    shifted = v3_mad(shifted, v3(fine.a, fine.b, 0), 0.7f * FIRE_WARP_FINE);
    FireCell cell = cell_at(fire, shifted);
    if (cell.flame > 0.05f) *light = shade_flame(fire, &cell, wide, fine, opaque);
    cell.smoke *= maxf(1 + 0.9f * wide.d, 0);
    return cell;
}

/// What there is at a place, a metre of it.
typedef struct Matter {
    V3 light;
    float dense; ///< 1/m, extinction
    bool flame;
} Matter;

static Matter matter_at(const Preview *preview, V3 p, int what) {
    const Fire *fire = &preview->fire;
    float time = (float)fmod(preview->time, 1e3);
    Matter m = {{0, 0, 0}, 0, false};
    FireCell cell;
    if (what & FIRE_FLAME) {
        cell = sample(fire, p, time, what, &m.light, &m.dense);
        m.flame = m.light.z > 0;
    } else {
        cell = cell_at(fire, p);
        cell.smoke *= maxf(1 + 0.9f * eddies(fire, p, time, 0.02f, 1.6f).d, 0);
    }
    if (cell.smoke > 0) m.light = v3_mad(m.light, smoke_colour(preview, cell.glow), cell.smoke);
    m.dense += cell.smoke;
    return m;
}

static void add_step(Gathered *g, const Matter *m, float step) {
    float depth = m->dense * step;
    // light of the step, dimmed on its own way out: (1 - exp(-d)) / d
    float kept = expf(-depth), mean = depth > 1e-3f ? (1 - kept) / depth : 1 - 0.5f * depth;
    g->light = v3_mad(g->light, m->light, g->clear * step * mean);
    g->clear *= kept;
}

// ---- along the ray

/// Enters and leaves the bounds. False where the ray misses them.
static bool clip(const Fire *fire, V3 eye, V3 d, float *near, float *far) {
    const float from[3] = {eye.x, eye.y, eye.z}, way[3] = {d.x, d.y, d.z};
    const float low[3] = {fire->low.x, fire->low.y, fire->low.z}, high[3] = {fire->high.x, fire->high.y, fire->high.z};
    *near = 0, *far = INFINITY;
    for (int c = 0; c < 3; c++) {
        float inverse = 1 / (fabsf(way[c]) > 1e-9f ? way[c] : 1e-9f);
        float a = (low[c] - from[c]) * inverse, b = (high[c] - from[c]) * inverse;
        *near = maxf(*near, minf(a, b)), *far = minf(*far, maxf(a, b));
    }
    return *near < *far;
}

/// What the brick at p holds, and how far the ray runs in it from there.
static int look_ahead(const Fire *fire, V3 p, V3 d, float *run) {
    float side = FIRE_BRICK * fire->cell;
    V3 g = v3_scale(v3_sub(p, fire->origin), 1 / side);
    const float at[3] = {g.x, g.y, g.z}, way[3] = {d.x, d.y, d.z};
    int brick[3];
    *run = INFINITY;
    for (int c = 0; c < 3; c++) {
        float f;
        int i = noise_floor(at[c], &f);
        brick[c] = i < 0 ? 0 : i < fire->bricks[c] ? i : fire->bricks[c] - 1;
        if (fabsf(way[c]) > 1e-9f) *run = minf(*run, ((way[c] > 0 ? 1 : 0) - f) * side / way[c]);
    }
    return fire->seen[(size_t)brick[0] + (size_t)fire->bricks[0] * ((size_t)brick[1] + (size_t)fire->bricks[1] *
                      (size_t)brick[2])];
}

void fire_see(const Preview *preview, V3 d, FireView *view) {
    const Fire *fire = &preview->fire;
    V3 eye = preview->camera.eye;
    float t, far, run;
    view->count = 0;
    if (!clip(fire, eye, d, &t, &far)) return;
    Gathered g = {{0, 0, 0}, 1};
    // far away a step must still be one in floats
    float fine = minf(0.35f * fire->cell, 0.0028f), least = maxf((far - t) / (4 * FIRE_STEPS), 1e-5f * far);
    bool dark = true; // longer steps until there is flame
    while (t < far && g.clear > 0.02f) {
        int what = look_ahead(fire, v3_mad(eye, d, t + 1e-5f), d, &run);
        if (!what) {
            t += maxf(minf(run, far - t), 0) + 2e-5f + 1e-6f * t;
            continue;
        }
        bool seek = dark && (what & FIRE_FLAME);
        // steps begin at multiples of their length: neighbouring rays then look at neighbouring places
        float step = maxf(what & FIRE_FLAME ? (dark ? 2 : 1) * fine : fire->cell, least);
        float next = maxf((floorf(t / step + 1e-3f) + 1) * step, t + 0.1f * step);
        step = next - t;
        Matter m = matter_at(preview, v3_mad(eye, d, t + 0.5f * step), what);
        dark = !m.flame;
        if (seek && m.flame) continue; // the same way again in short steps
        add_step(&g, &m, step);
        // the last place takes whatever is left
        int k = view->count < FIRE_STEPS ? view->count++ : FIRE_STEPS - 1;
        view->from[k] = t, t = next, view->distance[k] = t;
        view->light[k] = g.light, view->clear[k] = g.clear;
    }
}

void fire_until(const FireView *view, float distance, V3 *light, float *clear) {
    int low = 0, high = view->count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (view->distance[middle] <= distance) low = middle + 1;
        else high = middle;
    }
    // `low` steps lie wholly in front, and of the next a part
    *light = low ? view->light[low - 1] : v3(0, 0, 0);
    *clear = low ? view->clear[low - 1] : 1;
    if (low < view->count && view->from[low] < distance) {
        float part = (distance - view->from[low]) / (view->distance[low] - view->from[low]);
        *light = v3_mix(*light, view->light[low], part), *clear = mixf(*clear, view->clear[low], part);
    }
}
