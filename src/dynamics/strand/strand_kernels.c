// Which kernel this processor runs. A kernel that the compiler could not build is not offered.
#include "common/cpu.h"
#include "dynamics/dynamics_plan.h"

/// The calls of contact, in four lanes.
#define CONTACT_FOUR collision_open, repulsion_apply, ccd_apply
#define CONTACT_V3 collision_open_v3, repulsion_apply_v3, ccd_apply_v3

static const Kernels *kernels_of(SingeInstructions instructions) {
    static const Kernels kernels[] = {
        [SINGE_INSTRUCTIONS_PLAIN] = {strand_solve_plain, attach_hold_plain, strand_bend_plain, move_range_four,
                                      unit_range_four, plane_range_four, height_range_four, smooth_group_four,
                                      CONTACT_FOUR, SINGE_INSTRUCTIONS_PLAIN},
#ifdef SINGE_X86_LEVELS
        [SINGE_INSTRUCTIONS_X86_V2] = {strand_solve_v2, attach_hold_v2, strand_bend_v2, move_range_four,
                                       unit_range_four, plane_range_four, height_range_four, smooth_group_four,
                                       CONTACT_FOUR, SINGE_INSTRUCTIONS_X86_V2},
        [SINGE_INSTRUCTIONS_X86_V3] = {strand_solve_v3, attach_hold_v3, strand_bend_v3, move_range_v3, unit_range_v3,
                                       plane_range_v3, height_range_v3, smooth_group_v3, CONTACT_V3,
                                       SINGE_INSTRUCTIONS_X86_V3},
        [SINGE_INSTRUCTIONS_X86_V4] = {strand_solve_v4, attach_hold_v4, strand_bend_v4, move_range_v4, unit_range_v4,
                                       plane_range_v4, height_range_v4, smooth_group_v4, CONTACT_V3,
                                       SINGE_INSTRUCTIONS_X86_V4},
#endif
#ifdef __aarch64__
        [SINGE_INSTRUCTIONS_ARM_NEON] = {strand_solve_neon, attach_hold_neon, strand_bend_neon, move_range_four,
                                         unit_range_four, plane_range_four, height_range_four, smooth_group_four,
                                         CONTACT_FOUR, SINGE_INSTRUCTIONS_ARM_NEON},
#endif
#ifdef __wasm_simd128__
        [SINGE_INSTRUCTIONS_WASM_SIMD128] = {strand_solve_simd128, attach_hold_simd128, strand_bend_simd128,
                                             move_range_four, unit_range_four, plane_range_four, height_range_four,
                                             smooth_group_four, CONTACT_FOUR, SINGE_INSTRUCTIONS_WASM_SIMD128},
#endif
    };
    bool built = (size_t)instructions < sizeof kernels / sizeof kernels[0] && kernels[instructions].solve;
    return built && cpu_has(instructions) ? &kernels[instructions] : NULL;
}

const Kernels *kernels_choose(SingeInstructions instructions) {
    static const SingeInstructions best_first[] = {SINGE_INSTRUCTIONS_WASM_SIMD128, SINGE_INSTRUCTIONS_ARM_NEON,
                                                   SINGE_INSTRUCTIONS_X86_V4, SINGE_INSTRUCTIONS_X86_V3,
                                                   SINGE_INSTRUCTIONS_X86_V2};
    if (instructions != SINGE_INSTRUCTIONS_BEST) return kernels_of(instructions);

    for (size_t i = 0; i < sizeof best_first / sizeof best_first[0]; i++) {
        const Kernels *kernels = kernels_of(best_first[i]);
        if (kernels) return kernels;
    }

    return kernels_of(SINGE_INSTRUCTIONS_PLAIN);
}
