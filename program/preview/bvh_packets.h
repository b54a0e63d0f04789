// Packets of rays, compiled for each instruction set.
#ifndef PREVIEW_BVH_PACKETS_H
#define PREVIEW_BVH_PACKETS_H

#include "preview/bvh.h"
#include "singe/types.h"

typedef struct BvhPackets {
    void (*nearest)(const Bvh *bvh, Rays *rays, Hits *hits);
    void (*pass)(const Bvh *bvh, Rays *rays, BvhStops *stops, void *context);
} BvhPackets;

extern const BvhPackets bvh_packets_plain, bvh_packets_v3, bvh_packets_v4;

/// Those of an instruction set; NULL if they, or the set, are not there. SINGE_INSTRUCTIONS_BEST: of the machine's best.
const BvhPackets *bvh_packets(SingeInstructions set);

#endif
