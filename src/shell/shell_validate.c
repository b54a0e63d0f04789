#include "shell/shell_validate.h"

#include <math.h>

// ---- the Shell

static const char *validate_sheets(const Shell *shell) {
    uint32_t vertices = 0, cells = 0, spares = 0, used = 0;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        if (sheet->vertex_first != vertices || sheet->cell_first != cells) return "sheets follow each other";
        if (sheet->spare_used > sheet->spare_count) return "a sheet uses no more spares than it has";
        if (sheet->spare_count > sheet->vertex_count) return "spares are vertices of their sheet";
        if (!(sheet->cell_size > 0)) return "cells have a size";
        vertices += sheet->vertex_count;
        cells += sheet->cell_count;
        spares += sheet->spare_count;
        used += sheet->spare_used;
    }
    if (vertices != shell->vertex_count || cells != shell->cell_count) return "sheets hold all vertices and cells";
    if (shell->particle_count != vertices + cells) return "particles are the vertices and the cells' centres";
    if (spares != shell->spare_count || used != shell->split_count) return "every split has used a spare";
    return shell->edge_spare_used > shell->edge_spare_count ? "no more spare springs are used than there are" : NULL;
}

static const char *validate_cells(const Shell *shell) {
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const uint32_t *corner = shell->cells[c];
        const CellSprings *springs = &shell->cell_springs[c];
        for (int i = 0; i < 4; i++) {
            if (corner[i] >= shell->vertex_count) return "corners of cells are vertices";
            if (corner[i] == corner[(i + 1) & 3] || corner[i] == corner[(i + 2) & 3]) return "four corners differ";
            if (springs->red[i] >= shell->springs[SINGE_RED].count) return "red springs exist";
            if (springs->blue[i] >= shell->springs[SINGE_BLUE].count) return "blue springs exist";
            uint32_t green = springs->green[i];
            if (green != SHELL_NONE && green >= shell->springs[SINGE_GREEN].count) return "green springs exist";
        }
        for (int i = 0; i < 2; i++)
            if (springs->yellow[i] >= shell->springs[SINGE_YELLOW].count) return "yellow springs exist";
    }
    return NULL;
}

static const char *validate_springs(const Shell *shell, int colour) {
    const SpringSet *set = &shell->springs[colour];
    for (uint32_t s = 0; s < set->count; s++) {
        const uint32_t *ends = set->ends[s];
        if (ends[0] >= shell->particle_count || ends[1] >= shell->particle_count) return "springs join particles";
        if (!(set->rest[s] >= 0 && isfinite(set->rest[s]))) return "lengths at rest are finite";
        if (set->rest[s] > 0 && ends[0] == ends[1]) return "a spring joins two particles";
    }
    for (uint32_t k = 0; k < set->strand_count; k++)
        if (set->strand_first[k] >= set->strand_first[k + 1]) return "a strand has springs";
    for (uint32_t f = 0; f < set->family_count; f++)
        if (set->family_first[f] > set->family_first[f + 1]) return "families follow each other";
    if (set->strand_count && set->strand_first[set->strand_count] != shell_strand_springs(shell, colour))
        return "strands hold all springs but spares";
    if (set->family_count && set->family_first[set->family_count] != set->strand_count)
        return "families hold all strands";
    return NULL;
}

static const char *validate_fans(const Shell *shell) {
    if (shell->fan_first[0] != 0 || shell->fan_first[shell->vertex_count] > 4 * shell->cell_count)
        return "fans hold each corner of a cell once";
    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        if (shell->fan_first[v] > shell->fan_first[v + 1]) return "fans follow each other";
        for (uint32_t k = shell->fan_first[v]; k < shell->fan_first[v + 1]; k++) {
            if (shell->fan[k] >= shell->cell_count) return "fans hold cells";
            const uint32_t *corner = shell->cells[shell->fan[k]];
            if (corner[0] != v && corner[1] != v && corner[2] != v && corner[3] != v)
                return "the cells of a fan have its vertex";
        }
    }
    return NULL;
}

static const char *validate_families(const Shell *shell) {
    for (uint32_t f = 0; f < shell->cell_family_count; f++)
        if (shell->cell_family_first[f] > shell->cell_family_first[f + 1]) return "families of cells follow each other";
    if (shell->cell_count && shell->cell_family_first[shell->cell_family_count] != shell->cell_count)
        return "families hold all cells";
    for (uint32_t c = 0; c < shell->cell_count; c++)
        if (shell->cell_order[c] >= shell->cell_count) return "families hold cells";
    return NULL;
}

const char *shell_validate(const Shell *shell) {
    const char *broken = validate_sheets(shell);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT && !broken; colour++) broken = validate_springs(shell, colour);
    if (!broken) broken = validate_cells(shell);
    if (!broken) broken = validate_fans(shell);
    return broken ? broken : validate_families(shell);
}

// ---- the State

static const char *validate_particle(const State *state, uint32_t i) {
    const uint8_t flags = state->ablate.particle_flags[i];
    if (flags & ~(SINGE_ALIVE | SINGE_PINNED)) return "particles are alive, pinned or neither";
    if (!!(flags & SINGE_PINNED) != (state->dynamics.pinned[i] > 0)) return "what pins hold is marked";
    if (state->ablate.degree[i] && !(flags & SINGE_ALIVE)) return "springs are alive at particles that are";
    if ((state->ablate.degree[i] > 0) != (state->ablate.piece[i] >= 0)) return "what springs hold is in a piece";
    if (!(state->heat.temperature[i] >= 0 && isfinite(state->heat.temperature[i]))) return "temperatures are finite";
    if (!(state->heat.temperature_peak[i] >= state->heat.temperature[i])) return "the peak is the highest temperature";
    if (!(state->burn.mass[i] >= 0 && state->burn.mass[i] <= 1)) return "a mass fraction is from 0 to 1";
    if (!(state->burn.fuel[i] >= 0 && state->burn.fuel[i] <= 1)) return "a share of fuel is from 0 to 1";
    if (!(state->burn.burn_rate[i] >= 0 && state->burn.release[i] >= 0)) return "burning takes mass and gives heat";
    for (int k = 0; k < 3; k++)
        if (!isfinite(state->dynamics.position[i][k]) || !isfinite(state->dynamics.velocity[i][k]))
            return "positions and velocities are finite";
    return NULL;
}

/// Springs are alive or gone, and degrees count the ends of those alive.
static const char *validate_flags(const Shell *shell, const State *state) {
    uint64_t ends = 0, degrees = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t s = 0; s < shell->springs[colour].count; s++) {
            uint8_t flags = state->ablate.spring_flags[colour][s];
            if (flags & ~SINGE_ALIVE) return "springs are alive or gone";
            if (flags && !(shell->springs[colour].rest[s] > 0)) return "springs that live have a length at rest";
            ends += flags ? 2 : 0;
        }
    for (uint32_t i = 0; i < shell->particle_count; i++) degrees += state->ablate.degree[i];
    for (uint32_t c = 0; c < shell->cell_count; c++)
        if (state->ablate.cell_flags[c] & ~SINGE_ALIVE) return "cells are alive or gone";
    return ends == degrees ? NULL : "degrees count the ends of springs that live";
}

const char *state_validate(const Shell *shell, const State *state) {
    const char *broken = validate_flags(shell, state);
    for (uint32_t i = 0; i < shell->particle_count && !broken; i++) broken = validate_particle(state, i);
    if (!broken && shell->spare_count && state->tear.split_count != shell->split_count)
        broken = "the State lists the splits that made the Shell";
    return broken;
}
