// Target lengths of the springs at what burns, eq 6 (shell/target_length.h). The volume of eq 5 depends only on the mass,
// so only springs with an end that lost mass need a new length.
#include "burn/burn_job.h"
#include "shell/target_length.h"

#include <string.h>

void burn_follow(const Matter *matter, BurnState *burn, uint32_t first, uint32_t last) {
    uint32_t at[4]; // the last one again in lanes without a particle
    for (uint32_t k = 0; k < 4; k++) at[k] = first + k < last ? first + k : last - 1;
    const Float4 mass = float4_gather(burn->mass, at), fuel = float4_gather(burn->fuel, at), zero = {0};
    const Float4 min = field_four(matter->mass_min, at), span = field_four(matter->char_yield, at) - min;

    // as shell_char
    const Float4 max = 1 - fuel, share = (mass - fuel - min * max) / span;
    const Float4 within = float4_select(share < 0, zero, float4_select(share > max, max, share));
    const Float4 ash = max - float4_select(span > 0, within, zero);
    const Float4 volume =
        burn_volume_ratio(mass, fuel, ash, field_four(matter->char_density, at), field_four(matter->ash_density, at));
    for (uint32_t k = 0; k < 4; k++) {
        burn->ash[at[k]] = ash[k];
        burn->volume[at[k]] = volume[k];
    }
}

/// Springs s[k] of the bits `which`.
static inline void shrink_springs(const BurnJob *job, SingeColour colour, const uint32_t s[4], unsigned which,
                                  SpringEnds a, SpringEnds b, const Float4 *thickness) {
    if (!which) return;
    uint32_t at[4]; // in place of a missing one the first that exists
    for (unsigned k = 0; k < 4; k++) at[k] = s[which >> k & 1 ? k : (unsigned)__builtin_ctz(which)];
    const Float4 length = target_lengths(&job->shell->springs[colour], at, a, b, thickness);
    for (unsigned k = 0; k < 4; k++)
        if (which >> k & 1) job->burn->spring_length[colour][at[k]] = length[k];
}

/// Shortens the springs of a cell that has a burning end. One that is gone has none but sides of the cell beside it. A
/// spring of two cells is left to the first of them that sees an end of it burn: both see the ends of a blue spring,
/// each sees only its own centre of a green one.
static void shrink_cell(const BurnJob *job, uint32_t cell) {
    const Shell *shell = job->shell;
    const Matter *matter = &shell->matter;
    const BurnState *burn = job->burn;
    const uint8_t *flags = job->state->ablate->cell_flags;
    const uint32_t *at = shell->cells[cell], middle = shell_centre(shell, cell);
    const CellSprings *springs = &shell->cell_springs[cell];
    if (!(flags[cell] & SINGE_ALIVE)) return;

    unsigned burns = float4_bits(float4_gather(burn->burn_rate, at) > 0); // bit i: corner i; bit 4: corner 0 again
    burns |= burns << 4 & 16;
    const bool centre_burns = burn->burn_rate[middle] > 0;

    // the cells beside it
    uint32_t beyond[4];
    unsigned blue = 0, green = 0; // a shared spring by one of its two cells
    for (int i = 0; i < 4; i++) {
        const uint32_t other = shell_neighbour(shell, cell, i);
        const bool two = other != SHELL_NONE && flags[other] & SINGE_ALIVE, first = !two || cell < other;
        beyond[i] = two ? shell_centre(shell, other) : middle;
        blue |= (unsigned)first << i;
        green |= (unsigned)(two && (first || !(burn->burn_rate[beyond[i]] > 0))) << i;
    }

    const SpringEnds corner = spring_ends(matter, burn, at), next = spring_ends_turned(corner);
    const SpringEnds centre = spring_ends(matter, burn, (const uint32_t[4]){middle, middle, middle, middle});
    const Float4 thickness = float4_all(field_at(matter->thickness, middle));

    shrink_springs(job, SINGE_RED, springs->red, 15, centre, corner, &thickness);
    shrink_springs(job, SINGE_BLUE, springs->blue, (burns | burns >> 1) & blue, corner, next, NULL);
    if (centre_burns)
        shrink_springs(job, SINGE_GREEN, springs->green, green, centre, spring_ends(matter, burn, beyond), NULL);

    // the diagonals
    const uint32_t yellow[4] = {springs->yellow[0], springs->yellow[1], springs->yellow[0], springs->yellow[1]};
    if (burns) shrink_springs(job, SINGE_YELLOW, yellow, 3, corner, spring_ends_turned(next), NULL);
}

static void shrink_cells(void *context, int begin, int end) {
    const BurnJob *job = context;
    const uint8_t *burns = (const uint8_t *)job->burn->burns, *next = burns + begin; // nobody marks any more
    for (; (next = memchr(next, 1, (size_t)(burns + end - next))); next++) shrink_cell(job, (uint32_t)(next - burns));
}

void burn_shrink(BurnJob *job, Pool *pool) {
    pool_for(pool, (int)job->shell->cell_count, POOL_GRAIN, shrink_cells, job);
}

void burn_restore_lengths(const Shell *shell, const AblateState *ablate, BurnState *burn) {
    for (uint32_t i = 0; i < shell->particle_count; i += 4) burn_follow(&shell->matter, burn, i, shell->particle_count);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        for (uint32_t s = 0; s < springs->count; s += 4) {
            uint32_t at[4], first[4], second[4];
            Float4 thickness = {0};
            for (uint32_t k = 0; k < 4; k++) {
                at[k] = s + k < springs->count ? s + k : s;
                first[k] = springs->ends[at[k]][0];
                second[k] = springs->ends[at[k]][1];
                if (colour == SINGE_RED) // a centre comes after all vertices
                    thickness[k] = field_at(shell->matter.thickness, first[k] > second[k] ? first[k] : second[k]);
            }

            const SpringEnds a = spring_ends(&shell->matter, burn, first),
                             b = spring_ends(&shell->matter, burn, second);
            const Float4 length = target_lengths(springs, at, a, b, colour == SINGE_RED ? &thickness : NULL);
            for (uint32_t k = 0; k < 4; k++)
                if (ablate->spring_flags[colour][at[k]] & SINGE_ALIVE) burn->spring_length[colour][at[k]] = length[k];
        }
    }
}
