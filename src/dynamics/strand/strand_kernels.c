// Which kernel this processor runs. A kernel that the compiler could not build is not offered.
#include "dynamics/dynamics_plan.h"

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

static const Kernels *kernels_of(SingeInstructions instructions) {
    static const Kernels kernels[] = {[SINGE_INSTRUCTIONS_X86_V2] = {strand_solve_v2, attach_hold_v2, strand_bend_v2},
                                      [SINGE_INSTRUCTIONS_X86_V3] = {strand_solve_v3, attach_hold_v3, strand_bend_v3},
                                      [SINGE_INSTRUCTIONS_X86_V4] = {strand_solve_v4, attach_hold_v4, strand_bend_v4}};
    return cpu_has(instructions) ? &kernels[instructions] : NULL;
}
#else
static const Kernels *kernels_of(SingeInstructions instructions) {
    (void)instructions;
    return NULL;
}
#endif

const Kernels *kernels_choose(SingeInstructions instructions) {
    static const Kernels plain = {strand_solve_plain, attach_hold_plain, strand_bend_plain};
    if (instructions == SINGE_INSTRUCTIONS_PLAIN) return &plain;
    if (instructions != SINGE_INSTRUCTIONS_BEST) return kernels_of(instructions);
    for (int best = SINGE_INSTRUCTIONS_X86_V4; best >= SINGE_INSTRUCTIONS_X86_V2; best--) {
        const Kernels *kernels = kernels_of((SingeInstructions)best);
        if (kernels) return kernels;
    }
    return &plain;
}
