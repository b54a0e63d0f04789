// Means and medians of a few measured numbers.
#pragma once

double numbers_mean(const double *numbers, int count);

/// Sorts the numbers and returns their median.
double numbers_median(double *numbers, int count);
