// The machine of the measurement: its name, its clocks, and its threads.
#pragma once

#include <stddef.h>

#include "singe/singe.h"

/// The processor's name from the system, or its architecture.
const char *machine_name(void);

/// Number of processors of the system.
int machine_processors(void);

/// s, wall clock.
double machine_clock(void);

/// s, processor time of this process, all threads together.
double machine_cpu_clock(void);

/// Bytes that machine_resize has allocated and not freed, and the most there were.
typedef struct MachineHeld {
    size_t now, max;
} MachineHeld;

/// A SingeAllocator's resize, which counts; `context` is a MachineHeld.
void *machine_resize(void *context, void *block, size_t old_size, size_t new_size);

// ---- independent cases

/// Calls run(context, i) for all i below `count`, on `threads` threads; and done(context, i) in the order of i, one at
/// a time, as soon as case i and all before it have run.
void workers_run(int count, int threads, void (*run)(void *context, int i), void (*done)(void *context, int i),
                 void *context);
