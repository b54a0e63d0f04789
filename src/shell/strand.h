// Strands: chains and rings of springs of one colour.
#pragma once

#include "shell/shell.h"

/// Springs as the mesh gives them, and their continuations. End 2 s + k is spring s's end ends[s][k]; its mate is the
/// end of another spring at the same particle, or SHELL_NONE.
typedef struct LooseSprings {
    uint32_t count;
    uint32_t (*ends)[2];
    uint32_t *mate; ///< [2 * count], mates of each other
} LooseSprings;

/// Makes two ends at one particle continue each other.
static inline void strand_join(LooseSprings *springs, uint32_t a, uint32_t b) {
    springs->mate[a] = b;
    springs->mate[b] = a;
}

/// Traces strands, colours their families and fills all of `set` but rest lengths (which are allocated); its count is
/// already set. `number` receives each loose spring's number in the set.
SingeResult strand_build(Memory *memory, uint32_t particle_count, const LooseSprings *springs, SpringSet *set,
                         uint32_t *number, SingeError *error);

/// Frees what strand_build allocated.
void strand_free(Memory *memory, SpringSet *set);
