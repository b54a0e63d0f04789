// The appearance of burning paper.
//
// The simulation's cells are too coarse for the picture, so its fields are perturbed at the picture's scale. With b the
// burnt share, T the temperature, P the peak temperature and N noise of the rest position (it moves with the paper),
//
//     b' = b + |grad b| delta + floor,   P' = P + |grad P| delta,
//     delta = k (1.5 N(4 mm) + 0.7 N(1.3 mm) + 0.22 N(0.45 mm))  in mm:
//
// isolines move by delta for any width of the front, so they become ragged and hide the grid; k is 1 for triangles of 2
// mm and more and decreases for finer ones, which are ragged themselves. The colours follow b' and P', because browned
// paper stays brown: white - yellow - tan - brown by ln(P' - 293 K), which is linear in the distance to the front; char
// by b' > 0.1, ash by b' > 0.8 once it has cooled (shade_ash.c), ember at b' = 0.74 (shade_ember.c).

#include "preview/shade_paper.h"

/// Linear colours that multiply the paper's, by its scorching in [0, 1].
static Float3 scorch_colour(float s) {
    static const float stop[7][4] = {{0.00f, 1.00f, 1.00f, 1.00f},    {0.14f, 0.965f, 0.90f, 0.74f},
                                     {0.32f, 0.85f, 0.655f, 0.36f},   {0.50f, 0.55f, 0.315f, 0.105f},
                                     {0.69f, 0.225f, 0.098f, 0.032f}, {0.86f, 0.062f, 0.031f, 0.018f},
                                     {1.00f, 0.020f, 0.016f, 0.014f}};
    int i = 1;
    while (i < 6 && s > stop[i][0]) i++;
    float f = clampf((s - stop[i - 1][0]) / (stop[i][0] - stop[i - 1][0]), 0, 1);
    return float3_mix(float3_load(stop[i - 1] + 1), float3_load(stop[i] + 1), f);
}

/// The position for noise: the rest position, rotated so that the noise's lattice is oblique to sheets and their grids.
static Float3 askew(Float3 r) {
    return float3(0.7654f * r.x - 0.5321f * r.y + 0.3622f * r.z, 0.6133f * r.x + 0.7718f * r.y - 0.1673f * r.z,
                  -0.1905f * r.x + 0.3481f * r.y + 0.9179f * r.z);
}

void paper_state(const PreviewScene *scene, uint32_t triangle, float u, float v, PaperState *state) {
    const uint32_t *t = scene->triangles[triangle];
    const PaperVertex *a = &scene->vertices[t[0]], *b = &scene->vertices[t[1]], *c = &scene->vertices[t[2]];
    float w = 1 - u - v, min = minf(a->rim, minf(b->rim, c->rim));
    *state = (PaperState){
        .rest = float3_blend(a->rest, b->rest, c->rest, u, v),
        .uv = {w * a->uv[0] + u * b->uv[0] + v * c->uv[0], w * a->uv[1] + u * b->uv[1] + v * c->uv[1]},
        .temperature = w * a->temperature + u * b->temperature + v * c->temperature,
        .peak = w * a->peak + u * b->peak + v * c->peak,
        .burn = w * a->burn + u * b->burn + v * c->burn,
        .burn_rate = w * a->burn_rate + u * b->burn_rate + v * c->burn_rate,
        .glowing = w * (a->burn_rate - a->flaming) + u * (b->burn_rate - b->flaming) + v * (c->burn_rate - c->flaming),
        .gradient = w * a->gradient + u * b->gradient + v * c->gradient,
        .heat_gradient = w * a->heat_gradient + u * b->heat_gradient + v * c->heat_gradient,
        .spacing = w * a->spacing + u * b->spacing + v * c->spacing,
        .age = w * a->age + u * b->age + v * c->age,
        // a triangle without inner corner has no distance information: a strip or a crumb, which should remain
        .rim = min > 0.5f ? 0.25f : w * a->rim + u * b->rim + v * c->rim,
        .sheet = a->sheet,
        .piece = a->piece,
    };
}

static Bent shade_paper_bend(const PaperState *state, float footprint) {
    Bent bent = {.position = askew(state->rest)};
    bent.coarse = paper_noise(bent.position, 4.0f, footprint, 1);
    bent.medium = paper_noise(bent.position, 1.3f, footprint, 2);
    bent.fine = paper_noise(bent.position, 0.45f, footprint, 3);
    float delta = 1.5e-3f * bent.coarse + 0.7e-3f * bent.medium + 0.22e-3f * bent.fine;
    delta *= clampf(state->spacing / 1.8e-3f, 0.3f, 1);
    float slope = minf(state->gradient, 400.0f);
    float inside = stepf(0.15f, 0.5f, state->burn);
    bent.burn = state->burn + slope * delta + inside * (0.03f * bent.coarse + 0.05f * bent.medium + 0.03f * bent.fine);
    float jitter = (0.17f * bent.coarse + 0.08f * bent.medium + 0.025f * bent.fine) * (1 - 0.6f * inside);
    float peak = maxf(state->peak, state->temperature);
    // 0 where there was hardly any heat
    bent.temperature = state->temperature + (state->temperature - 293) * jitter * stepf(320, 420, state->temperature);
    float steep = minf(state->heat_gradient, 1.2e5f);
    bent.peak = peak + (0.25f * (peak - 293) * jitter + steep * delta) * stepf(310, 350, peak);
    return bent;
}

float paper_cracks(const Bent *bent, float millimetres, float width, float footprint) {
    Float3 p = float3_mad(bent->position, float3(bent->medium, bent->fine, bent->coarse), 0.5e-3f);
    float min = 0.5f * footprint * 1000 / millimetres; // at least a pixel wide, but paler
    float open = width * maxf(0, 0.75f + 0.9f * bent->coarse + 0.5f * bent->medium);
    float wall = noise_walls(float3_scale(p, 1000 / millimetres), 13);
    return minf(1, open / min) * (1 - stepf(0.4f, 1, wall / maxf(open, min)));
}

/// `folded`: the height is the noise's absolute value, with an edge where it changes sign, and steep slopes are
/// flattened.
static void tilt(Float3 position, float millimetres, float height, bool folded, uint32_t seed, Point *point) {
    height *= clampf(1.6f - point->footprint * 1000 / millimetres, 0, 1);
    if (height < 0.02f) return;
    Float3 p = float3_scale(position, 1000 / millimetres);
    float n = noise3(p, seed);
    Float3 slope = noise3_gradient(p, n, seed);
    if (folded) {
        float edge = clampf(n * 14, -1, 1), steep = float3_length(slope);
        slope = float3_scale(slope, edge / (0.5f + 0.5f * steep));
    }
    slope = float3_mad(slope, point->normal, -float3_dot(slope, point->normal));
    Float3 tilted = float3_unit_or(float3_mad(point->normal, slope, -height), point->normal);
    if (float3_dot(tilted, point->view) > 0.02f) point->normal = tilted;
}

void paper_crumple(Float3 position, float millimetres, float height, uint32_t seed, Point *point) {
    tilt(position, millimetres, height, false, seed, point);
}

void paper_fold(Float3 position, float millimetres, float height, uint32_t seed, Point *point) {
    tilt(position, millimetres, height, true, seed, point);
}

/// Burnt borders crumble, so that straight cuts become ragged within a triangle, and ash wears.
static bool is_hole(const PaperState *state, const Bent *bent, float footprint) {
    float bite = 0.40f + 0.38f * bent->medium + 0.20f * bent->fine + 0.28f * bent->coarse;
    float burnt = stepf(PAPER_WHOLE, 0.65f, state->burn);
    if (burnt > 0 && state->rim > 1 - burnt * clampf(bite, 0, 0.85f)) return true;
    return bent->burn > 0.7f && ash_amount(bent) * stepf(0.72f, 0.95f, ash_lace(bent, footprint)) > 0.5f;
}

bool paper_is_hole(const PaperState *state, float footprint) {
    if (state->burn <= PAPER_WHOLE) return false;
    Bent bent = shade_paper_bend(state, footprint);
    return is_hole(state, &bent, footprint);
}

float paper_transmittance(const Preview *preview, int32_t sheet) {
    const float *known = preview->def.transmittances;
    return known && sheet >= 0 && (uint32_t)sheet < preview->def.sheet_count ? known[sheet] : PREVIEW_TRANSMITTANCE;
}

static void fresh(const Preview *preview, const PaperState *state, Point *point) {
    Float3 white = float3(0.86f, 0.852f, 0.832f), colour = {1, 1, 1};
    if (state->sheet >= 0 && (uint32_t)state->sheet < preview->def.sheet_count) {
        const Texture *texture = preview->textures ? &preview->textures[state->sheet] : NULL;
        if (texture && texture->count)
            colour = texture_sample(preview, texture, state->uv[0], state->uv[1],
                                    0.45f * point->footprint * texture->texels_per_metre);
        if (preview->def.colours) colour = float3_mul(colour, float3_load(preview->def.colours[state->sheet]));
    }
    // uneven density of the fibres
    float cloud = 1 + 0.018f * paper_noise(askew(state->rest), 2.4f, point->footprint, 5);
    point->albedo = float3_scale(float3_mul(white, colour), cloud);
    point->transmission = paper_transmittance(preview, state->sheet);
}

/// Browning by heat, 0 to 0.76.
static float heat_scorch(float peak) {
    const float first = 55, last = 360; // K above a room's
    float above = peak - 293;
    return above > first ? 0.76f * minf(logf(above / first) / logf(last / first), 1) : 0;
}

/// Char: browner where it is thin, bluer where complete; print (1) remains readable on it, as a dull grey.
static Float3 char_colour(const Bent *bent, float ink, float footprint) {
    float value = 1 + 0.35f * bent->medium + 0.3f * bent->fine + 0.35f * bent->coarse;
    Float3 soot =
        float3_mix(float3(0.034f, 0.020f, 0.012f), float3(0.0125f, 0.0125f, 0.0132f), stepf(0.22f, 0.62f, bent->burn));
    float craze = paper_cracks(bent, 2.1f, 0.05f, footprint);
    Float3 colour = float3_scale(soot, value * (1 - 0.6f * craze));
    return float3_mad(colour, float3(0.024f, 0.024f, 0.026f), ink);
}

static void char_shade(const Bent *bent, Float3 burnt, float ink, Point *point) {
    float black = stepf(0.12f, 0.46f, bent->burn);
    point->albedo = burnt;
    if (black <= 0) return;
    point->albedo = float3_mix(burnt, char_colour(bent, ink, point->footprint), black);
    // tar makes it shine
    float tar = clampf(0.75f + 0.5f * bent->coarse - 0.5f * ink, 0.2f, 1.2f);
    point->gloss = 0.055f * black * tar;
    point->shininess = 14;
    point->mirror = 0.45f * black * tar;
    paper_fold(bent->position, 3.6f, 0.34f * black, 32, point);
    paper_crumple(bent->position, 0.9f, 0.11f * black, 31, point);
}

bool paper_shade(const Preview *preview, const PaperState *state, Point *point) {
    fresh(preview, state, point);
    bool touched = state->burn > 0 || maxf(state->peak, state->temperature) > 325;
    if (!touched) return true;

    Bent bent = shade_paper_bend(state, point->footprint);
    if (is_hole(state, &bent, point->footprint)) return false;
    float by_heat = heat_scorch(bent.peak), by_burn = 1 - expf(-7.5f * maxf(bent.burn, 0));
    float scorch = 1 - (1 - by_heat) * (1 - by_burn);
    float ink = 1 - clampf(float3_luminance(point->albedo), 0, 1), print = stepf(0.45f, 0.8f, ink);
    Float3 burnt = float3_mul(scorch_colour(scorch),
                              float3_mix(point->albedo, float3(0.80f, 0.80f, 0.80f), stepf(0.6f, 1.0f, scorch)));
    point->transmission *= 1 - stepf(0.1f, 0.7f, scorch);
    char_shade(&bent, burnt, print, point);
    ash_shade(state, &bent, print, point);
    ember_shade(preview, state, &bent, point);
    return true;
}
