// The table and the background.
//
// Stone is honed slabs of cast stone, which feet have worn: clouds of several sizes, cut gravel, pits, a hairline crack, and
// joints. Every octave fades when a pixel no longer resolves it.

#include "preview/ground.h"
#include "preview/internal.h"

#define PLANK_WIDTH 0.118f
#define PLANK_LENGTH 1.3f
#define SLAB 0.55f ///< m

static Plank find_plank(uint32_t seed, float x, float y) {
    float across, along;
    int row = noise_floor(y / PLANK_WIDTH, &across);
    float offset = hash_unit((uint32_t)row * 0x9e3779b1u + seed);
    int column = noise_floor(x / PLANK_LENGTH + offset, &along);
    uint32_t key = hash_u32((uint32_t)row * 0x9e3779b1u + (uint32_t)column * 0x85ebca6bu + seed);
    float side = minf(across, 1 - across) * PLANK_WIDTH, end = minf(along, 1 - along) * PLANK_LENGTH;

    return (Plank){.along = along * PLANK_LENGTH,
                   .across = (across - 0.5f) * PLANK_WIDTH,
                   .width = PLANK_WIDTH,
                   .edge = minf(side, end),
                   .tone = hash_unit(key),
                   .hue = hash_unit(key + 1),
                   .shift = 60 * hash_unit(key + 2)};
}

/// Noise of the slab, its slope added to the tilt.
static float uneven(float x, float y, float millimetres, float height, uint32_t seed, float footprint, Table *table) {
    float scale = 1000 / millimetres, e = 0.25f, shown = visible(millimetres * 1e-3f, footprint);
    if (shown <= 0) return 0;
    float n = noise2(x * scale, y * scale, seed);
    table->tilt[0] -= shown * height * (noise2(x * scale + e, y * scale, seed) - n) / e;
    table->tilt[1] -= shown * height * (noise2(x * scale, y * scale + e, seed) - n) / e;
    return shown * n;
}

/// Grains of gravel cut through and pits, one or none in each square of a lattice `wide` m: `tone` of gravel 0 without.
static float gravel(float x, float y, float wide, float most, uint32_t seed, float footprint) {
    const float shown = visible(0.5f * wide, footprint);
    if (shown <= 0) return 0;
    float fx, fy;
    const int i = noise_floor(x / wide, &fx), j = noise_floor(y / wide, &fy);
    const uint32_t key = sample_key(i, j, seed);
    if (hash_unit(key) > most) return 0;
    const float size = mixf(0.14f, 0.36f, hash_unit(key + 1) * hash_unit(key + 2)), room = size + 0.1f;
    const float dx = (fx - mixf(room, 1 - room, hash_unit(key + 3))) / size;
    const float dy = (fy - mixf(room, 1 - room, hash_unit(key + 4))) / size;
    const float turn = 2 * PI_F * hash_unit(key + 5), along = cosf(turn) * dx + sinf(turn) * dy;
    const float ragged = 0.22f * noise2(2 * dx, 2 * dy, key & 255), soft = 0.08f + 0.5f * footprint / (wide * size);
    const float depth = 1 - sqrtf(dx * dx + dy * dy + 0.9f * along * along) + ragged;
    return shown * stepf(-soft, soft, depth) * (hash_unit(key + 6) - 0.5f);
}

/// A pit: its far wall catches the light and its near one lies in shadow, from whichever side.
static float pits(float x, float y, float wide, float often, uint32_t seed, float footprint, Table *table) {
    const float shown = visible(0.3f * wide, footprint);
    if (shown <= 0 || often <= 0) return 0;
    float fx, fy;
    const int i = noise_floor(x / wide, &fx), j = noise_floor(y / wide, &fy);
    const uint32_t key = sample_key(i, j, seed);
    if (hash_unit(key) > often) return 0;
    const float size = mixf(0.04f, 0.15f, hash_unit(key + 1) * hash_unit(key + 2)), room = size + 0.05f;
    const float dx = (fx - mixf(room, 1 - room, hash_unit(key + 3))) / size;
    const float dy = (fy - mixf(room, 1 - room, hash_unit(key + 4))) / size;
    const float far = sqrtf(dx * dx + dy * dy) + 0.25f * noise2(2 * dx, 2 * dy, key & 255);
    const float deep = shown * (1 - stepf(0.55f, 1.1f, far)), wall = shown * stepf(0.3f, 0.8f, far) * (far < 1.2f);
    table->tilt[0] += 0.1f * wall * dx;
    table->tilt[1] += 0.1f * wall * dy;
    return deep;
}

/// How near a point is to a joint between slabs, 1 in it; chipped edges lean into it.
static float joint(float x, float y, uint32_t seed, float footprint, Table *table) {
    float within[2];
    noise_floor(x / SLAB + 0.31f, &within[0]);
    noise_floor(y / SLAB + 0.72f, &within[1]);
    const int k = fabsf(within[0] - 0.5f) > fabsf(within[1] - 0.5f) ? 0 : 1;
    const float far = SLAB * (0.5f - fabsf(within[k] - 0.5f)), soft = maxf(0.0008f, 0.6f * footprint);
    if (far > 0.008f + soft) return 0;
    const float chips = maxf(noise2(x * 70, y * 70, seed), 0) + 0.5f * noise2(x * 260, y * 260, seed + 1);
    const float edge = far - 0.0022f - 0.0016f * chips;
    const float bevel = (1 - stepf(0, 0.0035f, edge)) * visible(0.003f, footprint);
    table->tilt[k] -= 0.2f * (within[k] < 0.5f ? 1.0f : -1.0f) * bevel;
    return (1 - stepf(-soft, soft, edge)) * minf(1, 0.0045f / footprint);
}

static void stone(const Preview *preview, Float3 position, float footprint, Table *table) {
    uint32_t seed = preview->def.seed + 177;
    float x = 0.921f * position.x - 0.389f * position.y, y = 0.389f * position.x + 0.921f * position.y;
    float wide = noise2(x * 2.3f, y * 2.3f, seed), cloud = noise2(x * 7 + wide, y * 7, seed + 2);
    float patch = noise2(x * 26, y * 26, seed + 3);
    float rough = uneven(x, y, 9, 0.022f, seed + 4, footprint, table);
    float grain = uneven(x, y, 1.6f, 0.03f, seed + 5, footprint, table);
    float speck = noise2(x * 900, y * 900, seed + 6) * visible(0.0011f, footprint);
    float value = 0.93f + 0.16f * wide + 0.15f * cloud + 0.09f * patch + 0.07f * rough + 0.08f * grain;
    value += 0.22f * stepf(0.55f, 0.9f, speck) - 0.2f * stepf(0.5f, 0.9f, -speck);

    // gravel shows where feet have worn the skin of cement off
    const float worn = stepf(-0.35f, 0.5f, cloud + 0.5f * patch + 0.4f * rough);
    const float stones =
        gravel(x, y, 0.017f, 0.75f, seed + 20, footprint) + gravel(y + 0.4f, x, 0.0075f, 0.7f, seed + 21, footprint);
    value *= 1 + (0.12f + 0.5f * worn) * stones;
    const float open = stepf(-0.2f, 0.6f, 0.7f * patch - cloud);
    const float holes = maxf(pits(x, y, 0.023f, 0.22f * open, seed + 22, footprint, table),
                             0.5f * pits(y, x, 0.0085f, 0.4f * open, seed + 23, footprint, table));
    const float gap = joint(x, y, seed + 24, footprint, table);

    // a hairline crack breaks off
    float crack = stepf(0.1f, 0.5f, noise2(x * 3, y * 3, seed + 9)) * minf(1, 0.001f / footprint);
    if (crack > 0) {
        const float bend = 0.03f * noise2(x * 9, y * 9, seed + 7) + 0.012f * noise2(x * 31 + 7, y * 31, seed + 1);
        const float line = fabsf(noise2((x + bend) * 4.5f + 3, (y + bend) * 2.6f, seed + 8));
        crack *= 1 - stepf(0.001f, 0.004f + 2.5f * footprint, line);
    }
    value *= (1 - 0.75f * holes) * (1 - 0.8f * gap) * (1 - 0.45f * crack);

    // trodden paths are smooth, and what lies open is dull
    const float warm = 0.5f * cloud - 0.3f * patch + 0.8f * stones;
    table->albedo = float3_scale(float3(1.03f + 0.05f * warm, 1, 0.95f - 0.06f * warm), maxf(value, 0.03f));
    table->polish = 0.42f * clampf(1 + 0.5f * wide + 0.25f * patch + 0.3f * rough, 0.35f, 1.6f);
    table->polish *= (1 - holes) * (1 - 0.9f * gap);
}

Float3 background_colour(const Preview *preview, Float3 direction) {
    Float3 base = float3_load(preview->def.background);
    float height = clampf(direction.z * 1.6f, -0.6f, 1);
    return float3_scale(base, height > 0 ? mixf(1.12f, 0.62f, height) : mixf(1.12f, 0.75f, -height));
}

/// A pixel's size on the table: the mean of along and across.
static float footprint(const Preview *preview, float distance, float cosine) {
    return preview->camera.pixel * distance / sqrtf(maxf(fabsf(cosine), 0.02f));
}

void ground_look(const Preview *preview, Float3 position, float cosine, float distance, AshSquares *squares,
                 Table *table) {
    float size = footprint(preview, distance, cosine);
    *table = (Table){.albedo = {1, 1, 1}, .polish = 0.1f};
    const uint32_t seed = preview->def.seed + 77;
    const Plank plank = find_plank(seed, position.x, position.y);
    if (preview->def.ground == PREVIEW_GROUND_WOOD) wood_look(&plank, position.x, position.y, seed, size, table);
    if (preview->def.ground == PREVIEW_GROUND_STONE) stone(preview, position, size, table);
    table->albedo = float3_mul(table->albedo, float3_load(preview->def.ground_colour));
    if (stain_may_be(preview, position.x, position.y)) ash_look(preview, position, size, squares, &table->ash);
}

/// Scorches the ground under burnt paper, ragged at the scale of the picture: tan, then brown and dull with soot.
static void ground_stain(const Preview *preview, Point *point) {
    const uint32_t seed = preview->def.seed + 277;
    float x = point->position.x, y = point->position.y;
    float aside = 0.006f * noise2(x * 60, y * 60, seed + 3), along = 0.006f * noise2(x * 60, y * 60, seed + 4);
    float stain = stain_at(preview, x + aside, y + along);
    if (stain < 0.004f) return;

    float ragged = 0.5f * noise2(x * 34, y * 34, seed) + 0.35f * noise2(x * 130, y * 130, seed + 1);
    ragged += 0.25f * noise2(x * 420, y * 420, seed + 2) * visible(0.0024f, point->footprint);
    const float depth = preview->def.ground_stain * clampf(stain * (0.75f + 0.75f * ragged), 0, 1);
    const float tan = stepf(0.02f, 0.4f, depth), soot = 0.8f * stepf(0.15f, 1.0f, depth);
    point->albedo = float3_mul(point->albedo, float3_mix(float3(1, 1, 1), float3(0.74f, 0.60f, 0.46f), tan));
    point->albedo = float3_mix(point->albedo, float3(0.016f, 0.014f, 0.013f), soot);
    point->mirror *= 1 - 0.6f * soot;
    point->gloss *= 1 - 0.8f * soot;
}

void ground_shade(const Preview *preview, float distance, const Table *table, Point *point) {
    float side = point->view.z >= 0 ? 1.0f : -1.0f;
    point->footprint = footprint(preview, distance, maxf(fabsf(point->view.z), 0.02f));
    float far = distance / (9 * preview->camera.reach);
    point->fade = 1 - expf(-far * far * far);
    point->geometric = float3(0, 0, side);
    point->normal = float3_unit_or(float3(table->tilt[0], table->tilt[1], side), point->geometric);
    point->albedo = table->albedo;
    point->gloss = 0.10f * table->polish;
    point->shininess = 26;
    point->mirror = table->polish * preview->def.ground_gloss;
    if (!preview->stain.grids[0]) return;
    ground_stain(preview, point);
    ash_lay(preview, &table->ash, point);
}
