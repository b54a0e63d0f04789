// The machine that is measured on: its name, its clocks and what of it can be found out.
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include "singe/singe.h"

/// The processor's name as the system gives it, or its architecture.
const char *machine_name(void);

/// Processors that the system has.
int machine_processors(void);

/// s, of the wall's clock.
double machine_clock(void);

/// s of processor time that this process has used, all threads together.
double machine_cpu_clock(void);

#endif
