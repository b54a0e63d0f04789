// How paper looks while it burns.
//
// The simulation's cells are coarser than the look needs, so its fields are bent at the picture's scale. With
// b the share burnt, T the temperature and N noise of the rest position (it sticks to the paper),
//
//     b' = b + |grad b| delta + floor,   delta = 1.5 N(4 mm) + 0.7 N(1.3 mm) + 0.3 N(0.45 mm)  in mm:
//
// isolines move by delta whatever the front's width is, so they turn ragged and lose the grid. The colours then
// follow b' and T':  white - yellow - tan - brown by drying and browning (420 to 590 K), char by b' > 0.1, ash by
// b' > 0.7 once it has cooled. The ember is the line b' = EMBER_BURN, a Gaussian of the distance
//
//     d = (b' - EMBER_BURN) / |grad b|,   glow = blackbody(T') exp(-(d / w)^2),   w about EMBER_WIDTH,
//
// thinned, thickened and broken by noise that drifts slowly with time.

#include "preview/internal.h"

/// How much of the burnt edge is eaten away at the picture's scale: 0 leaves the simulation's own cut.
static const float edge_raggedness = 1.0f;

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

/// Noise whose features are `millimetres` wide, gone where a pixel no longer resolves it.
static float detail(V3 rest, float millimetres, float footprint, uint32_t seed) {
    float visible = 1.6f - footprint * 1000 / millimetres * 0.8f;
    if (visible <= 0) return 0;
    return minf(visible, 1) * noise3(v3_scale(rest, 1000 / millimetres), seed);
}

typedef struct Bent {
    float burn, temperature; ///< b' and T'
    float coarse, middle, fine; ///< the noise that bent them, [-1, 1]
} Bent;

static Bent bend(const PaperState *state, float footprint) {
    Bent bent;
    bent.coarse = detail(state->rest, 4.0f, footprint, 1);
    bent.middle = detail(state->rest, 1.3f, footprint, 2);
    bent.fine = detail(state->rest, 0.45f, footprint, 3);
    float delta = 1.5e-3f * bent.coarse + 0.7e-3f * bent.middle + 0.3e-3f * bent.fine;
    float slope = minf(state->gradient, 400.0f);
    float inside = stepf(0.15f, 0.5f, state->burn);
    bent.burn = state->burn + slope * delta + inside * (0.03f * bent.coarse + 0.05f * bent.middle + 0.03f * bent.fine);
    float jitter = 0.16f * bent.coarse + 0.09f * bent.middle + 0.05f * bent.fine;
    jitter *= stepf(320, 420, state->temperature); // nothing where there is no heat to speak of
    bent.temperature = state->temperature + (state->temperature - 293) * jitter * (1 - 0.6f * inside);
    return bent;
}

/// Thin lines where noise changes sign: cracks and fibres. 1 on the line.
static float ridge(float n, float width) { return 1 - stepf(0, width, fabsf(n)); }

static void ash(const PaperState *state, const Bent *bent, Point *point) {
    float cold = 1 - stepf(720, 980, bent->temperature);
    float amount = stepf(0.66f, 0.90f, bent->burn + 0.10f * bent->coarse) * (0.25f + 0.75f * cold);
    if (amount <= 0.01f) return;
    // fibres lie along a direction that wanders over the sheet
    V3 r = state->rest;
    float wander = 2.2f * noise3(v3_scale(r, 90), 11), c = cosf(wander), s = sinf(wander);
    V3 along = v3(c * r.x + s * r.y, c * r.y - s * r.x, r.z);
    float fibre = detail(v3(along.x * 0.22f, along.y * 1.5f, along.z), 0.55f, point->footprint * 0.6f, 12);
    float patch = stepf(-0.45f, 0.55f, bent->coarse + 0.7f * bent->middle);
    float crack = ridge(detail(r, 1.9f, point->footprint, 13) + 0.35f * bent->fine, 0.16f);
    float cover = amount * clampf(0.18f + 0.62f * patch + 0.35f * fibre, 0, 1) * (1 - 0.75f * crack);
    V3 grey = v3_scale(v3(0.36f, 0.345f, 0.325f), 0.75f + 0.35f * fibre + 0.2f * bent->fine);
    point->albedo = v3_mix(point->albedo, grey, clampf(cover, 0, 0.92f));
    point->gloss *= 1 - cover;
}

static void ember(const Preview *preview, const PaperState *state, const Bent *bent, Point *point) {
    float activity = ember_activity(state->burn_rate);
    if (activity < 0.02f || state->temperature < 780) return;
    float time = (float)fmod(preview->time, 4096.0);
    V3 drift = v3_add(v3_scale(state->rest, 230), v3(0.35f * time, -0.2f * time, 0.9f * time));
    float alive = stepf(-0.30f, 0.55f, noise3(drift, 21) + 0.40f * bent->middle + 0.2f * bent->fine);
    float distance = (bent->burn - EMBER_BURN) / maxf(state->gradient, 20.0f);
    float width = EMBER_WIDTH * (0.45f + 0.9f * alive);
    // sharp towards the char, slower to die towards the ash
    if (distance > 0) width *= 1.5f;
    float x = distance / width, profile = expf(-x * x);
    float temperature = state->temperature + 90 * (alive - 0.55f) + 60 * bent->fine;
    V3 glow = blackbody_glow(preview->blackbody, temperature);
    float strength = EMBER_GAIN * activity * profile * (0.04f + 0.96f * alive * alive) * (0.8f + 0.5f * bent->fine);
    // red-hot cracks in the char beside it
    float crack = ridge(noise3(v3_scale(state->rest, 620), 22) + 0.3f * bent->fine, 0.14f);
    strength += EMBER_GAIN * 0.07f * activity * crack * alive * expf(-0.06f * x * x);
    point->emission = v3_scale(glow, maxf(strength, 0));
}

/// Char is crazed: tilt its normal by the gradient of fine noise, and let it shine a little.
static void char_surface(const PaperState *state, float char_amount, Point *point) {
    float visible = clampf(1.6f - point->footprint * 700, 0, 1) * char_amount;
    if (visible < 0.02f) return;
    V3 p = v3_scale(state->rest, 700);
    V3 slope = noise3_gradient(p, noise3(p, 31), 31);
    slope = v3_mad(slope, point->normal, -v3_dot(slope, point->normal));
    V3 tilted = v3_unit(v3_mad(point->normal, slope, -0.26f * visible), point->normal);
    if (v3_dot(tilted, point->view) > 0.02f) point->normal = tilted;
}

static void fresh(const Preview *preview, const PaperState *state, Point *point) {
    V3 white = v3(0.855f, 0.835f, 0.79f), colour = {1, 1, 1};
    if (state->sheet >= 0 && (uint32_t)state->sheet < preview->def.sheet_count) {
        const Texture *texture = preview->textures ? &preview->textures[state->sheet] : NULL;
        if (texture && texture->count)
            colour = texture_sample(preview, texture, state->uv[0], state->uv[1],
                                    0.6f * point->footprint * texture->texels_per_metre);
        if (preview->def.colours) colour = v3_mul(colour, v3_load(preview->def.colours[state->sheet]));
    }
    // the cloudiness of its fibres
    float cloud = 1 + 0.018f * detail(state->rest, 2.4f, point->footprint, 5);
    point->albedo = v3_scale(v3_mul(white, colour), cloud);
    point->transmission = 0.22f;
}

bool paper_shade(const Preview *preview, const PaperState *state, Point *point) {
    fresh(preview, state, point);
    bool touched = state->burn > 0 || state->temperature > 325;
    if (!touched) return true;

    Bent bent = bend(state, point->footprint);
    float eaten = edge_raggedness * (0.35f + 0.65f * stepf(-0.6f, 0.4f, bent.middle));
    if (state->burn > 0.62f && bent.burn > 1.01f - 0.13f * eaten) return false;

    float by_heat = 0.74f * stepf(375, 600, bent.temperature), by_burn = 1 - expf(-7.5f * maxf(bent.burn, 0));
    float scorch = 1 - (1 - by_heat) * (1 - by_burn);
    float ink = 1 - clampf(v3_luminance(point->albedo), 0, 1);
    V3 burnt = v3_mul(scorch_colour(scorch), v3_mix(point->albedo, v3(0.80f, 0.80f, 0.80f), stepf(0.6f, 1.0f, scorch)));
    float black = stepf(0.16f, 0.46f, bent.burn);
    // print stays readable on char, as a dull grey
    V3 soot = v3_scale(v3(0.021f, 0.0195f, 0.0185f), 1 + 0.5f * bent.middle + 0.35f * bent.fine);
    soot = v3_mad(soot, v3(0.030f, 0.030f, 0.032f), stepf(0.45f, 0.8f, ink));
    point->albedo = v3_mix(burnt, soot, black);
    point->transmission *= 1 - stepf(0.1f, 0.7f, scorch);
    point->gloss = 0.055f * black, point->shininess = 14;
    char_surface(state, black, point);
    ash(state, &bent, point);
    ember(preview, state, &bent, point);
    return true;
}
