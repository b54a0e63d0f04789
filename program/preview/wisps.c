// Wisps: the smoke of what is hot and has no flame.
//
// The air over an ember rises in a smooth thread, h(a) = RISE a + SPEEDING a^2 above it at the age a. What left it at the
// moment s = t - a keeps a part of the swing that the air had then, so that with smooth noises N of the moment
//
//     p(a) = p0 + z h(a) + (N1(s), N2(s), N3(s)) g(a),   g = 0 up to the age LAMINAR, then growing:
//
// a thread sways little for some centimetres, then buckles, and rolls where what left later overtakes what left before. A
// wisp is a ribbon of THREADS of these, dense in its middle and thin at its sides. It leaves up to a centimetre of the rim
// in streams, each of which pulses by itself, narrows as it rises, and spreads in its own way. Their
// swings differ more and more, so it breaks into veils: where one turns its edge or folds there is a bright thin line beside
// a soft fill. It is bent across, so that it has a width from every side. Each thread is a row of soft dots. As much smoke
// passes each height, but for what condenses near the ember and is lost at last: where a wisp is wider it is fainter. At its
// foot threads thin out one by one, over millimetres to centimetres.
//
// Of smoke that comes to a flame soon only the straight part would be seen, a rod: such an ember has no wisp.

#include "preview/airborne.h"

enum {
    THREADS = 60,
    FEWER = 4,   ///< of which one is drawn where all are within a few pixels
    KNOTS = 150, ///< of a thread, between which it is straight
    SIGHTS = 3,  ///< times SIGHT_POINTS places of a thread where it is known whether it is seen; most are low
    LIGHTS = 12, ///< places of a wisp where its light is known
};
#define WISP_CELL 0.025f    ///< m, of the sites
#define WISP_LIFE 1.5f      ///< s
#define RISE 0.12f          ///< m/s
#define SPEEDING 0.13f      ///< m/s2
#define TURNS 0.08f         ///< s, over which it takes up the air's drift: cells that differ would be kinks
#define RIBBON 0.0008f      ///< m, half of its width at the ember
#define LAMINAR 0.14f       ///< s, in the mean
#define SWAY 0.009f         ///< m that it sways before it buckles
#define CURL 0.036f         ///< m, by which curls move it at most
#define CURLING 0.23f       ///< s after it has buckled, by which half of that
#define EDDY 0.010f         ///< m that small eddies move threads after that
#define RIM 0.0016f         ///< m of the rim on each side, at most, that feed a wisp
#define CLUMPED 0.5f        ///< share of its width along the rim by which threads cluster there
#define NARROWS 0.4f        ///< share of that width that remains
#define JOINED 0.8f         ///< s, until then
#define BURNT_SOON 0.30f    ///< s, age: smoke that comes to a flame before that is not seen
#define BURNT_LATE 0.8f     ///< s, the same: and smoke that comes later is seen whole
#define EMERGES_SOON 0.006f ///< m, over which threads thin from nothing at their foot: some of them
#define EMERGES_LATE 0.040f ///< m, others
#define HIDES 0.012f        ///< m, over which they fade before they are hidden
#define PULSES 1.6f         ///< powers of 2, by which all threads thicken and thin together
#define THREAD 0.0006f      ///< m, radius at the ember
#define WISP_DEPTH 19e-3f   ///< m, optical depth across a wisp times its width
#define FRESH 0.35f         ///< share of that at the ember: most vapours have not condensed yet
#define STRONG 1.2f         ///< by which strong wisps are weakened, or they would be white cords
#define AMID 0.55f          ///< share of a wisp's light among flames, which burn most of it
#define FLAME_FAINT 0.08f   ///< of a cell whose flame burns smoke
#define AHEAD 0.35f         ///< of what it takes from the light behind it, that goes on nearly straight is not missed
#define SMOKING 10.0f       ///< sites of which half smoke
#define WISP_AREA 1.0e-5f   ///< m2 that smoulder and give half of the densest wisp

typedef struct Wisp {
    Float3 path[KNOTS + 1]; ///< m, where the air carries what leaves the ember
    Float3 across;
    Float3 from[2]; ///< m from the first point of its path: where its first and last threads leave the rim
    float strength, now;
    float laminar; ///< s
    float burnt;   ///< s, age at which it comes to a flame
    float wide;    ///< times RIBBON
    Float3 light[LIGHTS];
    uint32_t seed;
} Wisp;

/// Smooth noise of a moment, and of the place across the ribbon.
static inline float swing(const Wisp *wisp, float moment, float often, float place, uint32_t which) {
    float n = noise2(moment * often, 0.55f * place, wisp->seed + which);
    return n + 0.4f * noise2(2.3f * moment * often, 1.1f * place + 7, wisp->seed + which);
}

/// Follows the air from an ember: smoke rises by itself, drifts with the gas as that does per m of rise, linear between cells,
/// and burns in flames.
static void wisp_follow(const Fire *fire, Wisp *wisp) {
    const float step = WISP_LIFE / KNOTS;
    wisp->burnt = WISP_LIFE;
    float along[2] = {0, 0};
    for (int k = 0; k < KNOTS; k++) {
        const float rise = (RISE + 2 * SPEEDING * step * ((float)k + 0.5f)) * step;
        float f[3], at[3], drift[2] = {0, 0}, flame = 0;
        int low[3];
        bool within = fire->size[0] && fire->visible;
        float3_store(at, float3_scale(float3_sub(wisp->path[k], fire->origin), 1 / fire->cell));
        for (int c = 0; c < 3 && within; c++) {
            low[c] = noise_floor(at[c], &f[c]);
            within = low[c] >= 0 && low[c] <= fire->size[c] - 2;
        }

        for (int corner = 0; corner < 8 && within; corner++) {
            size_t cell = 0;
            float share = 1;
            for (int c = 2; c >= 0; c--) {
                const int next = corner >> c & 1;
                cell = cell * (size_t)fire->size[c] + (size_t)(low[c] + next);
                share *= next ? f[c] : 1 - f[c];
            }
            for (int c = 0; c < 2; c++) drift[c] += share * fire->source[cell][c];
            flame = maxf(flame, fire->cells[cell].flame);
        }

        if (flame > FLAME_FAINT) wisp->burnt = minf(wisp->burnt, step * (float)k);
        for (int c = 0; c < 2; c++) along[c] += step / TURNS * (drift[c] - along[c]);
        wisp->path[k + 1] = float3_add(wisp->path[k], float3(rise * along[0], rise * along[1], rise));
    }
}

/// Half of its width at an age.
static float wisp_half(const Wisp *wisp, float age) {
    const float loose = maxf(age - wisp->laminar, 0);
    return wisp->wide * (RIBBON + 0.0055f * age + 0.036f * loose + 0.040f * loose * loose);
}

/// Where a thread's smoke of an age is. `place`: of the thread across the ribbon, -1 to 1.
static Float3 wisp_at(const Wisp *wisp, float age, float place) {
    const float moment = wisp->now - age, loose = maxf(age - wisp->laminar, 0);
    const float curled = loose * loose / (CURLING * CURLING), roll = CURL * curled / (1 + curled);
    const float bend = SWAY * stepf(-0.05f, 0.3f, age) + 0.11f * loose * loose / (0.08f + loose);
    const float turn = 3 * age + 3.4f * noise2(moment * 2.3f, 3, wisp->seed), c = cosf(turn), s = sinf(turn);
    const float half = wisp_half(wisp, age), drift = 0.045f * age;
    const float side = half * place, deep = 0.7f * half * noise2(1.3f * place + 5, 2.1f * moment, wisp->seed + 31);
    const float u = c * side - s * deep, v = s * side + c * deep;
    const float x = age * (KNOTS / WISP_LIFE);
    const int knot = (int)minf(x, KNOTS - 1);
    Float3 p = float3_mix(wisp->path[knot], wisp->path[knot + 1], x - (float)knot);
    p.x += u * wisp->across.x - v * wisp->across.y + drift * noise2(1.7f * moment, 0, wisp->seed + 21);
    p.y += u * wisp->across.y + v * wisp->across.x + drift * noise2(1.7f * moment, 0, wisp->seed + 22);

    const float rim = place + CLUMPED * noise2(2.3f * place, 0.6f * moment, wisp->seed + 32);
    p = float3_mad(p, wisp->from[rim > 0], fabsf(rim) * mixf(1, NARROWS, stepf(0, JOINED, age)));

    // threads part as it curls: what is beside in the ribbon is then elsewhere in the eddy
    const float parts = place * (0.3f + 1.9f * stepf(0.0f, 0.55f, loose)), eddy = EDDY * stepf(0.08f, 0.5f, loose);
    p.x += eddy * noise2(23 * moment, 2.6f * parts, wisp->seed + 15);
    p.y += eddy * noise2(23 * moment, 2.6f * parts, wisp->seed + 16);
    p.z += eddy * noise2(23 * moment, 2.6f * parts, wisp->seed + 17);
    p.x += bend * swing(wisp, moment, 3.4f, parts, 11) + roll * swing(wisp, moment, 10, parts, 13);
    p.y += bend * swing(wisp, moment, 3.4f, parts, 12) + roll * swing(wisp, moment, 10, parts, 14);
    p.z += 0.6f * bend * swing(wisp, moment + 0.07f, 3.4f, 0.5f * parts, 11);
    p.z += roll * swing(wisp, moment + 0.025f, 10, parts, 13);
    return p;
}

/// The age of place k of `count` where something is known of a thread, denser near the ember.
static float age_of(int k, int count) {
    const float part = (float)k / (float)(count - 1);
    return WISP_LIFE * part * part;
}

/// The number of the place below that, and how far it is to the next.
static int place_of(float age, int count, float *part) {
    const float at = sqrtf(age / WISP_LIFE) * (float)(count - 1);
    const int i = (int)minf(at, (float)(count - 2));
    *part = at - (float)i;
    return i;
}

/// The height over its ember at an age, m.
static float risen(float age) { return RISE * age + SPEEDING * age * age; }

/// How much of a thread is seen at its places, of which `sharp` says whether something hides them. It thins from nothing where
/// it leaves the ember or comes out from behind something, over `most` m, or its foot would be cut off; and it fades before it
/// passes behind something, because it may drift through a sheet there.
static void wisp_emerge(float most, const float *sharp, float *seen) {
    enum { COUNT = SIGHTS * SIGHT_POINTS };
    float open = 0, high = 0;
    for (int k = 0; k < COUNT; k++) {
        const float h = risen(age_of(k, COUNT));
        open = minf(open + (h - high) / most, 1) * sharp[k];
        seen[k] = open;
        high = h;
    }
    open = 1;
    for (int k = COUNT - 1; k >= 0; k--) {
        const float h = risen(age_of(k, COUNT));
        open = minf(open + (high - h) / HIDES, 1) * sharp[k];
        seen[k] = stepf(0, 1, minf(seen[k], open));
        high = h;
    }
}

/// `first`: of FEWER.
static void thread_draw(Preview *preview, const Wisp *wisp, float place, bool first) {
    Float3 knots[KNOTS + 1], points[SIGHT_POINTS];
    float seen[SIGHTS * SIGHT_POINTS], sharp[SIGHTS * SIGHT_POINTS], at[2], depth;
    for (int k = 0; k <= KNOTS; k++) knots[k] = wisp_at(wisp, WISP_LIFE * (float)k / KNOTS, place);
    for (int k = 0; k < SIGHTS; k++) {
        for (int i = 0; i < SIGHT_POINTS; i++)
            points[i] = wisp_at(wisp, age_of(k * SIGHT_POINTS + i, SIGHTS * SIGHT_POINTS), place);
        airborne_sight(preview, points, SIGHT_POINTS, sharp + k * SIGHT_POINTS);
    }

    wisp_emerge(
        mixf(EMERGES_SOON, EMERGES_LATE, hash_unit(hash_u32(wisp->seed + 2) + (uint32_t)(THREADS * (place + 1)))),
        sharp, seen);

    const float edge = 1.75f * expf(-2.2f * place * place); // the mean is 1
    const float rim = maxf(float3_length(wisp->from[0]), float3_length(wisp->from[1]));
    const float mist = hash_unit(hash_u32(wisp->seed) + (uint32_t)(THREADS * (place + 1))), spread = mist * mist;
    for (float age = 0.002f; age < WISP_LIFE;) {
        const float x = age * (KNOTS / WISP_LIFE);
        const int knot = (int)minf(x, KNOTS - 1);
        const Float3 p = float3_mix(knots[knot], knots[knot + 1], x - (float)knot);
        if (!airborne_project(preview, p, at, &depth)) return;
        float part;
        int i = place_of(age, SIGHTS * SIGHT_POINTS, &part);
        const float open = mixf(seen[i], seen[i + 1], part);
        i = place_of(age, LIGHTS, &part);
        const Float3 light = float3_mix(wisp->light[i], wisp->light[i + 1], part);

        // steps of half of a dot; what rises faster is thinner
        const float pixel = preview->camera.pixel * depth, fast = RISE + 2 * SPEEDING * age;
        const float loose = maxf(age - wisp->laminar, 0),
                    wide =
                        THREAD + 0.03f * rim + 0.0016f * age + (0.0030f + 0.026f * spread) * loose * minf(2 * loose, 1);
        const float radius = maxf(wide / pixel + camera_blur(&preview->camera, depth), 1.1f);
        const float way = float3_length(float3_sub(knots[knot + 1], knots[knot])) * (KNOTS / WISP_LIFE);
        const float step = minf(0.45f * radius * pixel / maxf(way, RISE), 0.02f), left = 1 - age / WISP_LIFE;

        // where it is narrow one thread stands for several
        const float half = wisp_half(wisp, age) + rim * mixf(1, NARROWS, stepf(0, JOINED, age));
        const float apart = stepf(2, 6, half / (pixel * radius));
        const float stands = mixf(first ? FEWER : 0, 1, apart);
        const float moment = wisp->now - age;
        const float puff = 1.4f * swing(wisp, moment, 5, 2.2f * place, 18) +
                           1.3f * noise2(1.7f * moment, 2.7f * place, wisp->seed + 19) +
                           PULSES * noise2(4.3f * moment, 0, wisp->seed + 24);
        const float strand =
            1.5f * noise2(2 * moment, 4 * place + noise2(1.9f * moment, 0, wisp->seed + 21), wisp->seed + 20);
        float dense = 0.75f * WISP_DEPTH * wisp->strength * edge * left * sqrtf(left) * exp2f(puff + strand);
        dense *= open * stands;
        if (wisp->burnt < WISP_LIFE) dense *= 1 - stepf(0.15f * wisp->burnt, wisp->burnt, age);
        dense *= mixf(FRESH, 1, stepf(0, 0.7f, age)) * RISE / fast;
        dense *= fast * step / (pixel * pixel * THREADS);
        if (dense > 0) airborne_dot(preview, at, radius, float3_scale(light, dense), AHEAD * dense);
        age += step;
    }
}

void wisps_draw(Preview *preview) {
    EmberSite sites[SITE_LIMIT];
    float strength[SITE_LIMIT];
    if (preview->def.wisps <= 0) return;
    ember_sites(preview, WISP_CELL, sites);

    // of many only some smoke at a time
    int count = 0;
    for (int i = 0; i < SITE_LIMIT; i++) {
        const float area = sites[i].smoulder, upright = 1 - stepf(0.2f, 0.5f, sites[i].level); // there it spreads
        strength[i] = 0;
        if (!(area > 0)) continue;
        Wisp wisp = {.path = {sites[i].ember}};
        wisp_follow(&preview->fire, &wisp);
        strength[i] = area / (area + WISP_AREA) * (1 - upright) * stepf(BURNT_SOON, BURNT_LATE, wisp.burnt);
        count += strength[i] > 0.15f;
    }
    const float still = 0.80f - 0.30f * minf(SMOKING / (float)(count + 1), 1);

    const float now = (float)fmod(preview->time, 4096.0);
    for (int i = 0; i < SITE_LIMIT; i++) {
        if (strength[i] <= 0) continue;
        const uint32_t key = sites[i].key;
        const float live = 0.5f + 0.5f * noise2(0.7f * now, 0, key);
        Wisp wisp = {.path = {sites[i].ember},
                     .across = ember_across(key),
                     .strength = preview->def.wisps * strength[i] * stepf(still, still + 0.3f, live),
                     .now = now,
                     .laminar = LAMINAR * (0.8f + 0.7f * hash_unit(key + 1) + 0.25f * noise2(0.9f * now, 9, key)),
                     .wide = exp2f(1.3f * hash_unit(key + 2) - 0.3f),
                     .seed = key & 0xffff};
        for (int k = 0; k < 2; k++) {
            const Float3 rim = float3_sub(sites[i].ends[k], sites[i].ember);
            wisp.from[k] = float3_scale(rim, RIM / maxf(float3_length(rim), RIM));
        }
        wisp.strength /= 1 + STRONG * wisp.strength;
        if (wisp.strength <= 0.01f) continue;
        wisp_follow(&preview->fire, &wisp);
        float lit = 0, clear[SIGHT_POINTS];
        Float3 places[LIGHTS], flames[SIGHT_POINTS];
        for (int k = 0; k < LIGHTS; k++) places[k] = wisp_at(&wisp, age_of(k, LIGHTS), 0);
        airborne_flames(preview, places, LIGHTS, flames, clear);
        for (int k = 0; k < LIGHTS; k++) {
            wisp.light[k] = smoke_light(preview, places[k]);
            if (k <= LIGHTS / 2) lit = maxf(lit, float3_luminance(wisp.light[k]));
            wisp.light[k] = float3_mad(float3_scale(flames[k], AHEAD), wisp.light[k], clear[k]);
        }
        const float amid = stepf(AMID / 3, AMID, lit);
        wisp.strength *= 1 - 0.85f * amid;
        wisp.laminar *= 1 - 0.7f * amid; // fires stir the air around them
        for (int k = 0; k < THREADS; k++)
            thread_draw(preview, &wisp, 2 * ((float)k + 0.5f) / THREADS - 1, k % FEWER == FEWER / 2);
    }
}
