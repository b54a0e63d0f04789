// Flames at sixteen positions at once, for x86-64-v4 (AVX-512).
#ifdef __AVX512DQ__
#define FIRE_LOOK fire_look_v4
#include "preview/fire_kernel.h"
#endif
