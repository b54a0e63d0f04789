// Particles held on a path.
#pragma once

#include "shell/shell.h"
#include "world/motion.h"
#include "world/path.h"

typedef struct Pin {
    uint32_t generation; ///< 0: the slot is free
    uint32_t count;
    uint32_t *particles; ///< held particles, increasing
    float (*anchors)[3]; ///< m, in the frame of the path's pose
    Path path;
    Motion motion; ///< of the particles, in space, instead of the path; its arrays are NULL if the path applies
    float end;     ///< s, when it lets go; it then holds nothing, and its handle stays valid
    void *user_data;
    SingePinDef waiting; ///< Def of a pin that was added before the commit, until then; owns its points and vertices
} Pin;

/// Position of held particle k at a time; `pose` is the path's pose at that time.
static inline Float3 pin_point(const Pin *pin, const Pose *pose, uint32_t k, float share) {
    return pin->motion.to ? motion_point(&pin->motion, k, share) : pose_apply(pose, float3_load(pin->anchors[k]));
}

typedef struct PinList {
    uint32_t count, capacity;
    Pin *items;
} PinList;
