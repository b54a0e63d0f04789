// Sweeps for every processor.
#define SWEEP_ROWS sweep_plain
#include "gas/sweep_kernel.h"

#if defined(__x86_64__) && defined(__GNUC__)
SweepFn *sweep_choose(SingeInstructions instructions) {
    bool asked = instructions == SINGE_INSTRUCTIONS_BEST || instructions >= SINGE_INSTRUCTIONS_X86_V3;
    __builtin_cpu_init();
    return asked && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")
               ? sweep_v3
               : sweep_plain;
}
#else
SweepFn *sweep_choose(SingeInstructions instructions) {
    (void)instructions;
    return sweep_plain;
}
#endif
