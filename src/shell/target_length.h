// Target length of a spring, eq 6 with the layers' own share of the shrinkage:
//
//   l = l_init (1 - e),   e = s (1 - (v0 + v1)/2)
//
//   l_init  initial length, m (the paper's l_rest is the same length; compounding would shrink without end)
//   v0, v1  volume ratios of the ends, eq 5
//   s       mean of the ends' shrink factors; 1 is the paper, and the layers' difference makes curl
//
// Paper shrinks more across its fibres than along them: for drying bond paper, 1.5 to 4 times (Roberts & Etherington,
// Bookbinding and the Conservation of Books, 1982, "anisotropic behavior"). With q the ratio, `fibre_shrink`, and
// b = e (q - 1)/(q + 1), lengths along the fibres are scaled by 1 - e + b, those across by 1 - e - b. So all springs
// fit one stretched plane: at the angle phi to the fibres
//
//   (l/l_init)^2 = (1 - e + b)^2 cos^2 phi + (1 - e - b)^2 sin^2 phi = (1 - e)^2 + b (b + 2 (1 - e) cos 2 phi)
//
// The component of a red spring normal to the sheet shrinks by 1 - e: with the share p of its square in the plane,
// p b^2 replaces b^2. Its `grain` already contains p (shell/rest_lengths.c).
//
// Volume ratio, eq 5:
//
//   v = (m / rho) / (m_init / rho_init) = m / rho      with m and rho relative to their initial values
//   rho = 1 + (rho_char - 1)(1 - f) + (rho_ash - rho_char) w
//
// f is the fuel, w = 1 - f - c/nu the share that has become ash (glow.c). In the paper, without char, the density is
// linear from 1 to rho_ash in the burn progress 1 - f = w = (1 - m)/(1 - m_min).
#pragma once

#include <math.h>

#include "shell/shell.h"

/// Volume ratio at a mass fraction, with the share `fuel` of the fuel left and the share `ash` turned to ash. In (0, 1]
/// for sane materials, clamped to [0.05, 1].
static inline float burn_volume_ratio(float mass, float fuel, float ash, float char_density, float ash_density) {
    float ratio = mass / (1 + (char_density - 1) * (1 - fuel) + (ash_density - char_density) * ash);
    return ratio < 0.05f ? 0.05f : ratio > 1 ? 1 : ratio;
}

/// A strong shrink factor must not invert a spring.
#define RATIO_MIN 0.05f

/// Properties of a spring's end.
typedef struct SpringEnd {
    float volume; ///< v of eq 5
    float shrink; ///< s
    float fibres; ///< q
} SpringEnd;

static inline SpringEnd spring_end(const Matter *matter, const BurnState *burn, uint32_t i) {
    float mass = burn->mass[i], fuel = burn->fuel[i];
    float ash = 1 - fuel - shell_char(mass, fuel, field_at(matter->mass_min, i), field_at(matter->char_yield, i));
    float volume =
        burn_volume_ratio(mass, fuel, ash, field_at(matter->char_density, i), field_at(matter->ash_density, i));
    return (SpringEnd){volume, field_at(matter->shrink, i), field_at(matter->fibre_shrink, i)};
}

static inline float length_ratio(SpringEnd a, SpringEnd b) {
    float shrink = 0.5f * (a.shrink + b.shrink);
    float ratio = 1 - shrink * (1 - 0.5f * (a.volume + b.volume));
    return ratio < RATIO_MIN ? RATIO_MIN : ratio;
}

/// The length ratio of a spring with this `grain`; `even` is the ratio without fibres.
static inline float fibre_ratio(SpringEnd a, SpringEnd b, float even, float grain, float in_plane) {
    float q = 0.5f * (a.fibres + b.fibres), max = even - RATIO_MIN, stretch = (1 - even) * (q - 1) / (q + 1);
    stretch = stretch > max ? max : stretch < -max ? -max : stretch;
    return sqrtf(even * even + stretch * (in_plane * stretch + 2 * even * grain));
}

/// The share p of the square of a red spring that lies in the plane of the sheet.
static inline float red_in_plane(const Matter *matter, const SpringSet *red, uint32_t s, uint32_t centre) {
    if (!red->grain) return 1; // unused
    float upright = field_at(matter->thickness, centre) / red->rest[s];
    return upright < 1 ? 1 - upright * upright : 0;
}

/// Target length of a spring whose share `in_plane` of its square lies in the sheet.
static inline float target_length(const SpringSet *springs, uint32_t s, SpringEnd a, SpringEnd b, float in_plane) {
    float ratio = length_ratio(a, b);
    if (springs->grain) ratio = fibre_ratio(a, b, ratio, springs->grain[s], in_plane);
    return springs->rest[s] * ratio;
}
