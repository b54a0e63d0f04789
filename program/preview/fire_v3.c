// Flames at eight positions at once, for x86-64-v3 (AVX2).
#ifdef __AVX2__
#define FIRE_LOOK fire_look_v3
#include "preview/fire_kernel.h"
#endif
