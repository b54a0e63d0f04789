// Sweeps eight cells at a time, for x86-64-v3 (AVX2).
#ifdef __AVX2__
#define SWEEP_ROWS sweep_v3
#include "gas/advect_kernel.h"
#endif
