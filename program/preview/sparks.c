// Sparks: crumbs of glowing char that embers throw into the air.
//
// One leaves its site at the speed u and is dragged, within LAG, to the speed w of the air less its own fall:
//
//     p(a) = p0 + w (a - g) + u g + eddies,   g = LAG (1 - exp(-a / LAG)) at the age a,
//
// and cools, T(a) = SPARK_COLD + (T0 - SPARK_COLD) exp(-COOLING a / life), so that it turns from yellow to orange to red
// and goes out. What the film sees is its way while the shutter is open: light that is spread over a streak.

#include "preview/airborne.h"

enum { SPARKS_A_SLOT = 4 }; ///< that a site may throw in a slot
#define SPARK_CELL 0.012f   ///< m, of the sites
#define SLOT 0.05f          ///< s
#define LIFE 1.05f          ///< s, the longest
#define LAG 0.09f           ///< s
#define CURL 0.0040f        ///< m, the widest
#define TAIL_COLD 0.22f     ///< by which share what it leaves behind is colder
#define SPARK_COLD 900.0f   ///< K
#define COOLING 1.7f
#define SPARK_OPEN (1 / 120.0f) ///< s, the shortest exposure of a spark: eye and film keep it
#define BLUR_MOST 2.0f          ///< pixels
#define STREAK_MOST 0.04f       ///< of the picture's height
#define STREAK_SHORT 24.0f      ///< pixels, which no streak is too long with
#define BUSY_RATE 0.8f          ///< 1/s, at which a site throws many and then few
#define BUSY 3.2f               ///< times as many, at most
#define SPARKS_A_METRE 1300.0f  ///< 1/(m s), of sites that glow along a few cm
#define SPARKS_CROWD 0.25f      ///< m of glowing line above which sparks become rarer

/// A spark's flight.
typedef struct Spark {
    Float3 from, launch, air; ///< m, m/s: where it leaves, how fast, and where it would be carried
    float life, hot, size;    ///< s, K, m
    float wander, turn[2];    ///< m/s, and the phases of its eddies
    float curl, spin;         ///< m, 1/s: crumbs spin, and their way curls
    float shows;              ///< times the exposure, while its glowing side does
} Spark;

static Float3 spark_at(const Spark *spark, float age) {
    const float lag = LAG * (1 - expf(-age / LAG)), aside = spark->wander * age * age / (age + 0.15f);
    Float3 p = float3_mad(float3_mad(spark->from, spark->air, age - lag), spark->launch, lag);
    p.x += aside * (sinf(spark->turn[0] + 7.3f * age) - sinf(spark->turn[0]));
    p.y += aside * (sinf(spark->turn[1] + 6.1f * age) - sinf(spark->turn[1]));

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

    // the last part of a way that is too long: it would be a comet
    const float most = maxf(STREAK_MOST * (float)preview->def.height, STREAK_SHORT);
    if (streak > most) {
        strength *= most / streak;
        begin = mixf(end, begin, most / streak);
        streak = most;
    }

    const float pixel = preview->camera.pixel * depth;
    // a wide lens would draw those that pass before the focus as capsules, which no eye takes for sparks
    const float radius =
        maxf(maxf(1.1f, 1.1f * spark->size / pixel), minf(camera_blur(&preview->camera, depth), BLUR_MOST));
    const int dots = 1 + (int)minf(streak / 0.5f, 400);
    const float wide = maxf(spark->size / pixel, 0.6f); // a lens spreads any point
    for (int k = 0; k < dots; k++) {
        float part = ((float)k + 0.5f) / (float)dots, age = mixf(begin, end, part);
        float temperature = SPARK_COLD + (spark->hot - SPARK_COLD) * expf(-COOLING * age / spark->life);
        temperature *= 1 - TAIL_COLD * (1 - part) * (1 - part);
        float left = 1 - stepf(0.6f, 1, age / spark->life), open = seen[(int)(part * SIGHT_POINTS)];
        Float3 glow = blackbody_glow(preview->blackbody, temperature);
        if (!airborne_project(preview, spark_at(spark, age), at, &depth)) return;

        // a bright head, and a tail that fades and tapers behind it, as eye and film keep it; the mean of `lets` is 1
        const float lets = 5.0f * part * part * part * (1 - stepf(0.85f, 1, part)) + 0.02f;
        const float thin = mixf(0.3f, 1, part);
        const float flicker = 1 + 0.7f * sinf((60 + 90 * spark->turn[0]) * age + 7 * spark->turn[1]);
        float light = EMBER_GAIN * strength * flicker * left * open * lets * 0.25f * PI_F * wide * wide / (float)dots;
        airborne_dot(preview, at, thin * radius, float3_scale(glow, light), 0);
    }
}

void sparks_draw(Preview *preview) {
    EmberSite sites[SITE_LIMIT];
    if (preview->def.sparks <= 0) return;
    ember_sites(preview, SPARK_CELL, sites);
    float total = 0, flaming = 0;
    for (int i = 0; i < SITE_LIMIT; i++) {
        total += sites[i].length;
        flaming += sites[i].flaming;
    }
    if (total <= 0) return;
    const float updraft = mixf(0.4f, 1.25f, flaming / total);

    const float open = maxf(preview->def.shutter, SPARK_OPEN), now = (float)fmod(preview->time, 4096.0);
    const float rate = SPARKS_A_METRE * preview->def.sparks / sqrtf(1 + total / SPARKS_CROWD);
    const int last = (int)floorf((now + 0.5f * open) / SLOT), first = (int)floorf((now - LIFE) / SLOT);

    for (int i = 0; i < SITE_LIMIT; i++)
        for (int slot = first; slot <= last && sites[i].length > 0; slot++) {
            // a rim that collapses throws many at once
            const uint32_t moment = hash_u32(sites[i].key ^ (uint32_t)slot * 0x8da6b343u);
            const bool burst = hash_unit(moment) < 0.012f;
            const float busy =
                BUSY * stepf(-0.2f, 0.5f, noise2(BUSY_RATE * SLOT * (float)slot, 0, sites[i].key & 0xffff));
            const float chance = rate * sites[i].length * SLOT * (burst ? 14 : busy) / SPARKS_A_SLOT;
            for (uint32_t k = 0; k < SPARKS_A_SLOT; k++) {
                const uint32_t key = hash_u32(moment + 97 * k);
                const float strength = clampf(5 * (1 - hash_unit(key) / chance), 0, 1);
                if (!(strength > 0)) continue;

                float r[14];
                for (uint32_t n = 0; n < 14; n++) r[n] = hash_unit(key + 1 + n);
                const float turn = 2 * PI_F * r[0], up = 0.15f + 0.85f * r[1], out = sqrtf(1 - up * up);
                const float fast = r[2] * r[2] * r[2] * r[2], large = r[5] * r[5] * r[5] * r[5];
                const float speed = (burst ? 0.5f : 0.1f) + 1.6f * fast;

                // the air leans as the eddies of the moment do; large crumbs fall through it. Most are small and
                // dull, slow and soon out: sparks of one size and speed look like dashes
                const Spark spark = {.from = float3_mad(sites[i].position, float3(r[6] - 0.5f, r[7] - 0.5f, 0), 0.006f),
                                     .launch = float3_scale(float3(out * cosf(turn), out * sinf(turn), up), speed),
                                     .air = float3(0.28f * (r[8] - 0.5f), 0.28f * (r[9] - 0.5f),
                                                   updraft * (0.12f + 1.6f * r[9] * r[9]) - 0.7f * large),
                                     .life = LIFE * (0.2f + 0.8f * r[3] * r[3]),
                                     .hot = 1280 + 520 * r[4] * r[4] * r[4],
                                     .size = 0.00012f + 0.0007f * large,
                                     .wander = 0.02f + 0.10f * r[6],
                                     .turn = {2 * PI_F * r[7], 2 * PI_F * r[8]},
                                     .curl = CURL * r[10],
                                     .spin = (r[11] < 0.5f ? -1 : 1) * (40 + 110 * r[12]),
                                     .shows = 0.35f + 2.2f * r[13] * r[13]};
                float age = now - ((float)slot + hash_unit(key ^ 0x5bd1e995u)) * SLOT;
                float begin = maxf(age - 0.5f * spark.shows * open, 0),
                      end = minf(age + 0.5f * spark.shows * open, spark.life);
                const float bright = 0.25f + 3.2f * r[4] * r[4] * r[4];
                if (begin < end) spark_draw(preview, &spark, begin, end, bright * strength * (end - begin) / open);
            }
        }
}
