// A simulation followed over frames of 1/24 s: what each frame costs, strain of every colour, motion.
#ifndef BENCH_TRAJECTORY_H
#define BENCH_TRAJECTORY_H

#include "bench/hung_sheet.h"
#include "bench/strain.h"

/// Seconds at which the height of the centre of mass is noted: frames 8, 12 and 16.
enum { TRAJECTORY_MARKS = 3 };

typedef struct Trajectory {
    int frames;     ///< done
    double *cpu_ms; ///< [frames] a frame, all threads together, ascending at the end
    double cpu_median, cpu_mean;
    double dynamics_ms;                ///< a frame's mean of the stage dynamics, by the wall's clock
    double fall_end;                   ///< m, rise of the centre of mass at the end
    double fall[TRAJECTORY_MARKS];     ///< m, rise of the centre of mass since the start; NAN where not reached
    double speed_max;                  ///< m/s, the largest met at the end of any frame
    Strain strain[SINGE_COLOUR_COUNT]; ///< over all frames
    double inverted;                   ///< cells whose centre is not in front of their corners, the most after any step
    double strand_length;              ///< mean, springs
    bool diverged;                     ///< a step failed, or a position or speed is not finite
} Trajectory;

/// Runs `frames` frames of `steps` steps, or fewer when `budget` seconds of the wall's clock are over. NULL and
/// *error when out of memory or when the simulation cannot be built.
Trajectory *trajectory_run(const BenchSetup *setup, int frames, int steps, double budget, SingeError *error);
void trajectory_free(Trajectory *trajectory);

/// cm, how far the centre of mass is at most, at the marks, from where all solvers converge to with finer time steps;
/// NAN where that is not known (it is of BENCH_SWING held at two corners) or a mark is not reached.
double trajectory_off(const BenchSetup *setup, const Trajectory *trajectory);

#endif
