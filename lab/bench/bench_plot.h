#ifndef BENCH_PLOT_H
#define BENCH_PLOT_H

/// Gets the arguments after "bench plot"; an exit code.
int bench_plot(int argc, char **argv);

#endif
