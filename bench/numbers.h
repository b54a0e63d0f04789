// Means and medians of a few measured numbers.
#ifndef BENCH_NUMBERS_H
#define BENCH_NUMBERS_H

double numbers_mean(const double *numbers, int count);

/// Sorts the numbers; the middle one, or the mean of the middle two.
double numbers_median(double *numbers, int count);

#endif
