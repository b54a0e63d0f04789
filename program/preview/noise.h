// Value noise on an integer lattice, inline because every sample near a burnt edge evaluates it.
#pragma once

#include "preview/render_math.h"

#include <stdint.h>

static inline uint32_t hash_u32(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

/// Uniform in [0, 1).
static inline float hash_unit(uint32_t x) { return (float)(hash_u32(x) >> 8) * (1.0f / 16777216.0f); }

static inline float noise_corner(uint32_t h) {
    h *= 0x9e3779b1u;
    h ^= h >> 15;
    h *= 0x85ebca6bu;
    return (float)(int32_t)h * (1.0f / 2147483648.0f);
}

static inline int noise_floor(float x, float *fraction) {
    float bounded = clampf(x, -1e8f, 1e8f);
    int i = (int)bounded - (bounded < (float)(int)bounded);
    *fraction = bounded - (float)i;
    return i;
}

/// Smooth noise in [-1, 1], lattice size 1, in the plane.
static inline float noise2(float x, float y, uint32_t seed) {
    float fx, fy;
    uint32_t ix = (uint32_t)noise_floor(x, &fx) * 0x8da6b343u, iy = (uint32_t)noise_floor(y, &fy) * 0xd8163841u;
    uint32_t jx = ix + 0x8da6b343u, jy = iy + 0xd8163841u, s = seed * 0xcb1ab31fu;
    fx = fx * fx * (3 - 2 * fx);
    fy = fy * fy * (3 - 2 * fy);
    float a = mixf(noise_corner(ix ^ iy ^ s), noise_corner(jx ^ iy ^ s), fx);
    float b = mixf(noise_corner(ix ^ jy ^ s), noise_corner(jx ^ jy ^ s), fx);
    return mixf(a, b, fy);
}

/// Smooth noise in [-1, 1], lattice size 1, in space.
static inline float noise3(Float3 p, uint32_t seed) {
    float fx, fy, fz;
    uint32_t ix = (uint32_t)noise_floor(p.x, &fx) * 0x8da6b343u, iy = (uint32_t)noise_floor(p.y, &fy) * 0xd8163841u;
    uint32_t iz = (uint32_t)noise_floor(p.z, &fz) * 0xcb1ab31fu, s = seed * 0x165667b1u;
    uint32_t jx = ix + 0x8da6b343u, jy = iy + 0xd8163841u, jz = iz + 0xcb1ab31fu;
    fx = fx * fx * (3 - 2 * fx);
    fy = fy * fy * (3 - 2 * fy);
    fz = fz * fz * (3 - 2 * fz);
    iz ^= s;
    jz ^= s;
    float a = mixf(noise_corner(ix ^ iy ^ iz), noise_corner(jx ^ iy ^ iz), fx);
    float b = mixf(noise_corner(ix ^ jy ^ iz), noise_corner(jx ^ jy ^ iz), fx);
    float c = mixf(noise_corner(ix ^ iy ^ jz), noise_corner(jx ^ iy ^ jz), fx);
    float d = mixf(noise_corner(ix ^ jy ^ jz), noise_corner(jx ^ jy ^ jz), fx);
    return mixf(mixf(a, b, fy), mixf(c, d, fy), fz);
}

/// Gradient of noise3 by forward differences from its value n at p.
static inline Float3 noise3_gradient(Float3 p, float n, uint32_t seed) {
    const float e = 0.25f;
    return float3((noise3(float3(p.x + e, p.y, p.z), seed) - n) / e, (noise3(float3(p.x, p.y + e, p.z), seed) - n) / e,
                  (noise3(float3(p.x, p.y, p.z + e), seed) - n) / e);
}

/// Difference between the distances to the nearest two of scattered points, one in each cell of the unit lattice
/// (Worley 1996): 0 on the walls between their regions, about 0.5 in the centres. `nearest`: the hash of the nearest.
static inline float noise_cell(Float3 p, uint32_t seed, uint32_t *nearest) {
    float fx, fy, fz, first = 9, second = 9, far[27];
    uint32_t keys[27];
    *nearest = 0;
    uint32_t ix = (uint32_t)noise_floor(p.x, &fx), iy = (uint32_t)noise_floor(p.y, &fy);
    uint32_t iz = (uint32_t)noise_floor(p.z, &fz);
    for (int k = 0; k < 27; k++) {
        const uint32_t dx = (uint32_t)(k % 3 - 1), dy = (uint32_t)(k / 3 % 3 - 1), dz = (uint32_t)(k / 9 - 1);
        keys[k] = ((ix + dx) * 0x8da6b343u) ^ ((iy + dy) * 0xd8163841u) ^ ((iz + dz) * 0xcb1ab31fu);
    }

    // apart from the search, in lanes
    for (int k = 0; k < 27; k++) {
        const uint32_t h = keys[k] = hash_u32(keys[k] ^ (seed * 0x165667b1u));
        const float x = (float)(k % 3 - 1) + (float)(int)(h & 1023) / 1024 - fx;
        const float y = (float)(k / 3 % 3 - 1) + (float)(int)(h >> 10 & 1023) / 1024 - fy;
        const float z = (float)(k / 9 - 1) + (float)(int)(h >> 20 & 1023) / 1024 - fz;
        far[k] = x * x + y * y + z * z;
    }
    for (int k = 0; k < 27; k++) {
        second = minf(second, maxf(first, far[k]));
        if (far[k] < first) first = far[k], *nearest = keys[k];
    }
    return sqrtf(second) - sqrtf(first);
}

static inline float noise_walls(Float3 p, uint32_t seed) {
    uint32_t nearest;
    return noise_cell(p, seed, &nearest);
}
