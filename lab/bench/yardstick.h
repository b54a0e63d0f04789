// The current speed of this machine: a fixed workload similar to a step.
#pragma once

typedef struct Yardstick Yardstick;

/// NULL when out of memory.
Yardstick *yardstick_create(void);
void yardstick_destroy(Yardstick *yardstick);

/// Does the work once; returns its time in milliseconds.
double yardstick_run(Yardstick *yardstick);
