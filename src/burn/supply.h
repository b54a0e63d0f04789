// The air that what burns shares.
#pragma once

#include "common/float4.h"
#include "common/memory.h"
#include "shell/shell.h"

/// A grid in space that holds how much of the air burns, in a hash table: a node per slot.
typedef struct BurnAir {
    float reach;    ///< m, between nodes
    uint32_t count; ///< slots
    uint64_t *node; ///< [count] the node's coordinates
    float *demand;  ///< [count]
} BurnAir;

/// The nodes about the position that was asked for last: most of the next ones have the same. Starts as {0}.
typedef struct BurnAirNear {
    bool known;
    int middle[3];     ///< of the nodes
    uint32_t slot[27]; ///< count: none
    Float4 demand[9];  ///< of the nodes, three a row
} BurnAirNear;

/// SINGE_ERROR_MEMORY; then burn_air_free is still to be called.
SingeResult burn_air_create(Memory *memory, const Shell *shell, BurnAir *air);
void burn_air_free(Memory *memory, BurnAir *air);

/// Empties the grid.
void burn_air_clear(BurnAir *air);

/// Adds what burns at four positions, each kg/s over the kg/(m2 s) that either face gets air for; what is not above 0 is
/// left out. The grid has it after burn_air_flush.
void burn_air_add(BurnAir *air, BurnAirNear *near, const float position[4][4], const float demand[4]);
void burn_air_flush(BurnAir *air, const BurnAirNear *near);

/// Whether a share may be below 1: none is above that of its nodes.
bool burn_air_is_short(const BurnAir *air);

/// The share of what would burn at four positions for which there is air: 1 in a front.
Float4 burn_air_share(BurnAir *air, BurnAirNear *near, const float position[4][4]);
