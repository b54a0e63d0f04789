// Value noise on an integer lattice: hashed corner values, blended by 6t^5 - 15t^4 + 10t^3
// (Perlin, Improving Noise, 2002), whose first and second derivatives vanish at the lattice.
#include "common/random.h"

#include "common/real.h"

#include <math.h>

uint32_t random_hash(uint32_t a, uint32_t b, uint32_t c, uint32_t seed) {
    // multiply and xorshift rounds with low-bias multipliers (C. Wellons, Prospecting for hash functions, 2018)
    uint32_t h = seed * 0x9e3779b9u + 0x85ebca6bu;
    h = (h ^ a) * 0x7feb352du;
    h ^= h >> 15;
    h = (h ^ b) * 0x846ca68bu;
    h ^= h >> 16;
    h = (h ^ c) * 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    h ^= h >> 16;
    return h;
}

static float random_blend(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// The lattice cell of a coordinate and the fraction within it. Beyond 2^31 a float has no fraction:
/// cell 0, fraction 0. The same holds for values that are not finite.
static uint32_t random_cell(float x, float *fraction) {
    float cell = floorf(x);
    bool near = cell >= -2147483648.0f && cell < 2147483648.0f;
    *fraction = near ? x - cell : 0;
    return near ? (uint32_t)(int32_t)cell : 0;
}

float random_noise(float x, float y, float z, uint32_t seed) {
    float u, v, w;
    uint32_t ix = random_cell(x, &u), iy = random_cell(y, &v), iz = random_cell(z, &w);
    u = random_blend(u);
    v = random_blend(v);
    w = random_blend(w);

    float corner[8];
    for (uint32_t k = 0; k < 8; k++)
        corner[k] = random_unit(random_hash(ix + (k & 1), iy + ((k >> 1) & 1), iz + (k >> 2), seed));
    for (int k = 0; k < 4; k++) corner[k] = corner[2 * k] + u * (corner[2 * k + 1] - corner[2 * k]);
    for (int k = 0; k < 2; k++) corner[k] = corner[2 * k] + v * (corner[2 * k + 1] - corner[2 * k]);
    return corner[0] + w * (corner[1] - corner[0]);
}

float random_fractal(const SingeNoise *noise, float x, float y, float z) {
    float sum = 0, strength = 1, total = 0, frequency = 1 / noise->scale;
    for (int octave = 0; octave < noise->octaves; octave++) {
        // shifted lattices, so that octaves do not share their planes of symmetry
        float shift = 17.31f * (float)octave;
        sum += strength * random_noise(x * frequency + shift, y * frequency + shift, z * frequency + shift,
                                       noise->seed + (uint32_t)octave);
        total += strength;
        strength *= 0.5f;
        frequency *= 2;
    }

    float centred = (sum / total - 0.5f) * 1.6f + 0.5f;
    return float_min(float_max(centred, 0), 1);
}
