// Sweeps for every processor.
#define SWEEP_ROWS sweep_plain
#include "gas/advect_kernel.h"

#include "common/cpu.h"

SweepFn *sweep_choose(SingeInstructions instructions) {
#ifdef SINGE_X86_LEVELS
    bool asked = instructions == SINGE_INSTRUCTIONS_BEST || instructions == SINGE_INSTRUCTIONS_X86_V3 ||
                 instructions == SINGE_INSTRUCTIONS_X86_V4;
    if (asked && cpu_has(SINGE_INSTRUCTIONS_X86_V3)) return sweep_v3;
#endif
    (void)instructions;
    return sweep_plain;
}
