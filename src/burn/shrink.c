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
// v depends only on the mass, so only springs with an end that lost mass need a new length.
#include "burn/burn_job.h"

#include <math.h>

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

static inline void shrink_spring(const BurnJob *job, SingeColour colour, uint32_t s, SpringEnd a, SpringEnd b,
                                 float in_plane) {
    if (job->state->ablate->spring_flags[colour][s] & SINGE_ALIVE)
        job->burn->spring_length[colour][s] = target_length(&job->shell->springs[colour], s, a, b, in_plane);
}

/// Shortens the springs of cells that have a burning end. A spring of two cells is left to the first of them that sees
/// an end of it burn: both see the ends of a blue spring, each sees only its own centre of a green one.
static void shrink_cells(void *context, int begin, int end) {
    const BurnJob *job = context;
    const Shell *shell = job->shell;
    const Matter *matter = &shell->matter;
    const BurnState *burn = job->burn;
    const float *burn_rate = burn->burn_rate;

    for (uint32_t cell = (uint32_t)begin; cell < (uint32_t)end; cell++) {
        const uint32_t *at = shell->cells[cell];
        bool centre_burns = burn_rate[shell_centre(shell, cell)] > 0;
        bool burns[4] = {burn_rate[at[0]] > 0, burn_rate[at[1]] > 0, burn_rate[at[2]] > 0, burn_rate[at[3]] > 0};
        if (!(centre_burns | burns[0] | burns[1] | burns[2] | burns[3])) continue;
        const CellSprings *springs = &shell->cell_springs[cell];
        SpringEnd corner[4], centre = spring_end(matter, burn, shell_centre(shell, cell));
        for (int i = 0; i < 4; i++) corner[i] = spring_end(matter, burn, at[i]);

        // red, blue and green springs; a shared one by one of its two cells
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(shell, cell, i), beyond = shell_centre(shell, other);
            int next = (i + 1) & 3;
            if (centre_burns | burns[i]) {
                uint32_t s = springs->red[i];
                float in_plane = red_in_plane(matter, &shell->springs[SINGE_RED], s, shell_centre(shell, cell));
                shrink_spring(job, SINGE_RED, s, centre, corner[i], in_plane);
            }

            if ((burns[i] | burns[next]) && (other == SHELL_NONE || cell < other))
                shrink_spring(job, SINGE_BLUE, springs->blue[i], corner[i], corner[next], 1);
            if (centre_burns && other != SHELL_NONE && (cell < other || !(burn_rate[beyond] > 0)))
                shrink_spring(job, SINGE_GREEN, springs->green[i], centre, spring_end(matter, burn, beyond), 1);
        }

        // the diagonals
        for (int i = 0; i < 2; i++)
            if (burns[i] | burns[i + 2])
                shrink_spring(job, SINGE_YELLOW, springs->yellow[i], corner[i], corner[i + 2], 1);
    }
}

void burn_shrink(BurnJob *job, Pool *pool) {
    pool_for(pool, (int)job->shell->cell_count, POOL_BLOCK, shrink_cells, job);
}

void burn_restore_lengths(const Shell *shell, const AblateState *ablate, BurnState *burn) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        for (uint32_t s = 0; s < springs->count; s++) {
            if (!(ablate->spring_flags[colour][s] & SINGE_ALIVE)) continue;
            uint32_t first = springs->ends[s][0], second = springs->ends[s][1];
            SpringEnd a = spring_end(&shell->matter, burn, first);
            SpringEnd b = spring_end(&shell->matter, burn, second);
            float in_plane = 1;
            if (colour == SINGE_RED) // a centre comes after all vertices
                in_plane = red_in_plane(&shell->matter, springs, s, first > second ? first : second);
            burn->spring_length[colour][s] = target_length(springs, s, a, b, in_plane);
        }
    }
}
