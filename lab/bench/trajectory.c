#include "bench/trajectory.h"

#include <math.h>
#include <stdlib.h>

#include "bench/machine.h"
#include "analysis/numbers.h"

static const int marks[TRAJECTORY_MARKS] = {8, 12, 16}; // frames

Trajectory *trajectory_run(const BenchSetup *setup, int frames, int steps, double budget, SingeError *error) {
    SingeSim *sim;
    if (sheet_build(setup, &sim, error)) return NULL;

    Trajectory *trajectory = calloc(1, sizeof *trajectory);
    if (trajectory) trajectory->cpu_ms = calloc((size_t)frames, sizeof *trajectory->cpu_ms);

    if (!trajectory || !trajectory->cpu_ms) {
        *error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1};
        trajectory_free(trajectory);
        trajectory = NULL;
    } else {
        for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) strain_clear(&trajectory->strain[colour]);
        for (int m = 0; m < TRAJECTORY_MARKS; m++) trajectory->fall[m] = NAN;
        trajectory->strand_length = singe_sim_counts(sim).mean_strand_length;

        // runs the frames until one fails or time runs out
        const double until = machine_clock() + budget;
        SingeView start = singe_sim_view(sim);
        double height = geometry_height(&start);
        while (trajectory->frames < frames && !trajectory->diverged && machine_clock() < until) {
            double begun = machine_cpu_clock();
            double looked = 0; // time that is not the simulation's
            for (int step = 0; step < steps && !trajectory->diverged; step++) {
                trajectory->diverged = singe_sim_step(sim);
                double look = machine_cpu_clock();
                trajectory->inverted = fmax(trajectory->inverted, geometry_inverted(&start));
                looked += machine_cpu_clock() - look;
            }

            trajectory->cpu_ms[trajectory->frames++] = 1e3 * (machine_cpu_clock() - begun - looked);
            if (!trajectory->diverged) {
                SingeView view = singe_sim_view(sim);
                for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
                    strain_add(&trajectory->strain[colour], &view, (SingeColour)colour);
                    if (!trajectory->strain[colour].finite) trajectory->diverged = true;
                }

                double speed = geometry_speed(&view);
                if (!(speed <= trajectory->speed_max)) trajectory->speed_max = speed;
                if (!isfinite(speed)) trajectory->diverged = true;
                trajectory->fall_end = geometry_height(&view) - height;
                for (int m = 0; m < TRAJECTORY_MARKS; m++)
                    if (trajectory->frames == marks[m]) trajectory->fall[m] = trajectory->fall_end;
            }
        }

        SingeTimers timers = singe_sim_timers(sim);
        trajectory->dynamics_ms = 1e3 * timers.seconds[SINGE_STAGE_DYNAMICS] / trajectory->frames;
        trajectory->cpu_mean = numbers_mean(trajectory->cpu_ms, trajectory->frames);
        trajectory->cpu_median = numbers_median(trajectory->cpu_ms, trajectory->frames);
    }

    singe_sim_destroy(sim);
    return trajectory;
}

void trajectory_free(Trajectory *trajectory) {
    if (trajectory) free(trajectory->cpu_ms);
    free(trajectory);
}

double trajectory_off(const BenchSetup *setup, const Trajectory *trajectory) {
    static const double right[TRAJECTORY_MARKS] = {-0.373, -0.486, -0.299}; // m
    double max = 0;
    if (setup->state != BENCH_SWING || setup->pins != 2) return NAN;
    for (int m = 0; m < TRAJECTORY_MARKS; m++) {
        double off = 100 * fabs(trajectory->fall[m] - right[m]);
        if (!(off <= max)) max = off; // keeps NaN: not reached
    }
    return max;
}
