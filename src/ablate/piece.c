// Pieces: particles that are connected by springs.
//
// Disjoint sets over the live springs, with path halving; the root of a set is its smallest particle, so that the
// result does not depend on the order of the springs. Red springs suffice: they join all particles of each cell that is
// left, every other spring that is left lies in such a cell or joins two that share a side, and with its red springs a
// cell goes whole (ablate_step.c). When a piece falls apart, the part with most particles keeps its
// id (among equals the one with the smallest particle); the others get new ids in order of their smallest particle. A
// particle without springs belongs to no piece.
#include "common/assertion.h"
#include "ablate/ablate_plan.h"

#include <string.h>

enum { PIECE_HELD = 1, PIECE_DROPPED = 2 };

static uint32_t piece_find(uint32_t *root, uint32_t i) {
    while (root[i] != i) {
        root[i] = root[root[i]];
        i = root[i];
    }

    return i;
}

/// Sets plan->root[i] to the smallest particle that is connected with i.
static void find_sets(AblatePlan *plan, const Shell *shell, const AblateState *ablate) {
    uint32_t *root = plan->root;
    for (uint32_t i = 0; i < shell->particle_count; i++) root[i] = i;

    const SpringSet *red = &shell->springs[SINGE_RED];
    const uint8_t *flags = ablate->spring_flags[SINGE_RED];
    for (uint32_t s = 0; s < red->count; s++) {
        if (!(flags[s] & SINGE_ALIVE)) continue;
        uint32_t a = piece_find(root, red->ends[s][0]), b = piece_find(root, red->ends[s][1]);
        if (a < b) root[b] = a;
        else root[a] = b;
    }

    // a root precedes the other particles of its set, so one lookup is enough
    for (uint32_t i = 0; i < shell->particle_count; i++) root[i] = root[root[i]];
}

/// Marks a sheet's small loose pieces; its largest stays whatever its size. The root of a piece is a corner: every
/// piece has one, and corners come first.
static bool mark_small(AblatePlan *plan, const Sheet *sheet) {
    uint32_t first = sheet->vertex_first, last = first + sheet->vertex_count, largest = SHELL_NONE;
    bool any = false;

    for (uint32_t r = first; r < last; r++)
        if (plan->size[r] && (largest == SHELL_NONE || plan->area[r] > plan->area[largest])) largest = r;
    for (uint32_t r = first; r < last; r++) {
        if (!plan->size[r] || r == largest || plan->mark[r] & PIECE_HELD) continue;
        if (!(plan->area[r] < (double)sheet->drop_pieces_below)) continue;

        plan->mark[r] |= PIECE_DROPPED;
        any = true;
    }

    return any;
}

static bool is_piece(const AblatePlan *plan, uint32_t root) {
    return plan->size[root] > 0 && !(plan->mark[root] & PIECE_DROPPED);
}

/// Gives every particle the id of its root.
static void spread_ids(const AblatePlan *plan, AblateState *ablate) {
    for (uint32_t i = 0; i < plan->particle_count; i++)
        ablate->piece[i] = ablate->degree[i] ? ablate->piece[plan->root[i]] : -1;
}

void ablate_label(AblatePlan *plan, const Shell *shell, AblateState *ablate) {
    if (ablate->next_piece) return;
    find_sets(plan, shell, ablate);
    for (uint32_t i = 0; i < shell->particle_count; i++)
        if (plan->root[i] == i && ablate->degree[i]) ablate->piece[i] = (int32_t)ablate->next_piece++;
    ablate->piece_count = ablate->next_piece;
    spread_ids(plan, ablate);
}

void piece_update(Removal *removal, EventList *events) {
    AblatePlan *plan = removal->plan;
    const Shell *shell = removal->shell;
    const StateInput *state = removal->state;
    AblateState *ablate = removal->ablate;
    find_sets(plan, shell, ablate);

    // size, area and pins of every set, at its root
    memset(plan->size, 0, shell->particle_count * sizeof *plan->size);
    memset(plan->mark, 0, shell->particle_count);
    for (uint32_t i = 0; i < shell->particle_count; i++) plan->area[i] = 0;

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        if (ablate->degree[i] == 0) continue;

        uint32_t root = plan->root[i];
        plan->size[root]++;
        if (i < shell->vertex_count) plan->area[root] += (double)shell->matter.area[i];
        if (state->dynamics->pinned[i]) plan->mark[root] |= PIECE_HELD;
    }

    // small loose pieces go whole: cells, springs and, with their last spring, particles
    bool drop = false;
    for (uint32_t s = 0; s < shell->sheet_count; s++) drop |= mark_small(plan, &shell->sheets[s]);
    for (uint32_t c = 0; drop && c < shell->cell_count; c++)
        if (plan->mark[plan->root[shell->cells[c][0]]] & PIECE_DROPPED) ablate->cell_flags[c] &= (uint8_t)~SINGE_ALIVE;
    for (int colour = 0; drop && colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t s = 0; s < shell->springs[colour].count; s++)
            if (plan->mark[plan->root[shell->springs[colour].ends[s][0]]] & PIECE_DROPPED)
                remove_spring(removal, (SingeColour)colour, s);

    // for every id, the root of the part that keeps it
    memset(plan->heir, 0xff, plan->particle_count * sizeof *plan->heir);
    for (uint32_t r = 0; r < plan->particle_count; r++) {
        if (!is_piece(plan, r)) continue;

        uint32_t *heir = &plan->heir[ablate->piece[r]];
        if (*heir == SHELL_NONE || plan->size[r] > plan->size[*heir]) *heir = r;
    }

    // new ids for the others
    ablate->piece_count = 0;
    for (uint32_t r = 0; r < plan->particle_count; r++) {
        if (!is_piece(plan, r)) continue;

        ablate->piece_count++;
        if (plan->heir[ablate->piece[r]] == r) continue;
        ablate->piece[r] = (int32_t)ablate->next_piece++;
        SINGE_ASSERT(ablate->next_piece <= plan->particle_count); // as ablate_fits requires of a snapshot
        event_push(events, SINGE_EVENT_PIECE_FREED, ablate->piece[r], state->time, state->dynamics->position[r]);
    }

    spread_ids(plan, ablate);
}

// ---- what was read back

bool ablate_fits(AblatePlan *plan, const Shell *shell, const AblateState *ablate) {
    // flags, and a count of the springs at their ends
    memset(plan->size, 0, shell->particle_count * sizeof *plan->size);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *springs = &shell->springs[colour];
        for (uint32_t s = 0; s < springs->count; s++) {
            uint8_t flags = ablate->spring_flags[colour][s];
            if ((flags & ~SINGE_ALIVE) || (flags && !(springs->rest[s] > 0))) return false;
            for (int k = 0; k < 2 && flags; k++) plan->size[springs->ends[s][k]]++;
        }
    }

    for (uint32_t c = 0; c < shell->cell_count; c++)
        if (ablate->cell_flags[c] & ~SINGE_ALIVE) return false;

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        uint8_t flags = ablate->particle_flags[i];
        if ((flags & ~(SINGE_ALIVE | SINGE_PINNED)) || (ablate->degree[i] && !(flags & SINGE_ALIVE))) return false;
        if (plan->size[i] != ablate->degree[i]) return false;
    }

    // pieces. One that falls apart takes a new id for each part but one, so it may need as many ids as it has particles,
    // less one. Spare vertices may become parts, too
    uint64_t pieces = 0, particles = 0;
    find_sets(plan, shell, ablate);
    memset(plan->heir, 0xff, shell->particle_count * sizeof *plan->heir);

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        int32_t piece = ablate->piece[i];
        uint32_t root = plan->root[i];

        particles += ablate->degree[i] > 0 || (shell_is_corner(shell, i) && shell_is_spare(shell, i));
        if ((ablate->degree[i] > 0) != (piece >= 0) || piece < -1) return false;
        if (piece < 0) continue;
        if ((uint32_t)piece >= ablate->next_piece || piece != ablate->piece[root]) return false;
        if ((uint32_t)piece >= shell->particle_count) return false;
        if (root == i && plan->heir[piece] != SHELL_NONE) return false;
        if (root != i) continue;

        plan->heir[piece] = i;
        pieces++;
    }

    return pieces == ablate->piece_count && ablate->next_piece + particles <= shell->particle_count + pieces;
}
