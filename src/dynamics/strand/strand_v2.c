// Strands and attachments four at a time, for x86-64-v2 (SSE 4.2).
#ifdef __SSE4_2__
#define ATTACH_HOLD attach_hold_v2
#define STRAND_SOLVE strand_solve_v2
#define STRAND_BEND strand_bend_v2
#include "dynamics/strand/strand_four.h"
#endif
