// Strands and attachments four at a time, for 64-bit Arm (NEON).
#ifdef __aarch64__
#define ATTACH_HOLD attach_hold_neon
#define STRAND_SOLVE strand_solve_neon
#define STRAND_BEND strand_bend_neon
#include "dynamics/strand/strand_four.h"
#endif
