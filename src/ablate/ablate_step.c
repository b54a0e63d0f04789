// The ablate stage: where holes open, what goes, and then the pieces (piece.c).
//
// A hole opens at a particle that burnt through in this step (its level fell below 0) if none of the particles that
// were connected with it by springs at the start is burnt through or gone, and if it is not at the mesh's boundary,
// where it leaves a notch. Of neighbours that burn through in the same step only the first in order of particle opens a
// hole. A centre is never at the boundary.
//
// Triangle i of a cell joins corners i and i + 1 and the virtual centre. It is gone when its three levels are negative;
// mass never grows, so it stays gone. A cell is gone when its four triangles are, and
//
//   red, yellow   go with their cell
//   green         goes with the first of its two cells
//   blue          goes with the last of its cells, two or, at a boundary or a tear, one
//
// and a particle goes with its last spring, with its mass and its enthalpy C (T - T_amb). The mass that it burnt in the
// step that removes it is in mass_burnt, but that step's heat of combustion is not released: heat is released in the
// next step, to particles that are then alive. It is not counted either, so that the ledger closes.
//
// Section 6 removes a red or blue spring as soon as both triangles that share it have disappeared. That leaves a burnt
// corner of a cell that is not gone on a single yellow spring. It is not drawn but moves: it spun about the corner
// opposite at up to 8 m/s, shook what hung there, and was in the way of other cells.
#include "ablate/ablate_plan.h"

/// Particles or cells that are looked at together.
enum { ABLATE_RUN = 64 };

// ---- holes

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

/// Whether a hole opens at a particle that has just burnt through.
static bool hole_opens(const HoleSearch *search, uint32_t particle) {
    const Shell *shell = search->shell;
    if (shell_is_corner(shell, particle)) {
        if (search->plan->rim[particle]) return false;

        for (uint32_t k = shell->fan_first[particle]; k < shell->fan_first[particle + 1]; k++)
            if (cell_open_before(search, shell->fan[k], particle)) return false;
        return true;
    }

    // a centre: its cell, and the centres of the cells around
    uint32_t cell = particle - shell->vertex_count;
    if (cell_open_before(search, cell, particle)) return false;

    for (int i = 0; i < 4; i++) {
        uint32_t other = shell_neighbour(shell, cell, i);
        if (other != SHELL_NONE && open_before(search, shell_centre(shell, other), particle)) return false;
    }

    return true;
}

/// Pushes a SINGE_EVENT_HOLE_OPENED for every hole that opens in this step. Before the removal.
static void hole_report(const AblatePlan *plan, const StepContext *context, const AblateState *ablate) {
    const Shell *shell = context->shell;
    const StateInput *state = &context->state;
    HoleSearch search = {plan, shell, state, ablate, (float)state->time};

    // most runs have no particle that burnt through now
    const float *burnt = state->burn->time_burnt;
    for (uint32_t first = 0, last; first < shell->particle_count; first = last) {
        int some = 0;
        last = shell->particle_count - first < ABLATE_RUN ? shell->particle_count : first + ABLATE_RUN;
        for (uint32_t i = first; i < last; i++) some |= burnt[i] == search.now;
        for (uint32_t i = first; i < last && some; i++) {
            if (!burnt_now(&search, i) || !(ablate->particle_flags[i] & SINGE_ALIVE) || !hole_opens(&search, i))
                continue;
            event_push(context->events, SINGE_EVENT_HOLE_OPENED, (int32_t)i, state->time, state->dynamics->position[i]);
        }
    }
}

// ---- removal

void remove_spring(Removal *removal, SingeColour colour, uint32_t spring) {
    const Matter *matter = &removal->shell->matter;
    AblateState *ablate = removal->ablate;
    uint8_t *flags = &ablate->spring_flags[colour][spring];
    if (!(*flags & SINGE_ALIVE)) return;

    *flags &= (uint8_t)~SINGE_ALIVE;
    removal->changed = true;
    for (int end = 0; end < 2; end++) {
        uint32_t particle = removal->shell->springs[colour].ends[spring][end];
        if (--ablate->degree[particle] > 0) continue;

        // the particle's last spring
        double above = (double)removal->state->heat->temperature[particle] - (double)removal->heat_ambient;
        ablate->heat_removed += (double)matter->capacity[particle] * above;
        ablate->mass_removed += (double)removal->state->burn->mass[particle] * (double)matter->mass[particle];
        ablate->particle_flags[particle] &= (uint8_t)~SINGE_ALIVE;
        ablate->piece[particle] = -1;
    }
}

/// Removes the sides of a cell that is gone where no other cell has them.
static void remove_sides(Removal *removal, uint32_t cell) {
    for (int i = 0; i < 4; i++) {
        const uint32_t other = shell_neighbour(removal->shell, cell, i);
        if (other == SHELL_NONE || !(removal->ablate->cell_flags[other] & SINGE_ALIVE))
            remove_spring(removal, SINGE_BLUE, removal->shell->cell_springs[cell].blue[i]);
    }
}

// ---- the stage

static Removal removal_begin(AblatePlan *plan, const StepContext *context, AblateState *ablate) {
    return (Removal){.plan = plan,
                     .shell = context->shell,
                     .state = &context->state,
                     .ablate = ablate,
                     .heat_ambient = context->ambient_temperature};
}

void ablate_torn(AblatePlan *plan, const StepContext *context, AblateState *ablate) {
    Removal removal = removal_begin(plan, context, ablate);
    for (uint32_t c = 0; c < context->shell->cell_count;
         c++) // a tear beside a cell that is gone gave it a side of its own
        if (!(ablate->cell_flags[c] & SINGE_ALIVE)) remove_sides(&removal, c);
    piece_update(&removal, context->events);
    ablate->topology_version++;
}

void ablate_step(AblatePlan *plan, const StepContext *context, AblateState *ablate) {
    Removal removal = removal_begin(plan, context, ablate);
    ablate_label(plan, context->shell, ablate);
    ablate_levels(plan, context->shell, context->state.burn);
    hole_report(plan, context, ablate);

    // a cell whose centre is left keeps everything
    const float *level = plan->level + shell_centre(context->shell, 0);
    const uint32_t cells = context->shell->cell_count;
    for (uint32_t first = 0, last; first < cells; first = last) {
        int some = 0;
        last = cells - first < ABLATE_RUN ? cells : first + ABLATE_RUN;
        for (uint32_t c = first; c < last; c++) some |= level[c] < 0;

        for (uint32_t c = first; c < last && some; c++) {
            // whether any of its triangles is left: all have the centre, and each corner has two
            bool left = level[c] >= 0;
            for (int i = 0; i < 4; i++) left |= plan->level[context->shell->cells[c][i]] >= 0;
            if (!(ablate->cell_flags[c] & SINGE_ALIVE) || left) continue;

            const CellSprings *springs = &context->shell->cell_springs[c];
            ablate->cell_flags[c] &= (uint8_t)~SINGE_ALIVE;
            for (int i = 0; i < 4; i++) remove_spring(&removal, SINGE_RED, springs->red[i]);
            for (int i = 0; i < 4; i++)
                if (springs->green[i] != SHELL_NONE) remove_spring(&removal, SINGE_GREEN, springs->green[i]);
            for (int i = 0; i < 2; i++) remove_spring(&removal, SINGE_YELLOW, springs->yellow[i]);
            remove_sides(&removal, c);
            removal.changed = true;
        }
    }

    if (!removal.changed) return;

    piece_update(&removal, context->events);
    ablate->topology_version++;
}
