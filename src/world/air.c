// Velocities of air that sources move. R is `radius`, U `speed` times the strength.
//
//   jet          a round turbulent jet from a nozzle of radius R along the axis x, with y the distance from it
//                (Pope, Turbulent Flows, 2000, section 5.1: decay 5.8, half-width .096 x):
//                  u = U min(1, 11.6 R/x) exp(-ln 2 y^2/b^2),   b = max(R, .096 x),   nothing behind the nozzle
//   vortex       about the axis (Scully 1975): u = U 2 (y/R)/(1 + (y/R)^2), fastest at R
//   attract      the same towards a point, from distance y
//   turbulence   a noise as of the wind's gusts, in swirls of R that last R/U0, U0 the speed without its strength
#include "world/air.h"

#include "common/random.h"
#include "common/real.h"

static const float JET_DECAY = 11.6f, JET_WIDTH = 0.096f;
static const float AIR_RADIUS_MIN = 1e-4f; ///< m

float source_strength(const Source *source, double time) {
    uint32_t count = source->strength_count, k = 0;
    const SingeValueKey *keys = source->strength;
    while (k < count && time >= keys[k].time) k++;

    float strength = count == 0 ? 1 : keys[k < count ? k : count - 1].value;
    if (k > 0 && k < count) {
        double part = (time - keys[k - 1].time) / ((double)keys[k].time - keys[k - 1].time);
        strength = (float)(keys[k - 1].value + part * ((double)keys[k].value - keys[k - 1].value));
    }

    return strength;
}

const SourceList *air_of(const SourceList *sources, double time) {
    for (uint32_t k = 0; sources && k < sources->count; k++)
        if (source_is_lit(&sources->items[k], time) && source_blows(&sources->items[k].def)) return sources;
    return NULL;
}

/// Fastest at a distance of 1.
static float air_profile(float y) { return 2 * y / (1 + y * y); }

Float3 source_air(const Source *source, Float3 position, double time) {
    const SingeSourceDef *def = &source->def;
    const Float3 still = {0, 0, 0};
    const float speed = def->speed * source_strength(source, time), radius = float_max(def->radius, AIR_RADIUS_MIN);
    if (!source_blows(def) || speed == 0) return still;

    if (def->kind == SINGE_SOURCE_TURBULENCE) {
        const float t = (float)(time * (double)def->speed / (double)radius), s = 1 / radius;
        float u[3];
        for (uint32_t c = 0; c < 3; c++)
            u[c] =
                2 * random_noise(position.x * s + t, position.y * s + 0.7f * t, position.z * s + 0.4f * t, 71 + c) - 1;
        return float3_scale(float3_load(u), speed);
    }

    const Float3 away = float3_sub(position, path_pose(&source->path, time).position);
    const Float3 axis = float3_unit(float3_load(def->direction));
    const float x = float3_dot(away, axis);
    const Float3 across = float3_mad(away, axis, -x);

    if (def->kind == SINGE_SOURCE_ATTRACT)
        return float3_scale(float3_unit(away), -speed * air_profile(float3_length(away) / radius));
    if (def->kind == SINGE_SOURCE_VORTEX)
        return float3_scale(float3_cross(axis, float3_unit(across)),
                            speed * air_profile(float3_length(across) / radius));

    if (x < 0) return still;
    const float width = float_max(radius, JET_WIDTH * x), y = float3_length(across) / width;
    const float decay = x > JET_DECAY * radius ? JET_DECAY * radius / x : 1;
    return float3_scale(axis, speed * decay * real_expf(-0.69314718f * y * y));
}

Float3 air_velocity(const SourceList *sources, Float3 position, double time) {
    Float3 sum = {0, 0, 0};
    for (uint32_t k = 0; sources && k < sources->count; k++)
        if (source_is_lit(&sources->items[k], time))
            sum = float3_add(sum, source_air(&sources->items[k], position, time));
    return sum;
}
