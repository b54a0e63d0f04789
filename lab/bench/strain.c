#include "bench/strain.h"

#include <math.h>
#include <string.h>

void strain_clear(Strain *strain) {
    memset(strain, 0, sizeof *strain);
    strain->finite = true;
}

void strain_add(Strain *strain, const SingeView *view, SingeColour colour) {
    for (uint32_t s = 0; s < view->spring_count[colour]; s++) {
        const uint32_t *ends = view->springs[colour][s];
        if (!(view->spring_flags[colour][s] & SINGE_ALIVE)) continue;
        if (view->particle_flags[ends[0]] & view->particle_flags[ends[1]] & SINGE_PINNED) continue;

        double x = (double)view->position[ends[1]][0] - (double)view->position[ends[0]][0],
               y = (double)view->position[ends[1]][1] - (double)view->position[ends[0]][1],
               z = (double)view->position[ends[1]][2] - (double)view->position[ends[0]][2];
        double length = sqrt(x * x + y * y + z * z);

        double value = fabs(length / (double)view->spring_length[colour][s] - 1);
        strain->count++;
        if (!isfinite(value)) {
            strain->finite = false;
            continue;
        }
        float rounded = (float)value;
        uint32_t bits;
        memcpy(&bits, &rounded, sizeof bits);
        strain->bins[bits >> 16]++;
        strain->sum += value;
        if (value > strain->max) strain->max = value;
    }
}

void strain_merge(Strain *strain, const Strain *other) {
    for (uint32_t bin = 0; bin < STRAIN_BINS; bin++) strain->bins[bin] += other->bins[bin];
    strain->count += other->count;
    strain->sum += other->sum;
    strain->max = fmax(strain->max, other->max);
    strain->finite = strain->finite && other->finite;
}

BenchValue strain_percent(const Strain *strain) {
    if (!strain->finite || strain->count == 0) return (BenchValue){.number = {NAN, NAN, NAN}};

    // the centre of the bin up to which 99 of 100 samples lie
    uint64_t below = 0, wanted = strain->count - strain->count / 100;
    double p99 = NAN;
    for (uint32_t bin = 0; bin < STRAIN_BINS; bin++) {
        below += strain->bins[bin];
        if (below < wanted) continue;
        uint32_t bits = bin << 16 | 0x8000;
        float value;
        memcpy(&value, &bits, sizeof value);
        p99 = fmin((double)value, strain->max);
        break;
    }

    return (BenchValue){.number = {100 * strain->max, 100 * p99, 100 * strain->sum / (double)strain->count}};
}

BenchValue strain_of(const SingeStats *stats) {
    return (BenchValue){.number = {100 * stats->strain_max, 100 * stats->strain_p99, 100 * stats->strain_mean}};
}
