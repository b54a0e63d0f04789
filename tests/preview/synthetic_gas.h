// The gas about a burning sheet by formula, in cells as coarse as a simulation's, so that flames can be looked at and
// tested without one.
#pragma once

#include "singe/sim.h"

typedef struct SyntheticGas {
    SingeGas gas;
    float *temperature, *smoke, *flame;
    float (*velocity)[3];
} SyntheticGas;

/// Fuel leaves the sheet where it burns, goes up layer by layer, spreads, sways with the time and burns off, a part of
/// it in each layer. Arrays come from malloc; free with synthetic_gas_free. False when out of memory.
bool synthetic_gas_make(const SingeSurface *surface, float cell, float time, SyntheticGas *gas);
void synthetic_gas_free(SyntheticGas *gas);
