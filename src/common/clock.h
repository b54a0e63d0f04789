// Time for the timers. No result depends on it.
#pragma once

/// s since some moment; never goes back.
double clock_seconds(void);
