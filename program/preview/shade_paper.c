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
// by b' > 0.1, ash by b' > 0.8 once it has cooled, ember at b' = 0.74.

#include "preview/internal.h"

/// The paper at a hit, at the picture's scale.
typedef struct Bent {
    Float3 position;               ///< for noise
    float burn, temperature, peak; ///< b', T' and P'
    float coarse, medium, fine;    ///< the noise that perturbed them, [-1, 1]
    float bays;                    ///< wider noise, where it is burnt
} Bent;

/// Noise whose features are `millimetres` wide, 0 where a pixel no longer resolves it.
static inline float paper_noise(Float3 position, float millimetres, float footprint, uint32_t seed) {
    float visible = 1.6f - footprint * 1000 / millimetres * 0.8f;
    if (visible <= 0) return 0;
    return minf(visible, 1) * noise3(float3_scale(position, 1000 / millimetres), seed);
}

/// Thin lines where noise changes sign. 1 on the line.
static inline float ridge(float n, float width) { return 1 - stepf(0, width, fabsf(n)); }

// ---- fields

/// Linear colours that multiply the paper's, by its scorching in [0, 1].
static Float3 scorch_colour(float s) {
    enum { STOPS = 8 };
    static const float stop[STOPS][4] = {{0.00f, 1.00f, 1.00f, 1.00f},    {0.09f, 0.975f, 0.93f, 0.81f},
                                         {0.21f, 0.84f, 0.68f, 0.44f},    {0.57f, 0.53f, 0.34f, 0.165f},
                                         {0.68f, 0.32f, 0.165f, 0.068f},  {0.77f, 0.14f, 0.062f, 0.026f},
                                         {0.86f, 0.056f, 0.030f, 0.018f}, {1.00f, 0.020f, 0.016f, 0.014f}};
    int i = 1;
    while (i < STOPS - 1 && s > stop[i][0]) i++;
    float f = clampf((s - stop[i - 1][0]) / (stop[i][0] - stop[i - 1][0]), 0, 1);
    return float3_mix(float3_load(stop[i - 1] + 1), float3_load(stop[i] + 1), f);
}

/// The position for noise: the rest position, rotated so that the noise's lattice is oblique to sheets and their grids.
static Float3 askew(Float3 r) {
    return float3(0.7654f * r.x - 0.5321f * r.y + 0.3622f * r.z, 0.6133f * r.x + 0.7718f * r.y - 0.1673f * r.z,
                  -0.1905f * r.x + 0.3481f * r.y + 0.9179f * r.z);
}

static Bent shade_paper_bend(const PaperState *state, float footprint) {
    Bent bent = {.position = askew(state->rest)};
    bent.coarse = paper_noise(bent.position, 4.0f, footprint, 1);
    bent.medium = paper_noise(bent.position, 1.3f, footprint, 2);
    bent.fine = paper_noise(bent.position, 0.45f, footprint, 3);
    if (state->burn > PAPER_WHOLE) bent.bays = paper_noise(bent.position, 9.5f, footprint, 4);
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

/// Lines between scattered scales, of varying width. 1 on a line.
static float paper_cracks(const Bent *bent, float millimetres, float width, float footprint) {
    Float3 p = float3_mad(bent->position, float3(bent->medium, bent->fine, bent->coarse), 0.5e-3f);
    float min = 0.5f * footprint * 1000 / millimetres; // at least a pixel wide, but paler
    float open = width * maxf(0, 0.75f + 0.9f * bent->coarse + 0.5f * bent->medium);
    float wall = noise_walls(float3_scale(p, 1000 / millimetres), 13);
    return minf(1, open / min) * (1 - stepf(0.4f, 1, wall / maxf(open, min)));
}

/// Tilts the normal by the gradient of noise of that size, as crumpling does. `folded`: the height is the noise's absolute
/// value, with an edge where it changes sign, and steep slopes are flattened.
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

#define FIBRE_WAVES 0.007f ///< m, height of the waves in which fibres lie
#define BAY 0.0055f        ///< m, depth of the deepest bay of a burnt border

// ---- ash

// Ash: the remaining leaf of mineral fibres, thin enough to transmit light. It is sooty at first and pales within about
// ten seconds, in patches; veins and the rims of holes are palest. It crackles into scales some millimetres wide, with
// dark lines between them. Print remains on it as on the char, lighter than what is around it and silvery: what colours
// ink leaves more ash than fibres. Char turns to ash at its borders first, unevenly, where it is thinnest.

/// The share of ash, 0 to 1.
static float ash_amount(const Bent *bent) {
    return stepf(0.78f, 0.94f, bent->burn + 0.06f * bent->coarse) * (1 - 0.75f * stepf(760, 1000, bent->temperature));
}

/// The share of its outermost triangles that a border of burnt paper has lost: it crumbles, so that straight cuts are ragged.
static float border_bite(float burn, const Bent *bent) {
    const float bite = 0.40f + 0.38f * bent->medium + 0.20f * bent->fine + 0.28f * bent->coarse;
    return stepf(PAPER_WHOLE, 0.65f, burn) * clampf(bite, 0, 0.85f);
}

/// How much farther it has crumbled, m: in bays, which are ragged themselves.
static float border_bay(const PaperState *state, const Bent *bent) {
    const float bay = bent->bays + 0.55f * bent->coarse + 0.3f * bent->medium + 0.15f * bent->fine - 0.1f;
    return BAY * stepf(PAPER_WHOLE, 0.6f, state->burn) * clampf(bay, 0, 1);
}

/// The distance to the ragged border, m.
static float border_distance(const PaperState *state, const Bent *bent) {
    const float bite = border_bite(state->burn, bent) * minf(state->spacing, 2.5e-3f);
    return maxf(state->edge - maxf(bite, border_bay(state, bent)), 0);
}

/// How near a border of a piece is: 1 on it, 0 `width` m away and in triangles that do not reach it, uneven.
static float near_border(const PaperState *state, const Bent *bent, float width) {
    const float distance = (1 - state->rim) * state->spacing;
    const float uneven = 1 + 0.5f * bent->coarse + 0.6f * bent->medium + 0.4f * bent->fine;
    return minf(1, 5 * state->rim) * (1 - stepf(0.1f * width, width * maxf(uneven, 0.2f), distance));
}

/// Along the fibres of a sheet and across them. They lie as they were made, along it, but in waves: turned by an angle that
/// varies they ran in rings, as of wood.
static Float3 fibres_along(Float3 position, float stretch, uint32_t seed) {
    const Float3 p = position;
    return float3(stretch * p.x, p.y + FIBRE_WAVES * noise3(float3_scale(p, 70), seed), p.z);
}

/// How far cold char has turned to ash, `cloud` its patches, `strand` and `fibre` its threads: from black at 0 over dark grey to
/// pale at 1. A fringe along dead borders, of a millimetre to some, pales first, in tongues that follow the fibres; in time a
/// thin skin of threads lies on the rest as well. Nothing of it ends abruptly: what does looks pasted on.
static float ash_on_char(const PaperState *state, const Bent *bent, float cloud, float strand, float fibre) {
    const float cold = stepf(PAPER_WHOLE, 0.5f, bent->burn) * (1 - stepf(520, 760, bent->temperature));
    if (cold <= 0) return 0;
    const float border = 1e3f * border_distance(state, bent); // mm
    const float threads = 0.5f * strand + 0.3f * (fibre - 0.4f), wide = maxf(0.9f + 1.6f * cloud, 0.35f);
    const float fringe = stepf(0, 4.2f, state->age + 2 * cloud) * stepf(-0.9f, 0, cloud + 0.4f * threads) *
                         minf(1, 1.15f * expf(-border / wide) * (1 + threads));
    const float skin =
        0.75f * stepf(0.53f, 0.62f, bent->burn) * stepf(2, 8, state->age) * stepf(-0.1f, 1.25f, cloud + 0.9f * threads);
    return cold * clampf(maxf(fringe, skin), 0, 1);
}

/// Noise that wears ash to lace: holes above 0.7.
static float ash_lace(const Bent *bent, float footprint) {
    return paper_noise(bent->position, 2.6f, footprint, 15) + 0.25f * bent->fine - 0.45f * bent->coarse;
}

static void ash_shade(const PaperState *state, const Bent *bent, float ink, Point *point) {
    const float size = point->footprint;
    if (bent->burn < PAPER_WHOLE) return;
    Float3 along =
        fibres_along(float3_mad(bent->position, float3(bent->medium, bent->coarse, bent->fine), 0.45e-3f), 0.14f, 11);
    const float cloud = 1.2f * paper_noise(bent->position, 12, size, 19), strand = paper_noise(along, 1.5f, size, 20);
    const float fibre = clampf(1.6f - size * 1400, 0, 1) * ridge(noise3(float3_scale(along, 2100), 12), 0.5f);
    const float plate = ash_on_char(state, bent, cloud, strand, fibre);
    const float whole = ash_amount(bent);
    const float amount = maxf(whole, minf(2.2f * plate, 0.92f));
    const float dry = 1 - 0.4f * stepf(2, 9, state->age); // tar dries
    point->gloss *= dry;
    point->mirror *= dry;
    if (amount <= 0.01f) return;

    // veins: creases of the shrinking leaf, long, fine and forking
    Float3 bowed = float3_mad(bent->position, float3(bent->medium, bent->coarse, bent->fine), 1.1e-3f);
    float large = ridge(paper_noise(bowed, 8.5f, size, 14), 0.10f);
    float small = ridge(paper_noise(float3_mad(bowed, float3(1, -1, 1), 2e-3f * bent->coarse), 3.4f, size, 18), 0.13f);
    float vein = maxf(large, 0.55f * small);

    float pale = maxf(whole * stepf(1, 13, state->age + 4 * cloud), 0.85f * plate * plate);
    float rim = whole * stepf(0.25f, 0.6f, ash_lace(bent, size));
    const float thin = maxf(rim, stepf(0.35f, 0.95f, state->rim + 0.25f * bent->fine));
    float value = mixf(0.030f, 0.42f, pale) * (1 + 0.22f * strand + 0.22f * (fibre - 0.4f) + 0.1f * bent->fine) +
                  (0.010f + 0.05f * pale) * cloud + (0.02f + 0.06f * pale) * vein;
    value += (0.03f + 0.07f * pale) * thin;

    const float crackle = paper_cracks(bent, 4.2f, 0.03f, size);
    value *= 1 - 0.4f * crackle;
    value += (0.05f + 0.19f * pale) * ink * (1 - 0.3f * crackle);

    Float3 tone = float3_mix(float3(0.90f, 0.98f, 1.12f), float3(0.95f, 1.0f, 1.06f), pale);
    Float3 grey = float3_scale(tone, clampf(value, 0.02f, 0.64f));
    point->albedo = float3_mix(point->albedo, grey, amount);
    point->gloss *= 1 - 0.8f * amount;
    point->mirror = mixf(point->mirror, 0.55f - 0.25f * pale + 0.2f * ink, amount);
    point->transmission = mixf(point->transmission, 0.28f + 0.27f * thin, amount);
    Float3 folded = float3_mad(bent->position, float3(bent->coarse, bent->medium, -bent->coarse), 0.8e-3f);
    tilt(folded, 8.5f, 0.55f * amount, true, 16, point);
    tilt(folded, 3.4f, 0.26f * amount, true, 17, point);
}

// ---- embers

// Glow: the line where char turns to ash, a Gaussian of the distance to the isoline b' = EMBER_BURN,
//
//     d = (b' - EMBER_BURN) / |grad b|,   glow = blackbody(T') exp(-(d / w)^2),   w about EMBER_WIDTH,
//
// steep towards the char, slower to fade towards the ash. It is thinned, thickened and broken by noise that crawls
// along the paper, brighter where the air supply varies, and flickers. Sparks creep behind it: a spot of the ash glows
// again for a moment when the time since its ignition passes a delay given by noise, so that lines of equal delay
// wander over the ash.

#define EMBER_HOT 1180.0f ///< K

/// Of a leaf's glow.
#define LEAF_SPREAD 1.35f
#define LEAF_STARVES 0.2f ///< how much less of it is alive below a flame
#define LEAF_FRONT 1.1f   ///< alive along the front of char that feeds a flame; above 1 it has no gaps
#define LEAF_DULL 1.7f
#define LEAF_SCATTERS 0.4f ///< spread of the coals' brightness where few still glow
#define LEAF_COOLER 150.0f ///< K, how much cooler it is between coals
#define LEAF_BRIGHT 1.2f
#define LEAF_DIM 150.0f      ///< K, how much cooler a coal's sides are
#define LEAF_CORE 60.0f      ///< K, how much hotter its core is
#define STARVED_COOLER 90.0f ///< K, how much cooler threads and border of char below a flame are
#define STARVED_BORDER 0.42f ///< the burn value of its line

static float seconds(const Preview *preview) { return (float)fmod(preview->time, 4096.0); }

float ember_air(const Preview *preview, Float3 p) {
    float t = seconds(preview);
    float slow = noise3(float3(21 * p.x + 0.8f * t, 21 * p.y - 0.5f * t, 21 * p.z - 1.7f * t), 51);
    float quick = noise3(float3(55 * p.x, 55 * p.y, 55 * p.z - 7.0f * t), 52);
    return clampf(1 + 0.42f * slow + 0.22f * quick, 0.3f, 1.7f);
}

/// Embers that are hotter than EMBER_HOT shine on as orange: a film of ash covers them, and skin of any temperature would be
/// flat white.
static float ember_seen(float temperature) {
    const float above = maxf(temperature - EMBER_HOT, 0), most = 160;
    return temperature - above + above * most / (above + most);
}

/// Activity of the line at a point, 0 (dead) to 1.
static float line_life(const Preview *preview, const Bent *bent) {
    float t = seconds(preview);
    Float3 drift = float3_add(float3_scale(bent->position, 190), float3(0.5f * t, -0.35f * t, 0.8f * t));
    Float3 patch = float3_add(float3_scale(bent->position, 62), float3(-0.12f * t, 0.2f * t, 0.15f * t));
    return stepf(-0.22f, 0.62f,
                 0.75f * noise3(drift, 21) + 0.5f * noise3(patch, 22) + 0.35f * bent->medium + 0.2f * bent->fine);
}

static Float3 ember_line(const Preview *preview, const PaperState *state, const Bent *bent, float air,
                         float footprint) {
    float activity = ember_activity(state->burn_rate);
    if (activity < 0.02f || state->temperature < BLACKBODY_MIN) return float3(0, 0, 0);
    float life = line_life(preview, bent) * minf(air, 1.2f);
    float distance = (bent->burn - EMBER_BURN) / maxf(state->gradient, 20.0f);
    float width = EMBER_WIDTH * (0.22f + 0.9f * life * life), x = fabsf(distance) / width;
    float profile = distance > 0 ? 0.72f * expf(-0.5f * x * x) + 0.28f * expf(-0.8f * x) : expf(-x * x);
    float temperature = ember_temperature(state->temperature) + 210 * (life - 0.6f) + 60 * bent->fine;
    if (distance > 0) temperature -= 45 * minf(x, 3);
    float strength = activity * profile * (0.05f + 0.95f * life * life) * (0.85f + 0.4f * bent->fine) * air;

    // red-hot cracks in the char next to it
    float near = 0.10f * activity * life * expf(-0.05f * x * x);
    if (near > 0.003f) strength += near * paper_cracks(bent, 1.6f, 0.12f, footprint);
    return float3_scale(blackbody_glow(preview->blackbody, ember_seen(temperature)), EMBER_GAIN * maxf(strength, 0));
}

static Float3 sparks(const Preview *preview, const PaperState *state, const Bent *bent, float air, float footprint) {
    float warm = stepf(420, 640, state->temperature) * stepf(0.76f, 0.86f, bent->burn);
    if (warm <= 0 || state->age <= 0) return float3(0, 0, 0);
    float patch = stepf(0.10f, 0.55f, noise3(float3_scale(bent->position, 85), 24) + 0.3f * bent->medium);
    if (patch <= 0) return float3(0, 0, 0);
    float delay = noise3(float3_scale(bent->position, 240), 23) + 0.5f * bent->medium + 0.25f * bent->fine;
    float late = (state->age - 3.2f) * 0.28f - delay;
    float glow = warm * patch * air * expf(-70 * late * late) * clampf(1.6f - footprint * 900, 0.3f, 1);
    return float3_scale(blackbody_glow(preview->blackbody, 1035 + 50 * bent->fine), 1.5f * glow);
}

/// Borders of plates that have left the fire glow on, while they are warm, in threads that fade within some seconds.
static Float3 border_glow(const Preview *preview, const PaperState *state, const Bent *bent, float air) {
    if (state->burn < PAPER_WHOLE || state->age <= 0 || state->age > 12) return float3(0, 0, 0);
    const float warm = stepf(420, 560, state->temperature) * (1 - ember_activity(state->burn_rate));
    const float near = warm > 0 ? near_border(state, bent, 0.6e-3f) : 0;
    if (near <= 0) return float3(0, 0, 0);
    const float strength = near * warm * air * line_life(preview, bent) * expf(-0.35f * state->age);
    return float3_scale(blackbody_glow(preview->blackbody, 1090 - 22 * state->age + 50 * bent->fine), 2.5f * strength);
}

/// How much of a leaf glows at a point, 0 to 1. It is most where air comes to it, along its border, and fades over a
/// centimetre; within, patches creep: each is brightest at its front, where a phase that grows in time passes a whole number,
/// and fades behind it. Most of a border and of a leaf is dead at any time, for one to three centimetres.
static float leaf_alive(const Preview *preview, const PaperState *state, const Bent *bent, float patch) {
    const float t = seconds(preview), border = 1e3f * border_distance(state, bent); // mm
    Float3 p = float3_mad(bent->position, float3(bent->medium, bent->coarse, bent->fine), 0.5e-3f);
    const float stretch = noise3(float3_mad(float3(0.05f * t, -0.08f * t, 0.11f * t), p, 1 / 17e-3f), 61);
    const float rim = stepf(-0.3f, 0.5f, stretch + 0.9f * patch);
    const float behind = rim * expf(-border / maxf(0.7f + 2.8f * rim * (0.9f + 0.6f * patch), 0.3f));

    const float creeps = stepf(-0.1f, 0.5f, 0.35f * patch - stretch);
    if (creeps <= 0) return behind;
    const float phase = 1.9f * noise3(float3_mad(float3(0, 0.04f * t, 0), p, 1 / 24e-3f), 63) +
                        0.6f * noise3(float3_scale(p, 1 / 7e-3f), 64) + 0.11f * t;
    const float since = phase - floorf(phase);
    return maxf(behind, creeps * stepf(0, 0.05f, since) * (0.75f * expf(-14 * since) + 0.25f * expf(-3 * since)));
}

/// A leaf of char that glows away, at its own temperature, which the simulation spreads over a cell or two. Where much of it
/// is alive it is yellow all over; where less is, coals and threads are left of that, orange in dull red, and then black char.
/// Char that still feeds a flame, which takes the air, glows along its border and its own front only.
static Float3 leaf_glow(const Preview *preview, const PaperState *state, const Bent *bent, float air, float footprint) {
    const float alone = ember_activity(state->glowing), starved = ember_starved(state->starved, bent->burn, alone);
    const float activity = alone + starved;
    if (activity < 0.02f || ember_temperature(state->temperature) < BLACKBODY_MIN) return float3(0, 0, 0);

    // threads .4 mm wide and some millimetres long
    const float fibre = paper_noise(fibres_along(bent->position, 0.25f, 65), 0.5f, footprint, 66);

    const float t = seconds(preview);
    const float patch = noise3(float3_mad(float3(-0.3f * t, 0.2f * t, 0.4f * t), bent->position, 1 / 4.4e-3f), 62);
    float alive = leaf_alive(preview, state, bent, patch) * (1 - LEAF_STARVES * starved);
    const float inward = (bent->burn - STARVED_BORDER) / (maxf(state->gradient, 20) * 2 * EMBER_WIDTH);
    alive = maxf(alive, LEAF_FRONT * starved * expf(-inward * inward));

    const float coals = 0.45f * patch + 0.42f * bent->medium + 0.45f * fibre + 0.2f * bent->fine;
    const float gathers =
        mixf(LEAF_SCATTERS, 1, stepf(0.05f, 0.5f, alive)); // no coals by themselves: they were glitter
    const float lit = clampf(LEAF_SPREAD * alive + gathers * coals - 0.56f, 0, 1),
                hot = lit * lit * (1.6f - 0.6f * lit);
    const float temperature = ember_temperature(state->temperature) - STARVED_COOLER * starved;
    Float3 red = blackbody_glow(preview->blackbody, ember_seen(temperature - LEAF_COOLER * (1.5f - alive)));
    Float3 bright = blackbody_glow(preview->blackbody, ember_seen(temperature + mixf(-LEAF_DIM, LEAF_CORE, hot)));
    Float3 glow = float3_scale(red, LEAF_DULL * alive * maxf(0.7f + 0.7f * coals, 0.1f) * alone);
    return float3_scale(float3_mad(glow, bright, LEAF_BRIGHT * hot * activity), EMBER_GAIN * air);
}

static void ember_shade(const Preview *preview, const PaperState *state, const Bent *bent, Point *point) {
    if (state->burn < 0.2f || state->temperature < 420) return;
    float air = ember_air(preview, point->position);
    Float3 glow = float3_add(ember_line(preview, state, bent, air, point->footprint),
                             sparks(preview, state, bent, air, point->footprint));
    glow = float3_add(glow, border_glow(preview, state, bent, air));
    glow = float3_add(glow, leaf_glow(preview, state, bent, air, point->footprint));

    // what film sees of it has the same colour and a bound: one hot sample does not fill a pixel at an edge
    point->glow = float3_scale(glow, 1 / (1 + maxf(glow.x, maxf(glow.y, glow.z)) / EMBER_MOST));
}

// ---- the sheet

/// Burnt borders crumble, and ash wears.
static bool is_hole(const PaperState *state, const Bent *bent, float footprint) {
    if (state->burn > PAPER_WHOLE &&
        (state->rim > 1 - border_bite(state->burn, bent) || state->edge < border_bay(state, bent)))
        return true;
    return bent->burn > 0.7f && ash_amount(bent) * stepf(0.72f, 0.95f, ash_lace(bent, footprint)) > 0.5f;
}

bool paper_is_hole(const Preview *preview, const PaperState *state, float footprint) {
    if (state->burn <= PAPER_WHOLE) return false;
    Bent bent = shade_paper_bend(state, footprint);
    const Weave *weave = cloth_weave(preview, state->sheet);
    if (weave) {
        Cloth cloth;
        cloth_find(weave, state, bent.burn, footprint, &cloth);
        return cloth_is_hole(&cloth);
    }
    return is_hole(state, &bent, footprint);
}

float paper_transmittance(const Preview *preview, int32_t sheet) {
    const float *known = preview->def.transmittances;
    return known && sheet >= 0 && (uint32_t)sheet < preview->def.sheet_count ? known[sheet] : PREVIEW_TRANSMITTANCE;
}

/// What is printed on a side of a sheet at the point, white where nothing is. From behind, u runs to the left.
static Float3 printed(const Preview *preview, const PaperState *state, bool back, float footprint) {
    if (state->sheet < 0 || (uint32_t)state->sheet >= preview->def.sheet_count) return float3(1, 1, 1);
    const Texture *texture = &preview->textures[(uint32_t)state->sheet + (back ? preview->def.sheet_count : 0)];
    if (!texture->count) return float3(1, 1, 1);
    return texture_sample(preview, texture, back ? 1 - state->uv[0] : state->uv[0], state->uv[1],
                          0.45f * footprint * texture->texels_per_metre);
}

/// Uneven density of the fibres: flocks that are hardly seen but against the light. Scattered often, it comes through warmer.
static float flocks_of(const PaperState *state, Point *point) {
    const float flocks = paper_noise(askew(state->rest), 3.6f, point->footprint, 5);
    point->through = float3_scale(float3(1.18f, 0.98f, 0.70f), 1 - 0.15f * flocks);
    return flocks;
}

/// What is seen of print on both sides. Of that on the far one so much is, T^2 / (1 - R^2) with the reflectance R of a stack;
/// what comes through has lost the share of both.
static Float3 print_seen(Float3 near, Float3 far, Point *point) {
    const Float3 seen = float3_mix(float3(1, 1, 1), far, minf(3 * point->transmission * point->transmission, 0.95f));
    point->through = float3_mul(point->through, float3(far.x / seen.x, far.y / seen.y, far.z / seen.z));
    return float3_mul(near, seen);
}

static void fresh(const Preview *preview, const PaperState *state, Point *point) {
    const bool known = state->sheet >= 0 && (uint32_t)state->sheet < preview->def.sheet_count;
    Float3 white = float3(0.86f, 0.852f, 0.832f), print = printed(preview, state, point->back, point->footprint);
    if (known && preview->def.colours) white = float3_mul(white, float3_load(preview->def.colours[state->sheet]));

    const float flocks = flocks_of(state, point);
    const float passed = point->transmission = paper_transmittance(preview, state->sheet);
    const Float3 far = printed(preview, state, !point->back, point->footprint);
    if (!cloth_weave(preview, state->sheet)) print = print_seen(print, far, point);
    else if (point->back && !(known && preview->def.backs && preview->def.backs[state->sheet])) print = far; // dyed
    point->albedo = float3_scale(float3_mul(white, print), 1 + 0.02f * flocks);

    // Wet: a film of water throws a share p of the light that leaves the fibres back to them, so that an albedo a becomes
    // a (1 - p)/(1 - p a) (Lekner and Dorf, Why some things are darker when wet, Applied Optics 27, 1988; p is about 0.44
    // for water). Pores full of water scatter less, so more light passes, and the film mirrors the sky. Air-dry paper holds
    // 5 to 8 % and shows none of it.
    const float film =
        stepf(0.15f, 0.9f, state->water + 0.06f * paper_noise(askew(state->rest), 6, point->footprint, 6));
    if (film <= 0 || state->water <= 0) return;
    const float p = 0.44f * film;
    Float3 dry = point->albedo;
    point->albedo =
        float3((1 - p) * dry.x / (1 - p * dry.x), (1 - p) * dry.y / (1 - p * dry.y), (1 - p) * dry.z / (1 - p * dry.z));
    point->transmission = mixf(passed, minf(2 * passed, 0.6f), film);
    point->albedo =
        float3_scale(point->albedo, (1 - point->transmission) / (1 - minf(passed, 0.9f))); // is not reflected
    point->gloss = 0.05f * film;
    point->shininess = 30;
    point->mirror = 0.5f * film;
}

/// A coating mirrors. It softens in the heat and blisters, in domes of some millimetres with creases between them, before
/// the paper chars, and what is left of it shines on the char.
static void coat(float coating, const Bent *bent, Point *point) {
    const float charred = bent ? stepf(0.3f, 0.7f, bent->burn) : 0;
    const float left = coating * (1 - 0.7f * charred) * (bent ? 1 - stepf(0.7f, 0.9f, bent->burn) : 1);
    point->gloss = maxf(point->gloss, 0.16f * left);
    point->shininess = mixf(point->shininess, 70, left);
    point->mirror = maxf(point->mirror, 0.9f * left);
    if (!bent) return;

    const float soft = coating * stepf(350, 410, bent->peak) * (1 - 0.6f * charred);
    Float3 p = float3_mad(bent->position, float3(bent->medium, bent->fine, bent->coarse), 0.3e-3f);
    tilt(p, 2.6f, 1.2f * soft, true, 41, point);
    tilt(p, 1.2f, 0.7f * soft * stepf(-0.2f, 0.5f, bent->coarse), true, 42, point);
}

/// What is seen on char of a woven sheet's picture, over what would be of print: dyes burn with their threads, and have none
/// of ink's minerals.
#define DYE_LEFT 0.12f

#define INK_LEAST 0.6f

/// How much of print is left on char, INK_LEAST to 1: it fades and flakes off in patches.
static float ink_kept(const Bent *bent) {
    return mixf(INK_LEAST, 1, stepf(-0.5f, 0.35f, bent->bays + 0.6f * bent->coarse + 0.3f * bent->medium));
}

#define SHEEN 0.09f ///< of char, where it turns away from the eye

/// Char: browner where it is thin, bluer where complete; print (1) remains readable on it, as a dull grey.
static void char_shade(const Bent *bent, Float3 burnt, float ink, Point *point) {
    float black = stepf(0.12f, 0.46f, bent->burn);
    point->albedo = burnt;
    if (black <= 0) return;

    float value = 1 + 0.2f * bent->medium + 0.1f * bent->fine + 0.4f * bent->coarse;
    Float3 soot =
        float3_mix(float3(0.034f, 0.020f, 0.012f), float3(0.0118f, 0.0125f, 0.0145f), stepf(0.22f, 0.62f, bent->burn));
    float craze = paper_cracks(bent, 3.1f, 0.04f, point->footprint);
    Float3 colour = float3_scale(soot, value * (1 - 0.6f * craze));
    point->albedo = float3_mix(burnt, float3_mad(colour, float3(0.072f, 0.078f, 0.088f), ink), black);

    // tar makes it shine
    float tar = clampf(0.75f + 0.5f * bent->coarse - 0.5f * ink, 0.2f, 1.2f);
    point->gloss = 0.06f * black * tar;
    point->shininess = 14;
    point->mirror = 0.45f * black * tar;
    Float3 cockled = float3_mad(bent->position, float3(bent->medium, bent->coarse, bent->fine), 0.7e-3f);
    tilt(cockled, 13, 0.17f * black, true, 33, point);
    tilt(cockled, 5.2f, 0.29f * black, true, 32, point);
    tilt(bent->position, 1.6f, 0.09f * black, true, 31, point);

    // aslant it is grey by whatever light: its skin is smooth
    const float away = 1 - maxf(float3_dot(point->normal, point->view), 0);
    const float sheen =
        SHEEN * black * away * away * away * away * (1 - 0.5f * craze) * maxf(0.8f + 0.5f * bent->coarse, 0.2f);
    point->albedo = float3_mad(point->albedo, float3(0.90f, 0.98f, 1.08f), sheen);
}

/// How brown paper is: by heat, up to 0.76, and by what has burnt. Near a front, where the peak temperature falls off within
/// millimetres, vapour has condensed on paper that was hardly warm: the band is more than twice as wide as heat alone makes
/// it. Paper is denser here than there, over centimetres: the band's border runs in tongues.
static float scorch_amount(const PaperState *state, const Bent *bent, float footprint) {
    const float by_burn = 1 - expf(-7.5f * maxf(bent->burn, 0));
    const float steep = state->heat_gradient / maxf(maxf(state->peak, state->temperature) - 293, 1);   // 1/m
    const float near = stepf(120, 350, steep), first = mixf(55, 5, near), last = mixf(360, 200, near); // K above 293
    float above = bent->peak - 293;
    if (above > 0.3f * first && by_burn < 0.9f)
        above *= expf(clampf(2.5e-3f * steep, 0.7f, 1.3f) *
                      (paper_noise(bent->position, 9, footprint, 7) + 0.5f * bent->coarse + 0.2f * bent->medium));
    const float by_heat = above > first ? 0.76f * minf(logf(above / first) / logf(last / first), 1) : 0;
    return 1 - (1 - by_heat) * (1 - by_burn);
}

bool paper_shade(const Preview *preview, const PaperState *state, Point *point) {
    fresh(preview, state, point);
    const Weave *weave = cloth_weave(preview, state->sheet);
    bool touched = state->burn > 0 || maxf(state->peak, state->temperature) > (weave ? CLOTH_WARM : 295);
    const float coating = preview->def.looks && state->sheet >= 0 && (uint32_t)state->sheet < preview->def.sheet_count
                              ? preview->def.looks[state->sheet].coating
                              : 0;
    if (!touched && coating > 0) coat(coating, NULL, point);
    const float sharp = weave ? 0 : crumple_amount(point->bent);
    if (sharp > 0) {
        crumple_shade(&preview->scene, state, sharp, point);
        tilt(askew(state->rest), 3.5f, 0.20f * sharp, true, 36, point);
    }
    if (!touched && !weave) return true;

    Bent bent = {.burn = 0};
    if (touched) bent = shade_paper_bend(state, point->footprint);
    Cloth cloth;
    float threads = 1;
    if (weave) {
        // aslant a pixel holds more threads, which would be a pattern of their own
        const float facing = maxf(float3_dot(point->geometric, point->view), 0.2f);
        cloth_find(weave, state, bent.burn, point->footprint / facing, &cloth);
        if (cloth_is_hole(&cloth)) return false;
        threads = cloth_shade(weave, state, &cloth, point);
        if (!touched) point->albedo = float3_scale(point->albedo, threads);
        if (!touched) return true;
    } else if (is_hole(state, &bent, point->footprint)) return false;

    const float scorch = weave ? cloth_scorch(weave, state, point) : scorch_amount(state, &bent, point->footprint);
    float ink = 1 - clampf(float3_luminance(point->albedo), 0, 1);
    const float print = (weave ? DYE_LEFT : ink_kept(&bent)) * stepf(0.3f, 0.75f, ink);
    Float3 burnt = float3_mul(scorch_colour(scorch),
                              float3_mix(point->albedo, float3(0.80f, 0.80f, 0.80f), stepf(0.6f, 1.0f, scorch)));
    point->transmission *= 1 - stepf(0.1f, 0.7f, scorch);
    char_shade(&bent, burnt, print, point);
    if (coating > 0) coat(coating, &bent, point);
    ash_shade(state, &bent, print, point);
    if (!weave) ember_shade(preview, state, &bent, point);
    else cloth_glow(preview, weave, state, &cloth, cloth_char(weave, state, &cloth, bent.burn, threads, point), point);
    return true;
}
