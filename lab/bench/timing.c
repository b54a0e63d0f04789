#include "bench/timing.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "analysis/numbers.h"

/// One 2.6 GHz Zen 4 core (AMD EPYC, gcc 12 -O3), between steps.
static const double yardstick_reference_ms = 8.6;

/// Steps between two runs of the yardstick. It takes the caches from the step that follows, and the other threads go to
/// sleep meanwhile: no run has that before each of its steps.
enum { YARDSTICK_STEPS = 20 };

double timing_yardstick_reference(void) { return yardstick_reference_ms; }

int timing_steps(double springs, int min, int max) {
    double steps = 2e7 / springs;
    return steps < min ? min : steps > max ? max : (int)steps;
}

double timing_springs(const SingeSim *sim) {
    SingeCounts counts = singe_sim_counts(sim);
    double springs = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) springs += counts.springs[colour];
    return springs;
}

SingeResult timing_measure(Timing *timing, SingeSim *sim, Yardstick *yardstick, int warm_up, int steps) {
    bool good = true;
    *timing = (Timing){.steps = steps};
    for (int what = 0; what < TIMED_COUNT; what++) {
        timing->ms[what] = calloc((size_t)steps, sizeof *timing->ms[what]);
        good = good && timing->ms[what];
    }

    if (!good) return SINGE_ERROR_MEMORY;
    SingeTimers first = singe_sim_timers(sim);
    double yardstick_ms = 0;
    for (int step = -warm_up; step < steps; step++) {
        if (yardstick && (step + warm_up) % YARDSTICK_STEPS == 0) yardstick_ms = yardstick_run(yardstick);
        SingeTimers before = singe_sim_timers(sim);
        if (step == 0) first = before;
        SingeResult result = singe_sim_step(sim);
        if (result) return result;

        SingeTimers after = singe_sim_timers(sim);
        if (step >= 0) {
            double total = 0;
            for (int stage = 0; stage < SINGE_STAGE_COUNT; stage++) {
                timing->ms[stage][step] = 1e3 * (after.seconds[stage] - before.seconds[stage]);
                total += timing->ms[stage][step];
            }

            timing->ms[TIMED_STEP][step] = total;
            timing->ms[TIMED_PROJECTION][step] = 1e3 * (after.projection_seconds - before.projection_seconds);
            timing->ms[TIMED_YARDSTICK][step] = yardstick_ms;

            // scaled by the last yardstick: a temporarily slow machine slows both
            timing->ms[TIMED_SCALED][step] = total / fmax(1, yardstick_ms / yardstick_reference_ms);
        }
    }

    // what was added since the first step
    SingeTimers after = singe_sim_timers(sim);
    for (int stage = 0; stage < SINGE_STAGE_COUNT; stage++) after.seconds[stage] -= first.seconds[stage];
    after.steps -= first.steps;
    after.heat_iterations -= first.heat_iterations;
    after.strands_projected -= first.strands_projected;
    after.contacts -= first.contacts;
    after.projection_seconds -= first.projection_seconds;
    after.springs_projected -= first.springs_projected;
    after.projection_iterations -= first.projection_iterations;
    after.projection_flops -= first.projection_flops;
    after.projection_bytes -= first.projection_bytes;
    timing->total = after;
    for (int what = 0; what < TIMED_COUNT; what++) numbers_median(timing->ms[what], steps); // sorts

    return SINGE_OK;
}

double timing_median(const Timing *timing, int what) { return timing->ms[what][timing->steps / 2]; }
double timing_min(const Timing *timing, int what) { return timing->ms[what][0]; }

void timing_free(Timing *timing) {
    for (int what = 0; what < TIMED_COUNT; what++) free(timing->ms[what]);
    *timing = (Timing){0};
}

// Chains of links over a grid of particles, in both directions, 5 MB in all. One run does the work of a strand
// projection: gather two particles, a square root and two divisions, a forward and a backward recurrence, scatter. It
// is a copy, so that it does not change with the library, and takes about as long as a step of 100,000 springs, so that
// interruptions affect both alike.

enum { SIDE = 224, PARTICLES = SIDE * SIDE, LINKS = 2 * SIDE * (SIDE - 1), PASSES = 8 };

typedef struct Link {
    uint32_t ends[2];
    float length, factor;
    float direction[4]; // the fourth is the right side
} Link;

struct Yardstick {
    float position[PARTICLES][4];
    Link links[LINKS];
};

Yardstick *yardstick_create(void) {
    Yardstick *yardstick = malloc(sizeof *yardstick);
    if (!yardstick) return NULL;

    uint32_t link = 0;
    for (uint32_t direction = 0; direction < 2; direction++)
        for (uint32_t line = 0; line < SIDE; line++)
            for (uint32_t k = 0; k + 1 < SIDE; k++) {
                uint32_t a = direction ? k * SIDE + line : line * SIDE + k, b = a + (direction ? SIDE : 1);
                yardstick->links[link++] = (Link){.ends = {a, b}, .length = 1.05f};
            }

    return yardstick;
}

void yardstick_destroy(Yardstick *yardstick) { free(yardstick); }

double yardstick_run(Yardstick *yardstick) {
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);

    // the same positions before every run: the same work, and no denormal numbers
    for (uint32_t i = 0; i < PARTICLES; i++) {
        float *x = yardstick->position[i];
        x[0] = (float)(i % SIDE);
        x[1] = (float)(i / SIDE);
        x[2] = 0.1f * (float)(i * 7 % 11);
        x[3] = 1;
    }

    for (int pass = 0; pass < PASSES; pass++)
        for (int first = 0; first < LINKS; first += SIDE - 1) {
            Link *links = yardstick->links + first;
            const int count = SIDE - 1;
            float before[3] = {0, 0, 0}, inverse = 0, right = 0, lambda = 0;
            for (int k = 0; k < count; k++) {
                Link *link = &links[k];
                const float *a = yardstick->position[link->ends[0]], *b = yardstick->position[link->ends[1]];
                float d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
                float distance = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), over = 1 / fmaxf(distance, 1e-6f);
                for (int i = 0; i < 3; i++) d[i] *= over;
                float lower = -(before[0] * d[0] + before[1] * d[1] + before[2] * d[2]);
                link->factor = lower * inverse;
                inverse = 1 / (a[3] + b[3] + 0.01f - link->factor * lower);
                right = (distance - link->length - lower * right) * inverse;
                for (int i = 0; i < 3; i++) before[i] = link->direction[i] = d[i];
                link->direction[3] = right;
            }

            float factor = 0;
            for (int k = count; k-- > 0;) {
                Link *link = &links[k];
                float *a = yardstick->position[link->ends[0]], *b = yardstick->position[link->ends[1]];
                lambda = link->direction[3] - factor * lambda;
                factor = link->factor;
                for (int i = 0; i < 3; i++) {
                    float pull = 0.5f * lambda * link->direction[i];
                    a[i] += pull;
                    b[i] -= pull;
                }
            }
        }

    clock_gettime(CLOCK_MONOTONIC, &end);
    return 1e3 * (double)(end.tv_sec - start.tv_sec) + 1e-6 * (double)(end.tv_nsec - start.tv_nsec);
}
