// Volume ratio, eq 5:
//
//   v = (m / rho) / (m_init / rho_init) = m / rho      with m and rho relative to their initial values
//
// The density goes linearly from 1 to rho_ash with the burn progress b = (1 - m)/(1 - m_min).
#ifndef BURN_VOLUME_H
#define BURN_VOLUME_H

#include "shell/shell.h"

/// Volume ratio for a mass fraction. In (0, 1] for sane materials, clamped to [0.05, 1].
static inline float burn_volume_ratio(float mass, float mass_min, float ash_density) {
    float density = 1 + (ash_density - 1) * shell_burn_progress(mass, mass_min);
    float ratio = mass / density;
    return ratio < 0.05f ? 0.05f : ratio > 1 ? 1 : ratio;
}

#endif
