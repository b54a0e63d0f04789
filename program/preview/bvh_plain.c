// Packets of rays, four at a time, for every processor; and the choice of those that run.
#include "common/float4.h"

enum { WIDTH = 4 };
typedef Float4 Wide;
typedef Float4Mask WideMask;

static inline Wide wide_min(Wide a, Wide b) { return float4_min(a, b); }
static inline Wide wide_max(Wide a, Wide b) { return float4_max(a, b); }
static inline unsigned wide_bits(WideMask mask) { return float4_bits(mask); }

#define BVH_WALK bvh_walk_plain
#include "preview/bvh_kernel.h"

#include "common/cpu.h"

BvhWalk *bvh_walk(SingeInstructions set) {
    bool best = set == SINGE_INSTRUCTIONS_BEST;
#ifdef SINGE_X86_LEVELS
    if ((best || set == SINGE_INSTRUCTIONS_X86_V4) && cpu_has(SINGE_INSTRUCTIONS_X86_V4)) return bvh_walk_v4;
    if ((best || set == SINGE_INSTRUCTIONS_X86_V3) && cpu_has(SINGE_INSTRUCTIONS_X86_V3)) return bvh_walk_v3;
#endif
    return best || set == SINGE_INSTRUCTIONS_PLAIN ? bvh_walk_plain : NULL;
}
