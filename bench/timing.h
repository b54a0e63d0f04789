// Steps timed one by one.
#ifndef BENCH_TIMING_H
#define BENCH_TIMING_H

#include <stdbool.h>

#include "bench/yardstick.h"
#include "singe/singe.h"

/// What is timed of a step, in milliseconds by the wall's clock; the stages come first, in their own order.
typedef enum Timed {
    TIMED_STEP = SINGE_STAGE_COUNT, ///< all stages
    TIMED_PROJECTION,               ///< of the stage dynamics
    TIMED_YARDSTICK,
    TIMED_SCALED, ///< the step as the reference machine would take it
    TIMED_COUNT
} Timed;

typedef struct Timing {
    int steps;
    double *ms[TIMED_COUNT]; ///< [steps] each, ascending when measured
    SingeTimers total;       ///< over the timed steps alone
} Timing;

/// What the yardstick takes on the reference machine, ms.
double timing_yardstick_reference(void);

/// Runs `warm_up` steps and times `steps` more. With a yardstick, that is run before every step.
SingeResult timing_measure(Timing *timing, SingeSim *sim, Yardstick *yardstick, int warm_up, int steps);

double timing_median(const Timing *timing, int what);
double timing_min(const Timing *timing, int what);
void timing_free(Timing *timing);

/// How many steps of a sheet of so many springs make up a good share of a second.
int timing_steps(double springs, int min, int max);

/// Springs of all colours, as they were at the commit.
double timing_springs(const SingeSim *sim);

#endif
