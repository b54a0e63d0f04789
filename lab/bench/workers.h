// Runs independent cases on several threads.
#pragma once

/// Calls run(context, i) for all i below `count`, on `threads` threads; and done(context, i) in the order of i, one at
/// a time, as soon as case i and all before it have run.
void workers_run(int count, int threads, void (*run)(void *context, int i), void (*done)(void *context, int i),
                 void *context);
