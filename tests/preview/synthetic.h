// Burning sheets made by formula, so that pictures can be looked at and tested without the simulator.
#pragma once

#include "singe/sim.h"

typedef enum SyntheticKind {
    SYNTHETIC_FLAT,    ///< flat on the table, a burning hole, curled at its edge
    SYNTHETIC_HANGING, ///< hanging, burnt from below
    SYNTHETIC_COLD,    ///< as FLAT, gone out
} SyntheticKind;

/// An A4 sheet of cells_x x (cells_x * 1.414) cells, four triangles each, cut at m = 0.22 and bent by `kind`.
/// `radius` (m) is the hole's. Arrays come from malloc; free with synthetic_free. False when out of memory.
bool synthetic_make(SyntheticKind kind, int cells_x, float radius, SingeSurface *surface);
void synthetic_free(SingeSurface *surface);
