// Target length of a spring, eq 6 with the layers' own share of the shrinkage:
//
//   l = l_init (1 - s (1 - (v0 + v1)/2))
//
//   l_init  initial length, m (the paper's l_rest is the same length; compounding would shrink without end)
//   v0, v1  volume ratios of the ends, eq 5
//   s       mean of the ends' shrink factors; 1 is the paper, and the layers' difference makes curl
//
// v follows from the mass alone, so that only springs with an end that lost mass need a new length.
#include "burn/burn_job.h"

/// A strong shrink factor must not turn a spring inside out.
#define LEAST_RATIO 0.05f

/// What a spring asks of an end.
typedef struct SpringEnd {
    float volume; ///< v of eq 5
    float shrink; ///< s
} SpringEnd;

static inline SpringEnd spring_end(const Matter *matter, const float *mass, uint32_t i) {
    float volume = burn_volume_ratio(mass[i], field_at(matter->mass_min, i), field_at(matter->ash_density, i));
    return (SpringEnd){volume, field_at(matter->shrink, i)};
}

static inline float length_ratio(SpringEnd a, SpringEnd b) {
    float shrink = 0.5f * (a.shrink + b.shrink);
    float ratio = 1 - shrink * (1 - 0.5f * (a.volume + b.volume));
    return ratio < LEAST_RATIO ? LEAST_RATIO : ratio;
}

static inline void shrink_spring(const BurnJob *job, SingeColour colour, uint32_t s, SpringEnd a, SpringEnd b) {
    if (job->state->ablate.spring_flags[colour][s] & SINGE_ALIVE)
        job->burn->spring_length[colour][s] = job->shell->springs[colour].rest[s] * length_ratio(a, b);
}

/// The springs of a cell of which an end burns. One that lies in two cells is left to the first of them that sees an
/// end of it burn: both see those of a blue spring, and each sees its own centre of a green one.
static void shrink_burning_cell(const BurnJob *job, uint32_t cell, const bool burns[4], bool centre_burns) {
    const Shell *shell = job->shell;
    const CellSprings *springs = &shell->cell_springs[cell];
    const float *burn_rate = job->burn->burn_rate, *mass = job->burn->mass;
    SpringEnd corner[4], centre = spring_end(&shell->matter, mass, shell_centre(shell, cell));
    for (int i = 0; i < 4; i++) corner[i] = spring_end(&shell->matter, mass, shell->cells[cell][i]);
    for (int i = 0; i < 4; i++) {
        uint32_t other = shell_neighbour(shell, cell, i), beyond = shell_centre(shell, other);
        int next = (i + 1) & 3;
        if (centre_burns | burns[i]) shrink_spring(job, SINGE_RED, springs->red[i], centre, corner[i]);
        if ((burns[i] | burns[next]) && (other == SHELL_NONE || cell < other))
            shrink_spring(job, SINGE_BLUE, springs->blue[i], corner[i], corner[next]);
        if (centre_burns && other != SHELL_NONE && (cell < other || !(burn_rate[beyond] > 0)))
            shrink_spring(job, SINGE_GREEN, springs->green[i], centre, spring_end(&shell->matter, mass, beyond));
    }
    for (int i = 0; i < 2; i++)
        if (burns[i] | burns[i + 2]) shrink_spring(job, SINGE_YELLOW, springs->yellow[i], corner[i], corner[i + 2]);
}

static void shrink_cells(void *context, int begin, int end) {
    const BurnJob *job = context;
    const float *burn_rate = job->burn->burn_rate;
    for (int c = begin; c < end; c++) {
        const uint32_t *corner = job->shell->cells[c];
        bool centre = burn_rate[shell_centre(job->shell, (uint32_t)c)] > 0;
        bool burns[4] = {burn_rate[corner[0]] > 0, burn_rate[corner[1]] > 0, burn_rate[corner[2]] > 0,
                         burn_rate[corner[3]] > 0};
        if (centre | burns[0] | burns[1] | burns[2] | burns[3]) shrink_burning_cell(job, (uint32_t)c, burns, centre);
    }
}

void burn_shrink(BurnJob *job, Pool *pool) {
    pool_for(pool, (int)job->shell->cell_count, POOL_BLOCK, shrink_cells, job);
}

void burn_restore_lengths(const Shell *shell, const State *state, BurnState *burn) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        for (uint32_t s = 0; s < springs->count; s++) {
            if (!(state->ablate.spring_flags[colour][s] & SINGE_ALIVE)) continue;
            SpringEnd a = spring_end(&shell->matter, burn->mass, springs->ends[s][0]);
            SpringEnd b = spring_end(&shell->matter, burn->mass, springs->ends[s][1]);
            burn->spring_length[colour][s] = springs->rest[s] * length_ratio(a, b);
        }
    }
}
