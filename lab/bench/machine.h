// The machine of the measurement: its name and its clocks.
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include "singe/singe.h"

/// The processor's name from the system, or its architecture.
const char *machine_name(void);

/// Number of processors of the system.
int machine_processors(void);

/// s, wall clock.
double machine_clock(void);

/// s, processor time of this process, all threads together.
double machine_cpu_clock(void);

#endif
