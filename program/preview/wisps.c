// Wisps: the smoke of what is hot and has no flame.
//
// The air over an ember rises in a smooth thread, h(a) = RISE a + SPEEDING a^2 above it at the age a. What left it at the
// moment s = t - a keeps a part of the swing that the air had then, so that with smooth noises N of the moment
//
//     p(a) = p0 + z h(a) + (N1(s), N2(s), N3(s)) g(a),   g growing as a^2:
//
// a thread is straight at first, then bends, and curls where what left later overtakes what left before. A wisp is a
// ribbon of THREADS of these, whose swings differ a little: where the ribbon turns its edge or folds it is denser. Each
// thread is a row of soft dots.

#include "preview/airborne.h"

enum {
    THREADS = 40,
    COVER = 9, ///< cm above an ember within which flames burn its smoke
};
#define WISP_CELL 0.025f  ///< m, of the sites
#define WISP_LIFE 1.5f    ///< s
#define RISE 0.12f        ///< m/s
#define SPEEDING 0.13f    ///< m/s2
#define RIBBON 0.0045f    ///< m, half of its width at half a second
#define KINDLING 0.28f    ///< s, in which it is seen more and more: vapour becomes droplets as it cools
#define THREAD 0.0009f    ///< m, radius there
#define WISP_DEPTH 13e-3f ///< m, optical depth across a wisp times its width
#define SMOKING 6.0f      ///< sites of which half smoke
#define WISP_AREA 2.5e-5f ///< m2 that smoulder and give half of the densest wisp
#define FORWARD 0.45f     ///< g of the phase function

typedef struct Wisp {
    Float3 from, across;
    float strength, now;
    uint32_t seed;
} Wisp;

/// Smooth noise of a moment, and of the place across the ribbon.
static inline float swing(const Wisp *wisp, float moment, float often, float place, uint32_t which) {
    float n = noise2(moment * often, 0.55f * place, wisp->seed + which);
    return n + 0.4f * noise2(2.3f * moment * often, 1.1f * place + 7, wisp->seed + which);
}

static Float3 wisp_at(const Wisp *wisp, float age, float place) {
    const float moment = wisp->now - age, early = age * age / (0.14f + age), late = early * age;
    const float neck = 0.12f + 0.5f * age / (0.15f + age) + 2.2f * age * age; // a point of the ember feeds it
    const float turn = 1.2f * age + 1.6f * noise2(moment * 1.3f, 3, wisp->seed), c = cosf(turn), s = sinf(turn);
    const float side = RIBBON * place * neck;
    Float3 p = wisp->from;
    p.x += side * (c * wisp->across.x - s * wisp->across.y) + 0.085f * early * swing(wisp, moment, 2.6f, place, 11);
    p.y += side * (s * wisp->across.x + c * wisp->across.y) + 0.085f * early * swing(wisp, moment, 2.6f, place, 12);
    p.x += 0.36f * late * swing(wisp, moment, 8, 1.7f * place, 13);
    p.y += 0.36f * late * swing(wisp, moment, 8, 1.7f * place, 14);
    p.z += (RISE + SPEEDING * age) * age + 0.36f * late * swing(wisp, moment, 7, 1.7f * place, 15);
    return p;
}

static void thread_draw(Preview *preview, const Wisp *wisp, float place) {
    Float3 points[SIGHT_POINTS], light = {0, 0, 0};
    float seen[SIGHT_POINTS], at[2], depth, edge = 1 - 0.6f * place * place;
    for (int i = 0; i < SIGHT_POINTS; i++) points[i] = wisp_at(wisp, WISP_LIFE * (float)i / SIGHT_POINTS, place);
    airborne_sight(preview, points, SIGHT_POINTS, seen);

    int lit = -1;
    for (float age = 0.004f; age < WISP_LIFE;) {
        const int i = (int)(age / WISP_LIFE * SIGHT_POINTS);
        const float open =
            mixf(seen[i], seen[i + 1 < SIGHT_POINTS ? i + 1 : i], age / WISP_LIFE * SIGHT_POINTS - (float)i);
        Float3 p = wisp_at(wisp, age, place);
        if (!airborne_project(preview, p, at, &depth)) return;
        if (i != lit) light = smoke_light(preview, p);
        lit = i;

        // steps of half of a dot; what rises faster is thinner
        const float pixel = preview->camera.pixel * depth, fast = RISE + 2 * SPEEDING * age;
        const float wide = THREAD + (0.0020f + 0.0075f * age) * age;
        const float radius = maxf(wide / pixel + camera_blur(&preview->camera, depth), 1.1f);
        const float step = minf(0.45f * radius * pixel / (1.4f * fast), 0.02f), left = 1 - age / WISP_LIFE;
        const float patchy = clampf(0.9f + 0.5f * swing(wisp, wisp->now - age, 3, 0.6f * place, 17), 0, 2);
        float dense = WISP_DEPTH * wisp->strength * edge * left * left * patchy * stepf(0, KINDLING, age) * open;
        dense *= RISE * step / (pixel * pixel * THREADS);
        airborne_dot(preview, at, radius, float3_scale(light, dense), dense);
        age += step;
    }
}

void wisps_draw(Preview *preview) {
    EmberSite sites[SITE_LIMIT];
    const Fire *fire = &preview->fire;
    if (preview->def.wisps <= 0) return;
    ember_sites(preview, WISP_CELL, sites);

    // of many only some smoke at a time
    int count = 0;
    for (int i = 0; i < SITE_LIMIT; i++) count += sites[i].smoulder > 0.2f * WISP_AREA;
    const float still = 0.80f - 0.30f * minf(SMOKING / (float)(count + 1), 1);

    for (int i = 0; i < SITE_LIMIT; i++) {
        if (sites[i].smoulder <= 0) continue;

        // a flame above burns the smoke
        float flame = 0;
        for (int up = 1; fire->size[0] && fire->visible && up <= COVER; up++) {
            Float3 p = float3_scale(float3_sub(sites[i].position, fire->origin), 1 / fire->cell);
            const float at[3] = {p.x, p.y, p.z + 0.01f * (float)up / fire->cell};
            size_t cell = 0;
            for (int c = 2; c >= 0; c--)
                cell = cell * (size_t)fire->size[c] + (size_t)clampf(at[c] + 0.5f, 0, (float)fire->size[c] - 1);
            flame = maxf(flame, fire->cells[cell].flame);
        }

        const float now = (float)fmod(preview->time, 4096.0), area = sites[i].smoulder;
        const float turn = 2 * PI_F * hash_unit(sites[i].key), live = 0.5f + 0.5f * noise2(0.7f * now, 0, sites[i].key);
        Wisp wisp = {.from = sites[i].position,
                     .across = float3(cosf(turn), sinf(turn), 0),
                     .strength = area / (area + WISP_AREA) * (1 - stepf(0.02f, 0.15f, flame)) *
                                 stepf(still, still + 0.3f, live),
                     .now = now,
                     .seed = sites[i].key & 0xffff};
        wisp.strength *= preview->def.wisps * stepf(0.2f, 0.5f, sites[i].level); // up a hanging sheet it spreads
        for (int k = 0; k < THREADS && wisp.strength > 0.01f; k++)
            thread_draw(preview, &wisp, 2 * ((float)k + 0.5f) / THREADS - 1);
    }
}
