// Key-framed motion.
#pragma once

#include "common/error.h"
#include "common/memory.h"
#include "common/float3.h"
#include "singe/types.h"

typedef struct Path {
    uint32_t count;
    SingePoseKey *keys; ///< in order of time
} Path;

typedef struct Pose {
    Float3 position;
    float rotation[4];
} Pose;

/// Checks keys: finite, times increasing, rotations not zero.
SingeResult path_check(uint32_t count, const SingePoseKey *keys, const char *owner, SingeError *error);

/// Whether keys that path_check accepts have rotations of length one, as path_set leaves them.
bool path_is_normal(const Path *path);

/// Copies keys after checking them; rotations are normalised.
SingeResult path_set(Path *path, Memory *memory, uint32_t count, const SingePoseKey *keys, const char *owner,
                     SingeError *error);
void path_free(Path *path, Memory *memory);

/// The pose at a time; linear position, normalised linear rotation, held beyond the ends. An empty
/// path is at the origin.
Pose path_pose(const Path *path, double time);

/// local → world and back.
static inline Float3 pose_apply(const Pose *pose, Float3 local) {
    return float3_add(pose->position, quat_rotate(pose->rotation, local));
}
static inline Float3 pose_unapply(const Pose *pose, Float3 world) {
    return quat_unrotate(pose->rotation, float3_sub(world, pose->position));
}
