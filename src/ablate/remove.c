// Removal (section 6): "if both triangles that share a spring disappear, we remove that spring".
//
// Triangle i of a cell joins corners i and i + 1 and the virtual centre. It is gone when its three levels are negative;
// mass never grows, so it stays gone. Then
//
//   blue   i goes when triangle i and the one across side i (none at the boundary) are gone
//   red    i goes when triangles i - 1 and i are gone
//   yellow   goes when its cell's four triangles are gone
//   green    goes when either of its cells' four triangles are gone
//
// and a particle goes with its last spring, with its mass and its enthalpy C (T - T_amb). The mass that it burnt in the
// step that removes it is in mass_burnt, but that step's heat of combustion is not released: heat is released in the
// next step, to particles that are then alive. It is not counted either, so that the ledger closes.
#include "ablate/ablate_plan.h"

static void remove_particle(Removal *removal, uint32_t particle) {
    const Matter *matter = &removal->shell->matter;
    AblateState *ablate = removal->ablate;
    double above = (double)removal->state->heat->temperature[particle] - (double)removal->heat_ambient;
    ablate->heat_removed += (double)matter->capacity[particle] * above;
    ablate->mass_removed += (double)removal->state->burn->mass[particle] * (double)matter->mass[particle];
    ablate->particle_flags[particle] &= (uint8_t)~SINGE_ALIVE;
    ablate->piece[particle] = -1;
}

void remove_spring(Removal *removal, SingeColour colour, uint32_t spring) {
    AblateState *ablate = removal->ablate;
    uint8_t *flags = &ablate->spring_flags[colour][spring];
    if (!(*flags & SINGE_ALIVE)) return;
    *flags &= (uint8_t)~SINGE_ALIVE;
    removal->changed = true;
    for (int end = 0; end < 2; end++) {
        uint32_t particle = removal->shell->springs[colour].ends[spring][end];
        if (--ablate->degree[particle] == 0) remove_particle(removal, particle);
    }
}

/// Whether the triangle across side i is gone, or never existed. The two share the side's corners, so only the other
/// centre remains to be checked.
static bool gone_across(const Removal *removal, uint32_t cell, int i) {
    uint32_t other = shell_neighbour(removal->shell, cell, i);
    if (other == SHELL_NONE || !(removal->ablate->cell_flags[other] & SINGE_ALIVE)) return true;
    return removal->plan->level[shell_centre(removal->shell, other)] < 0;
}

static void remove_from_cell(Removal *removal, uint32_t cell) {
    const CellSprings *springs = &removal->shell->cell_springs[cell];
    unsigned left = ablate_triangles(removal->plan, removal->shell, cell);
    for (int i = 0; i < 4; i++) {
        if (left >> i & 1) continue;
        if (!(left >> ((i + 3) & 3) & 1)) remove_spring(removal, SINGE_RED, springs->red[i]);
        if (gone_across(removal, cell, i)) remove_spring(removal, SINGE_BLUE, springs->blue[i]);
    }
    if (left) return;
    for (int i = 0; i < 4; i++)
        if (springs->green[i] != SHELL_NONE) remove_spring(removal, SINGE_GREEN, springs->green[i]);
    for (int i = 0; i < 2; i++) remove_spring(removal, SINGE_YELLOW, springs->yellow[i]);
    removal->ablate->cell_flags[cell] &= (uint8_t)~SINGE_ALIVE;
    removal->changed = true;
}

void remove_burnt(Removal *removal) {
    const float *centre_level = removal->plan->level + removal->shell->vertex_count;
    const uint8_t *flags = removal->ablate->cell_flags;
    for (uint32_t c = 0; c < removal->shell->cell_count; c++) // a cell whose centre is left keeps everything
        if (centre_level[c] < 0 && flags[c] & SINGE_ALIVE) remove_from_cell(removal, c);
}
