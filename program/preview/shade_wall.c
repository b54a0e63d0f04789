// The wall behind the scene: it catches the fire's light and the shadows of what burns.
//
// Plaster is trowelled and rolled: broad patches, the trowel's sweeps and the roller's grain, a few hairline cracks. Bricks
// lie in a stretcher bond of rows of 75 mm; each has its own tone, pits and worn edges, and mortar stands behind its face.
// Every octave fades when a pixel no longer resolves it.

#include "preview/ground.h"
#include "preview/internal.h"

#define BRICK_LONG 0.225f  ///< m, with a joint
#define BRICK_HIGH 0.075f  ///< m, with a joint
#define BRICK_JOINT 0.010f ///< m

/// Noise of the face, its slope added to the tilt. Those of odd and even seeds are turned by 45 degrees against each other, or
/// the squares of their lattices would show as blocks where light grazes the wall.
static float rough(float u, float v, float metres, float height, uint32_t seed, float footprint, Table *table) {
    const float shown = visible(metres, footprint), e = 0.25f;
    if (shown <= 0) return 0;
    const float c = seed & 1 ? 0.966f : 0.5f, s = seed & 1 ? 0.259f : 0.866f;
    const float x = (c * u - s * v) / metres, y = (c * v + s * u) / metres;
    const float n = noise2(x, y, seed), step = shown * height / e;
    const float dx = step * (noise2(x + e, y, seed) - n), dy = step * (noise2(x, y + e, seed) - n);
    table->tilt[0] -= c * dx + s * dy;
    table->tilt[1] -= c * dy - s * dx;
    return shown * n;
}

static void plaster(float u, float v, uint32_t seed, float footprint, Table *table) {
    const float patch = noise2(u * 1.7f, v * 1.7f, seed), cloud = noise2(u * 6, v * 6, seed + 1);
    const float bend = 0.05f * noise2(u * 5, v * 5, seed + 2);
    const float sweep = rough(u + bend, 2.6f * v + bend, 0.09f, 0.020f, seed + 3, footprint, table);
    const float hand = rough(u, v, 0.022f, 0.016f, seed + 4, footprint, table);
    const float grain = rough(u, v, 0.0037f, 0.035f, seed + 5, footprint, table) +
                        rough(u, v, 0.0033f, 0.037f, seed + 10, footprint, table);
    float value = 0.94f + 0.08f * patch + 0.07f * cloud + 0.05f * sweep + 0.04f * hand + 0.05f * grain;

    // a crack follows where two slow noises are equal, and only in places
    const float fray = 0.02f * noise2(u * 24, v * 24, seed + 6) + 0.006f * noise2(u * 90, v * 90, seed + 7);
    const float line = fabsf(noise2(u * 1.9f + fray, v * 1.3f + fray, seed + 8)) / 1.9f; // m, about
    const float crack = (1 - stepf(0.0003f, 0.0012f + 0.7f * footprint, line)) *
                        stepf(0.1f, 0.5f, noise2(u * 1.1f, v * 1.1f, seed + 9));
    value *= 1 - 0.5f * crack * minf(1, 0.0015f / footprint);
    table->albedo = float3_scale(float3(1 + 0.02f * cloud, 1, 1 - 0.03f * patch), value);
}

static void brick(float u, float v, uint32_t seed, float footprint, Table *table) {
    // joints are not ruled
    const float sag = 0.0016f * noise2(u * 7, v * 7, seed), lean = 0.0016f * noise2(u * 7, v * 7, seed + 1);
    float along, up;
    const int row = noise_floor((v + sag) / BRICK_HIGH, &up);
    const int column = noise_floor((u + lean) / BRICK_LONG + (row % 2 ? 0.5f : 0), &along);
    const uint32_t key = sample_key(row, column, seed);
    along *= BRICK_LONG;
    up *= BRICK_HIGH;
    const float side = minf(along, BRICK_LONG - along), end = minf(up, BRICK_HIGH - up);
    const float wear = 0.0022f * noise2(u * 130, v * 130, seed + 2) + 0.0012f * noise2(u * 420, v * 420, seed + 3);
    const float edge = minf(side, end) - 0.5f * BRICK_JOINT + wear; // m into the brick
    const float soft = maxf(0.0012f, 0.6f * footprint), face = stepf(-soft, soft, edge);

    // worn edges lean towards the joint, which lies back in their shadow
    const float bevel = (1 - stepf(0, 0.005f, fabsf(edge))) * visible(0.004f, footprint);
    if (side < end) table->tilt[0] += 0.5f * bevel * (along < 0.5f * BRICK_LONG ? -1.0f : 1.0f);
    else table->tilt[1] += 0.5f * bevel * (up < 0.5f * BRICK_HIGH ? -1.0f : 1.0f);

    const float cloud = noise2(u * 16, v * 16, key & 255),
                lump = rough(u, v, 0.011f, 0.05f, seed + 5, footprint, table);
    const float grain = rough(u, v, 0.0022f, 0.08f, seed + 6, footprint, table);
    const float open =
        noise2(u * 340 + v * 150, v * 340 - u * 150, seed + 7) + 0.5f * noise2(u * 900, v * 900, seed + 9);
    const float pit = stepf(0.55f, 0.9f, open) * visible(0.002f, footprint);
    const float tone = hash_unit(key), hue = hash_unit(key + 1) - 0.5f;
    float value = 0.94f + 0.55f * tone + 0.20f * cloud + 0.10f * lump + 0.12f * grain;
    value *= (1 - 0.45f * pit) * (hash_unit(key + 2) < 0.08f ? 0.6f : 1); // one in twelve is burnt dark
    value *=
        1 - 0.35f * hash_unit(key + 3) * stepf(0.2f, 1, fabsf(2 * along / BRICK_LONG - 1)); // and many at their ends
    Float3 clay =
        float3_scale(float3(0.56f + 0.14f * hue, 0.31f + 0.05f * hue, 0.22f - 0.03f * hue), maxf(value, 0.1f));

    // lime comes out of the joints and blooms on the faces; mortar stands back in the shadow of the brick above
    const float lime =
        stepf(0.0f, 0.9f, noise2(u * 9, v * 13, seed + 10) + 0.4f * noise2(u * 70, v * 70, seed + 11) - 18 * edge);
    clay = float3_mix(clay, float3(0.60f, 0.55f, 0.50f), 0.35f * lime);
    const float mortar = 0.62f + 0.10f * noise2(u * 60, v * 60, seed + 8) + 0.12f * grain;
    const float shadow = 1 - (up > 0.5f * BRICK_HIGH ? 0.1f : 0.45f) * stepf(-0.006f, 0, edge) * (1 - face);
    table->albedo = float3_mix(float3_scale(float3(1, 0.95f, 0.86f), mortar * shadow), clay, face);
}

float wall_hit(const Preview *preview, Float3 origin, Float3 direction) {
    if (!isfinite(preview->def.wall_distance)) return INFINITY;
    const Float3 along = preview->wall_along;
    const float before = preview->def.wall_distance - (along.x * origin.y - along.y * origin.x);
    const float towards = along.x * direction.y - along.y * direction.x;
    if (before <= 0 || towards < 1e-5f) return INFINITY;
    return before / towards < 1e4f ? before / towards : INFINITY;
}

float wall_clears(const Preview *preview) {
    if (!isfinite(preview->def.wall_distance)) return 1;
    const float behind = preview->wall_along.x * preview->sun.y - preview->wall_along.y * preview->sun.x;
    return 1 - stepf(-preview->sun_spread, preview->sun_spread, behind);
}

void wall_look(const Preview *preview, Float3 position, float footprint, Table *table) {
    const float u = float3_dot(position, preview->wall_along), v = position.z;
    const uint32_t seed = preview->def.seed + 377;
    *table = (Table){.albedo = {1, 1, 1}};
    if (preview->def.wall == PREVIEW_WALL_PLASTER) plaster(u, v, seed, footprint, table);
    if (preview->def.wall == PREVIEW_WALL_BRICK) brick(u, v, seed, footprint, table);
    table->albedo = float3_mul(table->albedo, float3_load(preview->def.wall_colour));

    // little light comes into the corner with the floor
    const float above = v - preview->def.ground_height;
    if (above >= 0) table->albedo = float3_scale(table->albedo, 1 - 0.5f * expf(-above / 0.03f));
}

void wall_shade(const Preview *preview, const Table *table, Point *point) {
    const Float3 along = preview->wall_along;
    point->geometric = float3(along.y, -along.x, 0);
    const Float3 tilted = float3_mad(point->geometric, along, table->tilt[0]);
    point->normal = float3_unit_or(float3_mad(tilted, float3(0, 0, 1), table->tilt[1]), point->geometric);
    point->albedo = table->albedo;
    point->gloss = 0.01f;
    point->shininess = 12;
}
