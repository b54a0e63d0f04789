// x86-64 in levels (System V ABI, section 3.1.1), by a query of the processor itself: the compiler's own query needs a
// part of its run-time library that not every toolchain has.
#include "common/cpu.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>

enum {
    // leaf 1, ecx
    CPU_SSE3 = 1 << 0,
    CPU_SSSE3 = 1 << 9,
    CPU_FMA = 1 << 12,
    CPU_SSE4_1 = 1 << 19,
    CPU_SSE4_2 = 1 << 20,
    CPU_MOVBE = 1 << 22,
    CPU_POPCNT = 1 << 23,
    CPU_OSXSAVE = 1 << 27,
    CPU_AVX = 1 << 28,
    CPU_F16C = 1 << 29,
    // leaf 7, ebx
    CPU_BMI1 = 1 << 3,
    CPU_AVX2 = 1 << 5,
    CPU_BMI2 = 1 << 8,
    CPU_AVX512F = 1 << 16,
    CPU_AVX512DQ = 1 << 17,
    CPU_AVX512CD = 1 << 28,
    CPU_AVX512BW = 1 << 30,
    // leaf 0x80000001, ecx
    CPU_LZCNT = 1 << 5,
    // registers that the operating system saves: SSE and AVX; AVX-512's masks and registers, too
    CPU_KEEPS_AVX = 0x06,
    CPU_KEEPS_AVX512 = 0xE6,
};
static const unsigned CPU_AVX512VL = 1u << 31; // leaf 7, ebx

typedef struct CpuFlags {
    unsigned basic, extended, more, kept;
} CpuFlags;

static bool cpu_all(unsigned flags, unsigned wanted) { return (flags & wanted) == wanted; }

static bool cpu_v2(const CpuFlags *f) {
    return cpu_all(f->basic, CPU_SSE3 | CPU_SSSE3 | CPU_SSE4_1 | CPU_SSE4_2 | CPU_POPCNT);
}

static bool cpu_v3(const CpuFlags *f) {
    return cpu_v2(f) && cpu_all(f->basic, CPU_FMA | CPU_MOVBE | CPU_OSXSAVE | CPU_AVX | CPU_F16C) &&
           cpu_all(f->extended, CPU_BMI1 | CPU_AVX2 | CPU_BMI2) && cpu_all(f->more, CPU_LZCNT) &&
           cpu_all(f->kept, CPU_KEEPS_AVX);
}

bool cpu_has(SingeInstructions set) {
    CpuFlags flags = {0};
    unsigned a, b, c, d;
    if (__get_cpuid(1, &a, &b, &c, &d)) flags.basic = c;
    if (__get_cpuid_count(7, 0, &a, &b, &c, &d)) flags.extended = b;
    if (__get_cpuid(0x80000001u, &a, &b, &c, &d)) flags.more = c;

    if (flags.basic & CPU_OSXSAVE) {
        __asm__ volatile("xgetbv" : "=a"(a), "=d"(d) : "c"(0));
        flags.kept = a;
    }

    switch (set) {
    case SINGE_INSTRUCTIONS_PLAIN: return true;
    case SINGE_INSTRUCTIONS_X86_V2: return cpu_v2(&flags);
    case SINGE_INSTRUCTIONS_X86_V3: return cpu_v3(&flags);
    case SINGE_INSTRUCTIONS_X86_V4:
        return cpu_v3(&flags) && cpu_all(flags.kept, CPU_KEEPS_AVX512) &&
               cpu_all(flags.extended, CPU_AVX512F | CPU_AVX512DQ | CPU_AVX512CD | CPU_AVX512BW | CPU_AVX512VL);
    default: return false;
    }
}
#else
bool cpu_has(SingeInstructions set) {
#ifdef __aarch64__ // every such processor has it
    if (set == SINGE_INSTRUCTIONS_ARM_NEON) return true;
#endif
#ifdef __wasm_simd128__ // or the module would have been refused
    if (set == SINGE_INSTRUCTIONS_WASM_SIMD128) return true;
#endif
    return set == SINGE_INSTRUCTIONS_PLAIN;
}
#endif
