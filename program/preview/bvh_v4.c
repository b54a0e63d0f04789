// Packets of rays, sixteen at a time, for x86-64-v4 (AVX-512).
#ifdef __AVX512DQ__
#define BVH_WALK bvh_walk_v4
#include "preview/bvh_kernel.h"
#endif
