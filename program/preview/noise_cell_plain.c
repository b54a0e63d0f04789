// noise_cell for every processor; and the choice of that which runs.
#include "preview/noise_cell.h"

#include "common/cpu.h"

float noise_cell_plain(Float3 p, uint32_t seed, uint32_t *nearest) { return noise_cell(p, seed, nearest); }

NoiseCell *noise_cell_best(void) {
#ifdef SINGE_X86_LEVELS
    if (cpu_has(SINGE_INSTRUCTIONS_X86_V3)) return noise_cell_v3;
#endif
    return noise_cell_plain;
}
