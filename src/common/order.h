// Comparison functions for qsort. Elements are compared by the numbers that they begin with.
#pragma once

#include <stdint.h>

static inline int order_by_float(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static inline int order_by_double(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline int order_by_int(const void *a, const void *b) {
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

/// By `count` numbers, the first of which counts most.
static inline int order_by_numbers(const void *a, const void *b, int count) {
    const uint32_t *x = a, *y = b;
    for (int k = 0; k < count; k++)
        if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

static inline int order_by_two(const void *a, const void *b) { return order_by_numbers(a, b, 2); }
static inline int order_by_three(const void *a, const void *b) { return order_by_numbers(a, b, 3); }
static inline int order_by_four(const void *a, const void *b) { return order_by_numbers(a, b, 4); }

/// By a double, then by the number after it.
static inline int order_by_double_and_number(const void *a, const void *b) {
    const int first = order_by_double(a, b);
    return first ? first : order_by_numbers((const double *)a + 1, (const double *)b + 1, 1);
}
