// noise_cell for each instruction set: crumpled paper looks up three for each sample.
#pragma once

#include "preview/noise.h"

typedef float NoiseCell(Float3 p, uint32_t seed, uint32_t *nearest);

NoiseCell noise_cell_plain, noise_cell_v3;

/// That for the machine's best instructions; all give the same bytes.
NoiseCell *noise_cell_best(void);
