// Ash on the ground: what came down from burnt sheets, as it lies where the ground is stained.
//
// Burnt paper breaks into a few leaves, more scraps and many crumbs, which lie together in drifts with dust between them. A
// leaf is thin and bent about a line, on which it rests, so its sides stand off the ground. It is creased, dark as char in
// its middle and pale at its rim. Its height over the ground is h(x, y). A view ray descends to the ground and sees the
// leaf where the ray's height falls below h inside the outline; otherwise it sees the ground, in the leaf's shadow.

#include "preview/ground.h"
#include "preview/internal.h"

enum {
    ASH_SIDES = 5, ///< of an outline
    ASH_STEPS = 9, ///< of a view ray down to the ground
    ASH_KINDS = 4, ///< leaves, scraps, crumbs and grains
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
    uint32_t key;    ///< 0: there is none
    float size;      ///< m
    float x, y;      ///< the point from its middle, along it and across, in units of its size
    float turn[2];   ///< cosine and sine of its direction
    float middle[2]; ///< m
} Leaf;

/// How much ash lies around a place, from 0 between drifts to 1.
static float ash_drift(uint32_t seed, float x, float y) {
    return stepf(-0.1f, 0.7f, noise2(x * 21, y * 21, seed) + 0.55f * noise2(x * 57, y * 57, seed + 310));
}

/// What lies in the square of a lattice, or nothing. Points that are looked up in turn are mostly in the same one.
typedef struct LeafSquare {
    int i, j;
    bool known;
    uint32_t key; ///< 0: nothing
    float size;
    float turn[2], at[2]; ///< as of a Leaf; its middle within the square
} LeafSquare;

/// Fills a square whose middle is (x, y).
static void leaf_lay(uint32_t seed, uint32_t kind, float x, float y, LeafSquare *square) {
    const AshKind *of = &ash_kinds[kind];
    const uint32_t key = sample_key(square->i, square->j, seed + 311 + kind) | 1;
    const float chance = hash_unit(key);
    square->key = 0;
    if (chance > of->often) return;
    float drift = ash_drift(seed, x, y);
    if (kind > 0) drift *= stepf(-0.35f, 0.6f, noise2(x * 105, y * 105, seed + 320));
    if (chance > mixf(of->alone, of->often, drift)) return;

    const float share = hash_unit(key + 4), turn = 2 * PI_F * hash_unit(key + 3);
    square->key = key;
    square->size = mixf(of->smallest, of->largest, share * share);
    square->turn[0] = cosf(turn);
    square->turn[1] = sinf(turn);
    const float room = 1.15f * square->size / of->square;
    square->at[0] = mixf(room, 1 - room, hash_unit(key + 1));
    square->at[1] = mixf(room, 1 - room, hash_unit(key + 2));
}

/// `square`: that of the point before, of the same kind.
static Leaf leaf_find(uint32_t seed, uint32_t kind, float x, float y, LeafSquare *square) {
    const AshKind *of = &ash_kinds[kind];
    float fx, fy;
    const int i = noise_floor(x / of->square + 0.37f * (float)kind, &fx);
    const int j = noise_floor(y / of->square + 0.61f * (float)kind, &fy);
    if (!square->known || square->i != i || square->j != j) {
        *square = (LeafSquare){.i = i, .j = j, .known = true};
        leaf_lay(seed, kind, x + (0.5f - fx) * of->square, y + (0.5f - fy) * of->square, square);
    }
    if (!square->key) return (Leaf){.key = 0};

    const float size = square->size, c = square->turn[0], s = square->turn[1];
    const float dx = (fx - square->at[0]) * of->square / size, dy = (fy - square->at[1]) * of->square / size;
    return (Leaf){.key = square->key,
                  .size = size,
                  .x = c * dx + s * dy,
                  .y = c * dy - s * dx,
                  .turn = {c, s},
                  .middle = {x - size * dx, y - size * dy}};
}

float scrap_depth(float x, float y, uint32_t key) {
    const float warp = noise2(1.9f * x, 1.9f * y, key & 255), bend = noise2(1.9f * x, 1.9f * y, key >> 8 & 255);
    float depth = 1;
    x += 0.22f * warp;
    y += 0.22f * bend;
    for (uint32_t s = 0; s < ASH_SIDES; s++) {
        const float turn = 2 * PI_F * ((float)s + 0.8f * hash_unit(key + 20 + s)) / ASH_SIDES, c = cosf(turn);
        const float far = mixf(0.55f, 1, hash_unit(key + 30 + s)) * (0.6f + 0.4f * fabsf(c));
        depth = minf(depth, far - c * x - sinf(turn) * y);
    }
    const float bites = maxf(noise2(2.6f * x, 2.6f * y, key >> 4 & 255) - 0.15f, 0);
    return depth - 0.45f * bites * (1 - minf(depth, 1)) + 0.07f * noise2(7 * x, 7 * y, key >> 16 & 255);
}

float scrap_height(float x, float y, uint32_t key) {
    const float bent = 0.16f + 0.5f * hash_unit(key + 9), off = y - 0.9f * (hash_unit(key + 10) - 0.5f);
    const float twist = 0.5f * (hash_unit(key + 11) - 0.5f) * x * off;
    const float folds = fabsf(noise2(1.7f * x, 1.7f * y, key >> 3 & 255));
    const float fine = noise2(4.3f * x, 4.3f * y, key >> 7 & 255);
    return clampf(0.03f + bent * off * off + twist + 0.20f * folds + 0.05f * fine, 0.01f, SCRAP_FLAT);
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
    const uint32_t key = leaf->key;
    const float e = 0.06f, h = scrap_height(leaf->x, leaf->y, leaf->key);
    const float along = (scrap_height(leaf->x + e, leaf->y, leaf->key) - h) / e,
                across = (scrap_height(leaf->x, leaf->y + e, leaf->key) - h) / e;
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

void ash_look(const Preview *preview, Float3 position, float footprint, Ash *ash) {
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
        LeafSquare square = {.known = false};
        const Leaf below = leaf_find(seed, kind, position.x, position.y, &square);
        if (below.key) {
            const float high = scrap_height(below.x, below.y, below.key), soft = 0.34f + 0.9f * high;
            const float dark = leaf_shown(&below, footprint) * mixf(0.9f, 0.6f, high / SCRAP_FLAT);
            leaf_over(&below, position, 0, (const float[2]){0, 0},
                      dark * stepf(-soft, 0.1f, scrap_depth(below.x, below.y, below.key)), ash);
        }

        // down the view ray
        const int steps = kind < 2 ? ASH_STEPS : 1;
        const float top = SCRAP_FLAT * ash_kinds[kind].largest;
        float above = 0, last = top;
        uint32_t key = 0;
        for (int k = 0; k <= steps; k++) {
            const float z = top * (1 - (float)k / (float)steps);
            Leaf leaf = leaf_find(seed, kind, position.x + z * view[0], position.y + z * view[1], &square);
            const float over = leaf.key ? z - leaf.size * scrap_height(leaf.x, leaf.y, leaf.key) : 0;
            if (leaf.key && leaf.key == key && over * above < 0) {
                const float met = mixf(z, last, over / (over - above));
                leaf = leaf_find(seed, kind, position.x + met * view[0], position.y + met * view[1], &square);
                const float soft = 0.6f * footprint / leaf.size, depth = scrap_depth(leaf.x, leaf.y, leaf.key);
                const float cover =
                    leaf.key == key ? leaf_shown(&leaf, footprint) * stepf(-soft, soft + 0.03f, depth) : 0;
                float tilt[2];
                if (cover > 0)
                    leaf_over(&leaf, position, leaf_look(&leaf, depth, view, footprint, tilt), tilt, cover, ash);
                if (cover > 0.5f) break;
            }
            key = leaf.key, above = over, last = z;
        }
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
