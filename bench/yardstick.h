// How fast this machine is now: a fixed piece of work of the same character as a step.
#ifndef BENCH_YARDSTICK_H
#define BENCH_YARDSTICK_H

typedef struct Yardstick Yardstick;

/// NULL when out of memory.
Yardstick *yardstick_create(void);
void yardstick_destroy(Yardstick *yardstick);

/// Does the work once; milliseconds that it took.
double yardstick_run(Yardstick *yardstick);

#endif
