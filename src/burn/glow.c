// Glowing, the second reaction (beyond the paper): the char that pyrolysis leaves burns to ash. With the fractions of
// the initial mass f of fuel, c of char and a of ash, and the share z = c/nu,
//
//   m = f + c + a,   a = m_min (1 - f - z)
//   dc/dt = -nu df/dt - nu (k/(F F_c)) z^(1/2),   1/k = 1/r(T) + 1/(s k_air),   r = A exp(-E/(R T))
//
//   nu     char_yield: mass that pyrolysis leaves; at or below m_min there is no char, and no glowing
//   r      1/s, kinetics of the oxidation of cellulose char: A = 5.667e9 1/s, E = 160 kJ/mol (Kashiwagi & Nambu,
//          Combust. Flame 88, 1992, 345-368)
//   k_air  1/s, char_rate: rate that the air at an edge sustains
//   s      share of this air that reaches a particle, s = (1 - f_n)^8 max(s_0, w, 1 at an edge): gas from the fuel, and
//          the flame, keep the air away; inside a leaf little air arrives, s_0 = char_air; at an edge, and where char
//          has burnt to porous ash, all of it. w is the max of 1 - f - z, and f_n the max of f, over the particle and
//          its neighbours in the other layer
//   F      front thickening, by which every rate is divided
//   F_c    1 + 3 (1 - f)^8: the diffusivity alpha includes heat that the flame's gas carries along the sheet. Char has
//          no flame, so alpha/F_c remains for it, and its front is thickened F_c times for the cells: conduction stays
//          unchanged, and char burns and cools F_c times slower (also heat/heat.c). Without this the heat of an ember
//          reaches half a cell, and embers die where the flame leaves them
//
// Slow kinetics and slow supply are resistances in series, as in the theory of burning carbon (Glassman, Combustion,
// 9B). So hot char glows at edges and dies where it loses more heat than it gains, and embers creep from the edges into
// a leaf. The order 1/2 ends in a finite time, like a thread whose rim burns at a constant speed.
//
// The heat of glowing stays in the sheet and heats the remaining mass,
//
//   dT/dt = (H/c_p)(1 - m_min/nu)(-dc/dt)/max(m, floor),   H = H_c (h + (1 - h)/(1 + q)),   q = 2500 exp(-6240 K/T)
//
// divided by the remaining mass like the losses (heat/heat.c). H_c is the heat of char that burns to CO2; q is the
// ratio of CO to CO2 (Arthur, Trans. Faraday Soc. 47, 1951, 164-178), and h = .28 the share of the heat that burning to
// CO gives: 9.2 of 32.8 MJ/kg of carbon. So a hotter ember gives less heat, and more air makes it faster rather than
// hotter.
#include "common/real.h"
#include "burn/burn_job.h"

#include <math.h>

static const float GLOW_PRE_EXPONENTIAL = 5.667e9f; // 1/s
static const float GLOW_CO = 2500, GLOW_CO_TEMPERATURE = 6240, GLOW_CO_HEAT = 0.28f;
static const float GLOW_TEMPERATURE = 160e3f / 8.314462618f; // K, E/R

/// s of a particle: (1 - f_n)^8 max(s_0, w), with w = 1 next to a cell that is gone, and at the border.
static float glow_supply(const BurnJob *job, uint32_t i) {
    const Shell *shell = job->shell;
    const float *ash = job->burn->ash, *fuel = job->burn->fuel;
    const uint8_t *cell_flags = job->state->ablate->cell_flags;
    const uint16_t springs = job->state->ablate->degree[i];
    Float4 most = {fuel[i], ash[i]}; // without branches, which nobody can predict
    bool edge = false;

    if (shell_is_corner(shell, i)) {
        // a neighbour across a side at the vertex is in its fan, too
        const uint32_t first = shell->fan_first[i], last = shell->fan_first[i + 1];
        for (uint32_t f = first; f < last; f++) {
            const uint32_t cell = shell->fan[f], centre = shell_centre(shell, cell);
            const bool gone = !(cell_flags[cell] & SINGE_ALIVE);
            edge |= gone;
            if (gone) continue;
            most = float4_max(most, (Float4){fuel[centre], ash[centre]});
        }
        edge |= springs > 3 * (last - first); // a red, a yellow and a blue one for each cell, and at a border one more
    } else {
        edge = springs < 8; // a red one for each corner, a green one for each neighbour
        const uint32_t *corner = shell->cells[i - shell->vertex_count];
        for (int k = 0; k < 4; k++) most = float4_max(most, (Float4){fuel[corner[k]], ash[corner[k]]});
    }

    float squared = (1 - most[0]) * (1 - most[0]);
    squared *= squared;
    return float_max(edge ? 1 : most[1], field_at(shell->matter.char_air, i)) * (squared * squared);
}

static void glow_air_blocks(void *context, int begin, int end) {
    BurnJob *job = context;
    const Matter *matter = &job->shell->matter;

    for (int block = begin; block < end; block++) {
        uint32_t first, last, run;
        burn_block(job, block, &first, &last);
        for (; first < last; first = run) {
            run = burn_run_end(first, last);
            if (!burn_is_hot(job, first, run)) continue;
            for (uint32_t i = first; i < run; i++) {
                bool chars = field_at(matter->char_yield, i) > field_at(matter->mass_min, i);
                if (!chars || job->burn->fuel[i] >= 1) continue;
                if (job->state->ablate->particle_flags[i] & SINGE_ALIVE) job->burn->release[i] = glow_supply(job, i);
            }
        }
    }
}

void burn_air(BurnJob *job, Pool *pool) {
    pool_for(pool, pool_blocks((int)job->shell->particle_count), 1, glow_air_blocks, job);
}

float burn_glow_heat(const BurnJob *job, uint32_t i) {
    float monoxide = GLOW_CO * real_expf(-GLOW_CO_TEMPERATURE / job->state->heat->temperature[i]);
    return field_at(job->shell->matter.char_heating, i) * (GLOW_CO_HEAT + (1 - GLOW_CO_HEAT) / (1 + monoxide));
}

float burn_glow(const BurnJob *job, uint32_t i, float fuel, float share, float air, float dt) {
    if (!(share > 0)) return share;
    float supply = field_at(job->shell->matter.char_rate, i) * air;
    float kinetics = GLOW_PRE_EXPONENTIAL * real_expf(-GLOW_TEMPERATURE / job->state->heat->temperature[i]);
    float rate = supply > 0 && kinetics > 0 ? supply * (kinetics / (kinetics + supply)) : 0;
    float half = 0.5f * dt * rate / shell_glow_slowing(&job->shell->matter, i, fuel), root = sqrtf(share);
    return half > root ? 0 : (root - half) * (root - half);
}
