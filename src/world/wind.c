// Wind = mean + gust, each component of the gust a smooth noise over space and time.
#include "world/wind.h"

#include "common/random.h"

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
