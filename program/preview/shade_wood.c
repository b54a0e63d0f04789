// Wood: of the table's planks, and of things that are cut from it.
//
// Each plank is cut from its own trunk: the year rings are cylinders around an axis oblique to the plank, so that the cut
// shows parallel lines or pointed arches, ragged where it is nearly along a ring. A ring darkens towards its end, the late
// wood, and ends abruptly; wide pores, dark dashes along the fibres, are crowded where the next begins. Where a branch was
// cut there is a knot, and fibres and rings flow around it. Every octave fades when a pixel no longer resolves it.

#include "preview/ground.h"
#include "preview/shape_look.h"

#include "world/triangle.h"

/// Where a point is among the fibres, and what it is cut through.
typedef struct Grain {
    float u, v;   ///< m, along the fibres and across them
    float depth;  ///< m, above the trunk's axis
    float knot;   ///< distance from the middle of a knot over its radius; large: there is none
    float late;   ///< late wood, 0 to 1
    float porous; ///< 0 to 1, how crowded wide pores are
} Grain;

/// Branches: fibres pass them as a stream passes a pile, and the trunk's rings bulge around them.
static void grow_knots(const Plank *p, uint32_t seed, float footprint, Grain *grain) {
    enum { PLACES = 3 };
    if (p->width < 0.06f) return;
    for (uint32_t k = 0; k < PLACES; k++) {
        const uint32_t key = hash_u32((uint32_t)(1024 * p->shift) + seed + 0x9e3779b1u * k);
        if (hash_unit(key) > 0.4f) continue;
        const float size = 0.0025f + 0.011f * hash_unit(key + 1) * hash_unit(key + 2), skew = hash_unit(key + 5) - 0.5f;
        const float x = (p->along - 1.3f * ((float)k + hash_unit(key + 3)) / PLACES) / size;
        const float y = (p->across - 0.9f * p->width * (hash_unit(key + 4) - 0.5f)) / size + 0.4f * skew * x;
        const float far2 = 0.16f * x * x + y * y, room = maxf(1 - far2 / 60, 0),
                    near = room * room * visible(2 * size, footprint);
        if (near <= 0) continue;
        grain->v -= size * y * near * minf(1 / maxf(far2, 1e-6f), 1);
        grain->depth -= 3.2f * size * near * expf(-far2 / 7);
        grain->knot = minf(grain->knot, sqrtf(mixf(0.35f, 0.9f, hash_unit(key + 6)) * x * x + y * y) +
                                            0.22f * noise2(1.3f * x, 1.3f * y, key & 255));
    }
}

/// Years differ in width and in strength, and fade in and out along a plank.
static void grow_rings(const Plank *p, uint32_t seed, float footprint, Grain *grain) {
    const float u = grain->u, v = grain->v;
    const float bend = 0.011f * noise2(u * 2.3f, v * 9, seed) + 0.0030f * noise2(u * 9, v * 30, seed + 1);
    const float aside = v + 0.09f * (p->hue - 0.5f) + bend;
    const float radius = sqrtf(aside * aside + grain->depth * grain->depth), wide = 0.0034f + 0.0030f * p->hue;
    float year = radius / wide + 0.35f * noise2(u * 1.3f, radius * 60, seed + 2);
    year += 1.1f * noise2(p->shift, radius * 85, seed + 9) + 0.30f * noise2(u * 17, v * 70, seed + 3);
    year += visible(0.002f, footprint) *
            (0.10f * noise2(u * 40, v * 330, seed + 4) + 0.035f * noise2(u * 170, v * 1300, seed + 7));

    float within;
    const int ring = noise_floor(year, &within);
    const float slope = maxf(fabsf(aside) / maxf(radius, 1e-4f), 0.12f); // of the cut through the rings
    const float fall = clampf(1.2f * footprint * slope / wide, 0.12f, 0.4f);
    const float late = stepf(0.25f, 1.0f - fall, within) * (1 - stepf(1 - fall, 1.0f, within));
    const float shown = visible(0.0035f / maxf(slope, 0.3f), footprint);
    float strength = 0.35f + 0.65f * hash_unit((uint32_t)ring * 0x27d4eb2fu + seed + (uint32_t)(1024 * p->tone));
    strength *= 0.75f + 0.5f * noise2(u * 3.7f, radius * 110, seed + 10);
    grain->late = mixf(0.33f, late, shown) * mixf(0.65f, strength, shown);
    grain->porous = mixf(0.3f, 1 - stepf(0.05f, 0.5f, within), shown);
}

/// Dashes along the fibres, one or none in each cell of a lattice `wide` across: how much of a pixel they cover.
static float dashes(float u, float v, float wide, float often, uint32_t seed, float footprint) {
    const float shown = visible(1.3f * wide, footprint), even = 0.18f * often;
    if (shown <= 0) return even;
    float fx, fy;
    const int row = noise_floor(v / wide, &fy);
    const int column = noise_floor(u / (11 * wide) + 7 * hash_unit((uint32_t)row * 0x85ebca6bu + seed), &fx);
    const uint32_t key = sample_key(column, row, seed);
    if (hash_unit(key) >= often) return (1 - shown) * even;
    const float half = mixf(0.12f, 0.30f, hash_unit(key + 1)), reach = mixf(0.15f, 0.48f, hash_unit(key + 2));
    const float x = (fx - mixf(reach, 1 - reach, hash_unit(key + 3))) / reach,
                y = fy - mixf(half, 1 - half, hash_unit(key + 4));
    const float taper = sqrtf(maxf(1 - x * x, 0)), soft = maxf(0.4f * half, 0.6f * footprint / wide);
    const float dark = mixf(0.5f, 1, hash_unit(key + 5));
    return mixf(even, taper > 0 ? dark * stepf(-soft, soft, half * taper - fabsf(y)) : 0, shown);
}

/// Fibres: streaks along the grain, from 2 mm to an eighth of one across, each finer one shorter.
static float wood_fibres(const Grain *grain, uint32_t seed, float footprint) {
    float sum = 0, wide = 0.002f, weight = 0.5f;
    for (uint32_t octave = 0; octave < 5; octave++, wide *= 0.5f, weight *= 0.9f) {
        const float shown = visible(wide, footprint);
        if (shown <= 0) break;
        sum += shown * weight * noise2(grain->u / (16 * wide), grain->v / wide, seed + octave);
    }
    return sum;
}

void wood_look(const Plank *plank, float x, float y, uint32_t seed, float footprint, Table *table) {
    const Plank p = *plank;
    // the trunk's axis is below the plank and rises or falls along it
    const float rise = (p.hue > 0.5f ? 1 : -1) * (0.035f + 0.07f * p.tone);
    Grain grain = {.u = p.along + p.shift, .v = p.across, .knot = 9};
    grain.depth = 0.016f + 0.09f * p.tone + rise * (p.along - 0.6f) - p.deep;
    grow_knots(&p, seed + 40, footprint, &grain);
    grow_rings(&p, seed, footprint, &grain);
    const float u = grain.u, late = grain.late;
    grain.v += y - p.across;
    const float fibre = wood_fibres(&grain, seed + 20, footprint);
    float pores = 0.9f * dashes(u, grain.v, 0.00075f, 0.9f * grain.porous, seed + 30, footprint);
    pores = maxf(pores, 0.7f * dashes(u, grain.v, 0.0004f, 0.4f, seed + 31, footprint));

    // planks differ, and the heart of a tree is darker than its outside
    const float blotch = noise2(u * 3.1f, p.across * 14, seed + 5), wear = noise2(x * 5, y * 5, seed + 6);
    const float heart = noise2(u * 0.9f, p.across * 11 + 7 * p.hue, seed + 8);
    float value = 1.19f + 0.46f * (p.tone - 0.5f) - 0.56f * late + 0.30f * fibre + 0.10f * blotch + 0.05f * wear;
    value += 0.10f * heart;
    value *= 1 - 0.64f * pores;

    // a knot is dark, darkest at its bark, and has rings of its own
    const float bark = fabsf(grain.knot - 1), inside = 1 - stepf(0.9f, 1.05f, grain.knot);
    if (grain.knot < 2.5f) {
        const float own = noise2(6 * grain.knot, p.shift, seed + 11) + 0.8f * fibre;
        value *= mixf(1 - 0.3f * (1 - stepf(0.9f, 2.5f, grain.knot)), 0.50f + 0.18f * own, inside);
        value *=
            1 - 0.55f * (1 - stepf(0.02f, 0.20f, bark)) * (0.6f + 0.4f * noise2(u * 220, grain.v * 220, seed + 14));
    }

    // a joint: a dark gap, soft-edged, and a bevel next to it, worn unevenly, that leans towards it; dirt lies along it
    const float worn = 0.00022f * noise2(x * 60, y * 60, seed + 12), edge = p.edge + worn + 0.0004f * (p.hue - 0.5f);
    const float soft = maxf(0.0008f, 0.7f * footprint), joint = 1 - stepf(0.0003f, soft + 0.0003f, edge);
    const float bevel = (1 - stepf(0.0008f, 0.0030f, edge)) * visible(0.0016f, footprint);
    const float dirt = (1 - stepf(0.0005f, 0.009f, edge)) * (0.6f + 0.4f * noise2(x * 45, y * 45, seed + 13));
    value *= (1 - 0.86f * joint * minf(1, 0.0016f / footprint)) * (1 - 0.12f * bevel) * (1 - 0.30f * dirt);

    // late wood is redder, early wood more golden; planks differ
    const float red = clampf(0.45f * late + 0.5f * (p.hue - 0.4f) - 0.10f * fibre + 0.3f * inside, -0.25f, 0.55f);
    table->albedo = float3_scale(float3(1 + 0.22f * red, 1 - 0.10f * red, 1 - 0.42f * red), maxf(value, 0.04f));

    // an oiled face: scratched in any direction, dull in the pores and where it is worn, and its mirror image breaks up along the fibres
    float scratch = dashes(0.03f * (8 * x + 6 * y), 8 * y - 6 * x, 0.005f, 0.06f, seed + 15, 10 * footprint);
    scratch += dashes(0.03f * (9 * x - 4 * y), 9 * y + 4 * x, 0.005f, 0.06f, seed + 16, 10 * footprint);
    table->polish = (0.46f - 0.16f * late + 0.20f * wear + 0.16f * fibre - 0.3f * scratch) * (1 - 0.8f * joint) *
                    (1 - 0.6f * pores);
    const float across = clampf(p.across / (0.5f * p.width), -1, 1);
    table->tilt[0] = 0.004f * wear;
    table->tilt[1] = 0.012f * blotch + 0.030f * fibre + 0.010f * across + 0.16f * bevel * (across > 0 ? 1.0f : -1.0f);
}

// ---- things cut from it

#define STAVE 0.072f ///< m, width of the pieces that a board is glued from

#define SINGED 0.014f ///< m, from the origin of what grips a sheet to what of that burns at it

void wood_singe(Preview *preview) {
    const PreviewScene *scene = &preview->scene;
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        PreviewShape *shape = &preview->shapes[k];
        if (!shape->grips) continue;
        // the nearest points of triangles: vertices of a coarse sheet may all be farther away
        float burnt = 0, count = 0;
        for (uint32_t i = 0; i < scene->triangle_count; i++) {
            const uint32_t *v = scene->triangles[i];
            const TriangleClosest near =
                triangle_closest(float3_load(shape->position), float3_load(scene->positions[v[0]]),
                                 float3_load(scene->positions[v[1]]), float3_load(scene->positions[v[2]]));
            if (near.square > (double)SINGED * (double)SINGED) continue;
            const float s = (float)near.s, t = (float)near.t;
            burnt += (1 - s - t) * scene->vertices[v[0]].burn + s * scene->vertices[v[1]].burn +
                     t * scene->vertices[v[2]].burn;
            count++;
        }
        shape->singed = count > 0 ? stepf(0.1f, 0.6f, burnt / count) : 1; // nothing is left of it
    }
}

/// Wood that grips what burns is brown, and black at its tips and edges.
static void singe(const Place *place, const Table *table, Point *point) {
    if (!(place->shape->singed > 0)) return;
    const float rough = noise3(float3_scale(place->p, 140), 377) + 0.5f * noise3(float3_scale(place->p, 420), 378);
    const float up = place->p.x + 0.009f * rough - 0.010f * (table->polish - 0.4f);
    const float brown = place->shape->singed * (1 - stepf(0.006f, 0.045f, up)),
                black = place->shape->singed * (1 - stepf(-0.004f, 0.014f, up));
    point->albedo = float3_mul(point->albedo, float3_mix(float3(1, 1, 1), float3(0.34f, 0.20f, 0.12f), brown));
    point->albedo = float3_mix(point->albedo, float3(0.022f, 0.020f, 0.019f), 0.92f * black);
}

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
                         .width = board ? STAVE : 0.04f,
                         .edge = board ? 0.5f * STAVE - fabsf(across) + 0.0009f : 1,
                         .tone = hash_unit(key),
                         .hue = hash_unit(key + 1),
                         .shift = 60 * hash_unit(key + 2)};
    Table table = {.polish = 0};
    // oblique, so that fibres show on each face
    wood_look(&plank, p[axis[0]], p[axis[1]] + 0.83f * p[axis[2]], seed, point->footprint, &table);
    const float end = fabsf(n[axis[0]]); // cut across, it takes up more oil
    point->albedo = float3_mul(point->albedo, float3_scale(table.albedo, 1 - 0.35f * end * end));
    singe(place, &table, point);

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
