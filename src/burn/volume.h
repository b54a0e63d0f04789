// Volume ratio, eq 5:
//
//   v = (m / rho) / (m_init / rho_init) = m / rho      with m and rho relative to their initial values
//   rho = 1 + (rho_char - 1)(1 - f) + (rho_ash - rho_char) w
//
// f is the fuel, w = 1 - f - c/nu the share that has become ash (glow.c). In the paper, without char, the density is
// linear from 1 to rho_ash in the burn progress 1 - f = w = (1 - m)/(1 - m_min).
#ifndef BURN_VOLUME_H
#define BURN_VOLUME_H

#include "shell/shell.h"

/// Volume ratio at a mass fraction, with the share `fuel` of the fuel left and the share `ash` turned to ash. In (0, 1]
/// for sane materials, clamped to [0.05, 1].
static inline float burn_volume_ratio(float mass, float fuel, float ash, float char_density, float ash_density) {
    float ratio = mass / (1 + (char_density - 1) * (1 - fuel) + (ash_density - char_density) * ash);
    return ratio < 0.05f ? 0.05f : ratio > 1 ? 1 : ratio;
}

#endif
