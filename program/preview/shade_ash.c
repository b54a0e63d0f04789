// Ash on the ground: what came down from burnt sheets, as it lies where the ground is stained.
//
// Burnt paper breaks into a few leaves, more scraps and many crumbs, which lie together in drifts with dust between them. A
// leaf is thin and bent about a line, on which it rests, so its sides stand off the ground. It is creased, dark as char in
// its middle and pale at its rim. Its height over the ground is h(x, y). A view ray descends to the ground and sees the
// leaf where the ray's height falls below h inside the outline; otherwise it sees the ground, in the leaf's shadow.

#include "preview/ground.h"
#include "preview/internal.h"

enum {
    ASH_STEPS = 9, ///< of a view ray down to the ground
};
#define ASH_ASIDE 5.0f ///< m that a view ray moves sideways for each metre of height, at most

/// One kind of ash: at most one piece in each square of a lattice.
typedef struct AshKind {
    float square;            ///< m
    float smallest, largest; ///< m, half of their length
    float often, alone;      ///< share of squares that have one, in drifts and outside
} AshKind;

static const AshKind ash_kinds[ASH_KINDS] = {{0.026f, 0.0038f, 0.0110f, 0.62f, 0.03f},
                                             {0.0085f, 0.0010f, 0.0032f, 0.50f, 0.03f},
                                             {0.0027f, 0.00028f, 0.0010f, 0.62f, 0.04f},
                                             {0.0011f, 0.00012f, 0.00032f, 0.70f, 0.03f}};

/// A leaf, seen from a point.
typedef struct Leaf {
    const Scrap *scrap; ///< NULL: there is none
    float size;         ///< m
    float x, y;         ///< the point from its middle, along it and across, in units of its size
    float turn[2];      ///< cosine and sine of its direction
    float middle[2];    ///< m
} Leaf;

/// How much ash lies around a place, from 0 between drifts to 1.
static float ash_drift(uint32_t seed, float x, float y) {
    return stepf(-0.1f, 0.7f, noise2(x * 21, y * 21, seed) + 0.55f * noise2(x * 57, y * 57, seed + 310));
}

/// How far the lattice of a kind is moved, in squares.
static const float ash_aside[2] = {0.37f, 0.61f};

/// Fills a square.
static void leaf_lay(uint32_t seed, uint32_t kind, LeafSquare *square) {
    const AshKind *of = &ash_kinds[kind];
    const uint32_t key = sample_key(square->i, square->j, seed + 311 + kind) | 1;
    const float chance = hash_unit(key);
    square->taken = false;
    if (chance > of->often) return;
    const float x = ((float)square->i + 0.5f - ash_aside[0] * (float)kind) * of->square;
    const float y = ((float)square->j + 0.5f - ash_aside[1] * (float)kind) * of->square;
    float drift = ash_drift(seed, x, y);
    if (kind > 0) drift *= stepf(-0.35f, 0.6f, noise2(x * 105, y * 105, seed + 320));
    if (chance > mixf(of->alone, of->often, drift)) return;

    const float share = hash_unit(key + 4), turn = 2 * PI_F * hash_unit(key + 3);
    square->taken = true;
    square->scrap = scrap_make(key);
    square->size = mixf(of->smallest, of->largest, share * share);
    square->turn[0] = cosf(turn);
    square->turn[1] = sinf(turn);
    const float room = 1.15f * square->size / of->square;
    square->at[0] = mixf(room, 1 - room, hash_unit(key + 1));
    square->at[1] = mixf(room, 1 - room, hash_unit(key + 2));
}

static const LeafSquare *leaf_square(uint32_t seed, uint32_t kind, float x, float y, AshSquares *squares) {
    const AshKind *of = &ash_kinds[kind];
    float within;
    const int i = noise_floor(x / of->square + ash_aside[0] * (float)kind, &within);
    const int j = noise_floor(y / of->square + ash_aside[1] * (float)kind, &within);
    LeafSquare *square = &squares->kept[kind][(i & 1) + 2 * (j & 1)];
    if (square->known && square->i == i && square->j == j) return square;
    square->i = i;
    square->j = j;
    square->known = true;
    leaf_lay(seed, kind, square);
    return square;
}

/// The leaf of the square that a point lies in.
static Leaf leaf_find(uint32_t kind, float x, float y, const LeafSquare *square) {
    if (!square->taken) return (Leaf){.scrap = NULL};
    const AshKind *of = &ash_kinds[kind];
    const float within[2] = {x / of->square + ash_aside[0] * (float)kind - (float)square->i,
                             y / of->square + ash_aside[1] * (float)kind - (float)square->j};
    const float size = square->size, c = square->turn[0], s = square->turn[1];
    const float dx = (within[0] - square->at[0]) * of->square / size,
                dy = (within[1] - square->at[1]) * of->square / size;
    return (Leaf){.scrap = &square->scrap,
                  .size = size,
                  .x = c * dx + s * dy,
                  .y = c * dy - s * dx,
                  .turn = {c, s},
                  .middle = {x - size * dx, y - size * dy}};
}

Scrap scrap_make(uint32_t key) {
    Scrap scrap = {.key = key,
                   .bent = 0.16f + 0.5f * hash_unit(key + 9),
                   .aside = 0.9f * (hash_unit(key + 10) - 0.5f),
                   .twist = 0.5f * (hash_unit(key + 11) - 0.5f)};
    for (uint32_t s = 0; s < SCRAP_SIDES; s++) {
        const float turn = 2 * PI_F * ((float)s + 0.8f * hash_unit(key + 20 + s)) / SCRAP_SIDES;
        float *side = scrap.sides[s];
        side[0] = cosf(turn);
        side[1] = sinf(turn);
        side[2] = mixf(0.55f, 1, hash_unit(key + 30 + s)) * (0.6f + 0.4f * fabsf(side[0]));
    }
    return scrap;
}

float scrap_depth(const Scrap *scrap, float x, float y) {
    const uint32_t key = scrap->key;
    const float warp = noise2(1.9f * x, 1.9f * y, key & 255), bend = noise2(1.9f * x, 1.9f * y, key >> 8 & 255);
    float depth = 1;
    x += 0.22f * warp;
    y += 0.22f * bend;
    for (int s = 0; s < SCRAP_SIDES; s++) {
        const float *side = scrap->sides[s];
        depth = minf(depth, side[2] - side[0] * x - side[1] * y);
    }
    const float bites = maxf(noise2(2.6f * x, 2.6f * y, key >> 4 & 255) - 0.15f, 0);
    return depth - 0.45f * bites * (1 - minf(depth, 1)) + 0.07f * noise2(7 * x, 7 * y, key >> 16 & 255);
}

float scrap_height(const Scrap *scrap, float x, float y) {
    const uint32_t key = scrap->key;
    const float off = y - scrap->aside, twist = scrap->twist * x * off;
    const float folds = fabsf(noise2(1.7f * x, 1.7f * y, key >> 3 & 255));
    const float fine = noise2(4.3f * x, 4.3f * y, key >> 7 & 255);
    return clampf(0.03f + scrap->bent * off * off + twist + 0.20f * folds + 0.05f * fine, 0.01f, SCRAP_FLAT);
}

/// Whether a leaf of that size is visible, 0 to 1.
static float leaf_shown(const Leaf *leaf, float footprint) { return visible(1.2f * leaf->size, footprint); }

/// Lays a share of a leaf or of its shadow over what a position already shows.
static void leaf_over(const Leaf *leaf, Float3 position, float albedo, const float tilt[2], float cover, Ash *ash) {
    const float from[2] = {leaf->middle[0] - position.x, leaf->middle[1] - position.y};
    ash->cover += (1 - ash->cover) * cover;
    ash->albedo = mixf(ash->albedo, albedo, cover);
    for (int d = 0; d < 2; d++) {
        ash->tilt[d] = mixf(ash->tilt[d], tilt[d], cover);
        ash->from[d] = mixf(ash->from[d], from[d], cover);
    }
}

/// The albedo and the visible tilt of a leaf at one of its points. `view`: m sideways for each metre of height.
static float leaf_look(const Leaf *leaf, float depth, const float view[2], float footprint, float tilt[2]) {
    const uint32_t key = leaf->scrap->key;
    const float e = 0.06f, h = scrap_height(leaf->scrap, leaf->x, leaf->y);
    const float along = (scrap_height(leaf->scrap, leaf->x + e, leaf->y) - h) / e,
                across = (scrap_height(leaf->scrap, leaf->x, leaf->y + e) - h) / e;
    const float slope[2] = {leaf->turn[0] * along - leaf->turn[1] * across,
                            leaf->turn[1] * along + leaf->turn[0] * across};
    const float faces = 1 - slope[0] * view[0] - slope[1] * view[1], steep = hypotf(slope[0], slope[1]);
    for (int d = 0; d < 2; d++) tilt[d] = slope[d] * (faces < 0 ? 0.2f : -1) / maxf(1, 0.8f * steep);

    // most are char, some have turned to ash, which begins at the rim, in patches and along creases
    const float burnt = hash_unit(key + 6), turned = 0.8f * burnt * burnt;
    const float patch = noise2(1.5f * leaf->x + 3, 1.5f * leaf->y, key >> 5 & 255);
    const float rim = expf(-maxf(depth, 0) / (0.09f + 0.09f * patch));
    const float crease = 1 - stepf(0, 0.11f, fabsf(noise2(1.7f * leaf->x, 1.7f * leaf->y, key >> 3 & 255)));
    const float grain = noise2(11 * leaf->x, 11 * leaf->y, key >> 9 & 255) * visible(0.09f * leaf->size, footprint);
    const float pale = clampf(turned + 0.6f * rim * (0.5f + 0.8f * burnt) + 0.28f * patch + 0.15f * grain, 0, 1);
    float value = mixf(0.018f, 0.36f, pale * pale * (1.5f - 0.5f * pale)) + (0.012f + 0.05f * pale) * crease;
    return value * (1 + 0.2f * grain) * (faces < 0 ? 0.55f : 1);
}

/// A view ray at a height over the ground, and the leaf under or over it.
typedef struct AshRay {
    Leaf leaf;
    float z;    ///< m
    float over; ///< m over the leaf, if it is known; else it is higher than any part of it
    bool known;
} AshRay;

static void ash_ray_measure(AshRay *ray) {
    if (!ray->known) ray->over = ray->z - ray->leaf.size * scrap_height(ray->leaf.scrap, ray->leaf.x, ray->leaf.y);
    ray->known = true;
}

/// Whether a leaf was met between two heights, and where. Heights are measured only if they may matter.
static bool ash_ray_meets(AshRay *before, AshRay *ray, float *z) {
    if (!ray->leaf.scrap || ray->leaf.scrap != before->leaf.scrap) return false;
    const bool high = ray->z > SCRAP_FLAT * ray->leaf.size, was_high = !before->known;
    if (high && was_high) return false;
    ash_ray_measure(ray);
    ash_ray_measure(before);
    if (!(ray->over * before->over < 0)) return false;
    *z = mixf(ray->z, before->z, ray->over / (ray->over - before->over));
    return true;
}

/// Looks for leaves of a kind down the view ray to a point of the ground. `view`: m sideways for each metre of height;
/// `only`: the square that the ray does not leave, or NULL.
static void ash_descend(uint32_t seed, uint32_t kind, Float3 position, const float view[2], float footprint,
                        const LeafSquare *only, AshSquares *squares, Ash *ash) {
    const int steps = kind < 2 ? ASH_STEPS : 1;
    const float top = SCRAP_FLAT * ash_kinds[kind].largest;
    AshRay before = {.z = top, .known = true};
    for (int k = 0; k <= steps; k++) {
        AshRay ray = {.z = top * (1 - (float)k / (float)steps)};
        const float x = position.x + ray.z * view[0], y = position.y + ray.z * view[1];
        ray.leaf = leaf_find(kind, x, y, only ? only : leaf_square(seed, kind, x, y, squares));
        if (ray.leaf.scrap && !(ray.z > SCRAP_FLAT * ray.leaf.size)) ash_ray_measure(&ray);
        float met;
        if (ash_ray_meets(&before, &ray, &met)) {
            const Scrap *scrap = ray.leaf.scrap;
            const float at[2] = {position.x + met * view[0], position.y + met * view[1]};
            const Leaf leaf =
                leaf_find(kind, at[0], at[1], only ? only : leaf_square(seed, kind, at[0], at[1], squares));
            const float soft = 0.6f * footprint / ray.leaf.size;
            const float depth = leaf.scrap == scrap ? scrap_depth(scrap, leaf.x, leaf.y) : -INFINITY;
            const float cover = leaf_shown(&ray.leaf, footprint) * stepf(-soft, soft + 0.03f, depth);
            float tilt[2];
            if (cover > 0) leaf_over(&leaf, position, leaf_look(&leaf, depth, view, footprint, tilt), tilt, cover, ash);
            if (cover > 0.5f) break;
        }
        before = ray;
    }
}

void ash_look(const Preview *preview, Float3 position, float footprint, AshSquares *squares, Ash *ash) {
    const uint32_t seed = preview->def.seed;
    const Float3 to = float3_sub(preview->camera.eye, position);
    const float most = ASH_ASIDE / maxf(hypotf(to.x, to.y), 1e-6f), up = maxf(to.z, 1e-6f);
    const float view[2] = {to.x * minf(1 / up, most), to.y * minf(1 / up, most)};

    // dust first, then larger pieces over smaller ones
    const float drift = ash_drift(seed, position.x, position.y);
    const float dust = 0.22f * drift * stepf(-0.5f, 0.9f, noise2(position.x * 240, position.y * 240, seed + 312));
    *ash = (Ash){.cover = dust, .albedo = 0.10f * dust};
    for (uint32_t kind = ASH_KINDS; kind-- > 0;) {
        if (visible(ash_kinds[kind].largest, footprint) <= 0) continue;
        // where the view ray stays in a square without a leaf it meets none
        const float top = SCRAP_FLAT * ash_kinds[kind].largest;
        const LeafSquare *square =
            leaf_square(seed, kind, position.x + top * view[0], position.y + top * view[1], squares);
        const int i = square->i, j = square->j;
        square = leaf_square(seed, kind, position.x, position.y, squares);
        const bool stays = square->i == i && square->j == j;
        if (stays && !square->taken) continue;

        const Leaf below = leaf_find(kind, position.x, position.y, square);
        if (below.scrap) {
            const float high = scrap_height(below.scrap, below.x, below.y), soft = 0.34f + 0.9f * high;
            const float dark = leaf_shown(&below, footprint) * mixf(0.9f, 0.6f, high / SCRAP_FLAT);
            leaf_over(&below, position, 0, (const float[2]){0, 0},
                      dark * stepf(-soft, 0.1f, scrap_depth(below.scrap, below.x, below.y)), ash);
        }
        ash_descend(seed, kind, position, view, footprint, stays ? square : NULL, squares, ash);
    }
}

void ash_lay(const Preview *preview, const Ash *ash, Point *point) {
    if (!(ash->cover > 0)) return;
    const float x = point->position.x + ash->from[0] / ash->cover, y = point->position.y + ash->from[1] / ash->cover;
    const float lies = preview->def.ground_stain * stepf(0.03f, 0.2f, stain_at(preview, x, y)),
                left = 1 - lies * ash->cover;
    point->albedo = float3_mad(float3_scale(point->albedo, left), float3(1, 1, 0.98f), lies * ash->albedo);
    point->mirror *= left;
    point->gloss *= left;
    const Float3 tilt = float3(ash->tilt[0], ash->tilt[1], 0);
    point->normal = float3_unit_or(float3_mad(point->normal, tilt, lies), point->geometric);
}
