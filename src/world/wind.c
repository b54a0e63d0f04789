// Wind = mean + gust, each component of the gust a smooth noise over space and time.
#include "world/wind.h"

#include "common/random.h"

SingeResult wind_check(const SingeWindDef *def, SingeError *error) {
    const char *what = NULL;
    for (int i = 0; i < 3; i++)
        if (!(fabsf(def->velocity[i]) <= 1000)) what = "velocity must be between -1000 and 1000 m/s";
    if (!(def->gust >= 0 && def->gust <= 1000)) what = "gust must be between 0 and 1000 m/s";
    // beyond these the noise's coordinates are not finite
    if (!(def->gust_time >= 1e-6f && def->gust_time <= 1e6f)) what = "gust_time must be between 1e-6 and 1e6 s";
    if (!(def->gust_size >= 1e-6f && def->gust_size <= 1e6f)) what = "gust_size must be between 1e-6 and 1e6 m";
    return what ? error_set(error, SINGE_ERROR_ARGUMENT, "wind", -1, "%s", what) : SINGE_OK;
}

Float3 wind_velocity(const SingeWindDef *def, Float3 position, double time) {
    Float3 mean = float3_load(def->velocity);
    if (def->gust <= 0) return mean;
    // time moves along a diagonal of the lattice, so that no position repeats another's gusts
    float t = (float)(time / def->gust_time), s = 1 / def->gust_size, gust[3];
    for (uint32_t i = 0; i < 3; i++)
        gust[i] = 2 * random_noise(position.x * s + t, position.y * s + 0.7f * t, position.z * s + 0.4f * t,
                                   def->seed * 3 + i) -
                  1;
    return float3_mad(mean, float3_load(gust), def->gust);
}
