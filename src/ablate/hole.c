// Where holes open.
//
// A hole opens at a particle that burnt through in this step (its level fell below 0) if none of the particles that
// were connected with it by springs at the start is burnt through or gone, and if it is not at the mesh's boundary,
// where it leaves a notch. Of neighbours that burn through in the same step only the first in order of particle opens a
// hole. A centre is never at the boundary.
#include "ablate/ablate_plan.h"

typedef struct HoleSearch {
    const AblatePlan *plan;
    const Shell *shell;
    const StateInput *state;
    const AblateState *ablate;
    float now; ///< s, time stamp of the burn stage
} HoleSearch;

static bool burnt_now(const HoleSearch *search, uint32_t particle) {
    return search->state->burn->time_burnt[particle] == search->now && search->plan->level[particle] < 0;
}

/// Burnt through or gone before `particle`, in time or in order.
static bool open_before(const HoleSearch *search, uint32_t other, uint32_t particle) {
    if (other == particle) return false;
    if (!(search->ablate->particle_flags[other] & SINGE_ALIVE)) return true;
    return search->plan->level[other] < 0 && (!burnt_now(search, other) || other < particle);
}

/// Whether a corner or the centre of a cell is open: the red, blue and yellow neighbours of its particles.
static bool cell_open_before(const HoleSearch *search, uint32_t cell, uint32_t particle) {
    for (int i = 0; i < 4; i++)
        if (open_before(search, search->shell->cells[cell][i], particle)) return true;
    return open_before(search, shell_centre(search->shell, cell), particle);
}

static bool corner_opens(const HoleSearch *search, uint32_t vertex) {
    const Shell *shell = search->shell;
    if (search->plan->rim[vertex]) return false;
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++)
        if (cell_open_before(search, shell->fan[k], vertex)) return false;
    return true;
}

static bool centre_opens(const HoleSearch *search, uint32_t cell) {
    uint32_t centre = shell_centre(search->shell, cell);
    if (cell_open_before(search, cell, centre)) return false;
    for (int i = 0; i < 4; i++) {
        uint32_t other = shell_neighbour(search->shell, cell, i);
        if (other != SHELL_NONE && open_before(search, shell_centre(search->shell, other), centre)) return false;
    }
    return true;
}

void hole_report(const AblatePlan *plan, const Shell *shell, const StateInput *state, const AblateState *ablate,
                 EventList *events) {
    HoleSearch search = {plan, shell, state, ablate, (float)state->time};
    for (uint32_t i = 0; i < shell->particle_count; i++) {
        if (!burnt_now(&search, i) || !(ablate->particle_flags[i] & SINGE_ALIVE)) continue;
        bool corner = shell_is_corner(shell, i);
        bool opens = corner ? corner_opens(&search, i) : centre_opens(&search, i - shell->vertex_count);
        if (opens) event_push(events, SINGE_EVENT_HOLE_OPENED, (int32_t)i, state->time, state->dynamics->position[i]);
    }
}
