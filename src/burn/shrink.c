// Target lengths of the springs at what burns, eq 6 (shell/target_length.h). The volume of eq 5 depends only on the mass,
// so only springs with an end that lost mass need a new length.
#include "burn/burn_job.h"
#include "shell/target_length.h"

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
    pool_for(pool, (int)job->shell->cell_count, POOL_GRAIN, shrink_cells, job);
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
