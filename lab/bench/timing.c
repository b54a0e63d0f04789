#include "bench/timing.h"

#include <math.h>
#include <stdlib.h>

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
