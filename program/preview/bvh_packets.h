// Packets of rays, compiled for each instruction set.
#pragma once

#include "preview/bvh.h"
#include "singe/types.h"

BvhWalk bvh_walk_plain, bvh_walk_v3, bvh_walk_v4;

/// That of an instruction set; NULL if it, or the set, is not there. SINGE_INSTRUCTIONS_BEST: of the machine's best.
BvhWalk *bvh_walk(SingeInstructions set);
