// Strands and attachments four at a time, for WebAssembly (simd128).
#ifdef __wasm_simd128__
#define ATTACH_HOLD attach_hold_simd128
#define STRAND_SOLVE strand_solve_simd128
#define STRAND_BEND strand_bend_simd128
#include "dynamics/strand/strand_four.h"
#endif
