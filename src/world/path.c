#include "world/path.h"

/// Positions (m) up to this size leave room for their differences and squares in float.
static const float path_position_max = 1e9f;

/// In double, where the square of a float neither overflows nor underflows.
static double path_rotation_length(const float q[4]) {
    double square = 0;
    for (int k = 0; k < 4; k++) square += (double)q[k] * (double)q[k];
    return sqrt(square);
}

SingeResult path_check(uint32_t count, const SingePoseKey *keys, const char *owner, SingeError *error) {
    if (count > 0 && !keys)
        return error_set(error, SINGE_ERROR_ARGUMENT, owner, -1, "the path has %u keys but no array", count);

    for (uint32_t i = 0; i < count; i++) {
        bool finite = isfinite(keys[i].time);
        for (int k = 0; k < 3; k++) finite = finite && fabsf(keys[i].position[k]) <= path_position_max;
        for (int k = 0; k < 4; k++) finite = finite && isfinite(keys[i].rotation[k]);

        if (!finite)
            return error_set(error, SINGE_ERROR_ARGUMENT, owner, i, "path key %u is not finite or beyond 1e9 m", i);
        if (i > 0 && !(keys[i].time > keys[i - 1].time))
            return error_set(error, SINGE_ERROR_ARGUMENT, owner, i, "path key %u is not later than the one before", i);
        if (!(path_rotation_length(keys[i].rotation) > 1e-6))
            return error_set(error, SINGE_ERROR_ARGUMENT, owner, i,
                             "path key %u has a rotation of length zero; {0,0,0,1} is none", i);
    }

    return SINGE_OK;
}

bool path_is_normal(const Path *path) {
    for (uint32_t i = 0; i < path->count; i++)
        if (!(fabs(path_rotation_length(path->keys[i].rotation) - 1) < 1e-5)) return false;
    return true;
}

SingeResult path_set(Path *path, Memory *memory, uint32_t count, const SingePoseKey *keys, const char *owner,
                     SingeError *error) {
    TRY(path_check(count, keys, owner, error));
    SingePoseKey *copy;
    if (!NEW(memory, copy, count)) return error_set(error, SINGE_ERROR_MEMORY, owner, -1, "out of memory for a path");

    for (uint32_t i = 0; i < count; i++) {
        copy[i] = keys[i];
        double length = path_rotation_length(keys[i].rotation);
        for (int k = 0; k < 4; k++) copy[i].rotation[k] = (float)((double)keys[i].rotation[k] / length);
    }

    path_free(path, memory);
    *path = (Path){count, copy};
    return SINGE_OK;
}

void path_free(Path *path, Memory *memory) {
    FREE(memory, path->keys, path->count);
    path->count = 0;
}

Pose path_pose(const Path *path, double time) {
    if (path->count == 0) return (Pose){{0, 0, 0}, {0, 0, 0, 1}};

    uint32_t next = 0;
    while (next < path->count && path->keys[next].time <= time) next++;

    const SingePoseKey *b = &path->keys[next < path->count ? next : path->count - 1];
    const SingePoseKey *a = next > 0 ? &path->keys[next - 1] : b;
    float t = a == b ? 0 : (float)((time - a->time) / ((double)b->time - a->time));
    Pose pose = {
        float3_mad(float3_load(a->position), float3_sub(float3_load(b->position), float3_load(a->position)), t),
        {0, 0, 0, 1}};

    // the shorter rotation, then normalised
    float dot = 0, length = 0;
    for (int k = 0; k < 4; k++) dot += a->rotation[k] * b->rotation[k];
    for (int k = 0; k < 4; k++) {
        pose.rotation[k] = a->rotation[k] + ((dot < 0 ? -b->rotation[k] : b->rotation[k]) - a->rotation[k]) * t;
        length += pose.rotation[k] * pose.rotation[k];
    }

    length = sqrtf(length);
    for (int k = 0; k < 4; k++) pose.rotation[k] /= length;
    return pose;
}
