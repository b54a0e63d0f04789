// Strain of springs, |length/target - 1|, over any number of samples: the greatest, the mean, the 99th percentile.
#ifndef BENCH_STRAIN_H
#define BENCH_STRAIN_H

#include <stdbool.h>

#include "bench/table.h"
#include "singe/singe.h"

/// A histogram over the top bits of the strain as a float, sign aside: 8 of the exponent and 7 of the mantissa, so
/// that a percentile is right to 1/128 of itself.
enum { STRAIN_BINS = 1 << 15 };

typedef struct Strain {
    uint64_t count, bins[STRAIN_BINS];
    double sum, max;
    bool finite; ///< no length was NaN or infinite
} Strain;

void strain_clear(Strain *strain);

/// Adds every spring of a colour that is left. Springs between two held particles are left out: no solver can
/// change them.
void strain_add(Strain *strain, const SingeView *view, SingeColour colour);

/// Adds the samples of another.
void strain_merge(Strain *strain, const Strain *other);

/// Max, p99 and mean in percent.
BenchValue strain_percent(const Strain *strain);

#endif
