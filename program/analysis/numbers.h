// Means and medians of a few measured numbers, and singular values of a dense matrix.
#pragma once

#include <stddef.h>

double numbers_mean(const double *numbers, int count);

/// Sorts the numbers and returns their median.
double numbers_median(double *numbers, int count);

/// All min(rows, columns) singular values of [rows][columns], the largest first, into `values`. 0, or -1 when out of
/// memory.
int singular_values(const double *matrix, size_t rows, size_t columns, double *values);
