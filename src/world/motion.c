#include "world/motion.h"

#include <string.h>

bool motion_create(Memory *memory, uint32_t count, const float *points, Motion *motion) {
    *motion = (Motion){.count = count};
    if (!NEW(memory, motion->from, count) || !NEW(memory, motion->to, count)) {
        motion_free(memory, motion);
        return false;
    }

    if (count) memcpy(motion->from, points, count * sizeof *motion->from);
    if (count) memcpy(motion->to, points, count * sizeof *motion->to);
    return true;
}

void motion_free(Memory *memory, Motion *motion) {
    FREE(memory, motion->from, motion->count);
    FREE(memory, motion->to, motion->count);
    *motion = (Motion){0};
}

float motion_share(const Motion *motion, double time) {
    if (time >= motion->end) return 1;
    return time <= motion->start ? 0 : (float)((time - motion->start) / (motion->end - motion->start));
}

void motion_set(Motion *motion, const float *to, double now, double time) {
    const float share = motion_share(motion, now);
    for (uint32_t i = 0; i < motion->count; i++) float3_store(motion->from[i], motion_point(motion, i, share));
    memcpy(motion->to, to, motion->count * sizeof *motion->to);
    motion->start = now;
    motion->end = time > now ? time : now;
}

SingeResult motion_check(uint32_t count, const float *points, float max, const char *owner, SingeError *error) {
    if (count && !points) return error_set(error, SINGE_ERROR_ARGUMENT, owner, -1, "the positions are NULL");
    for (size_t k = 0; k < 3 * (size_t)count; k++)
        if (!(fabsf(points[k]) <= max))
            return error_set(error, SINGE_ERROR_ARGUMENT, owner, (int64_t)(k / 3),
                             "position %zu is not finite or beyond %g m", k / 3, (double)max);
    return SINGE_OK;
}
