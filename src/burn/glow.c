// Glowing, the second reaction (beyond the paper): what pyrolysis leaves as char burns away to ash. With the fractions
// of the initial mass f of fuel, c of char and a of ash, and the share z = c/nu,
//
//   m = f + c + a,   a = m_min (1 - f - z)
//   dc/dt = -nu df/dt - nu (k/F) z^(1/2),   1/k = 1/r(T) + 1/(s k_air),   r = A exp(-E/(R T))
//
//   nu     char_yield: what pyrolysis leaves; at or below m_min there is no char, and nothing here
//   r      1/s, kinetics of the oxidation of cellulose's char: A = 5.667e9 1/s, E = 160 kJ/mol (Kashiwagi & Nambu,
//          Combust. Flame 88, 1992, 345-368)
//   k_air  1/s, char_rate: what air at an edge can burn
//   s      share of it that reaches a particle, s = (1 - f)^2 max(s_0, 1 - f - z, 1 at an edge): gas that leaves the
//          fuel keeps the air away; within a leaf little air comes, s_0 = char_air; at an edge, and where the char has
//          begun to burn away and is porous, all of it
//   F      front thickening, by which every rate is divided
//
// Slow kinetics and slow supply are resistances in series, as in the theory of burning carbon (Glassman, Combustion,
// 9B). So char that is hot glows at edges and dies where it loses more than it gets, and embers crawl into a leaf from
// there. The order 1/2 ends in a finite time, as a thread does whose rim burns at an even pace.
//
// The heat of what glows stays in the sheet and warms what is left there,
//
//   dT/dt = (H_c/c_p)(1 - m_min/nu)(-dc/dt)/max(m, floor)
//
// as the losses are over what is left (heat/heat.c).
#include "burn/burn_job.h"

#include <math.h>

static const float GLOW_PRE_EXPONENTIAL = 5.667e9f; // 1/s
static const float GLOW_TEMPERATURE = 160e3f / 8.314462618f; // K, E/R

static bool glow_is_gone(const BurnJob *job, uint32_t cell) {
    return cell == SHELL_NONE || !(job->state->ablate.cell_flags[cell] & SINGE_ALIVE);
}

/// Whether a particle lies at an edge: of the sheet, of a hole or of a tear.
static bool glow_at_edge(const BurnJob *job, uint32_t particle) {
    const Shell *shell = job->shell;
    if (!shell_is_corner(shell, particle)) {
        uint32_t cell = particle - shell->vertex_count;
        for (int k = 0; k < 4; k++)
            if (glow_is_gone(job, shell_neighbour(shell, cell, k))) return true;
        return false;
    }
    for (uint32_t f = shell->fan_first[particle]; f < shell->fan_first[particle + 1]; f++) {
        uint32_t cell = shell->fan[f];
        int i = 0;
        while (shell->cells[cell][i] != particle) i++;
        if (glow_is_gone(job, cell) || glow_is_gone(job, shell_neighbour(shell, cell, i)) ||
            glow_is_gone(job, shell_neighbour(shell, cell, (i + 3) & 3)))
            return true;
    }
    return false;
}

/// 1/s, k above.
static float glow_rate(const BurnJob *job, uint32_t i, float fuel, float share, float temperature) {
    const Matter *matter = &job->shell->matter;
    float air = fmaxf(field_at(matter->char_air, i), 1 - fuel - share), burnt = 1 - fuel;
    if (air < 1 && glow_at_edge(job, i)) air = 1;
    float supply = field_at(matter->char_rate, i) * air * burnt * burnt;
    float kinetics = GLOW_PRE_EXPONENTIAL * expf(-GLOW_TEMPERATURE / temperature);
    return supply > 0 && kinetics > 0 ? supply * (kinetics / (kinetics + supply)) : 0;
}

float burn_glow(const BurnJob *job, uint32_t i, float fuel, float share, float dt) {
    if (!(share > 0)) return share;
    float half = 0.5f * dt * glow_rate(job, i, fuel, share, job->state->heat.temperature[i]), root = sqrtf(share);
    return half > root ? 0 : (root - half) * (root - half);
}
