// The table and what lies behind it. The table is planks of wood along x: each plank has its own tone and grain;
// the grain is noise stretched along the plank and bent by slower noise, as year rings are where a saw cut them
// at a low angle. Every octave fades when a pixel no longer resolves it.

#include "preview/internal.h"

static const float plank_width = 0.145f;

static float visible(float metres, float footprint) { return clampf(1.5f - 0.9f * footprint / metres, 0, 1); }

static V3 wood(const Preview *preview, float x, float y, float footprint) {
    uint32_t seed = preview->def.seed + 77;
    float across, lane = y / plank_width;
    int plank = noise_floor(lane, &across);
    uint32_t key = hash_u32((uint32_t)plank * 0x9e3779b1u + seed);
    float tone = hash_unit(key), shift = 40 * hash_unit(key + 1), u = x + shift, v = y;
    float bend = 0.020f * noise2(u * 2.1f, v * 9 + shift, seed) + 0.006f * noise2(u * 7, v * 26, seed + 1);
    float rings = noise2((u + bend) * 0.7f, (v + bend) * 95, seed + 2) * visible(0.012f, footprint);
    float fine = noise2(u * 6, (v + 0.6f * bend) * 420, seed + 3) * visible(0.0024f, footprint);
    float pores = noise2(u * 60, v * 1500, seed + 4) * visible(0.0008f, footprint);
    float blotch = noise2(u * 3.3f, v * 5, seed + 5);
    float value = 0.86f + 0.22f * (tone - 0.5f) + 0.17f * rings + 0.10f * fine + 0.07f * blotch;
    value -= 0.22f * stepf(0.35f, 0.8f, pores);
    // a dark, slightly soft joint between planks
    float edge = minf(across, 1 - across) * plank_width, soft = maxf(0.0011f, 0.7f * footprint);
    value *= 1 - 0.68f * (1 - stepf(0.0003f, soft + 0.0003f, edge)) * minf(1, 0.0016f / footprint);
    // what is dark is also redder
    float warm = clampf(0.95f - value, -0.3f, 0.5f);
    return v3_scale(v3(1 + 0.14f * warm, 1 - 0.06f * warm, 1 - 0.24f * warm), maxf(value, 0.05f));
}

V3 background_colour(const Preview *preview, V3 direction) {
    V3 base = v3_load(preview->def.background);
    float height = clampf(direction.z * 1.6f, -0.6f, 1);
    return v3_scale(base, height > 0 ? mixf(1.12f, 0.62f, height) : mixf(1.12f, 0.75f, -height));
}

/// A pixel's size on the table: the mean of along and across.
static float footprint(const Preview *preview, float distance, float cosine) {
    return preview->camera.pixel * distance / sqrtf(maxf(fabsf(cosine), 0.02f));
}

V3 ground_albedo(const Preview *preview, V3 direction, float distance) {
    V3 p = v3_mad(preview->camera.eye, direction, distance);
    return v3_mul(v3_load(preview->def.ground_colour),
                  wood(preview, p.x, p.y, footprint(preview, distance, direction.z)));
}

void ground_shade(const Preview *preview, float distance, V3 albedo, Point *point) {
    float cosine = maxf(fabsf(point->view.z), 0.02f);
    point->footprint = footprint(preview, distance, cosine);
    float far = distance / (9 * preview->camera.reach);
    point->fade = 1 - expf(-far * far * far);
    point->normal = point->geometric = v3(0, 0, point->view.z >= 0 ? 1.0f : -1.0f);
    point->albedo = albedo;
    point->gloss = 0.045f, point->shininess = 26;
    // a waxed table mirrors a little of the sky at grazing angles (Schlick)
    float grazing = 1 - cosine, mirror = 0.22f * grazing * grazing * grazing * grazing * grazing;
    point->emission = v3_scale(v3_load(preview->def.background), mirror);
}
