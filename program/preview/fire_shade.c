// Flame and smoke at a position.
//
// The gas comes in cells of several millimetres and is interpolated by quadratic B-splines, so its cells are not
// visible. Finer detail is added: the lookup position is shifted by noise (domain warping), which rises with the gas and
// grows longer as the gas accelerates, so flames have tongues and streaks and flicker.
//
// A flame over paper is a thin sheet of burning gas around clear, hot vapour. With f the share that burns, r the height
// above the paper and N noise of the width of a tongue, it lies where
//
//     e = f + a(r) N - c (r / H)^2 = EDGE,   H = (1 + h N) FLAME_HEIGHT,
//
// thin, with a fainter glow inside. It begins at the paper, is faint and blue in the first millimetres, where there is no
// soot yet, yellow above, orange and torn at its tips. Soot glows as a black body between FLAME_COOL and FLAME_HOT; it
// hides almost nothing behind it.

#include "preview/internal.h"

// Gas leaves the paper slowly and accelerates: v^2 = BASE_SPEED^2 + 2 BUOYANCY h at the height h. An eddy that was formed
// at the base grows longer as it rises, and moves by the same share of its length in every frame.
#define BASE_SPEED 0.14f ///< m/s
#define BUOYANCY 5.0f    ///< m/s2
#define EDDY_RATE 8.0f   ///< 1/s, eddies that pass a height

#define FLAME_COOL 1350.0f ///< K
#define FLAME_HOT 2050.0f
#define FLAME_DIM 0.25f ///< radiance of a thick flame at its coolest and its hottest
#define FLAME_BRIGHT 4.6f
#define SOOT_DENSE 12.5f    ///< 1/m: radiance per metre relative to that of a thick flame
#define SOOT_OPAQUE 6.0f    ///< 1/m, extinction
#define BLUE_DENSE 1.2f     ///< 1/m: radiance of the base per metre
#define EDGE 0.19f          ///< burning share at a flame's edge
#define STAND_OFF 0.0006f   ///< m above the paper, below which nothing is visible
#define SOOT_BEGINS 0.0034f ///< m
#define SOOT_FULL 0.0125f

// ---- looking up

typedef struct Noise {
    float a, b, c, d;
} Noise;

/// The integer part of x, and the rest. Positions are within some kilometres, so it fits an int.
static inline int fire_split(float x, float *rest) {
    int whole = (int)x - (x < (float)(int)x);
    *rest = x - (float)whole;
    return whole;
}

/// Four smooth noises from -1 to 1 at q, lattice size 1.
static inline Noise noise_at(const Fire *fire, Float3 q) {
    float fx, fy, fz;
    int x = fire_split(q.x, &fx), y = fire_split(q.y, &fy), z = fire_split(q.z, &fz);
    fx = fx * fx * (3 - 2 * fx);
    fy = fy * fy * (3 - 2 * fy);
    fz = fz * fz * (3 - 2 * fz);
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

/// The number of eddies that have passed the height since the start: grows with time, and by one over each eddy.
static inline float eddies_passed(float height, float time) {
    float speed = sqrtf(BASE_SPEED * BASE_SPEED + 2 * BUOYANCY * maxf(height, 0));
    return EDDY_RATE * (time - (speed - BASE_SPEED) / BUOYANCY) - minf(height, 0) * EDDY_RATE / BASE_SPEED;
}

/// Noise of eddies `width` across, of which `often` pass where one of the largest does; rotated away from the axes.
static inline Noise eddies(const Fire *fire, Float3 p, float passed, float width, float often) {
    const float c = 0.829f, s = 0.559f; // 34 degrees around the vertical
    float across = 1 / width;
    return noise_at(fire, float3((c * p.x - s * p.y) * across + 0.21f * passed,
                                 (s * p.x + c * p.y) * across + 0.17f * passed, -often * passed));
}

// ---- flame and smoke

void fire_fill_colours(Preview *preview) {
    for (int i = 0; i < FIRE_COLOURS; i++) {
        float hot = (float)i / (FIRE_COLOURS - 1);
        Float3 glow = blackbody_glow(preview->blackbody, mixf(FLAME_COOL, FLAME_HOT, hot));
        float brightness = mixf(FLAME_DIM, FLAME_BRIGHT, hot * hot);
        preview->fire.colours[i] = float3_scale(glow, brightness / maxf(float3_luminance(glow), 1e-6f));
    }
}

static Float3 flame_colour(const Fire *fire, float hot) {
    float x = hot * (FIRE_COLOURS - 1);
    int i = (int)minf(x, FIRE_COLOURS - 2);
    return float3_mix(fire->colours[i], fire->colours[i + 1], x - (float)i);
}

Float3 fire_emission(const Preview *preview) { return float3_scale(flame_colour(&preview->fire, 1), 103); }

float fire_share(const FireCell *cell) {
    if (cell->flame <= 0.05f) return 0;
    float rise = cell->rise / cell->flame;
    return stepf(0.1f, 0.6f, cell->flame) * stepf(SOOT_BEGINS, SOOT_FULL, rise);
}

float fire_flicker(const Fire *fire, Float3 p) {
    Noise whole = noise_at(fire, float3(0.4f, 0.6f, 6 * fire->moment));
    Noise part = eddies(fire, p, EDDY_RATE * fire->moment, 0.04f, 1);
    return maxf(1 + 0.5f * whole.a + 0.8f * part.c, 0.1f);
}

/// Emission and absorption of flame per metre.
static Float3 shade_flame(const Fire *fire, const FireCell *cell, Noise wide, Noise fine, float *opaque) {
    float rise = cell->rise / cell->flame, stand = stepf(STAND_OFF, 4 * STAND_OFF, rise);
    if (stand <= 0) return float3(0, 0, 0);
    float tall = maxf(rise, 0) / (FLAME_HEIGHT * (1 + 0.6f * wide.c + 0.25f * fine.c)), torn = stepf(0, 0.018f, rise);
    float present = minf(5 * cell->flame, 1);
    float edge = cell->flame + present * ((0.05f + 0.13f * torn) * wide.c + (0.03f + 0.10f * torn) * fine.c);
    edge -= EDGE + 0.09f * tall * tall;
    float body = stepf(0, 0.05f, edge);
    if (body <= 0) return float3(0, 0, 0);

    float fold = 0.8f * wide.d + 0.35f * fine.c, sheet = maxf(1 - 20 * fold * fold, 0);
    float soot = stepf(SOOT_BEGINS, SOOT_FULL, rise + 0.0025f * fine.d), cooling = stepf(0.4f, 1.5f, tall);
    soot *= soot;
    float thin = mixf(0.14f, 0.04f + 1.2f * sheet * sheet, torn) * body;
    float hot = 0.50f + 0.3f * stepf(0.05f, 0.3f, edge) + 0.2f * sheet - 0.45f * cooling + 0.12f * fine.d;
    *opaque = SOOT_OPAQUE * thin * soot;
    Float3 glow = float3_scale(flame_colour(fire, clampf(hot, 0, 1)), SOOT_DENSE * thin * soot);

    return float3_mad(glow, float3(0.22f, 0.50f, 1.25f), BLUE_DENSE * body * stand * (1 - soot));
}

/// Quadratic B-spline over 3 x 3 x 3 cells at p.
static FireCell cell_at(const Fire *fire, Float3 p) {
    const Float3 g = float3_scale(float3_sub(p, fire->origin), 1 / fire->cell); // cells from the centre of the first
    float f[3], w[3][3];
    int base[3];
    const float at[3] = {g.x, g.y, g.z};

    for (int c = 0; c < 3; c++) {
        float bounded = clampf(at[c], 1, (float)(fire->size[c] - 2));
        base[c] = (int)(bounded + 0.5f) - 1;
        base[c] = base[c] > fire->size[c] - 3 ? fire->size[c] - 3 : base[c];
        f[c] = bounded - (float)(base[c] + 1);
        w[c][0] = 0.5f * (0.5f - f[c]) * (0.5f - f[c]);
        w[c][1] = 0.75f - f[c] * f[c];
        w[c][2] = 0.5f * (0.5f + f[c]) * (0.5f + f[c]);
    }

    Four sum = {0, 0, 0, 0};
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++) {
            size_t row = (size_t)base[0] + (size_t)fire->size[0] *
                                               ((size_t)(base[1] + y) + (size_t)fire->size[1] * (size_t)(base[2] + z));
            const FireCell *cells = &fire->cells[row];
            Four across = four_load(&cells[0].flame) * w[0][0] + four_load(&cells[1].flame) * w[0][1] +
                          four_load(&cells[2].flame) * w[0][2];
            sum += across * (w[2][z] * w[1][y]);
        }

    return (FireCell){sum[0], sum[1], sum[2], sum[3]};
}

/// Flame and smoke at p, as the eddies have shifted them.
static FireCell fire_sample(const Fire *fire, Float3 p, int what, Float3 *light, float *opaque) {
    FireCell cell = cell_at(fire, p);
    float height = cell.flame > 1e-4f ? cell.rise / cell.flame : p.z - fire->low.z;
    float passed = eddies_passed(height, fire->moment);
    Noise wide = eddies(fire, p, passed, 0.019f, 1);
    Float3 shifted = float3_mad(p, float3(wide.a, wide.b, 0), 0.7f * FIRE_WARP_WIDE);

    // whether the small eddies can bring flame there
    Float3 g = float3_scale(float3_sub(shifted, fire->origin), 1 / fire->cell);
    size_t x = (size_t)clampf(g.x + 0.5f, 0, (float)(fire->size[0] - 1));
    size_t y = (size_t)clampf(g.y + 0.5f, 0, (float)(fire->size[1] - 1));
    size_t z = (size_t)clampf(g.z + 0.5f, 0, (float)(fire->size[2] - 1));

    if (fire->burns[x + (size_t)fire->size[0] * (y + (size_t)fire->size[1] * z)]) {
        Noise fine = eddies(fire, shifted, passed, 0.0075f, 1.7f);
        cell = cell_at(fire, float3_mad(shifted, float3(fine.a, fine.b, 0), 0.7f * FIRE_WARP_FINE));
        if (cell.flame > 0.05f) *light = shade_flame(fire, &cell, wide, fine, opaque);
    } else if (what & FIRE_SMOKE) {
        cell = cell_at(fire, shifted);
    }

    cell.smoke *= maxf(1 + 0.9f * wide.d, 0);
    return cell;
}

Matter fire_matter(const Preview *preview, Float3 p, int what) {
    const Fire *fire = &preview->fire;
    Matter m = {{0, 0, 0}, 0, false};
    FireCell cell;

    if (what & FIRE_FLAME) {
        cell = fire_sample(fire, p, what, &m.light, &m.dense);
        m.flame = m.light.z > 0;
    } else {
        cell = cell_at(fire, p);
        cell.smoke *= maxf(1 + 0.9f * eddies(fire, p, eddies_passed(p.z - fire->low.z, fire->moment), 0.02f, 1).d, 0);
    }

    // soot and tar scatter about a third, in all directions
    Float3 lit = float3_mad(float3_scale(fire->daylight, 0.35f), float3(1, 0.5f, 0.16f), 0.35f * cell.glow);
    if (cell.smoke > 0) m.light = float3_mad(m.light, lit, cell.smoke);
    m.dense += cell.smoke;
    return m;
}

// ---- for programs that draw the cells themselves

SingeResult preview_bake_gas(Preview *preview, const SingeSurface *surface, double time, int detail, float *smoke,
                             float *flame, SingeError *error) {
    const Fire *fire = &preview->fire;
    if (!isfinite(time) || detail < 1 || detail > PREVIEW_BAKE_MAX)
        return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the time is not finite, or the detail is not 1 to %d",
                            PREVIEW_BAKE_MAX);
    if (!fire->size[0]) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "there is no gas");

    preview->time = time;
    SingeResult result = tracer_load(preview, surface, error);
    if (result) return result;

    fire_raise(preview);

    const float side = fire->cell / (float)detail, first = (FIRE_BORDER - 0.5f) * fire->cell + 0.5f * side;
    const float brightest = SOOT_DENSE * float3_luminance(fire->colours[FIRE_COLOURS - 1]);
    const Float3 origin = float3_add(fire->origin, float3(first, first, first));
    int size[3];

    for (int c = 0; c < 3; c++) size[c] = (fire->size[c] - 2 * FIRE_BORDER) * detail;
    size_t i = 0;
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++, i++) {
                const Float3 p = float3_mad(origin, float3((float)x, (float)y, (float)z), side);
                Float3 light = {0, 0, 0};
                float opaque = 0;
                const FireCell cell = fire_sample(fire, p, FIRE_FLAME | FIRE_SMOKE, &light, &opaque);
                flame[i] = float3_luminance(light) / brightest;
                smoke[i] = maxf(cell.smoke, 0);
            }

    return SINGE_OK;
}
