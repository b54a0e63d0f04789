// Camera rays and the points at which a picture is sampled.
//
// Sequence: R2 (M. Roberts 2018), x_i = frac(a + i/g), y_i = frac(b + i/g^2) with g = 1.3247..., the root of g^3 = g +
// 1; turned per pixel (Cranley & Patterson 1976) by interleaved gradient noise (Jimenez 2014), whose neighbours differ,
// so that the remaining noise is fine-grained. The lens takes its points from R3 and the time from R1, so that they are
// independent of the light's. They are rotated at random: where a lens spreads a point over many pixels, the gradient
// noise would be visible as a weave.
//
// Thin lens of radius R, sharp at distance f: rays from its points c meet at f. A point at depth z is spread over
// R |1/f - 1/z| at distance 1.

#include "preview/lens.h"

Camera camera_make(const PreviewDef *def) {
    Float3 eye = float3_load(def->camera.eye), forward = float3_sub(float3_load(def->camera.target), eye);
    Camera camera = {.eye = eye, .reach = float3_length(forward)};
    camera.forward = float3_unit_or(forward, float3(0, 1, 0));
    Float3 up = float3_unit_or(float3_load(def->camera.up), float3(0, 0, 1));
    Float3 right = float3_cross(camera.forward, up);

    // looking along `up`: any other direction works
    if (float3_dot(right, right) < 1e-8f)
        right = float3_cross(camera.forward, fabsf(camera.forward.y) < 0.9f ? float3(0, 1, 0) : float3(1, 0, 0));
    right = float3_unit_or(right, float3(1, 0, 0));
    float half = tanf(0.5f * def->camera.fov), aspect = (float)def->width / (float)def->height;
    camera.up = float3_scale(float3_cross(right, camera.forward), half);
    camera.right = float3_scale(right, half * aspect);
    camera.pixel = 2 * half / (float)def->height;
    camera.lens = 0.5f * def->camera.aperture;
    camera.focus = def->camera.focus > 0 ? def->camera.focus : camera.reach;
    camera.lens_right = float3_scale(right, camera.lens);
    camera.lens_up = float3_scale(float3_cross(right, camera.forward), camera.lens);

    return camera;
}

/// x and y run from -1 to 1, left to right and bottom to top.
void camera_ray(const Camera *camera, float x, float y, const float disc[2], Float3 *origin, Float3 *direction) {
    Float3 d = float3_mad(float3_mad(camera->forward, camera->right, x), camera->up, y);
    *origin = camera->eye;
    if (camera->lens > 0) {
        Float3 aside = float3_mad(float3_scale(camera->lens_right, disc[0]), camera->lens_up, disc[1]);
        *origin = float3_add(camera->eye, aside);
        d = float3_mad(d, aside, -1 / camera->focus);
    }

    *direction = float3_scale(d, 1 / float3_length(d));
}

float camera_blur(const Camera *camera, float depth) {
    if (!(camera->lens > 0)) return 0;
    return camera->lens * fabsf(1 / camera->focus - 1 / depth) / camera->pixel;
}

static float fraction(float x) { return x - (float)(int)x; }

void sample_square(uint32_t index, float a, float b, float out[2]) {
    out[0] = fraction(a + 0.75487767f * (float)index);
    out[1] = fraction(b + 0.56984029f * (float)index);
}

uint32_t sample_key(int x, int y, uint32_t seed) {
    return hash_u32((uint32_t)x * 0x8da6b343u ^ (uint32_t)y * 0xd8163841u ^ seed * 0xcb1ab31fu);
}

void sample_lens(uint32_t index, uint32_t key, float out[2]) {
    out[0] = fraction((float)(key & 0xffff) / 65536 + 0.81917251f * (float)index);
    out[1] = fraction((float)(key >> 16) / 65536 + 0.67104360f * (float)index);
}

float sample_time(uint32_t index, uint32_t key) { return fraction(hash_unit(key) + 0.61803399f * (float)index); }

float sample_half(uint32_t index) {
    float out = 0, half = 0.5f;
    for (; index; index /= 2, half *= 0.5f) out += index % 2 ? half : 0;
    return out;
}

void sample_pixel(int x, int y, uint32_t seed, float out[2]) {
    float px = (float)(x + (int)(seed & 63)), py = (float)(y + (int)(seed >> 6 & 63));
    out[0] = fraction(52.9829189f * fraction(0.06711056f * px + 0.00583715f * py));
    out[1] = fraction(52.9829189f * fraction(0.06711056f * (py + 47) + 0.00583715f * (px + 17)));
}

/// sin(pi x) for x in [-1, 1], to 1e-3: enough to choose a direction.
static float sine(float x) {
    float y = 4 * x * (1 - fabsf(x));
    return y * (0.775f + 0.225f * fabsf(y));
}

void sample_disc(const float square[2], float out[2]) {
    float r = sqrtf(square[0]), x = 2 * square[1] - 1, quarter = x + 0.5f;
    out[0] = r * sine(quarter > 1 ? quarter - 2 : quarter);
    out[1] = r * sine(x);
}

Float3 sample_cosine(Float3 normal, const float square[2]) {
    Float3 a, b;
    float disc[2];
    float3_frame(normal, &a, &b);
    sample_disc(square, disc);
    float height = sqrtf(maxf(0.0f, 1 - square[0]));
    return float3_mad(float3_mad(float3_scale(normal, height), a, disc[0]), b, disc[1]);
}
