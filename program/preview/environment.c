// Ambient light: a small picture of the sky by direction, a blurred copy for dull reflections, and the irradiance by
// normal, as spherical harmonics of order 2 (Ramamoorthi & Hanrahan 2001):
//
//     E(n)/pi = sum_lm A_l L_lm Y_lm(n),   L_lm = integral L Y_lm dw,   A_0 = 1, A_1 = 2/3, A_2 = 1/4
//
// Below the horizon it is the light reflected by the ground. Every kind of sky is scaled so that an upward surface in
// the open gets as much light as from an even sky.

#include "preview/internal.h"

/// Direction of the centre of a cell. Its centre longitude lies towards +y.
static Float3 sky_direction(int row, int column) {
    float polar = PI_F * ((float)row + 0.5f) / SKY_DOWN;
    float azimuth = 2 * PI_F * (((float)column + 0.5f) / SKY_ACROSS - 0.5f);
    return float3(sinf(polar) * sinf(azimuth), sinf(polar) * cosf(azimuth), cosf(polar));
}

static float solid_angle(int row) {
    float top = cosf(PI_F * (float)row / SKY_DOWN), bottom = cosf(PI_F * (float)(row + 1) / SKY_DOWN);
    return (top - bottom) * 2 * PI_F / SKY_ACROSS;
}

/// A soft-edged lamp around a direction, by angles across and up from it.
static float lamp(Float3 d, float azimuth, float height, float half_width, float half_height, float soft) {
    float a = atan2f(d.x, d.y) - azimuth, h = asinf(clampf(d.z, -1, 1)) - height;
    if (a > PI_F) a -= 2 * PI_F;
    if (a < -PI_F) a += 2 * PI_F;
    return (1 - stepf(half_width - soft, half_width + soft, fabsf(a))) *
           (1 - stepf(half_height - soft, half_height + soft, fabsf(h)));
}

/// The unscaled sky, above the horizon or, for a picture, all around.
static Float3 sky_light(const Preview *preview, int row, int column) {
    Float3 d = sky_direction(row, column), sun = preview->sun;
    float turn = -preview->def.sky_turn, c = cosf(turn), s = sinf(turn);
    d = float3(c * d.x - s * d.y, s * d.x + c * d.y, d.z);

    switch (preview->def.sky) {
    case PREVIEW_SKY_STUDIO: {
        // a dim room: a tall cool window across from the sun, a warm lamp behind it, a ceiling that takes a little of
        // both
        float azimuth = atan2f(sun.x, sun.y);
        float window = lamp(d, azimuth + 2.1f, 0.62f, 0.42f, 0.45f, 0.16f);
        float warm = lamp(d, azimuth - 0.9f, 0.45f, 0.30f, 0.22f, 0.14f), ceiling = stepf(0.55f, 1.0f, d.z);
        Float3 light = float3_scale(float3(0.36f, 0.37f, 0.40f), 0.75f + 0.5f * ceiling);
        light = float3_mad(light, float3(3.4f, 3.9f, 4.7f), window);
        return float3_mad(light, float3(4.2f, 2.9f, 1.7f), warm);
    }
    case PREVIEW_SKY_OPEN: {
        // outdoors: bluer overhead, pale at the horizon and around the sun
        float haze = expf(-4.5f * maxf(d.z, 0)), near = maxf(float3_dot(d, sun), 0), near2 = near * near,
              near8 = near2 * near2;
        near8 *= near8;
        Float3 light = float3_mix(float3(0.62f, 0.86f, 1.30f), float3(1.45f, 1.35f, 1.22f), haze);
        return float3_mad(light, float3(1.5f, 1.25f, 0.9f), 0.35f * near2 + 1.3f * near8);
    }
    case PREVIEW_SKY_PICTURE: {
        // mean of a cell of the picture
        const Image *image = preview->def.sky_picture;
        float across = (atan2f(d.x, d.y) / (2 * PI_F) + 0.5f) * SKY_ACROSS;
        int seen = (int)clampf(across, 0, SKY_ACROSS - 1);
        int x0 = seen * image->width / SKY_ACROSS, x1 = (seen + 1) * image->width / SKY_ACROSS;
        int y0 = row * image->height / SKY_DOWN, y1 = (row + 1) * image->height / SKY_DOWN;
        x1 = x1 > x0 ? x1 : x0 + 1;
        y1 = y1 > y0 ? y1 : y0 + 1;
        Float3 sum = {0, 0, 0};
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++) {
                const uint8_t *p = image->rgb + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
                sum = float3_add(sum, float3(preview->linear[p[0]], preview->linear[p[1]], preview->linear[p[2]]));
            }
        return float3_scale(sum, 1 / (float)((x1 - x0) * (y1 - y0)));
    }
    default: return float3(1, 1, 1);
    }
}

/// Scales the upper half so that its mean, weighted as on an upward surface, is the sky's colour; fills the lower one.
static void fill_radiance(Preview *preview) {
    Sky *sky = &preview->sky;
    const PreviewDef *def = &preview->def;
    bool pictured_below = def->sky == PREVIEW_SKY_PICTURE && !isfinite(def->ground_height);
    float total = 0;

    for (int row = 0; row < SKY_DOWN; row++)
        for (int column = 0; column < SKY_ACROSS; column++) {
            sky->radiance[row][column] = sky_light(preview, row, column);
            float weight = solid_angle(row) * maxf(sky_direction(row, column).z, 0);
            total += weight * float3_luminance(sky->radiance[row][column]);
        }
    Float3 colour = float3_scale(float3_load(def->sky_colour), FILM_SPEED), bounce = float3_scale(colour, 0.5f);
    float height = maxf(preview->sun.z, 0), scale = total > 0 ? PI_F / total : 0;
    if (isfinite(def->ground_height))
        bounce = float3_mul(float3_load(def->ground_colour),
                            float3_mad(colour, float3_scale(preview->sun_light, height), 0.8f));
    for (int row = 0; row < SKY_DOWN; row++)
        for (int column = 0; column < SKY_ACROSS; column++) {
            bool above = row < SKY_DOWN / 2 || pictured_below;
            Float3 light = float3_mul(float3_scale(sky->radiance[row][column], scale), colour);
            sky->radiance[row][column] = above ? light : bounce;
        }
}

void sky_fill(Preview *preview) {
    static const float share[9] = {1, 2.0f / 3, 2.0f / 3, 2.0f / 3, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f};
    Sky *sky = &preview->sky;
    fill_radiance(preview);

    Float3 direction[SKY_DOWN][SKY_ACROSS];
    for (int k = 0; k < 9; k++) sky->ambient[k] = float3(0, 0, 0);
    for (int row = 0; row < SKY_DOWN; row++)
        for (int column = 0; column < SKY_ACROSS; column++) {
            const float angle = solid_angle(row);
            const Float3 d = direction[row][column] = sky_direction(row, column);
            const float y[9] = {
                0.282095f,
                0.488603f * d.y,
                0.488603f * d.z,
                0.488603f * d.x,
                1.092548f * d.x * d.y,
                1.092548f * d.y * d.z,
                0.315392f * (3 * d.z * d.z - 1),
                1.092548f * d.x * d.z,
                0.546274f * (d.x * d.x - d.y * d.y),
            };
            for (int k = 0; k < 9; k++)
                sky->ambient[k] = float3_mad(sky->ambient[k], sky->radiance[row][column], angle * y[k] * share[k]);
        }

    // each cell of the blurred copy: the mean of its surroundings, weighted by cos^16 of the angle
    for (int cell = 0; cell < SKY_DOWN * SKY_ACROSS; cell++) {
        Float3 d = direction[cell / SKY_ACROSS][cell % SKY_ACROSS], sum = {0, 0, 0};
        float total = 0;
        for (int row = 0; row < SKY_DOWN; row++) {
            float angle = solid_angle(row);
            for (int column = 0; column < SKY_ACROSS; column++) {
                float w = float3_dot(d, direction[row][column]);
                if (w <= 0.5f) continue;
                w *= w;
                w *= w;
                w *= w;
                w *= w;
                w *= angle;
                sum = float3_mad(sum, sky->radiance[row][column], w);
                total += w;
            }
        }

        sky->blurred[cell / SKY_ACROSS][cell % SKY_ACROSS] = float3_scale(sum, 1 / total);
    }
}

Float3 sky_ambient(const Sky *sky, Float3 n) {
    const Float3 *a = sky->ambient;
    Float3 sum = float3_scale(a[0], 0.282095f);
    sum = float3_mad(float3_mad(float3_mad(sum, a[1], 0.488603f * n.y), a[2], 0.488603f * n.z), a[3], 0.488603f * n.x);
    sum = float3_mad(float3_mad(sum, a[4], 1.092548f * n.x * n.y), a[5], 1.092548f * n.y * n.z);
    sum = float3_mad(float3_mad(sum, a[6], 0.315392f * (3 * n.z * n.z - 1)), a[7], 1.092548f * n.x * n.z);
    sum = float3_mad(sum, a[8], 0.546274f * (n.x * n.x - n.y * n.y));
    return float3(maxf(sum.x, 0), maxf(sum.y, 0), maxf(sum.z, 0));
}

Float3 sky_mirrored(const Sky *sky, Float3 d) {
    // atan2(x, y) / 2 pi by atan(r) = r (pi/4 + 0.273 (1 - r)), to 1e-3: enough for a cell of the sky
    float ax = fabsf(d.x), ay = fabsf(d.y), small = minf(ax, ay), large = maxf(maxf(ax, ay), 1e-20f);
    float r = small / large, turn = r * (0.125f + 0.04345f * (1 - r));
    turn = ax > ay ? 0.25f - turn : turn;
    turn = d.y < 0 ? 0.5f - turn : turn;
    turn = d.x < 0 ? -turn : turn;
    float across = (turn + 0.5f) * SKY_ACROSS - 0.5f;

    // acos by a square root times a line (Abramowitz & Stegun 4.4.45, its first terms)
    float z = fabsf(d.z), polar = sqrtf(maxf(1 - z, 0)) * (1.5707f - 0.2121f * z + 0.0742f * z * z);
    float down = (d.z < 0 ? PI_F - polar : polar) / PI_F * SKY_DOWN - 0.5f, fx, fy;
    int x = noise_floor(across, &fx), y = noise_floor(clampf(down, 0, SKY_DOWN - 1.001f), &fy);
    int x0 = (x + SKY_ACROSS) % SKY_ACROSS, x1 = (x0 + 1) % SKY_ACROSS;
    return float3_mix(float3_mix(sky->blurred[y][x0], sky->blurred[y][x1], fx),
                      float3_mix(sky->blurred[y + 1][x0], sky->blurred[y + 1][x1], fx), fy);
}
