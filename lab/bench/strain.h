// Strain of springs, |length/target - 1|, over any number of samples: max, mean, 99th percentile.
#pragma once

#include <stdbool.h>

#include "bench/table.h"
#include "singe/singe.h"

/// A histogram over the top bits of the strain as a float, without the sign: 8 of the exponent and 7 of the mantissa,
/// so that a percentile has a relative error of 1/128.
enum { STRAIN_BINS = 1 << 15 };

typedef struct Strain {
    uint64_t count, bins[STRAIN_BINS];
    double sum, max;
    bool finite; ///< no length was NaN or infinite
} Strain;

void strain_clear(Strain *strain);

/// Adds every remaining spring of a colour, except springs between two held particles: no solver can change them.
void strain_add(Strain *strain, const SingeView *view, SingeColour colour);

/// Adds the samples of another.
void strain_merge(Strain *strain, const Strain *other);

/// Max, p99 and mean in percent: of the samples, and of a simulation.
BenchValue strain_percent(const Strain *strain);
BenchValue strain_of(const SingeStats *stats);
