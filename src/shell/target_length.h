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
//
// Four springs at once.
#pragma once

#include "common/float4.h"
#include "shell/shell.h"

/// Volume ratio at a mass fraction, with the share `fuel` of the fuel left and the share `ash` turned to ash. In (0, 1]
/// for sane materials, clamped to [0.05, 1].
static inline Float4 burn_volume_ratio(Float4 mass, Float4 fuel, Float4 ash, Float4 char_density, Float4 ash_density) {
    const Float4 ratio = mass / (1 + (char_density - 1) * (1 - fuel) + (ash_density - char_density) * ash);
    return float4_select(ratio < 0.05f, float4_all(0.05f), float4_select(ratio > 1, float4_all(1), ratio));
}

/// A strong shrink factor must not invert a spring.
#define RATIO_MIN 0.05f

/// Properties of the ends of four springs.
typedef struct SpringEnds {
    Float4 volume; ///< v of eq 5
    Float4 shrink; ///< s
    Float4 fibres; ///< q
} SpringEnds;

/// Four particles as ends.
static inline SpringEnds spring_ends(const Matter *matter, const BurnState *burn, const uint32_t at[4]) {
    return (SpringEnds){float4_gather(burn->volume, at), field_four(matter->shrink, at),
                        field_four(matter->fibre_shrink, at)};
}

/// Those of the corners 0 to 3 of a cell in the order 1, 2, 3, 0.
static inline SpringEnds spring_ends_turned(SpringEnds ends) {
    return (SpringEnds){FLOAT4_SHUFFLE(ends.volume, ends.volume, 1, 2, 3, 0),
                        FLOAT4_SHUFFLE(ends.shrink, ends.shrink, 1, 2, 3, 0),
                        FLOAT4_SHUFFLE(ends.fibres, ends.fibres, 1, 2, 3, 0)};
}

/// The length ratios without fibres.
static inline Float4 length_ratio(SpringEnds a, SpringEnds b) {
    const Float4 shrink = 0.5f * (a.shrink + b.shrink);
    const Float4 ratio = 1 - shrink * (1 - 0.5f * (a.volume + b.volume));
    return float4_select(ratio < RATIO_MIN, float4_all(RATIO_MIN), ratio);
}

/// The length ratios of springs with this `grain`; `even` are the ratios without fibres.
static inline Float4 fibre_ratio(SpringEnds a, SpringEnds b, Float4 even, Float4 grain, Float4 in_plane) {
    const Float4 q = 0.5f * (a.fibres + b.fibres), max = even - RATIO_MIN, whole = (1 - even) * (q - 1) / (q + 1);
    const Float4 stretch = float4_select(whole > max, max, float4_select(whole < -max, -max, whole));
    return float4_sqrt(even * even + stretch * (in_plane * stretch + 2 * even * grain));
}

/// Target lengths of four springs. At red ones the share p of a spring's square that lies in the sheet follows from the
/// sheet's `thickness`, which is NULL for other colours: these lie in it.
static inline Float4 target_lengths(const SpringSet *springs, const uint32_t s[4], SpringEnds a, SpringEnds b,
                                    const Float4 *thickness) {
    const Float4 rest = float4_gather(springs->rest, s), ratio = length_ratio(a, b);
    if (!springs->grain) return rest * ratio;
    Float4 in_plane = float4_all(1);
    if (thickness) {
        const Float4 upright = *thickness / rest;
        in_plane = float4_select(upright < 1, 1 - upright * upright, (Float4){0});
    }
    return rest * fibre_ratio(a, b, ratio, float4_gather(springs->grain, s), in_plane);
}
