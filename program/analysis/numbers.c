#include "analysis/numbers.h"
#include "common/order.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

double numbers_mean(const double *numbers, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += numbers[i];
    return count ? sum / count : NAN;
}

double numbers_median(double *numbers, int count) {
    if (count == 0) return NAN;
    qsort(numbers, (size_t)count, sizeof *numbers, order_by_double);
    return 0.5 * (numbers[(count - 1) / 2] + numbers[count / 2]);
}

// One-sided Jacobi (Hestenes 1958): the vectors of the shorter side are rotated in pairs until all are orthogonal; then
// their lengths are the singular values. A pair a, b with p = a.a, q = b.b, r = a.b is rotated by the angle with
//
//   tan = sign(z)/(|z| + sqrt(1 + z^2)),   z = (q - p)/(2 r)
//
// which makes a.b zero.

enum { SWEEPS = 60 };

static double singular_dot(const double *a, const double *b, size_t n) {
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static int descending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

int singular_values(const double *matrix, size_t rows, size_t columns, double *values) {
    bool turned = true, upright = rows > columns;
    size_t count = upright ? columns : rows, length = upright ? rows : columns;
    double *vectors = malloc((count * length + 1) * sizeof *vectors), norm = 0;

    if (!vectors) return -1;

    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < length; k++)
            vectors[i * length + k] = upright ? matrix[k * columns + i] : matrix[i * columns + k];

    for (size_t i = 0; i < count * length; i++) norm += vectors[i] * vectors[i];
    double floor = 1e-30 * norm; // below it vectors are rounding errors, and rotating them would not end
    for (int sweep = 0; sweep < SWEEPS && turned; sweep++) {
        turned = false;
        for (size_t i = 0; i + 1 < count; i++)
            for (size_t j = i + 1; j < count; j++) {
                double *a = vectors + i * length, *b = vectors + j * length;
                double p = singular_dot(a, a, length), q = singular_dot(b, b, length), r = singular_dot(a, b, length);
                if (fabs(r) <= 1e-15 * sqrt(p * q) || (p <= floor && q <= floor)) continue;
                double z = (q - p) / (2 * r), t = copysign(1, z) / (fabs(z) + sqrt(1 + z * z));
                double c = 1 / sqrt(1 + t * t), s = c * t;
                for (size_t k = 0; k < length; k++) {
                    double x = a[k], y = b[k];
                    a[k] = c * x - s * y;
                    b[k] = s * x + c * y;
                }

                turned = true;
            }
    }

    for (size_t i = 0; i < count; i++)
        values[i] = sqrt(singular_dot(vectors + i * length, vectors + i * length, length));
    qsort(values, count, sizeof *values, descending);
    free(vectors);
    return 0;
}
