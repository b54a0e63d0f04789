// Woven cloth: its threads, and what a fire leaves of them.
//
// Threads run along v (the warp) and along u (the weft), in a plain weave. They are counted from the sheet at the start, so
// that they stay where they are while it burns. Where a pixel no longer resolves them, they fade, and what is left is the
// unevenness of bundles of 2, 4, 8, ... threads.
//
// Whole cloth is worn and washed: it has creases of some sizes, which wander, cross, and lie in patches. Fibres stand out of its
// threads: where it turns away from the eye they are what is seen, pale and soft, whatever its dye.
//
// Burnt cloth falls to pieces in rounded holes of many sizes, and its threads lie in waves. Beyond its ends strands of some
// threads, and single ones where a pixel resolves them, stand out, each to its own length, and curl. There is a hole where
// neither thread is left.

#include "preview/shape_look.h"

#define FRAY 15.0f       ///< threads, depth to which a burnt edge loses them
#define REACH 28.0f      ///< threads, to which the longest stand out at it
#define STRANDS 11.0f    ///< threads from strand to strand
#define STRAND 1.0f      ///< threads, half of its width
#define WORN 0.58f       ///< damage at which char has a hole
#define HOLE_SLOPE 30.0f ///< threads from there to where it is 1 more
#define CLOSED 0.5f      ///< half a thread's width over the pitch, of whole cloth
#define SHRUNKEN 0.36f   ///< the same of char
#define RIM_GLOW 2.0f    ///< threads, half the width of the line that glows along a burnt edge
#define RIM_HOT 1190.0f  ///< K, of that line at most

#define CREASE_WIDE 0.052f ///< m, from one of the largest creases to the next
#define CREASE_STEEP 0.44f ///< slope of their sides
#define CREASE_MOST 0.60f  ///< slope that none reaches where they cross
#define CREASE_LONG 3.2f   ///< their length over their width
#define CREASE_FLAT 0.75f  ///< how much flatter the largest are where cloth lies
#define CREASE_LAIN 0.5f   ///< of that, the part of the smallest
#define FUZZ_WRAP 0.35f    ///< cosine by which light goes around what is round, by its fibres
#define FUZZ_MOST 0.42f    ///< share of fibres that stand out in what is seen, where cloth turns away

#define SCORCH_FIRST 2.5f  ///< K, at which cloth yellows
#define SCORCH_LAST 420.0f ///< K, at which it is as brown as heat alone makes it
#define SCORCH_MOST 0.74f  ///< how brown that is

// ---- the threads of a sheet

/// Lengths of the cell's first and last side, and how far they go along u and v.
static void cloth_side(const PreviewStart *start, uint32_t cell, int corner, Float3 *side, float uv[2]) {
    const uint32_t a = start->cells[4 * cell], b = start->cells[4 * cell + (uint32_t)corner];
    const float *from = start->corner_uv ? start->corner_uv + 8 * (size_t)cell : start->uv + 2 * (size_t)a;
    const float *to = start->corner_uv ? from + 2 * corner : start->uv + 2 * (size_t)b;
    *side = float3_sub(float3_load(start->positions + 3 * (size_t)b), float3_load(start->positions + 3 * (size_t)a));
    for (int k = 0; k < 2; k++) uv[k] = to[k] - from[k];
}

void cloth_count(const PreviewDef *def, uint32_t sheet, Weave *weave) {
    *weave = (Weave){.pitch = 0};
    const PreviewStart *start = def->starts ? &def->starts[sheet] : NULL;
    const float pitch = def->looks ? def->looks[sheet].weave : 0;
    if (!(pitch > 0) || !start || !(start->uv || start->corner_uv)) return;

    // P = P0 + U u + V v in each cell; the means of |U| and |V|, weighted by the area over uv
    double length[2] = {0, 0}, total = 0;
    for (uint32_t cell = 0; cell < start->cell_count; cell++) {
        Float3 p, q;
        float a[2], b[2];
        cloth_side(start, cell, 1, &p, a);
        cloth_side(start, cell, 3, &q, b);
        const float turn = a[0] * b[1] - a[1] * b[0];
        if (!(fabsf(turn) > 1e-14f)) continue;
        Float3 u = float3_scale(float3_sub(float3_scale(p, b[1]), float3_scale(q, a[1])), 1 / turn);
        Float3 v = float3_scale(float3_sub(float3_scale(q, a[0]), float3_scale(p, b[0])), 1 / turn);
        length[0] += (double)(fabsf(turn) * float3_length(u));
        length[1] += (double)(fabsf(turn) * float3_length(v));
        total += (double)fabsf(turn);
    }

    for (int k = 0; k < 2 && total > 0; k++) weave->threads[k] = (float)(length[k] / total) / pitch;
    if (weave->threads[0] > 0 && weave->threads[1] > 0 && weave->threads[0] < 1e7f && weave->threads[1] < 1e7f)
        weave->pitch = pitch;
}

const Weave *cloth_weave(const Preview *preview, int32_t sheet) {
    if (!preview->weaves || sheet < 0 || (uint32_t)sheet >= preview->def.sheet_count) return NULL;
    const Weave *weave = &preview->weaves[sheet];
    return weave->pitch > 0 ? weave : NULL;
}

void cloth_frame(const PreviewScene *scene, uint32_t triangle, Point *point) {
    const uint32_t *t = scene->triangles[triangle];
    const PaperVertex *a = &scene->vertices[t[0]], *b = &scene->vertices[t[1]], *c = &scene->vertices[t[2]];
    Float3 origin = float3_load(scene->positions[t[0]]);
    Float3 p = float3_sub(float3_load(scene->positions[t[1]]), origin);
    Float3 q = float3_sub(float3_load(scene->positions[t[2]]), origin);
    const float pu = b->uv[0] - a->uv[0], pv = b->uv[1] - a->uv[1], qu = c->uv[0] - a->uv[0], qv = c->uv[1] - a->uv[1];
    const float turn = pu * qv - pv * qu > 0 ? 1 : -1;
    point->across[0] =
        float3_unit_or(float3_scale(float3_sub(float3_scale(p, qv), float3_scale(q, pv)), turn), float3(1, 0, 0));
    point->across[1] =
        float3_unit_or(float3_scale(float3_sub(float3_scale(q, pu), float3_scale(p, qu)), turn), float3(0, 1, 0));
}

// ---- a point

static float resolved(float threads, float wide) { return clampf(1.6f - 0.8f * wide / threads, 0, 1); }

/// Noise of features that wide, about twice as long, 0 where a pixel does not resolve it. Its direction follows from the seed,
/// and is never the threads': what ends along these ends in steps.
static float oblique(const float at[2], float size, float wide, uint32_t seed) {
    static const float direction[5][2] = {
        {0.500f, 0.866f}, {0.829f, 0.559f}, {-0.848f, 0.530f}, {-0.559f, 0.829f}, {0.719f, 0.695f}};
    const float shown = resolved(0.5f * size, wide);
    if (shown <= 0) return 0;
    const float c = direction[seed % 5][0] / size, s = direction[seed % 5][1] / size;
    return shown * noise2(c * at[0] + s * at[1], 0.55f * (c * at[1] - s * at[0]), seed);
}

/// The creases of whole cloth: how high it lies, about -1 to 1, and its slope along u and v.
typedef struct Creases {
    float height, slope[2];
} Creases;

/// noise2 and its gradient.
static float noise2_slope(float x, float y, uint32_t seed, float slope[2]) {
    float fx, fy;
    const uint32_t ix = (uint32_t)noise_floor(x, &fx) * 0x8da6b343u, iy = (uint32_t)noise_floor(y, &fy) * 0xd8163841u;
    const uint32_t jx = ix + 0x8da6b343u, jy = iy + 0xd8163841u, s = seed * 0xcb1ab31fu;
    const float a = noise_corner(ix ^ iy ^ s), b = noise_corner(jx ^ iy ^ s), c = noise_corner(ix ^ jy ^ s),
                d = noise_corner(jx ^ jy ^ s);
    const float sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
    slope[0] = 6 * fx * (1 - fx) * mixf(b - a, d - c, sy);
    slope[1] = 6 * fy * (1 - fy) * mixf(c - a, d - b, sx);
    return mixf(mixf(a, b, sx), mixf(c, d, sx), sy);
}

/// Creases lie where noise, long in an oblique direction, changes sign. The largest are round: sharp ones make
/// facets, as of paper. Where cloth lies its weight flattens them: slopes as of what hangs were blotches beside a low fire.
static Creases cloth_creases(const Weave *weave, const PaperState *state, const Point *point) {
    static const float direction[6][2] = {{0.940f, 0.342f},  {0.766f, -0.643f}, {0.574f, 0.819f},
                                          {0.906f, -0.423f}, {0.259f, 0.966f},  {0.643f, 0.766f}};
    const float x = state->uv[0] * weave->threads[0] * weave->pitch,
                y = state->uv[1] * weave->threads[1] * weave->pitch;
    const float footprint = point->footprint / maxf(float3_dot(point->geometric, point->view), 0.2f);
    const float lies = stepf(0.4f, 0.9f, fabsf(point->geometric.z));
    const float bow = 0.35f * CREASE_WIDE * noise2(x / 0.06f, y / 0.06f, 241);
    const float patch = stepf(-0.7f, 0.5f, noise2(x / 0.13f + 3.7f, y / 0.13f, 242));
    Creases creases = {.height = 0};
    float size = CREASE_WIDE, weight = 0.8f;
    for (uint32_t k = 0; k < 6; k++) {
        const float shown = clampf(2.4f - 14 * footprint / size, 0, 1);
        if (shown <= 0) break;
        const float c = direction[k][0] / size, s = direction[k][1] / size, px = x + bow, py = y - 0.7f * bow;
        float slope[2];
        const float n = noise2_slope(c * px + s * py, (c * py - s * px) / CREASE_LONG, 243 + k, slope);
        const float sharp = sqrtf(n * n + 0.015f + 0.09f * size / CREASE_WIDE),
                    steep = shown * weight * mixf(0.35f, 1, patch) *
                            (1 - lies * mixf(CREASE_LAIN, 1, size / CREASE_WIDE) * CREASE_FLAT);
        const float fall = -steep * CREASE_STEEP * n / sharp; // of the ridge, over the slope of the noise
        slope[1] /= CREASE_LONG;
        creases.height += steep * 0.5f * (0.45f - 1.3f * sharp);
        creases.slope[0] += fall * (direction[k][0] * slope[0] - direction[k][1] * slope[1]);
        creases.slope[1] += fall * (direction[k][1] * slope[0] + direction[k][0] * slope[1]);
        if (k & 1) size *= 0.42f, weight *= 0.9f;
    }
    const float steep = hypotf(creases.slope[0], creases.slope[1]) / CREASE_MOST, less = 1 / sqrtf(1 + steep * steep);
    creases.slope[0] *= less;
    creases.slope[1] *= less;
    return creases;
}

/// How far burnt cloth has fallen to pieces there, about -1 to 1: rounded holes of sizes in octaves.
static float cloth_damage(const float at[2], float wide) {
    float sum = 0, weight = 0.76f, size = 60;
    for (uint32_t octave = 0; octave < 5; octave++, size *= 0.45f, weight *= 0.62f)
        sum += weight * oblique(at, size, wide, 151 + octave);
    return sum;
}

/// Burnt threads lie in waves, as they have shrunk unevenly; `loose` ones curl.
static void cloth_bend(float x, float y, float burnt, float loose, float wide, float at[2]) {
    const float from[2] = {x, y};
    memcpy(at, from, sizeof from);
    for (uint32_t k = 0; k < 2 && burnt > 0; k++) {
        at[k] += burnt * 20 * oblique(from, 70, wide, 63 + k);
        at[k] += burnt * 9 * oblique(from, 22, wide, 65 + k);
        at[k] += burnt * 4 * oblique(from, 11, wide, 61 + k);
        if (loose > 0) at[k] += loose * 30 * oblique(from, 36, wide, 67 + k);
    }
}

/// How far a thread stands out beyond cloth's end, in threads: strands of some that stick together, each to its own length, and
/// single ones where a pixel resolves them. A strand is at least a pixel wide, or it were a row of crumbs.
static float thread_reach(float at, float along, float pixel, float most, float tuft, uint32_t seed) {
    float within;
    const uint32_t strand = hash_u32((uint32_t)noise_floor(at / STRANDS, &within) * 0x85ebca6bu + seed);
    const float length = hash_unit(strand), middle = 0.2f + 0.6f * hash_unit(strand + 1);
    const float single = resolved(1, pixel);
    const float wide = maxf(STRAND * (1 + 0.4f * noise2(along / 9, length, seed + 3)), 0.3f * pixel),
                off = STRANDS * fabsf(within - middle);
    float reach = (tuft < 0 ? 0.40f : 0.12f) * tuft - 0.03f; // pinholes, and no islands
    if (single > 0) {
        const float fate = hash_unit((uint32_t)noise_floor(at, &within) * 0x85ebca6bu + seed);
        reach += single * (0.8f * fate * fate * fate * fate + 0.2f * noise2(at, along / 23, seed + 2));
    }
    return REACH * (off < wide ? maxf(reach, most * length * length) : reach);
}

void cloth_find(const Weave *weave, const PaperState *state, float burn, float footprint, Cloth *cloth) {
    const float wide = footprint / weave->pitch, burnt = stepf(PAPER_WHOLE, 0.6f, burn);
    const float x = state->uv[0] * weave->threads[0], y = state->uv[1] * weave->threads[1];
    const float hot = ember_activity(state->burn_rate) * stepf(600, 760, state->temperature);
    const float edge = state->edge / weave->pitch;
    *cloth = (Cloth){.shown = clampf(1.9f - 3.6f * wide, 0, 1), .burnt = burnt, .left = CLOTH_EDGE};

    float at[2];
    cloth_bend(x, y, burnt, 0, wide, at);
    memcpy(cloth->at, at, sizeof at);
    if (cloth->shown + burnt <= 0) return;

    // how many threads it is from there to where cloth ends: the border of the piece, from which much has crumbled, and holes
    const float damage = burnt > 0 ? cloth_damage(at, wide) : -1;
    const float worn = WORN - 0.4f * stepf(0.45f, 0.9f, burn);
    // what burns crumbles less, but is nibbled, or its rim followed the sides of cells
    const float nibble = 5.5f * oblique(at, 28, wide, 156) + 3.2f * oblique(at, 9, wide, 157);
    const float bite =
        burnt * (FRAY * (1 - 0.65f * hot) * maxf(0.6f + 1.5f * damage, 0.1f) + hot * maxf(3 + nibble, 0));
    const float left = minf((worn - damage) * HOLE_SLOPE, edge < CLOTH_EDGE ? edge - bite : INFINITY);
    cloth->left = left;
    const float loose = burnt * (1 - stepf(-REACH, 4, left));
    const bool firm = burnt <= 0 || left > 0.85f * REACH;
    if (loose > 0) cloth_bend(x, y, burnt, loose, wide, at);
    memcpy(cloth->at, at, sizeof at);

    const float lean = firm ? 0 : stepf(-0.2f, 0.2f, oblique(at, 70, wide, 70)); // one family's strands are left
    const float single = resolved(1, wide), tuft = firm ? 0 : oblique(at, 8, wide, 69);
    int thread[2];
    for (int k = 0; k < 2; k++) {
        float within, along = at[1 - k];
        thread[k] = noise_floor(at[k], &within);
        const uint32_t seed = 71 + 100 * (uint32_t)k;
        const float own = hash_unit((uint32_t)thread[k] * 0x9e3779b1u + seed);
        float half = CLOSED;
        if (burnt > 0 && single > 0) {
            const float thin = 0.8f + 0.5f * own + 0.3f * noise2(1.7f * (float)thread[k], 0.21f * along, seed + 40);
            half = mixf(CLOSED, SHRUNKEN * thin, burnt * maxf(cloth->shown, loose * single));
        }
        cloth->across[k] = (within - 0.5f) / half;
        cloth->tone[k] = own - 0.5f;
        cloth->gone[k] = fabsf(cloth->across[k]) > 1;
        if (!firm)
            cloth->gone[k] = cloth->gone[k] || edge < 0.5f ||
                             left + thread_reach(at[k], along, wide, k ? lean : 1 - lean, tuft, seed) < 0;
    }

    cloth->top = (thread[0] + thread[1]) & 1;
    if (cloth->gone[cloth->top]) cloth->top = 1 - cloth->top;
}

bool cloth_is_hole(const Cloth *cloth) { return cloth->gone[0] && cloth->gone[1]; }

float cloth_shade(const Weave *weave, const PaperState *state, const Cloth *cloth, Point *point) {
    const int top = cloth->top;
    const float wide = point->footprint / weave->pitch, across = clampf(cloth->across[top], -1, 1);

    // a thread is a cylinder that goes over its neighbour and dips beside it
    const float over = 0.9f * clampf(cloth->across[1 - top], -1, 1);
    Float3 lean = float3_mad(float3_scale(point->across[top], across * (0.55f + 0.35f * across * across)),
                             point->across[1 - top], 0.5f * over);
    Float3 tilted = float3_unit_or(float3_mad(point->normal, lean, 0.6f * cloth->shown), point->normal);
    if (float3_dot(tilted, point->view) > 0.02f) point->normal = tilted;

    // slubs: bundles of threads that are thicker for some way, too short to cross each other in a plaid
    const float fine = clampf(2 - 0.9f * wide, 0, 1), coarse = resolved(5, wide);
    float slub = 0;
    for (int k = 0; k < 2; k++) {
        const float at = state->uv[k] * weave->threads[k], along = state->uv[1 - k] * weave->threads[1 - k];
        if (fine > 0) slub += fine * 0.05f * noise2(0.4f * at, 0.08f * along, 91 + (uint32_t)k);
        if (coarse > 0) slub += coarse * 0.02f * noise2(0.19f * at, 0.04f * along, 93 + (uint32_t)k);
    }

    const Creases creases = cloth_creases(weave, state, point);
    const float whole = 1 - cloth->burnt, side = point->back ? whole : -whole;
    // what the fibres hide is by the cloth as it hangs: sides of creases were pale streaks across its print
    const float away = 1 - maxf(float3_dot(point->normal, point->view), 0);
    Float3 creased = float3_mad(float3_mad(point->normal, point->across[0], side * creases.slope[0]), point->across[1],
                                side * creases.slope[1]);
    creased = float3_unit_or(creased, point->normal);
    const float hidden = maxf(0.06f - float3_dot(creased, point->view), 0); // what turns away from the eye is not seen
    point->normal = float3_unit_or(float3_mad(creased, point->view, hidden), point->normal);
    const float hollow = 1 + 0.16f * clampf(point->back ? -creases.height : creases.height, -1, 1) * whole;

    point->fuzz = FUZZ_WRAP * whole;
    const float fuzz = FUZZ_MOST * whole * away * away * away;
    point->albedo = float3_mix(point->albedo, float3(0.80f, 0.79f, 0.77f), fuzz);

    const float a2 = across * across, dip = over * over;
    const float tone = 1 + 0.16f * cloth->tone[top] - 0.30f * a2 * a2 - 0.22f * dip * dip;
    return hollow * (1 + slub) * mixf(1, 1.12f * tone, cloth->shown);
}

/// Cloth browns by the logarithm of its heat, which falls off evenly from a front: a fire's vapour condenses on cloth that is
/// hardly warm. Along threads all this spreads farther, and the ridges of creases, which stand in the hot gas, are browner than
/// their hollows.
float cloth_scorch(const Weave *weave, const PaperState *state, Point *point) {
    const float above = maxf(state->peak, state->temperature) - CLOTH_WARM, wide = point->footprint / weave->pitch;
    if (above <= 0) return 0;
    const float at[2] = {state->uv[0] * weave->threads[0], state->uv[1] * weave->threads[1]};
    float uneven = 0.8f * oblique(at, 90, wide, 211) + 0.5f * oblique(at, 30, wide, 212);
    for (int k = 0; k < 2; k++)
        uneven += 0.45f * resolved(4, wide) * noise2(at[k] / 4, at[1 - k] / 60, 213 + (uint32_t)k);
    const float height = cloth_creases(weave, state, point).height;
    uneven += 1.1f * (point->back ? -height : height);
    const float by_heat = (logf(above / SCORCH_FIRST) + uneven) / logf(SCORCH_LAST / SCORCH_FIRST);
    const float scorch = 1 - (1 - SCORCH_MOST * powf(clampf(by_heat, 0, 1), 0.8f)) * expf(-4 * maxf(state->burn, 0));
    point->albedo = float3_mix(point->albedo, float3(0.66f, 0.65f, 0.62f), 0.8f * stepf(0.2f, 0.7f, scorch));
    Float3 warm = float3_mix(float3(1, 1, 1), float3(1.06f, 0.93f, 0.86f), stepf(0.05f, 0.4f, scorch)); // less green
    point->albedo = float3_mul(point->albedo, warm);
    return scorch;
}

float cloth_char(const Weave *weave, const PaperState *state, const Cloth *cloth, float burn, float threads,
                 Point *point) {
    const float wide = point->footprint / weave->pitch;
    float bundle[2], relief[2];
    for (int k = 0; k < 2; k++) {
        const float at = cloth->at[k], along = cloth->at[1 - k];
        float sum = 0, slope = 0, size = 3, weight = 0.5f;
        for (uint32_t octave = 0; octave < 4; octave++, size *= 2.2f, weight *= 0.85f) {
            const float shown = resolved(0.5f * size, wide);
            if (shown <= 0) continue;
            const uint32_t seed = 171 + 10 * (uint32_t)k + octave;
            const float n = noise2(at / size, along / (5 * size), seed);
            sum += shown * weight * n;
            slope += shown * weight * (noise2(at / size + 0.3f, along / (5 * size), seed) - n) / 0.3f;
        }
        bundle[k] = sum;
        relief[k] = 0.6f * slope;
    }

    // it wrinkles
    float wrinkle = 0, size = 44, weight = 0.7f;
    for (uint32_t octave = 0; octave < 3; octave++, size *= 0.45f, weight *= 0.8f) {
        const float n = oblique(cloth->at, size, wide, 191 + octave);
        wrinkle += weight * n;
        for (int k = 0; k < 2; k++) {
            float beside[2] = {cloth->at[0], cloth->at[1]};
            beside[k] += 0.2f * size;
            relief[k] += weight * (oblique(beside, size, wide, 191 + octave) - n) / 0.2f;
        }
    }

    // it shrinks in bundles, over and under each other: crowns are grey with ash, and hollows black; where it has just
    // charred it is brown
    const float charred = stepf(0.2f, 0.45f, burn), top = maxf(bundle[0], bundle[1]),
                up = top - 0.25f + 0.35f * wrinkle;
    const float cold = charred * (1 - stepf(520, 760, state->temperature));
    const float ash = cold * stepf(0.42f, 0.7f, burn) * stepf(0.15f, 0.95f, top);
    // rims are paler, but where they are hot: there the ash was a line that seemed drawn
    const float torn = cold * (1 - stepf(0.5f, 5, cloth->left)) * stepf(-0.3f, 0.3f, wrinkle);
    const float brown = charred * (1 - stepf(0.45f, 0.75f, burn)) * stepf(-0.4f, 0.6f, up);
    point->albedo = float3_mix(point->albedo, float3(0.060f, 0.030f, 0.015f), 0.7f * brown);
    point->albedo = float3_scale(point->albedo, 1 + charred * clampf(0.5f * up, -0.5f, 0.6f));
    point->albedo = float3_mix(point->albedo, float3(0.155f, 0.150f, 0.143f), 0.6f * ash);
    point->albedo = float3_mix(point->albedo, float3(0.190f, 0.182f, 0.170f), 0.4f * torn);
    Float3 lean = float3_mad(float3_scale(point->across[0], relief[0]), point->across[1], relief[1]);
    Float3 tilted = float3_unit_or(float3_mad(point->normal, lean, -0.36f * charred), point->normal);
    if (float3_dot(tilted, point->view) > 0.02f) point->normal = tilted;

    point->albedo = float3_scale(point->albedo, threads);
    return 1 - stepf(-0.4f, 0.3f, up);
}

/// A line so far from its middle, in threads; narrower than a pixel it is drawn a pixel wide and paler.
static float cloth_line(float distance, float width, float wide) {
    const float seen = maxf(width, 0.6f * wide), x = distance / seen;
    return width / seen * expf(-x * x);
}

/// What glows of char: its rim, in a line broken in length and brightness, where it still burns; some lines that creep over it;
/// and between them, dully, what lies deep. Below a flame it is dark.
void cloth_glow(const Preview *preview, const Weave *weave, const PaperState *state, const Cloth *cloth, float deep,
                Point *point) {
    const float line = stepf(CHAR_LEAF, EMBER_BURN, state->burn) * ember_activity(state->burn_rate);
    const float alone = maxf(ember_activity(state->glowing), 0.4f * line);
    const float starved = ember_starved(state->starved, state->burn, alone);
    const float mean = ember_temperature(state->temperature), wide = point->footprint / weave->pitch;
    point->glow = float3(0, 0, 0);
    if (alone + starved < 0.02f || mean < BLACKBODY_MIN) return;

    // how much burns there, 0 to 1: most of a rim is dead for some centimetres, and the rest of it varies
    const float t = (float)fmod(preview->time, 4096.0), *place = cloth->at;
    const float far[2] = {place[0] + 0.9f * t, place[1] - 0.6f * t},
                near[2] = {place[0] - 1.7f * t, place[1] + 1.1f * t};
    const float alive = 0.75f * oblique(far, 90, wide, 201) + 0.5f * oblique(near, 34, wide, 202);
    const float life = stepf(-0.05f, 0.5f, alive + 0.2f * oblique(near, 12, wide, 203));

    // a rim glows from a point to two millimetres wide, dull red but for few spots, with gaps
    const float uneven = 0.8f * oblique(near, 15, wide, 208) + 0.6f * oblique(near, 6, wide, 209);
    const float spot = stepf(0.3f, 0.75f, uneven + 0.35f * life);
    const float rim = cloth_line(cloth->left, RIM_GLOW * clampf(0.25f + 0.7f * life + 1.7f * uneven, 0.04f, 2), wide);
    const float bow = 5 * oblique(cloth->at, 9, wide, 207), at[2] = {cloth->at[0] + bow - 0.8f * t, cloth->at[1] - bow};
    const float creeping = life > 0 ? cloth_line(32 * fabsf(oblique(at, 80, wide, 205)), 0.9f, wide) : 0;
    const float hot = 1.5f * life * maxf(rim, 0.22f * creeping);
    const float temperature = minf(mean, RIM_HOT) - 190 + 100 * life + 130 * spot;
    Float3 bright = blackbody_glow(preview->blackbody, temperature);
    Float3 dull = blackbody_glow(preview->blackbody, temperature - 130);
    Float3 glow = float3_scale(bright, hot * (0.5f * alone + 0.1f * starved));
    glow = float3_mad(glow, dull, alone * (0.03f + 0.3f * life) * deep);
    glow = float3_scale(glow, EMBER_GAIN * ember_air(preview, point->position));
    point->glow = float3_scale(glow, 1 / (1 + maxf(glow.x, maxf(glow.y, glow.z)) / EMBER_MOST));
}

// ---- cloth over a shape

#define COVER_PITCH 0.0011f ///< m from thread to thread
#define COVER_SEAMS 4       ///< around what is round

void shape_cloth(const Place *place, Point *point) {
    const float footprint = point->footprint;
    const Float3 p = place->p, n = place->normal;
    const float side = fabsf(n.x), front = fabsf(n.y), top = fabsf(n.z);
    float s = side > maxf(front, top) ? p.y : p.x, t = top > maxf(side, front) ? p.y : p.z, seam = 1;
    if (place->shape->kind == SINGE_COLLIDER_SPHERE || place->shape->kind == SINGE_COLLIDER_CAPSULE) {
        const float turn = atan2f(p.y, p.x) / (2 * PI_F);
        float within;
        noise_floor(turn * COVER_SEAMS, &within);
        s = turn * 2 * PI_F * place->shape->radius;
        t = p.z;
        seam = minf(within, 1 - within) * 2 * PI_F * hypotf(p.x, p.y) / COVER_SEAMS;
    }

    float tone = 0, relief[2] = {0, 0};

    // threads of uneven thickness, in bundles of 1 to 8
    float weight = 0.060f;
    for (uint32_t octave = 0; octave < 4; octave++, weight *= 0.55f) {
        const float wide = COVER_PITCH * (float)(1 << octave), shown = visible(1.4f * wide, footprint);
        if (shown <= 0) continue;
        const float warp = noise2(s / wide, t / (7 * wide), 421 + octave),
                    weft = noise2(s / (8 * wide), t / wide, 431 + octave);
        tone += shown * weight * (warp + weft);
        relief[0] += shown * 0.025f * warp;
        relief[1] += shown * 0.025f * weft;
    }

    const float shown = visible(COVER_PITCH, footprint);
    if (shown > 0) {
        float fs, ft;
        const int over = (noise_floor(s / COVER_PITCH, &fs) + noise_floor(t / COVER_PITCH, &ft)) & 1;
        const float x = 2 * fs - 1, y = 2 * ft - 1;
        tone -= shown * 0.28f * (over ? x * x : y * y);
        relief[over ? 0 : 1] += shown * 0.3f * (over ? x : y);
    }

    // a seam: a fold that casts a shadow, and puckers beside it
    const float groove = (1 - stepf(0.0003f, 0.0009f + footprint, seam)) * minf(1, 0.0012f / footprint);
    const float beside = expf(-seam / 0.006f), pucker = beside * noise2(7.3f, t / 0.005f, 441);
    const float stains = noise3(float3_scale(place->p, 14), 442) + 0.5f * noise3(float3_scale(place->p, 37), 443);
    tone += 0.05f * stains - 0.45f * groove + 0.04f * pucker;
    point->albedo = float3_scale(point->albedo, maxf(1 + tone, 0.2f));
    point->gloss = 0;
    point->mirror = 0.25f; // fuzz

    const float z = place->shape->kind == SINGE_COLLIDER_BOX ? 0.0f : relief[0];
    shape_lean(place, float3(place->normal.y * z, -place->normal.x * z, relief[1] + 0.2f * pucker), point);
}

/// Three strands that are twisted together along x.
void shape_cord(const Place *place, Point *point) {
    const Float3 p = place->p, n = place->normal;
    const float radius = place->shape->radius, turn = atan2f(n.z, n.y) / (2 * PI_F), pitch = 9 * radius;
    float within, shown = visible(0.25f * pitch, point->footprint);
    const int strand = noise_floor(3 * (turn + p.x / pitch), &within);
    const float x = 2 * within - 1, fibre = noise2(7 * x, p.x / (2.5f * radius), 451 + (uint32_t)strand);
    const float worn = noise2(p.x / 0.031f, turn, 452);
    const float tone = 0.10f * worn + shown * (0.14f - 0.55f * x * x * x * x + 0.12f * fibre);
    point->albedo = float3_scale(point->albedo, maxf(1 + tone, 0.2f));
    point->gloss = 0;
    point->mirror = 0.2f; // fuzz
    const Float3 around = float3_cross(float3(1, 0, 0), n);
    shape_lean(place, float3_scale(float3_mad(around, float3(1, 0, 0), 0.7f), -shown * 0.8f * x), point);
}
