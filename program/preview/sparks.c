// Sparks: crumbs of glowing char that embers throw into the air.
//
// One leaves its site at the speed u and is dragged, within LAG, to the speed w of the air less its own fall:
//
//     p(a) = p0 + w (a - g) + u g + eddies,   g = LAG (1 - exp(-a / LAG)) at the age a,
//
// is drawn with the air towards the middle of the fire around it, is swirled by the eddies that rise in the plume, and
// cools, T(a) = SPARK_COLD + (T0 - SPARK_COLD) exp(-COOLING a / life), so that it turns from yellow to orange to red
// and goes out. What the film sees is its way while the shutter is open: light that is spread over a streak.
//
// Crumbs break as stones do: sizes and light are log-normal, so few sparks are bright and many are hardly seen, and most
// are out before they are far from the rim that has thrown them.

#include "preview/airborne.h"

enum {
    SPARKS_A_SLOT = 6, ///< at most, from a site in a slot
    VEILED = 4,        ///< points of a way where it is known how much of it passes flames
};
#define SPARK_CELL 0.012f ///< m, of the sites
#define SLOT 0.05f        ///< s
#define LIFE 1.05f        ///< s, the longest
#define LAG 0.09f         ///< s
#define CURL 0.0016f      ///< m, the widest
#define SWIRL 0.034f      ///< m between eddies of the plume
#define SWIRL_RISE 0.28f  ///< m/s, slower than sparks, which pass them
#define SWIRL_WIDE 0.009f ///< m that they carry a spark sideways, at most
#define TAIL_COLD 0.22f   ///< by which share what it leaves behind is colder
#define SPARK_COLD 900.0f ///< K
#define COOLING 3.8f
#define PULL 0.75f              ///< of the way to the middle of the fire that the air takes them
#define PULL_TIME 0.4f          ///< s
#define FIRE_AROUND 0.05f       ///< m, from a site, of which the fire is around it
#define SPARK_OPEN (1 / 120.0f) ///< s, the shortest exposure of a spark: eye and film keep it
#define BLUR_MOST 2.0f          ///< pixels
#define WIDE_MOST 0.8f          ///< pixels
#define STREAK_MOST 0.03f       ///< of the picture's height
#define STREAK_SHORT 23.0f      ///< pixels, below which no streak is cut
#define BUSY_RATE 2.1f          ///< 1/s, how often crackling embers change between many sparks and none
#define BUSY_WIDE 0.03f         ///< m between embers that crackle and others that do not
#define BUSY 13.0f              ///< factor on the sparks of embers that crackle, at most
#define BUSY_LEAST 0.15f        ///< the same of the others
#define SPARKS_A_METRE 6000.0f  ///< 1/(m s), from sites that glow over a few cm
#define SPARKS_CROWD 0.25f      ///< m of glowing line above which sparks become rarer

/// A spark's flight.
typedef struct Spark {
    Float3 from, launch, air; ///< m, m/s: where it leaves, how fast, and where it would be carried
    float life, hot, size;    ///< s, K, m
    float wander, turn[2];    ///< m/s, and the phases of its eddies
    float pull[2];            ///< m, along x and y, to the middle of the fire
    float eddy[2], winds;     ///< rad, their phases as it leaves; m, how far they carry it
    float curl, spin;         ///< m, 1/s: crumbs spin, and their way curls
    float shows;              ///< times the exposure, while its glowing side does
    float comet;              ///< 0: both of its ends fade alike; 1: it has a bright head
} Spark;

static Float3 spark_at(const Spark *spark, float age) {
    const float lag = LAG * (1 - expf(-age / LAG)), aside = spark->wander * age * age / (age + 0.15f);
    const float pull = age * age / (age * age + PULL_TIME * PULL_TIME);
    Float3 p = float3_mad(float3_mad(spark->from, spark->air, age - lag), spark->launch, lag);
    p.x += pull * spark->pull[0];
    p.y += pull * spark->pull[1];
    p.x += aside * (sinf(spark->turn[0] + 7.3f * age) - sinf(spark->turn[0]));
    p.y += aside * (sinf(spark->turn[1] + 6.1f * age) - sinf(spark->turn[1]));

    // sparks rise through slower eddies: their paths are arcs, and similar to those of their neighbours
    const float rise = maxf(p.z - spark->from.z, 0), winds = spark->winds * rise / (rise + 0.5f * SWIRL);
    const float passed = 2 * PI_F * (rise - SWIRL_RISE * age) / SWIRL;
    p.x += winds * sinf(spark->eddy[0] + passed);
    p.y += winds * sinf(spark->eddy[1] + 0.8f * passed);

    const float curl = spark->curl * minf(age / LAG, 1);
    p.x += curl * sinf(spark->spin * age + spark->turn[1]);
    p.z += curl * cosf(spark->spin * age + spark->turn[0]);
    return p;
}

/// Draws the spark's way from the age `begin` to `end`.
static void spark_draw(Preview *preview, const Spark *spark, float begin, float end, float strength) {
    Float3 points[SIGHT_POINTS];
    float seen[SIGHT_POINTS], at[2], last[2] = {0, 0}, depth, streak = 0;
    for (int i = 0; i < SIGHT_POINTS; i++) {
        points[i] = spark_at(spark, mixf(begin, end, ((float)i + 0.5f) / SIGHT_POINTS));
        if (!airborne_project(preview, points[i], at, &depth)) return;
        if (i) streak += hypotf(at[0] - last[0], at[1] - last[1]);
        memcpy(last, at, sizeof last);
    }
    airborne_sight(preview, points, SIGHT_POINTS, seen);

    // most ways are short: few of their points are asked for what of it passes flames
    Float3 few[VEILED], flames[SIGHT_POINTS];
    float clear[SIGHT_POINTS];
    for (int k = 0; k < VEILED; k++) few[k] = points[(2 * k + 1) * SIGHT_POINTS / (2 * VEILED)];
    airborne_flames(preview, few, VEILED, flames, clear);
    for (int i = 0; i < SIGHT_POINTS; i++) seen[i] *= clear[i * VEILED / SIGHT_POINTS];

    // the last part of a way that is too long: it would be a comet
    const float most = maxf(STREAK_MOST * (float)preview->def.height, STREAK_SHORT);
    if (streak > most) {
        strength *= most / streak;
        begin = mixf(end, begin, most / streak);
        streak = most;
    }

    const float pixel = preview->camera.pixel * depth;
    // a wide lens would draw those that pass before the focus as capsules, which no eye takes for sparks
    const float blur = camera_blur(&preview->camera, depth), radius = maxf(1.1f, minf(blur, BLUR_MOST));
    strength *= BLUR_MOST / maxf(blur, BLUR_MOST); // or the light of a wide disc would be in a thin streak, with a halo
    const int dots = 1 + (int)minf(streak / 0.5f, 400);
    // a lens spreads any point, and a near spark must not look like a lamp: its brightness has a limit
    const float wide = clampf(spark->size / pixel, 0.6f, WIDE_MOST);
    for (int k = 0; k < dots; k++) {
        float part = ((float)k + 0.5f) / (float)dots, age = mixf(begin, end, part);
        float temperature = SPARK_COLD + (spark->hot - SPARK_COLD) * expf(-COOLING * age / spark->life);
        temperature *= 1 - TAIL_COLD * (1 - part) * (1 - part);
        float left = 1 - stepf(0.6f, 1, age / spark->life), open = seen[(int)(part * SIGHT_POINTS)];
        Float3 glow = blackbody_glow(preview->blackbody, temperature);
        if (!airborne_project(preview, spark_at(spark, age), at, &depth)) return;

        // a bright head, and a tail that fades and tapers behind it, as eye and film keep it, or an end as the other; the mean
        // of `lets` is 1
        const float head = 5.0f * part * part * part * (1 - stepf(0.85f, 1, part)) + 0.02f;
        const float lets = mixf(6 * part * (1 - part), head, spark->comet);
        const float thin = mixf(0.3f, 1, mixf(4 * part * (1 - part), part, spark->comet));
        const float flicker = 1 + 0.7f * sinf((60 + 90 * spark->turn[0]) * age + 7 * spark->turn[1]);
        float light = EMBER_GAIN * strength * flicker * left * open * lets * 0.25f * PI_F * wide * wide / (float)dots;
        airborne_dot(preview, at, thin * radius, float3_scale(glow, light), 0);
    }
}

/// From the hash of a key, about a normal distribution: mean 0, deviation 1.
static float hash_normal(uint32_t key) { return 2 * (hash_unit(key) + hash_unit(key + 1) + hash_unit(key + 2) - 1.5f); }

/// The fire around a site.
typedef struct Around {
    Float3 middle;
    float flaming; ///< share of it under flames
} Around;

static Around fire_around(const EmberSite sites[SITE_LIMIT], const EmberSite *site) {
    Float3 middle = {0, 0, 0};
    float length = 0, flaming = 0;
    for (int i = 0; i < SITE_LIMIT; i++) {
        if (!(sites[i].length > 0)) continue;
        const Float3 to = float3_sub(sites[i].position, site->position);
        const float far = 1 + float3_dot(to, to) / (FIRE_AROUND * FIRE_AROUND), weight = 1 / (far * far);
        middle = float3_mad(middle, sites[i].position, weight * sites[i].length);
        length += weight * sites[i].length, flaming += weight * sites[i].flaming;
    }
    return (Around){float3_scale(middle, 1 / length), flaming / length};
}

/// The spark of a key. `burst`: one of many.
static Spark spark_make(const EmberSite *site, const Around *around, uint32_t key, bool burst) {
    float r[12];
    for (uint32_t n = 0; n < 12; n++) r[n] = hash_unit(key + 1 + n);
    const float turn = 2 * PI_F * r[0], up = 0.15f + 0.85f * r[1], out = sqrtf(1 - up * up);
    const float speed = (burst ? 0.4f : 0.1f) + 1.3f * r[2] * r[2] * r[2] * r[2];
    const float leans = mixf(0.24f, 0.12f, around->flaming); // a plume goes straight up
    const float size = hash_normal(key + 20), updraft = mixf(0.26f, 1.1f, around->flaming);
    Spark spark = {.from = float3_mad(site->position, float3(r[6] - 0.5f, r[7] - 0.5f, 0), 0.006f),
                   .launch = float3_scale(float3(out * cosf(turn), out * sinf(turn), up), speed),
                   .life = LIFE * mixf(0.65f, 1, around->flaming) * (0.15f + 0.85f * r[3] * r[3] * r[3]),
                   .hot = 1220 + 620 * r[4] * r[4],
                   .size = 0.00012f * expf(0.55f * size),
                   .wander = 0.02f + 0.5f * leans * r[6],
                   .turn = {2 * PI_F * r[7], 2 * PI_F * r[8]},
                   .curl = CURL * r[10] * r[10],
                   .spin = (r[11] < 0.5f ? -1 : 1) * (40 + 110 * r[5]),
                   .shows = 0.12f + 1.1f * r[9] * r[9],
                   .comet = r[5],
                   .eddy = {site->position.x / BUSY_WIDE + 1.3f * r[6], site->position.y / BUSY_WIDE + 1.3f * r[7]},
                   .winds = SWIRL_WIDE * r[2] * r[9]};

    // the air leans as the eddies of the moment do; large crumbs fall through it
    spark.air = float3(leans * (r[8] - 0.5f), leans * (r[9] - 0.5f),
                       updraft * (0.2f + 1.1f * r[10] * r[10]) - 0.22f * expf(0.9f * (size - 1)));
    const Float3 to = float3_sub(around->middle, site->position);
    spark.pull[0] = PULL * to.x, spark.pull[1] = PULL * to.y;
    return spark;
}

void sparks_draw(Preview *preview) {
    EmberSite sites[SITE_LIMIT];
    if (preview->def.sparks <= 0) return;
    ember_sites(preview, SPARK_CELL, sites);
    float total = 0;
    for (int i = 0; i < SITE_LIMIT; i++) total += sites[i].length;
    if (total <= 0) return;

    const float open = maxf(preview->def.shutter, SPARK_OPEN), now = (float)fmod(preview->time, 4096.0);
    const float rate = SPARKS_A_METRE * preview->def.sparks / sqrtf(1 + total / SPARKS_CROWD);
    const int last = (int)floorf((now + 0.5f * open) / SLOT), first = (int)floorf((now - LIFE) / SLOT);

    for (int i = 0; i < SITE_LIMIT; i++) {
        if (!(sites[i].length > 0)) continue;
        const Around around = fire_around(sites, &sites[i]);
        for (int slot = first; slot <= last; slot++) {
            // a rim that collapses throws many at once
            const uint32_t moment = hash_u32(sites[i].key ^ (uint32_t)slot * 0x8da6b343u);
            const bool burst = hash_unit(moment) < 0.012f;
            const float crackle = noise3(float3(sites[i].position.x / BUSY_WIDE, sites[i].position.y / BUSY_WIDE,
                                                BUSY_RATE * SLOT * (float)slot),
                                         71);
            const float busy = BUSY_LEAST + BUSY * stepf(0.2f, 0.75f, crackle);
            const float chance =
                rate * (1 + 1.2f * around.flaming) * sites[i].length * SLOT * (burst ? 20 : busy) / SPARKS_A_SLOT;
            for (uint32_t k = 0; k < SPARKS_A_SLOT; k++) {
                const uint32_t key = hash_u32(moment + 97 * k);
                const float strength = clampf(5 * (1 - hash_unit(key) / chance), 0, 1);
                if (!(strength > 0)) continue;
                const Spark spark = spark_make(&sites[i], &around, key, burst);
                const float age = now - ((float)slot + hash_unit(key ^ 0x5bd1e995u)) * SLOT;
                const float begin = maxf(age - 0.5f * spark.shows * open, 0),
                            end = minf(age + 0.5f * spark.shows * open, spark.life);
                const float bright = 0.6f * expf(1.5f * minf(hash_normal(key + 30), 1.9f));
                if (begin < end) spark_draw(preview, &spark, begin, end, bright * strength * (end - begin) / open);
            }
        }
    }
}
