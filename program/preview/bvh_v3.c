// Packets of rays, eight at a time, for x86-64-v3 (AVX2).
#ifdef __AVX2__
#define BVH_WALK bvh_walk_v3
#include "preview/bvh_kernel.h"
#endif
