// Woven cloth: its threads, and what a fire leaves of them.
//
// Threads run along v (the warp) and along u (the weft), in a plain weave. They are counted from the sheet at the start, so
// that they stay where they are while it burns. Where a pixel no longer resolves them, they fade, and what is left is the
// unevenness of bundles of 2, 4, 8, ... threads.
//
// Threads give way one by one. A thread's fate is its own noise, and that of bundles of 2 to 16 threads of both families:
// so single threads, and tufts of them, stand out at a burnt edge, and holes in burnt cloth are slits along threads, of
// many sizes. There is a hole where neither thread is left.

#include "preview/shape_look.h"

#define FRAY 10.0f ///< threads, mean depth to which a burnt edge loses them
#define FATE_MOST 0.8f
#define LONG 16.0f     ///< how much longer than wide the patches are in which a bundle has one fate
#define CLOSED 0.5f    ///< half a thread's width over the pitch, of whole cloth
#define SHRUNKEN 0.36f ///< the same of char

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

/// How much sooner than others threads give way there, about -1 to 1, in bundles of 2 to 16 of both families at once: what each
/// family loses alone would end along the other's threads, in stairs of squares.
static float bundle_fate(const float at[2], float wide) {
    float sum = 0, size = 2, weight = 0.36f;
    for (uint32_t octave = 1; octave <= 4; octave++, size *= 2, weight *= 1.12f) {
        const float shown = resolved(size, wide);
        if (shown <= 0) continue;
        sum += shown * weight *
               (noise2(at[0] / size, at[1] / (LONG * size), 71 + 7 * octave) +
                noise2(at[1] / size, at[0] / (LONG * size), 171 + 7 * octave));
    }
    return sum;
}

/// How far burnt cloth has fallen to pieces there, about -1 to 1: rips of sizes in octaves, here along one family of threads and
/// there along the other.
static float cloth_damage(float x, float y, float wide) {
    const float aspect = 5, lean = 0.7f * noise2(x / 90, y / 90, 150);
    float sum = -0.34f, weight = 0.6f, size = 56;
    for (uint32_t octave = 0; octave < 4; octave++, size *= 0.4f, weight *= 0.85f) {
        const float shown = resolved(size, wide);
        if (shown <= 0) break;
        const float warp = noise2(x / size, y / (aspect * size), 151 + octave);
        const float weft = noise2(x / (aspect * size), y / size, 161 + octave);
        sum += shown * weight * maxf(warp + lean, weft - lean);
    }
    return sum;
}

void cloth_find(const Weave *weave, const PaperState *state, float burn, float footprint, Cloth *cloth) {
    const float wide = footprint / weave->pitch, burnt = stepf(PAPER_WHOLE, 0.6f, burn);
    const float x = state->uv[0] * weave->threads[0], y = state->uv[1] * weave->threads[1];
    const float hot = ember_activity(state->burn_rate) * stepf(600, 760, state->temperature);
    const float edge = state->edge / weave->pitch, loose = burnt * (1 - stepf(2, CLOTH_EDGE, edge));
    *cloth = (Cloth){.shown = clampf(1.9f - 3.6f * wide, 0, 1), .burnt = burnt};
    if (cloth->shown + burnt <= 0) return;

    // burnt threads lie unevenly and in waves, and their ends bend aside
    float at[2] = {x, y};
    if (burnt > 0) {
        const float aside = cloth->shown * (0.5f * burnt + 2 * loose), wave = 5 * burnt;
        at[0] += wave * noise2(0.021f * x, 0.013f * y, 63);
        at[1] += wave * noise2(0.013f * x, 0.021f * y, 64);
        if (aside > 0) at[0] += aside * noise2(0.13f * x, 0.08f * y, 61);
        if (aside > 0) at[1] += aside * noise2(0.08f * x, 0.13f * y, 62);
    }

    // far from where it could give way?
    const float damage = burnt > 0 ? cloth_damage(at[0], at[1], wide) : 0;
    const float worn = 0.9f - 0.4f * stepf(0.45f, 0.9f, burn);
    const bool firm = burnt <= 0 || (edge >= CLOTH_EDGE && damage + 0.5f * FATE_MOST + 0.25f < worn);
    const float fates = firm ? 0 : bundle_fate(at, wide);
    int thread[2];
    for (int k = 0; k < 2; k++) {
        float within, along = at[1 - k];
        thread[k] = noise_floor(at[k], &within);
        const uint32_t seed = 71 + 100 * (uint32_t)k;
        const float own = hash_unit((uint32_t)thread[k] * 0x9e3779b1u + seed);
        float half = CLOSED;
        if (burnt > 0 && cloth->shown > 0) {
            const float thin = 0.8f + 0.5f * own + 0.3f * noise2(1.7f * (float)thread[k], 0.21f * along, seed + 40);
            half = mixf(CLOSED, SHRUNKEN * thin, burnt * cloth->shown);
        }
        cloth->across[k] = (within - 0.5f) / half;
        cloth->tone[k] = own - 0.5f;
        cloth->gone[k] = fabsf(cloth->across[k]) > 1;
        if (firm) continue;

        float fate = fates;
        if (wide < 2) fate += 0.45f * resolved(1, wide) * noise2((float)thread[k], along / LONG, seed);
        fate = clampf(fate, -FATE_MOST, FATE_MOST);
        const float bite = minf(
            burnt * FRAY * (1 - 0.75f * hot) * maxf(0.4f + 1.7f * fate + 2.1f * maxf(damage, -0.1f), 0), CLOTH_EDGE);
        cloth->gone[k] = cloth->gone[k] || edge < bite || damage + 0.5f * fate + 0.5f * cloth->tone[k] > worn;
        cloth->end[k] = 1 - stepf(0, 3, edge - bite);
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

    // slubs: bundles of threads that are thicker for some way
    const float fine = clampf(2 - 0.9f * wide, 0, 1), coarse = resolved(9, wide);
    float slub = 0;
    for (int k = 0; k < 2; k++) {
        const float at = state->uv[k] * weave->threads[k], along = state->uv[1 - k] * weave->threads[1 - k];
        if (fine > 0) slub += fine * 0.05f * noise2(0.4f * at, 0.011f * along, 91 + (uint32_t)k);
        if (coarse > 0) slub += coarse * 0.03f * noise2(0.11f * at, 0.004f * along, 93 + (uint32_t)k);
    }

    const float a2 = across * across, dip = over * over;
    const float tone = 1 + 0.16f * cloth->tone[top] - 0.30f * a2 * a2 - 0.22f * dip * dip;
    return (1 + slub) * mixf(1, 1.12f * tone, cloth->shown);
}

void cloth_char(const Weave *weave, const PaperState *state, const Cloth *cloth, float burn, float threads,
                Point *point) {
    const float wide = point->footprint / weave->pitch;
    float bundle[2], relief[2];
    for (int k = 0; k < 2; k++) {
        const float at = state->uv[k] * weave->threads[k], along = state->uv[1 - k] * weave->threads[1 - k];
        float sum = 0, slope = 0, size = 3, weight = 0.55f;
        for (uint32_t octave = 0; octave < 4; octave++, size *= 2.2f, weight *= 0.85f) {
            const float shown = resolved(0.5f * size, wide);
            if (shown <= 0) continue;
            const uint32_t seed = 171 + 10 * (uint32_t)k + octave;
            const float n = noise2(at / size, along / (9 * size), seed);
            sum += shown * weight * n;
            slope += shown * weight * (noise2(at / size + 0.3f, along / (9 * size), seed) - n) / 0.3f;
        }
        bundle[k] = sum;
        relief[k] = slope;
    }

    // it shrinks in bundles, over and under each other: crowns are grey with ash, and hollows black; where it has just
    // charred it is brown
    const float charred = stepf(0.2f, 0.45f, burn), up = bundle[0] + bundle[1], top = maxf(bundle[0], bundle[1]);
    const float ash =
        charred * stepf(0.42f, 0.7f, burn) * stepf(0.15f, 0.95f, top) * (1 - stepf(520, 760, state->temperature));
    const float brown = charred * (1 - stepf(0.45f, 0.75f, burn)) * stepf(-0.4f, 0.6f, up);
    point->albedo = float3_mix(point->albedo, float3(0.060f, 0.030f, 0.015f), 0.7f * brown);
    point->albedo = float3_scale(point->albedo, 1 + charred * clampf(0.75f * up, -0.6f, 0.9f));
    point->albedo = float3_mix(point->albedo, float3(0.155f, 0.150f, 0.143f), 0.75f * ash);
    Float3 lean = float3_mad(float3_scale(point->across[0], relief[0]), point->across[1], relief[1]);
    Float3 tilted = float3_unit_or(float3_mad(point->normal, lean, -0.55f * charred), point->normal);
    if (float3_dot(tilted, point->view) > 0.02f) point->normal = tilted;

    const float glows = 1 + charred * clampf(0.9f * top - 0.25f, -0.7f, 0.6f);
    point->albedo = float3_scale(point->albedo, threads);
    point->glow =
        float3_scale(point->glow, glows * mixf(1, threads, cloth->shown) * (1 + 1.5f * cloth->end[cloth->top]));
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
