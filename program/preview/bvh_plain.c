// Packets of rays, four at a time, for every processor; and the choice of those that run.
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
