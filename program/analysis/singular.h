// Singular values of a dense matrix, to full relative accuracy for small ones.
#pragma once

#include <stddef.h>

/// All min(rows, columns) singular values of [rows][columns], the largest first, into `values`. 0, or -1 when out of
/// memory.
int singular_values(const double *matrix, size_t rows, size_t columns, double *values);
