// A parameter over the particles of a shell: one number for all particles, or an array where it varies.
#pragma once

#include "common/float4.h"
#include "common/memory.h"

/// Number of consecutive particles that field_run gives.
enum { FIELD_RUN = 256 };

typedef struct Field {
    float *values; ///< one per particle, or FIELD_RUN times the same
    uint32_t mask; ///< UINT32_MAX, or 0 where the field is uniform
} Field;

static inline float field_at(Field field, uint32_t particle) { return field.values[particle & field.mask]; }

/// Those of four particles.
static inline Float4 field_four(Field field, const uint32_t at[4]) {
    return field.mask ? float4_gather(field.values, at) : float4_all(field.values[0]);
}

/// The values of particles first, first + 1 .. up to FIELD_RUN of them: a loop over these is the same for both kinds,
/// and a compiler can vectorise it.
static inline const float *field_run(Field field, uint32_t first) { return field.values + (first & field.mask); }

/// A uniform field. False when out of memory.
bool field_create(Memory *memory, Field *field, float value);
/// Gives each of `count` particles a value of its own, initially the uniform one. False when out of memory.
bool field_vary(Memory *memory, Field *field, uint32_t count);
/// `count` particles are the shell's. A zeroed field is allowed.
void field_free(Memory *memory, Field *field, uint32_t count);
