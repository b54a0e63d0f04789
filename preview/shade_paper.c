// How paper looks while it burns.
//
// The simulation's cells are coarser than the look needs, so its fields are bent at the picture's scale. With
// b the share burnt, T the temperature, P the highest temperature so far and N noise of the rest position (it sticks
// to the paper),
//
//     b' = b + |grad b| delta + floor,   delta = 1.5 N(4 mm) + 0.7 N(1.3 mm) + 0.22 N(0.45 mm)  in mm:
//
// isolines move by delta whatever the front's width is, so they turn ragged and lose the grid. The colours then
// follow b' and P', for paper that browned stays brown: white - yellow - tan - brown (420 to 620 K), char by b' > 0.1,
// ash by b' > 0.8 once it has cooled. The ember is the line b' = EMBER_BURN, a Gaussian of the distance
//
//     d = (b' - EMBER_BURN) / |grad b|,   glow = blackbody(T') exp(-(d / w)^2),   w about EMBER_WIDTH,
//
// thinned, thickened and broken by noise that drifts slowly with time.

#include "preview/internal.h"

/// Linear colours that multiply the paper's, by how far it is scorched in [0, 1].
static V3 scorch_colour(float s) {
    static const float stop[6][4] = {
        {0.00f, 1.00f, 1.00f, 1.00f},    {0.22f, 0.90f, 0.775f, 0.54f},   {0.45f, 0.60f, 0.37f, 0.145f},
        {0.68f, 0.235f, 0.105f, 0.036f}, {0.86f, 0.062f, 0.031f, 0.018f}, {1.00f, 0.020f, 0.016f, 0.014f}};
    int i = 1;
    while (i < 5 && s > stop[i][0]) i++;
    float f = clampf((s - stop[i - 1][0]) / (stop[i][0] - stop[i - 1][0]), 0, 1);
    return v3_mix(v3_load(stop[i - 1] + 1), v3_load(stop[i] + 1), f);
}

/// Where noise is read: the rest position turned, so that the noise's lattice lies askew to sheets and their grids.
static V3 askew(V3 r) {
    return v3(0.7654f * r.x - 0.5321f * r.y + 0.3622f * r.z, 0.6133f * r.x + 0.7718f * r.y - 0.1673f * r.z,
              -0.1905f * r.x + 0.3481f * r.y + 0.9179f * r.z);
}

void paper_state(const Scene *scene, uint32_t triangle, float u, float v, PaperState *state) {
    const uint32_t *t = scene->triangles[triangle];
    const PaperVertex *a = &scene->vertices[t[0]], *b = &scene->vertices[t[1]], *c = &scene->vertices[t[2]];
    float w = 1 - u - v, least = minf(a->rim, minf(b->rim, c->rim));
    *state = (PaperState){
        .rest = v3_blend(a->rest, b->rest, c->rest, u, v),
        .uv = {w * a->uv[0] + u * b->uv[0] + v * c->uv[0], w * a->uv[1] + u * b->uv[1] + v * c->uv[1]},
        .temperature = w * a->temperature + u * b->temperature + v * c->temperature,
        .peak = w * a->peak + u * b->peak + v * c->peak,
        .burn = w * a->burn + u * b->burn + v * c->burn,
        .burn_rate = w * a->burn_rate + u * b->burn_rate + v * c->burn_rate,
        .gradient = w * a->gradient + u * b->gradient + v * c->gradient,
        // a triangle with no corner inside tells nothing of the distance: a strip or a crumb, which is to stay
        .rim = least > 0.5f ? 0.25f : w * a->rim + u * b->rim + v * c->rim,
        .sheet = a->sheet,
    };
}

/// Noise whose features are `millimetres` wide, gone where a pixel no longer resolves it.
static float detail(V3 rest, float millimetres, float footprint, uint32_t seed) {
    float visible = 1.6f - footprint * 1000 / millimetres * 0.8f;
    if (visible <= 0) return 0;
    return minf(visible, 1) * noise3(v3_scale(rest, 1000 / millimetres), seed);
}

/// The paper at a hit as the picture's scale has it.
typedef struct Bent {
    V3 place;                    ///< where noise is read
    float burn, temperature, peak; ///< b', T' and P'
    float coarse, middle, fine;  ///< the noise that bent them, [-1, 1]
} Bent;

static Bent bend(const PaperState *state, float footprint) {
    Bent bent = {.place = askew(state->rest)};
    bent.coarse = detail(bent.place, 4.0f, footprint, 1);
    bent.middle = detail(bent.place, 1.3f, footprint, 2);
    bent.fine = detail(bent.place, 0.45f, footprint, 3);
    float delta = 1.5e-3f * bent.coarse + 0.7e-3f * bent.middle + 0.22e-3f * bent.fine;
    float slope = minf(state->gradient, 400.0f);
    float inside = stepf(0.15f, 0.5f, state->burn);
    bent.burn = state->burn + slope * delta + inside * (0.03f * bent.coarse + 0.05f * bent.middle + 0.03f * bent.fine);
    float jitter = (0.17f * bent.coarse + 0.08f * bent.middle + 0.025f * bent.fine) * (1 - 0.6f * inside);
    float peak = maxf(state->peak, state->temperature);
    // nothing where there was no heat to speak of
    bent.temperature = state->temperature + (state->temperature - 293) * jitter * stepf(320, 420, state->temperature);
    bent.peak = peak + (peak - 293) * jitter * stepf(320, 420, peak);
    return bent;
}

/// Thin lines where noise changes sign. 1 on the line.
static float ridge(float n, float width) { return 1 - stepf(0, width, fabsf(n)); }

/// Fibres lie along a direction that wanders over the sheet. 1 on a fibre.
static float fibres(V3 place, float footprint) {
    float wander = 2.4f * noise3(v3_scale(place, 110), 11), c = cosf(wander), s = sinf(wander);
    V3 along = v3(0.22f * (c * place.x + s * place.y), c * place.y - s * place.x, place.z);
    float visible = clampf(1.6f - footprint * 1400, 0, 1);
    return visible * ridge(noise3(v3_scale(along, 2100), 12), 0.5f);
}

/// Cracks between crazed scales, wider and narrower by turns. 1 in a crack.
static float cracks(const Bent *bent, float millimetres, float width, float footprint) {
    V3 p = v3_mad(bent->place, v3(bent->middle, bent->fine, bent->coarse), 0.5e-3f);
    float least = 0.5f * footprint * 1000 / millimetres; // no thinner than a pixel, but paler then
    float open = width * maxf(0, 0.75f + 0.9f * bent->coarse + 0.5f * bent->middle);
    float wall = noise_walls(v3_scale(p, 1000 / millimetres), 13);
    return minf(1, open / least) * (1 - stepf(0.4f, 1, wall / maxf(open, least)));
}

/// Tilts the normal by the gradient of noise of that size, as crumpling does.
static void crumple(V3 place, float millimetres, float height, uint32_t seed, Point *point) {
    height *= clampf(1.6f - point->footprint * 1000 / millimetres, 0, 1);
    if (height < 0.02f) return;
    V3 p = v3_scale(place, 1000 / millimetres);
    V3 slope = noise3_gradient(p, noise3(p, seed), seed);
    slope = v3_mad(slope, point->normal, -v3_dot(slope, point->normal));
    V3 tilted = v3_unit(v3_mad(point->normal, slope, -height), point->normal);
    if (v3_dot(tilted, point->view) > 0.02f) point->normal = tilted;
}

/// How far the paper is ash, 0 to 1.
static float ash_amount(const Bent *bent) {
    return stepf(0.78f, 0.92f, bent->burn + 0.06f * bent->coarse) * (1 - 0.75f * stepf(760, 1000, bent->temperature));
}

/// Noise that wears ash to lace: holes above 0.7.
static float lace(const Bent *bent, float footprint) {
    return detail(bent->place, 2.3f, footprint, 15) + 0.65f * bent->fine - 0.35f * bent->coarse;
}

/// Burnt borders crumble, so that the cut's straight pieces turn ragged within a cell of the mesh, and ash wears.
static bool is_hole(const PaperState *state, const Bent *bent, float footprint) {
    float bite = 0.42f + 0.40f * bent->middle + 0.35f * bent->fine + 0.25f * bent->coarse;
    float burnt = stepf(PAPER_WHOLE, 0.65f, state->burn);
    if (burnt > 0 && state->rim > 1 - burnt * clampf(bite, 0, 0.85f)) return true;
    return bent->burn > 0.7f && ash_amount(bent) * stepf(0.60f, 0.85f, lace(bent, footprint)) > 0.5f;
}

bool paper_is_hole(const PaperState *state, float footprint) {
    if (state->burn <= PAPER_WHOLE) return false;
    Bent bent = bend(state, footprint);
    return is_hole(state, &bent, footprint);
}

/// What is left when all that can burn has: a thin felt of mineral fibres, sooty in patches and paler where it burnt
/// through, creased and cracked.
static void ash(const Bent *bent, float ink, Point *point) {
    float amount = ash_amount(bent);
    if (amount <= 0.01f) return;
    float crack = cracks(bent, 6.5f, 0.06f, point->footprint), fibre = fibres(bent->place, point->footprint);
    float crease = ridge(detail(v3_mad(bent->place, v3(bent->middle, bent->coarse, bent->fine), 0.6e-3f), 3.1f,
                                point->footprint, 14),
                         0.20f);
    float pale = stepf(-0.9f, 0.8f, 0.8f * bent->coarse + 0.35f * bent->middle);
    float value = 0.075f + 0.17f * pale + (0.05f + 0.13f * pale) * fibre + 0.09f * crease + 0.035f * bent->fine;
    // the rims of holes burn palest
    value += 0.10f * stepf(0.25f, 0.6f, lace(bent, point->footprint));
    V3 grey = v3_scale(v3(1.0f, 0.98f, 0.955f), clampf(value * (1 - 0.35f * ink), 0.03f, 0.55f));
    point->albedo = v3_scale(v3_mix(point->albedo, grey, amount), 1 - 0.75f * crack * amount);
    point->gloss *= 1 - amount;
    point->transmission = mixf(point->transmission, 0.20f, amount);
    crumple(bent->place, 4.2f, 0.18f * amount, 16, point);
    crumple(bent->place, 1.3f, 0.07f * amount, 17, point);
}

static void ember(const Preview *preview, const PaperState *state, const Bent *bent, Point *point) {
    float activity = ember_activity(state->burn_rate);
    if (activity < 0.02f || state->temperature < 780) return;
    float time = (float)fmod(preview->time, 4096.0);
    V3 drift = v3_add(v3_scale(bent->place, 230), v3(0.35f * time, -0.2f * time, 0.9f * time));
    float alive = stepf(-0.45f, 0.55f, noise3(drift, 21) + 0.40f * bent->middle + 0.2f * bent->fine);
    float distance = (bent->burn - EMBER_BURN) / maxf(state->gradient, 20.0f);
    float width = EMBER_WIDTH * (0.55f + 0.65f * alive);
    // sharp towards the char, slower to die towards the ash
    if (distance > 0) width *= 1.6f;
    float x = distance / width, profile = expf(-x * x);
    float temperature = ember_temperature(state->temperature) + 190 * (alive - 0.62f) + 60 * bent->fine;
    V3 glow = blackbody_glow(preview->blackbody, temperature);
    float strength = EMBER_GAIN * activity * profile * (0.16f + 0.84f * alive * alive) * (0.85f + 0.4f * bent->fine);
    // red-hot cracks in the char beside it
    float near = 0.10f * activity * alive * expf(-0.05f * x * x);
    if (near > 0.003f) strength += EMBER_GAIN * near * cracks(bent, 1.6f, 0.12f, point->footprint);
    point->emission = v3_scale(glow, maxf(strength, 0));
}

static void fresh(const Preview *preview, const PaperState *state, Point *point) {
    V3 white = v3(0.86f, 0.852f, 0.832f), colour = {1, 1, 1};
    if (state->sheet >= 0 && (uint32_t)state->sheet < preview->def.sheet_count) {
        const Texture *texture = preview->textures ? &preview->textures[state->sheet] : NULL;
        if (texture && texture->count)
            colour = texture_sample(preview, texture, state->uv[0], state->uv[1],
                                    0.45f * point->footprint * texture->texels_per_metre);
        if (preview->def.colours) colour = v3_mul(colour, v3_load(preview->def.colours[state->sheet]));
    }
    // the cloudiness of its fibres
    float cloud = 1 + 0.018f * detail(askew(state->rest), 2.4f, point->footprint, 5);
    point->albedo = v3_scale(v3_mul(white, colour), cloud);
    point->transmission = 0.22f;
}

/// Char: dark, browner where it is thin; print stays readable on it, as a dull grey.
static V3 char_colour(const Bent *bent, float ink) {
    float value = 1 + 0.45f * bent->middle + 0.35f * bent->fine + 0.3f * bent->coarse;
    V3 soot = v3_mix(v3(0.026f, 0.019f, 0.015f), v3(0.017f, 0.016f, 0.0155f), stepf(0.25f, 0.6f, bent->burn));
    return v3_mad(v3_scale(soot, value), v3(0.026f, 0.026f, 0.028f), stepf(0.45f, 0.8f, ink));
}

bool paper_shade(const Preview *preview, const PaperState *state, Point *point) {
    fresh(preview, state, point);
    bool touched = state->burn > 0 || maxf(state->peak, state->temperature) > 325;
    if (!touched) return true;

    Bent bent = bend(state, point->footprint);
    if (is_hole(state, &bent, point->footprint)) return false;
    float by_heat = 0.76f * stepf(335, 640, bent.peak), by_burn = 1 - expf(-7.5f * maxf(bent.burn, 0));
    float scorch = 1 - (1 - by_heat) * (1 - by_burn);
    float ink = 1 - clampf(v3_luminance(point->albedo), 0, 1);
    V3 burnt = v3_mul(scorch_colour(scorch), v3_mix(point->albedo, v3(0.80f, 0.80f, 0.80f), stepf(0.6f, 1.0f, scorch)));
    float black = stepf(0.14f, 0.42f, bent.burn);
    point->albedo = v3_mix(burnt, char_colour(&bent, ink), black);
    point->transmission *= 1 - stepf(0.1f, 0.7f, scorch);
    point->gloss = 0.035f * black, point->shininess = 10;
    crumple(bent.place, 0.9f, 0.16f * black, 31, point);
    ash(&bent, stepf(0.45f, 0.8f, ink), point);
    ember(preview, state, &bent, point);
    return true;
}
