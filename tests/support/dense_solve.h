// A dense system of equations, for comparison with the solvers.
#pragma once

#include <stdint.h>

/// Solves a x = b of size n by Gaussian elimination; rows of zeros give 0.
static inline void dense_solve(double *a, double *b, uint32_t n) {
    for (uint32_t k = 0; k < n; k++) { // positive definite but for empty rows: no pivoting
        if (a[k * n + k] == 0) continue;
        for (uint32_t i = k + 1; i < n; i++) {
            double f = a[i * n + k] / a[k * n + k];
            for (uint32_t j = k; j < n; j++) a[i * n + j] -= f * a[k * n + j];
            b[i] -= f * b[k];
        }
    }

    for (uint32_t k = n; k-- > 0;) {
        for (uint32_t j = k + 1; j < n; j++) b[k] -= a[k * n + j] * b[j];
        b[k] = a[k * n + k] == 0 ? 0 : b[k] / a[k * n + k];
    }
}
