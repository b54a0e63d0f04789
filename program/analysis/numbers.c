#include "analysis/numbers.h"

#include <math.h>
#include <stdlib.h>

double numbers_mean(const double *numbers, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += numbers[i];
    return count ? sum / count : NAN;
}

static int numbers_ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double numbers_median(double *numbers, int count) {
    if (count == 0) return NAN;
    qsort(numbers, (size_t)count, sizeof *numbers, numbers_ascending);
    return 0.5 * (numbers[(count - 1) / 2] + numbers[count / 2]);
}
