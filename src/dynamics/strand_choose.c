// Which kernel this processor runs. A kernel that the compiler could not build is not offered.
#include "dynamics/strand.h"

#if defined(__x86_64__) && defined(__GNUC__)
static bool cpu_has(SingeInstructions instructions) {
    __builtin_cpu_init();
    switch (instructions) {
    case SINGE_INSTRUCTIONS_X86_V2: return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    case SINGE_INSTRUCTIONS_X86_V3:
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    case SINGE_INSTRUCTIONS_X86_V4:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
    default: return false;
    }
}

static StrandSolve *const kernels[] = {[SINGE_INSTRUCTIONS_X86_V2] = strand_solve_v2,
                                       [SINGE_INSTRUCTIONS_X86_V3] = strand_solve_v3,
                                       [SINGE_INSTRUCTIONS_X86_V4] = strand_solve_v4};

StrandSolve *strand_choose(SingeInstructions instructions) {
    if (instructions == SINGE_INSTRUCTIONS_PLAIN) return strand_solve_plain;
    if (instructions != SINGE_INSTRUCTIONS_BEST) return cpu_has(instructions) ? kernels[instructions] : NULL;
    for (int best = SINGE_INSTRUCTIONS_X86_V4; best >= SINGE_INSTRUCTIONS_X86_V2; best--)
        if (cpu_has((SingeInstructions)best)) return kernels[best];
    return strand_solve_plain;
}
#else
StrandSolve *strand_choose(SingeInstructions instructions) {
    return instructions <= SINGE_INSTRUCTIONS_PLAIN ? strand_solve_plain : NULL;
}
#endif
