// Steps timed one by one.
#pragma once

#include "singe/singe.h"

/// The timed parts of a step, in milliseconds of wall clock; the stages come first, in order.
typedef enum Timed {
    TIMED_STEP = SINGE_STAGE_COUNT, ///< all stages
    TIMED_PROJECTION,               ///< of the stage dynamics
    TIMED_YARDSTICK,
    TIMED_SCALED, ///< the step's time on the reference machine
    TIMED_COUNT
} Timed;

typedef struct Timing {
    int steps;
    double *ms[TIMED_COUNT]; ///< [steps] each, ascending when measured
    SingeTimers total;       ///< over the timed steps only
} Timing;

/// The current speed of this machine: a fixed workload similar to a step.
typedef struct Yardstick Yardstick;

/// NULL when out of memory.
Yardstick *yardstick_create(void);
void yardstick_destroy(Yardstick *yardstick);

/// Does the work once; returns its time in milliseconds.
double yardstick_run(Yardstick *yardstick);

/// The yardstick's time on the reference machine, ms.
double timing_yardstick_reference(void);

/// Runs `warm_up` steps and times `steps` more. With a yardstick, that is run before every 20th step.
SingeResult timing_measure(Timing *timing, SingeSim *sim, Yardstick *yardstick, int warm_up, int steps);

double timing_median(const Timing *timing, int what);
double timing_min(const Timing *timing, int what);
void timing_free(Timing *timing);

/// The number of steps of a sheet with so many springs that take a good share of a second.
int timing_steps(double springs, int min, int max);

/// Springs of all colours, as they were at the commit.
double timing_springs(const SingeSim *sim);
