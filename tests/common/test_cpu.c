// The instruction sets found, compared with the compiler's own answer.
#include "support/support.h"

#include "common/cpu.h"

TEST(levels_are_as_the_compiler_says) {
    assert_true(cpu_has(SINGE_INSTRUCTIONS_PLAIN));
    assert_false(cpu_has(SINGE_INSTRUCTIONS_BEST)); // no set
#ifdef __x86_64__
    assert_false(cpu_has(SINGE_INSTRUCTIONS_ARM_NEON));
    assert_false(cpu_has(SINGE_INSTRUCTIONS_WASM_SIMD128));
    assert_int_equal(cpu_has(SINGE_INSTRUCTIONS_X86_V2), !!__builtin_cpu_supports("sse4.2"));
    assert_int_equal(cpu_has(SINGE_INSTRUCTIONS_X86_V3),
                     __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"));
    assert_int_equal(cpu_has(SINGE_INSTRUCTIONS_X86_V4),
                     __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
                         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd"));
#endif
}
