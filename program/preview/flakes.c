// Flakes: small plates of char and ash that come off a burning border, and fall as plates do.
//
// A flake is carried up by the air of a flame, which it leaves within CARRIED, and falls at the speed w of a plate that
// lies on the air, with w of its mass. It does not fall straight. Light plates either flutter, swinging from side to
// side, or tumble, turning over and gliding one way (Belmonte, Eisenberg and Moses 1998; Andersen, Pesavento and Wang
// 2005). With its tilt q about a level axis and d the direction across it, at the age a,
//
//     q = Q sin(f a),  the side is  (S / f)(1 - cos(f a)) d,  and it falls faster while it is steep,   or
//     q = f a,         the side is  S a d,                    bobbing twice a turn,
//
// both about an axis that itself turns slowly. f follows from f d / w, which differs little between plates.
//
// It is a scrap of burnt paper (shade_ash.c), bent and creased, and each part is lit by its own slope. It is drawn as soft
// dots, one for each of its points, at several moments while the shutter is open. The veil that it is drawn into lies over
// all flames: so each dot has the light of those before it, and of its own what passes them.

#include "preview/airborne.h"
#include "preview/ground.h"

enum {
    FLAKES_A_SLOT = 3,  ///< that a site may lose in a slot
    ACROSS_LIMIT = 40,  ///< points along a side of its square
    MOMENT_LIMIT = 28,  ///< while the shutter is open
    LANDING_STEPS = 12, ///< of halving
};
#define FLAKE_CELL 0.020f     ///< m, of the sites
#define FLAKE_SLOT 0.1f       ///< s
#define FLAKE_LIFE 1.7f       ///< s, the longest
#define CARRIED 0.70f         ///< s
#define LYING 0.3f            ///< s, of what came to the ground: what lies there is the stain's
#define SHOWS 0.3f            ///< of the exposure: a plate that turns shows its face for a part of it, or is a grey bar
#define STARTING 0.06f        ///< s, within which it falls at its speed
#define FLAKES_A_METRE 270.0f ///< 1/(m s), from sites that glow over a few cm
#define FLAKES_CROWD 0.25f    ///< m of glowing line above which flakes become rarer
#define FLAKE_DEPTH 3.2f      ///< optical depth across: 0.96 of what is behind is hidden
#define FLAKE_AIR_DENSITY 1.2f
#define FLAKE_COLD 600.0f      ///< K: nothing of it glows
#define FLAKE_BENT 1.4f        ///< factor on the bend of a scrap that lies on the ground
#define FLAKE_AMID 950.0f      ///< K, of a flake in a flame: so thin, it takes the heat of the gas at once
#define FLAKE_AMID_WIDE 0.004f ///< m to either side of the flame's edge, over which it is heated

/// Light that reaches a flake along each axis and against it: what a white surface reflects that faces that way.
typedef struct FlakeLight {
    Float3 from[6];
} FlakeLight;

/// Fire around a flake.
typedef struct FlakeFire {
    Float3 light[SIGHT_POINTS]; ///< of flames before it, at BEFORE x BEFORE places of its plate
    float clear[SIGHT_POINTS];  ///< what passes these
    float amid;                 ///< 0 outside of all flames to 1 within one
} FlakeFire;

enum { BEFORE = 4 }; ///< squared it is SIGHT_POINTS: they are asked at once

/// A flake's flight.
typedef struct Flake {
    Float3 from, drift;      ///< m, m/s
    float up, fall, side;    ///< m/s: with the flame, and when it has left it
    float often, swing;      ///< rad/s, and rad: 0 tumbles
    float phase, turn, spin; ///< rad, rad, rad/s
    float life, hot;         ///< s, K
    float size, narrow;      ///< m, half of its length; its width over that
    float ash;               ///< 0 char to 1 ash
    float landing;           ///< s, the age at which it lies on the ground; infinite: never
    uint32_t seed;
} Flake;

/// A plate in space: its centre and two half axes.
typedef struct Plate {
    Float3 centre, along, across, normal;
} Plate;

static float flake_rise(const Flake *flake, float age) {
    const float carried = CARRIED * (1 - expf(-age / CARRIED)), lag = STARTING * (1 - expf(-age / STARTING));
    return flake->up * carried - flake->fall * (age - lag);
}

static Plate flake_at(const Flake *flake, float age) {
    const bool lies = age >= flake->landing, tumbles = flake->swing == 0;
    if (lies) age = flake->landing;
    const float start = age * age / (age + 2 * STARTING), beat = flake->often * age + flake->phase;
    const float tilt = tumbles ? beat : flake->swing * sinf(beat), turn = flake->turn + flake->spin * age;
    const Float3 axis = {cosf(turn), sinf(turn), 0}, aside = {-axis.y, axis.x, 0};
    const float side = tumbles ? flake->side * start
                               : flake->side / flake->often * (cosf(flake->phase) - cosf(beat)) * start / (age + 1e-6f);
    const float bob = 0.25f * flake->fall / flake->often * (sinf(2 * beat) - sinf(2 * flake->phase));

    Plate plate;
    plate.centre = float3_mad(float3_mad(flake->from, flake->drift, start), aside, side);
    plate.centre.z += flake_rise(flake, age) + (lies ? 0 : bob);
    const float c = lies ? 1 : cosf(tilt), s = lies ? 0 : sinf(tilt);
    plate.along = float3_scale(axis, flake->size);
    plate.across = float3_scale(float3(c * aside.x, c * aside.y, -s), flake->size * flake->narrow);
    plate.normal = float3(s * aside.x, s * aside.y, c);
    return plate;
}

/// The height of a flake over its plate.
static float flake_height(const Scrap *scrap, float u, float v) {
    return FLAKE_BENT * (scrap_height(scrap, u, v) - 0.14f);
}

/// Where a point of the plate is, u along it and v across it from -1 to 1.
static Float3 plate_point(const Plate *plate, float u, float v) {
    return float3_mad(float3_mad(plate->centre, plate->along, u), plate->across, v);
}

static FlakeFire flake_fire(const Preview *preview, const Plate *plate) {
    const Fire *fire = &preview->fire;
    FlakeFire around = {.amid = 0};
    Float3 points[SIGHT_POINTS];
    for (int k = 0; k < BEFORE * BEFORE; k++)
        points[k] =
            plate_point(plate, 2 * (float)(k % BEFORE) / (BEFORE - 1) - 1, 2 * (float)(k / BEFORE) / (BEFORE - 1) - 1);
    airborne_flames(preview, points, BEFORE * BEFORE, around.light, around.clear);
    if (!fire->visible) return around;

    FirePlaces places = {{0}, {0}, {0}, {0}};
    FirePoints found;
    fire_place(&places, 0, plate->centre, 0);
    fire->look(fire, 1, &places, &found);
    around.amid = stepf(-FLAKE_AMID_WIDE, FLAKE_AMID_WIDE, found.depth[0]);
    return around;
}

/// What a dot at (u, v) of the plate shows of its light: flames are before it.
static Float3 flake_behind(const FlakeFire *around, float u, float v, Float3 light) {
    const float x = 0.5f * (u + 1) * (BEFORE - 1), y = 0.5f * (v + 1) * (BEFORE - 1);
    const int i = (int)clampf(x, 0, BEFORE - 2), j = (int)clampf(y, 0, BEFORE - 2), k = BEFORE * j + i;
    const float s = x - (float)i, t = y - (float)j;
    const Float3 before = float3_mix(float3_mix(around->light[k], around->light[k + 1], s),
                                     float3_mix(around->light[k + BEFORE], around->light[k + BEFORE + 1], s), t);
    const float clear = mixf(mixf(around->clear[k], around->clear[k + 1], s),
                             mixf(around->clear[k + BEFORE], around->clear[k + BEFORE + 1], s), t);
    return float3_mad(before, light, clear);
}

/// Draws the flake at an age, for a `share` of the exposure. `apart`: pixels that it moves between two such moments.
static void plate_draw(Preview *preview, const Flake *flake, const FlakeLight *lit, const FlakeFire *around, float age,
                       float share, float apart) {
    const Plate plate = flake_at(flake, age);
    const Scrap scrap = scrap_make(flake->seed);
    const Float3 to = float3_unit_or(float3_sub(preview->camera.eye, plate.centre), plate.normal);
    float at[2], depth;
    if (!airborne_project(preview, plate.centre, at, &depth)) return;
    const float pixel = preview->camera.pixel * depth, wide = 2 * flake->size / pixel;
    const int across = (int)clampf(ceilf(1.2f * wide), 3, ACROSS_LIMIT);
    const float spacing = wide / (float)across, blur = camera_blur(&preview->camera, depth);
    const float least = maxf(blur, 1.6f * apart); // pixels, of a dot
    const float cover = FLAKE_DEPTH * share * flake->narrow * spacing * spacing;
    const float heat = maxf(FLAKE_COLD + (flake->hot - FLAKE_COLD) * expf(-3.2f * age / flake->life),
                            mixf(FLAKE_COLD, FLAKE_AMID, around->amid));

    for (int j = 0; j < across; j++)
        for (int i = 0; i < across; i++) {
            const uint32_t seed = flake->seed;
            const uint32_t dither = hash_u32(seed ^ (uint32_t)(i + across * j) ^ (uint32_t)(age * 65536) * 0x8da6b343u);
            const float u = 2 * ((float)i + 0.25f + 0.5f * hash_unit(dither)) / (float)across - 1;
            const float v = 2 * ((float)j + 0.25f + 0.5f * hash_unit(dither + 1)) / (float)across - 1;
            const float inside = scrap_depth(&scrap, u, v);
            if (inside <= 0) continue;

            // by the slope of its bend there; edge-on, its creases make it thick
            const float e = 0.08f, high = flake_height(&scrap, u, v);
            const float slope[2] = {(flake_height(&scrap, u + e, v) - high) / e,
                                    (flake_height(&scrap, u, v + e) - high) / e};
            Float3 normal = float3_mad(plate.normal, plate.along, -slope[0] / flake->size);
            normal = float3_mad(normal, plate.across, -slope[1] / (flake->size * flake->narrow * flake->narrow));
            const float stretched = float3_length(normal); // of what is seen, and so from dot to dot
            const float radius = maxf(1.25f * spacing * sqrtf(stretched), least), hides = cover * minf(stretched, 2.5f);
            normal = float3_unit_or(normal, plate.normal);
            const float facing = float3_dot(normal, to), seen = 0.07f + 0.93f * fabsf(facing);
            if (facing < 0) normal = float3_scale(normal, -1);

            // pale at its rim and in patches; embers last longest at the rim, as threads
            const float patch = noise2(2.3f * u + 5, 2.3f * v + 5, seed + 1);
            const float rim = expf(-inside / 0.13f),
                        pale = clampf(0.85f * flake->ash + 0.4f * rim + 0.32f * patch, 0, 1);
            const float albedo = mixf(0.026f, 0.36f, pale * pale);
            const float alive = stepf(0.05f, 0.5f, noise2(3 * u + 1, 3 * v + 1, seed + 2) + 0.3f * patch);
            const float glows = alive * maxf(rim, around->amid * mixf(0.15f, 1, rim)) * stepf(FLAKE_COLD, 900, heat);
            Float3 light = float3_scale(lit->from[normal.x < 0], albedo * normal.x * normal.x);
            light = float3_mad(light, lit->from[2 + (normal.y < 0)], albedo * normal.y * normal.y);
            light = float3_mad(light, lit->from[4 + (normal.z < 0)], albedo * normal.z * normal.z);
            light = float3_mad(light, blackbody_glow(preview->blackbody, heat + 120 * rim), EMBER_GAIN * glows);

            light = flake_behind(around, u, v, light);
            const Float3 point = float3_mad(plate_point(&plate, u, v), plate.normal, flake->size * high);
            if (!airborne_project(preview, point, at, &depth)) return;
            airborne_dot(preview, at, radius, float3_scale(light, seen * hides), seen * hides);
        }
}

/// The light around a place.
static FlakeLight flake_light(const Preview *preview, Float3 place) {
    const EmberLights *lamps = &preview->scene.lights;
    const float through = 0.25f; // of what comes from behind
    FlakeLight light;
    for (int d = 0; d < 6; d++) {
        const float axis[3] = {d / 2 == 0, d / 2 == 1, d / 2 == 2};
        const Float3 normal = float3_scale(float3_load(axis), d % 2 ? -1 : 1);
        const float sun = float3_dot(normal, preview->sun);
        Float3 lit = float3_mad(sky_ambient(&preview->sky, normal), preview->sun_light, maxf(sun, -through * sun));
        Float3 fire = {0, 0, 0};
        for (int k = 0; k < preview->scene.light_count; k++) {
            const Float3 to = float3_sub(float3(lamps->x[k], lamps->y[k], lamps->z[k]), place);
            const float d2 = float3_dot(to, to) + lamps->softness[k], cosine = float3_dot(normal, to) / sqrtf(d2);
            const float share = maxf(cosine, -through * cosine) / d2;
            fire = float3_mad(fire, float3(lamps->strength[0][k], lamps->strength[1][k], lamps->strength[2][k]), share);
        }
        light.from[d] = float3_mad(lit, fire, 1 / (1 + float3_luminance(fire) / FIRE_MOST));
    }
    return light;
}

/// Draws the flake while the shutter is open, from the age `begin` to `end`.
static void flake_draw(Preview *preview, const Flake *flake, float begin, float end, float strength) {
    Float3 points[SIGHT_POINTS];
    float clear[SIGHT_POINTS], first[2], last[2], depth;
    for (int i = 0; i < SIGHT_POINTS; i++) {
        points[i] = flake_at(flake, mixf(begin, end, ((float)i + 0.5f) / SIGHT_POINTS)).centre;
        points[i].z += 2e-4f; // above the ground that it lies on
    }
    if (!airborne_project(preview, points[0], first, &depth)) return;
    if (!airborne_project(preview, points[SIGHT_POINTS - 1], last, &depth)) return;
    airborne_sight(preview, points, SIGHT_POINTS, clear);

    const Plate middle = flake_at(flake, 0.5f * (begin + end));
    const FlakeLight lit = flake_light(preview, middle.centre);
    const FlakeFire around = flake_fire(preview, &middle);
    const float way = hypotf(last[0] - first[0], last[1] - first[1]);
    const float turned = flake->often * (end - begin) * flake->size / (preview->camera.pixel * depth);
    const int moments = (int)clampf(1 + way + turned, 1, MOMENT_LIMIT);
    for (int k = 0; k < moments; k++) {
        const float part = ((float)k + 0.5f) / (float)moments, age = mixf(begin, end, part);
        const float left = 1 - stepf(0.75f, 1, age / flake->life), open = clear[(int)(part * SIGHT_POINTS)];
        if (open * left > 0)
            plate_draw(preview, flake, &lit, &around, age,
                       6 * part * (1 - part) * strength * open * left / (float)moments, way / (float)moments);
    }
}

/// The flake of a key, which leaves `site`.
static Flake flake_make(const Preview *preview, const EmberSite *site, uint32_t key) {
    float r[14];
    for (uint32_t n = 0; n < 14; n++) r[n] = hash_unit(key + 1 + n);
    const float flames = site->length > 0 ? minf(site->flaming / site->length, 1) : 0;

    // char of 20 g/m2, ash of 6; most are small, and char
    const float ash = r[0] * r[0] * r[0], grammage = mixf(0.020f, 0.006f, ash), drag = 1.3f;
    const float size = 0.0015f + 0.0045f * r[1] * r[1] * r[1];
    Flake flake = {.from = float3_mad(site->position, float3(r[2] - 0.5f, r[3] - 0.5f, r[4] - 0.5f), 0.010f),
                   .drift = float3(0.24f * (r[5] - 0.5f), 0.24f * (r[6] - 0.5f), 0),
                   .up = (0.8f + 0.4f * flames) * clampf(1.3f * r[7] - 0.25f, 0, 1),
                   .fall = sqrtf(2 * 9.81f * grammage / (FLAKE_AIR_DENSITY * drag)),
                   .swing = r[8] < 0.4f ? 0 : 0.5f + 1.1f * r[8],
                   .phase = 2 * PI_F * r[9],
                   .turn = 2 * PI_F * r[10],
                   .spin = 5 * (r[11] - 0.5f),
                   .life = FLAKE_LIFE * (0.5f + 0.5f * r[12]),
                   .hot = 750 + 250 * r[13] * r[13],
                   .size = size,
                   .narrow = 0.45f + 0.5f * r[4],
                   .ash = ash,
                   .seed = key};
    flake.side = 0.7f * flake.fall;
    flake.often = clampf(2 * PI_F * 0.07f * flake.fall / flake.size, 14, 50);
    flake.landing = INFINITY;

    // when it comes to the ground
    const float ground = preview->def.ground_height - flake.from.z;
    if (isfinite(ground) && flake_rise(&flake, flake.life) < ground) {
        float low = 0, high = flake.life;
        for (int i = 0; i < LANDING_STEPS; i++) {
            const float middle = 0.5f * (low + high);
            *(flake_rise(&flake, middle) > ground ? &low : &high) = middle;
        }
        flake.landing = low;
    }
    flake.life = minf(flake.life, flake.landing + LYING);
    return flake;
}

void flakes_draw(Preview *preview) {
    EmberSite sites[SITE_LIMIT];
    if (preview->def.flakes <= 0) return;
    ember_sites(preview, FLAKE_CELL, sites);
    float total = 0;
    for (int i = 0; i < SITE_LIMIT; i++) total += sites[i].weight;
    if (total <= 0) return;

    const float open = preview->def.shutter, now = (float)fmod(preview->time, 4096.0);
    const float rate = FLAKES_A_METRE * preview->def.flakes / sqrtf(1 + total / FLAKES_CROWD);
    const int last = (int)floorf((now + 0.5f * open) / FLAKE_SLOT),
              first = (int)floorf((now - FLAKE_LIFE) / FLAKE_SLOT);

    for (int i = 0; i < SITE_LIMIT; i++)
        for (int slot = first; slot <= last && sites[i].weight > 0; slot++) {
            const uint32_t moment = hash_u32((sites[i].key + 0x68e31da4u) ^ (uint32_t)slot * 0xd8163841u);
            const float chance = rate * sites[i].weight * FLAKE_SLOT / FLAKES_A_SLOT;
            for (uint32_t k = 0; k < FLAKES_A_SLOT; k++) {
                const uint32_t key = hash_u32(moment + 131 * k);
                const float strength = clampf(5 * (1 - hash_unit(key) / chance), 0, 1);
                if (!(strength > 0)) continue;

                const Flake flake = flake_make(preview, &sites[i], key);
                const float age = now - ((float)slot + hash_unit(key ^ 0x5bd1e995u)) * FLAKE_SLOT;
                const float begin = maxf(age - 0.5f * SHOWS * open, 0),
                            end = minf(age + 0.5f * SHOWS * open, flake.life);
                if (begin < end || (open == 0 && age >= 0 && age < flake.life))
                    flake_draw(preview, &flake, begin, end, strength);
            }
        }
}
