// Wood: of the table's planks, and of things that are cut from it.
//
// Each plank is cut from its own trunk: the year rings are cylinders around an axis oblique to the plank, so that the cut
// shows parallel lines or pointed arches. A ring darkens towards its end, the late wood, and ends abruptly. Fibres and
// pores run along the plank. Every octave fades when a pixel no longer resolves it.

#include "preview/shape_look.h"

/// Late wood, 0 to 1, of the year rings: years differ in width and in strength, and fade in and out along a plank.
static float year_rings(const Plank *p, uint32_t seed, float footprint) {
    float u = p->along + p->shift, bend = 0.011f * noise2(u * 2.3f, p->across * 9, seed);
    bend += 0.0022f * noise2(u * 9, p->across * 40, seed + 1);

    // the trunk's axis is below the plank and rises along it
    float aside = p->across + 0.09f * (p->hue - 0.5f) + bend;
    float depth = 0.012f + 0.09f * p->tone + 0.05f * (p->along - 0.6f) - p->deep;
    float radius = sqrtf(aside * aside + depth * depth), year = radius / (0.0034f + 0.0022f * p->hue);
    year += 0.35f * noise2(u * 1.3f, radius * 60, seed + 2) + 1.1f * noise2(p->shift, radius * 85, seed + 9);
    float within;
    int ring = noise_floor(year, &within);
    float strength = 0.2f + 0.8f * hash_unit((uint32_t)ring * 0x27d4eb2fu + seed + (uint32_t)(1024 * p->tone));
    strength *= 0.75f + 0.5f * noise2(u * 3.7f, radius * 110, seed + 10);
    float slope = maxf(fabsf(aside) / maxf(radius, 1e-4f), 0.12f); // slope of the cut through the rings
    float late = stepf(0.05f, 0.88f, within) * (1 - stepf(0.86f, 1.0f, within));

    return mixf(0.33f, late, visible(0.0035f / slope, footprint)) * strength;
}

/// Fibres: streaks along the grain, from 8 mm to half a millimetre across, each finer one shorter.
static float wood_fibres(float u, float y, uint32_t seed, float footprint) {
    float sum = 0, wide = 0.008f, weight = 0.5f;
    for (uint32_t octave = 0; octave < 5; octave++, wide *= 0.5f, weight *= 0.86f) {
        const float shown = visible(wide, footprint);
        if (shown <= 0) break;
        sum += shown * weight * noise2(u / (26 * wide), y / wide, seed + octave);
    }
    return sum;
}

/// Pores: dark dashes along the grain, a few tenths of a millimetre across, crowded in the early wood.
static float wood_pores(float u, float y, float late, uint32_t seed, float footprint) {
    float sum = 0;
    for (uint32_t k = 0; k < 2; k++) {
        const float wide = k ? 0.00045f : 0.0008f, shown = visible(1.3f * wide, footprint);
        const float n = noise2(u / (30 * wide), y / wide + 0.5f * (float)k, seed + k);
        sum += shown * stepf(0.28f + 0.3f * late, 0.72f + 0.3f * late, n);
    }
    return minf(sum, 1);
}

void wood_look(const Plank *plank, float x, float y, uint32_t seed, float footprint, Table *table) {
    const Plank p = *plank;
    float u = p.along + p.shift, late = year_rings(&p, seed, footprint);
    float bow = 0.011f * noise2(u * 2.3f, p.across * 9, seed), side = y + 0.6f * bow; // fibres follow the rings
    const float fibre = wood_fibres(u, side, seed + 20, footprint),
                pores = wood_pores(u, side, late, seed + 30, footprint);

    // planks differ, and the heart of a tree is darker than its outside
    float blotch = noise2(u * 3.1f, p.across * 14, seed + 5), wear = noise2(x * 5, y * 5, seed + 6);
    float heart = noise2(u * 0.9f, p.across * 11 + 7 * p.hue, seed + 8);
    float value = 1.09f + 0.42f * (p.tone - 0.5f) - 0.44f * late + 0.17f * fibre + 0.10f * blotch + 0.05f * wear;
    value += 0.10f * heart;
    value *= 1 - 0.42f * pores;

    // a joint: a dark gap, soft-edged, and a bevel next to it that leans towards it
    float soft = maxf(0.0011f, 0.7f * footprint), joint = 1 - stepf(0.0003f, soft + 0.0003f, p.edge);
    float bevel = (1 - stepf(0.0008f, 0.0026f, p.edge)) * visible(0.0016f, footprint);
    value *= (1 - 0.86f * joint * minf(1, 0.0016f / footprint)) * (1 - 0.18f * bevel);

    // late wood is redder, early wood more golden; planks differ
    float red = clampf(0.35f * late + 0.6f * (p.hue - 0.5f) - 0.12f * fibre, -0.35f, 0.5f);
    table->albedo = float3_scale(float3(1 + 0.22f * red, 1 - 0.10f * red, 1 - 0.42f * red), maxf(value, 0.04f));

    // an oiled face: dull in the pores and where it is worn, and its mirror image breaks up along the fibres
    table->polish = (0.44f - 0.14f * late + 0.16f * wear + 0.10f * fibre) * (1 - 0.8f * joint) * (1 - 0.6f * pores);
    float across = clampf(p.across / (0.5f * p.width), -1, 1);
    table->tilt[0] = 0.004f * wear;
    table->tilt[1] = 0.012f * blotch + 0.030f * fibre + 0.010f * across + 0.16f * bevel * (across > 0 ? 1.0f : -1.0f);
}

// ---- things cut from it

#define STAVE 0.072f ///< m, width of the pieces that a board is glued from

void shape_wood(const Preview *preview, const Place *place, Point *point) {
    const float p[3] = {place->p.x, place->p.y, place->p.z}, n[3] = {place->normal.x, place->normal.y, place->normal.z};
    const uint32_t seed = preview->def.seed + 377;
    const bool board = place->shape->kind == SINGE_COLLIDER_BOX;

    // the axes: along the grain, which is the longest, across, and through
    const float *half = place->shape->half_size, high = place->shape->kind == SINGE_COLLIDER_CAPSULE ? 2 : 0;
    const float length[3] = {board ? half[0] : 1, board ? half[1] : 0.5f, board ? half[2] : high};
    int axis[3] = {length[1] > length[0], 0, 0};
    if (length[2] > length[axis[0]]) axis[0] = 2;
    axis[1] = (axis[0] + 1) % 3;
    axis[2] = (axis[0] + 2) % 3;
    if (length[axis[2]] > length[axis[1]]) {
        axis[1] = axis[2];
        axis[2] = (axis[0] + 1) % 3;
    }

    float across = p[axis[1]];
    int stave = 0;
    if (board) {
        stave = noise_floor(across / STAVE + 0.5f, &across);
        across = (across - 0.5f) * STAVE;
    }

    const uint32_t key = hash_u32((uint32_t)stave * 0x9e3779b1u + seed);
    const Plank plank = {.along = p[axis[0]] + 0.6f,
                         .across = across,
                         .deep = p[axis[2]],
                         .width = board ? STAVE : 0.1f,
                         .edge = board ? 0.5f * STAVE - fabsf(across) + 0.0009f : 1,
                         .tone = hash_unit(key),
                         .hue = hash_unit(key + 1),
                         .shift = 60 * hash_unit(key + 2)};
    Table table = {.polish = 0};
    // oblique, so that fibres show on each face
    wood_look(&plank, p[axis[0]], p[axis[1]] + 0.83f * p[axis[2]], seed, point->footprint, &table);
    const float end = fabsf(n[axis[0]]); // cut across, it takes up more oil
    point->albedo = float3_mul(point->albedo, float3_scale(table.albedo, 1 - 0.35f * end * end));

    float slope[3] = {0, 0, 0};
    slope[axis[0]] = -table.tilt[0];
    slope[axis[1]] = -table.tilt[1];
    shape_lean(place, float3_load(slope), point);
    const float oil = clampf(table.polish, 0.05f, 0.6f);
    point->gloss = point->mirror = 0;
    point->shine = float3_scale(float3(0.04f, 0.04f, 0.04f), 1.6f * oil);
    point->rough[0] = 0.34f;
    point->rough[1] = 0.40f;
}
