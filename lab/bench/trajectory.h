// A simulation over frames of 1/24 s: the cost of each frame, strain of every colour, motion.
#pragma once

#include "bench/hung_sheet.h"
#include "bench/geometry.h"

/// Times at which the height of the centre of mass is recorded, s: frames 8, 12 and 16.
enum { TRAJECTORY_MARKS = 3 };

typedef struct Trajectory {
    int frames;     ///< done
    double *cpu_ms; ///< [frames] per frame, all threads together, sorted at the end
    double cpu_median, cpu_mean;
    double dynamics_ms;                ///< mean per frame of the stage dynamics, wall clock
    double fall_end;                   ///< m, rise of the centre of mass at the end
    double fall[TRAJECTORY_MARKS];     ///< m, rise of the centre of mass since the start; NAN where not reached
    double speed_max;                  ///< m/s, the largest met at the end of any frame
    Strain strain[SINGE_COLOUR_COUNT]; ///< over all frames
    double inverted;                   ///< cells whose centre is not in front of their corners, the max after any step
    double strand_length;              ///< mean, springs
    bool diverged;                     ///< a step failed, or a position or speed is not finite
} Trajectory;

/// Runs `frames` frames of `steps` steps, or fewer if `budget` seconds of wall clock are over. NULL and *error when out
/// of memory or if the simulation cannot be built.
Trajectory *trajectory_run(const BenchSetup *setup, int frames, int steps, double budget, SingeError *error);
void trajectory_free(Trajectory *trajectory);

/// cm, max distance of the centre of mass, at the marks, from the limit to which all solvers converge with finer time
/// steps; NAN if the limit is unknown (it is known for BENCH_SWING held at two corners) or a mark is not reached.
double trajectory_off(const BenchSetup *setup, const Trajectory *trajectory);
