// Time for the timers. No result depends on it.
#ifndef COMMON_CLOCK_H
#define COMMON_CLOCK_H

/// s since some moment; never goes back.
double clock_seconds(void);

#endif
