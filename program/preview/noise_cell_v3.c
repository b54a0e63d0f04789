// noise_cell for x86-64-v3 (AVX2), whose products of eight integers are one instruction.
#ifdef __AVX2__
#include "preview/noise_cell.h"

float noise_cell_v3(Float3 p, uint32_t seed, uint32_t *nearest) { return noise_cell(p, seed, nearest); }
#endif
