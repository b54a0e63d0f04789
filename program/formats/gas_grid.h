// Shared by the writer and the reader of gas.
#pragma once

#include "formats/formats.h"

#include <math.h>

enum { GAS_BLOCK = 8 }; ///< cells along a block's side: an OpenVDB leaf

// thresholds of visibility
#define GAS_SMOKE_MIN 1e-7f  ///< kg/m3; at 8.7 m2/g half a metre of it hides 0.04 %
#define GAS_FLAME_MIN 100.0f ///< W/m3; flames have about 1e6
#define GAS_WARM_MIN 2.0f    ///< K above the coolest cell

/// The box of cells [low, high) of a block, clipped to the gas.
static inline void gas_block_box(const SingeGas *gas, const uint32_t block[3], uint32_t low[3], uint32_t high[3]) {
    for (int c = 0; c < 3; c++) {
        low[c] = block[c] * GAS_BLOCK;
        high[c] = low[c] + GAS_BLOCK;
        if (high[c] > gas->size[c]) high[c] = gas->size[c];
    }
}

static inline size_t gas_index(const SingeGas *gas, uint32_t x, uint32_t y, uint32_t z) {
    return x + (size_t)gas->size[0] * (y + (size_t)gas->size[1] * z);
}

static inline size_t gas_cells(const SingeGas *gas) { return (size_t)gas->size[0] * gas->size[1] * gas->size[2]; }

/// Whether any of the block's cells is above a threshold. `coolest` is the temperature of still air.
bool gas_block_holds(const SingeGas *gas, const uint32_t block[3], float coolest);
float gas_coolest(const SingeGas *gas);
/// Whether the sizes, the origin and the number of cells are possible.
bool gas_shape_is_good(const SingeGas *gas);
/// Sets every temperature.
void gas_fill(Gas *gas, float coolest);
/// Computes smoke and flame from the file's values. False if one is not finite.
bool gas_decode(Gas *gas);
/// Makes the arrays for gas->view.size, filled with still air.
SINGE_NODISCARD SingeResult gas_make(Gas *gas, const char *name, float coolest, SingeError *error);
