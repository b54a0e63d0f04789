// The air that what burns shares.
#pragma once

#include "common/memory.h"
#include "shell/shell.h"

/// A grid in space that holds how much of the air burns, in a hash table: a node per slot.
typedef struct BurnAir {
    float reach;    ///< m, between nodes
    uint32_t count; ///< slots
    uint64_t *node; ///< [count] the node's coordinates
    float *demand;  ///< [count]
} BurnAir;

/// The nodes about the position that was asked for last: most of the next ones have the same. Starts as {0}, and holds
/// while nothing else is done to the grid.
typedef struct BurnAirNear {
    bool known;
    int middle[3];     ///< of the nodes
    uint32_t slot[27]; ///< count: none
} BurnAirNear;

/// SINGE_ERROR_MEMORY; then burn_air_free is still to be called.
SingeResult burn_air_create(Memory *memory, const Shell *shell, BurnAir *air);
void burn_air_free(Memory *memory, BurnAir *air);

/// Empties the grid.
void burn_air_clear(BurnAir *air);

/// Adds what burns at a position, kg/s over the kg/(m2 s) that either face gets air for.
void burn_air_add(BurnAir *air, BurnAirNear *near, const float position[3], float demand);

/// Whether a share may be below 1: none is above that of its nodes.
bool burn_air_is_short(const BurnAir *air);

/// The share of what would burn at a position for which there is air: 1 in a front.
float burn_air_share(const BurnAir *air, BurnAirNear *near, const float position[3]);
