// Seeded noise from integer hashes: the same on every machine.
#pragma once

#include "singe/types.h"

/// A well-mixed 32-bit hash of four numbers.
uint32_t random_hash(uint32_t a, uint32_t b, uint32_t c, uint32_t seed);

/// Uniform in [0, 1).
static inline float random_unit(uint32_t hash) { return (float)(hash >> 8) * (1.0f / 16777216.0f); }

/// Smooth value noise in [0, 1] of lattice size 1.
float random_noise(float x, float y, float z, uint32_t seed);

/// Octaves of value noise in [0, 1], spread so that it fills most of that range.
float random_fractal(const SingeNoise *noise, float x, float y, float z);
