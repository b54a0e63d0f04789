#include "shell/shell_validate.h"

#include "common/format.h"

static const char *const COLOURS[SINGE_COLOUR_COUNT] = {
    [SINGE_RED] = "red", [SINGE_GREEN] = "green", [SINGE_BLUE] = "blue", [SINGE_YELLOW] = "yellow"};

/// Writes what is wrong. Returns false, for the validators to return.
SINGE_PRINTF(2, 3) static bool fault_is(ShellFault *fault, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    text_print(fault->text, sizeof fault->text, format, arguments);
    va_end(arguments);
    return false;
}

// ---- the Shell

static bool validate_sheets(const Shell *shell, ShellFault *fault) {
    uint32_t vertices = 0, cells = 0, spares = 0, used = 0;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        if (sheet->vertex_first != vertices)
            return fault_is(fault, "sheet %u begins at vertex %u, not %u", s, sheet->vertex_first, vertices);
        if (sheet->cell_first != cells)
            return fault_is(fault, "sheet %u begins at cell %u, not %u", s, sheet->cell_first, cells);
        if (sheet->spare_used > sheet->spare_count)
            return fault_is(fault, "sheet %u uses %u spares, but has %u", s, sheet->spare_used, sheet->spare_count);
        if (sheet->spare_count > sheet->vertex_count)
            return fault_is(fault, "sheet %u has %u vertices, fewer than its spares", s, sheet->vertex_count);
        if (!(sheet->cell_size > 0)) return fault_is(fault, "the cells of sheet %u have no size", s);

        vertices += sheet->vertex_count;
        cells += sheet->cell_count;
        spares += sheet->spare_count;
        used += sheet->spare_used;
    }

    if (vertices != shell->vertex_count)
        return fault_is(fault, "the sheets have %u vertices, the shell %u", vertices, shell->vertex_count);
    if (cells != shell->cell_count)
        return fault_is(fault, "the sheets have %u cells, the shell %u", cells, shell->cell_count);
    if (shell->particle_count != vertices + cells)
        return fault_is(fault, "there are %u particles of %u vertices and cells", shell->particle_count,
                        vertices + cells);
    if (spares != shell->spare_count)
        return fault_is(fault, "the sheets have %u spares, the shell %u", spares, shell->spare_count);
    if (used != shell->split_count) return fault_is(fault, "%u splits have used %u spares", shell->split_count, used);
    if (shell->edge_spare_used > shell->edge_spare_count)
        return fault_is(fault, "tears use %u spare springs, but there are %u", shell->edge_spare_used,
                        shell->edge_spare_count);

    return true;
}

static bool validate_cells(const Shell *shell, ShellFault *fault) {
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const uint32_t *corner = shell->cells[c];
        const CellSprings *springs = &shell->cell_springs[c];

        for (int i = 0; i < 4; i++) {
            if (corner[i] >= shell->vertex_count)
                return fault_is(fault, "cell %u names corner %u of %u vertices", c, corner[i], shell->vertex_count);
            for (int j = 0; j < i; j++)
                if (corner[i] == corner[j]) return fault_is(fault, "cell %u names corner %u twice", c, corner[i]);
        }

        const uint32_t *const named[SINGE_COLOUR_COUNT] = {[SINGE_RED] = springs->red,
                                                           [SINGE_GREEN] = springs->green,
                                                           [SINGE_BLUE] = springs->blue,
                                                           [SINGE_YELLOW] = springs->yellow};
        for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
            for (int i = 0; i < (colour == SINGE_YELLOW ? 2 : 4); i++) {
                uint32_t spring = named[colour][i], count = shell->springs[colour].count;
                if (spring >= count && !(colour == SINGE_GREEN && spring == SHELL_NONE))
                    return fault_is(fault, "cell %u names %s spring %u of %u", c, COLOURS[colour], spring, count);
            }
    }

    return true;
}

static bool validate_springs(const Shell *shell, int colour, ShellFault *fault) {
    const SpringSet *set = &shell->springs[colour];
    const char *name = COLOURS[colour];

    for (uint32_t s = 0; s < set->count; s++) {
        const uint32_t *ends = set->ends[s];
        for (int k = 0; k < 2; k++)
            if (ends[k] >= shell->particle_count)
                return fault_is(fault, "%s spring %u ends at particle %u of %u", name, s, ends[k],
                                shell->particle_count);
        if (!(set->rest[s] >= 0 && isfinite(set->rest[s])))
            return fault_is(fault, "%s spring %u has length %g at rest", name, s, (double)set->rest[s]);
        if (set->rest[s] > 0 && ends[0] == ends[1])
            return fault_is(fault, "%s spring %u has both ends at particle %u", name, s, ends[0]);
    }

    uint32_t in_strands = shell_strand_springs(shell, colour);
    for (uint32_t k = 0; k < set->strand_count; k++)
        if (set->strand_first[k] >= set->strand_first[k + 1])
            return fault_is(fault, "%s strand %u has no springs", name, k);
    for (uint32_t f = 0; f < set->family_count; f++)
        if (set->family_first[f] > set->family_first[f + 1])
            return fault_is(fault, "%s family %u ends before it begins", name, f);

    if (set->strand_count && set->strand_first[set->strand_count] != in_strands)
        return fault_is(fault, "the %s strands hold %u springs of %u", name, set->strand_first[set->strand_count],
                        in_strands);
    if (set->family_count && set->family_first[set->family_count] != set->strand_count)
        return fault_is(fault, "the %s families hold %u strands of %u", name, set->family_first[set->family_count],
                        set->strand_count);

    return true;
}

/// The cells around each vertex, and the families of cells.
static bool validate_fans(const Shell *shell, ShellFault *fault) {
    const uint32_t *first = shell->fan_first, *family = shell->cell_family_first;
    if (first[0] != 0) return fault_is(fault, "the fan of vertex 0 begins at %u", first[0]);
    if (first[shell->vertex_count] > 4 * shell->cell_count)
        return fault_is(fault, "the fans hold %u cells, more than there are corners", first[shell->vertex_count]);

    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        if (first[v] > first[v + 1]) return fault_is(fault, "the fan of vertex %u ends before it begins", v);

        for (uint32_t k = first[v]; k < first[v + 1]; k++) {
            uint32_t cell = shell->fan[k];
            if (cell >= shell->cell_count)
                return fault_is(fault, "the fan of vertex %u names cell %u of %u", v, cell, shell->cell_count);
            const uint32_t *corner = shell->cells[cell];
            if (corner[0] != v && corner[1] != v && corner[2] != v && corner[3] != v)
                return fault_is(fault, "cell %u is in the fan of vertex %u, which is none of its corners", cell, v);
        }
    }

    for (uint32_t f = 0; f < shell->cell_family_count; f++)
        if (family[f] > family[f + 1]) return fault_is(fault, "family %u of cells ends before it begins", f);
    if (shell->cell_count && family[shell->cell_family_count] != shell->cell_count)
        return fault_is(fault, "the families hold %u cells of %u", family[shell->cell_family_count], shell->cell_count);

    for (uint32_t c = 0; c < shell->cell_count; c++)
        if (shell->cell_order[c] >= shell->cell_count)
            return fault_is(fault, "the families name cell %u of %u", shell->cell_order[c], shell->cell_count);

    return true;
}

bool shell_validate(const Shell *shell, ShellFault *fault) {
    if (!validate_sheets(shell, fault)) return false;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        if (!validate_springs(shell, colour, fault)) return false;
    return validate_cells(shell, fault) && validate_fans(shell, fault);
}

// ---- the State

static bool validate_particle(const State *state, uint32_t i, ShellFault *fault) {
    const uint8_t flags = state->ablate.particle_flags[i], pins = state->dynamics.pinned[i];
    const double T = (double)state->heat.temperature[i], peak = (double)state->heat.temperature_peak[i];
    const double mass = (double)state->burn.mass[i], fuel = (double)state->burn.fuel[i];
    const int degree = state->ablate.degree[i], piece = state->ablate.piece[i];

    if (flags & ~(SINGE_ALIVE | SINGE_PINNED)) return fault_is(fault, "particle %u has flags 0x%x", i, flags);
    if (!!(flags & SINGE_PINNED) != (pins > 0))
        return fault_is(fault, "%d pins hold particle %u, whose flags say otherwise", pins, i);
    if (degree && !(flags & SINGE_ALIVE)) return fault_is(fault, "particle %u is gone, but has %d springs", i, degree);
    if ((degree > 0) != (piece >= 0))
        return fault_is(fault, "particle %u has %d springs in piece %d", i, degree, piece);
    if (!(T >= 0 && isfinite(T))) return fault_is(fault, "particle %u has temperature %g", i, T);
    if (!(peak >= T)) return fault_is(fault, "particle %u has temperature %g above its peak %g", i, T, peak);
    if (!(mass >= 0 && mass <= 1)) return fault_is(fault, "particle %u has mass fraction %g", i, mass);
    if (!(fuel >= 0 && fuel <= 1)) return fault_is(fault, "particle %u has fuel %g", i, fuel);
    if (!(state->burn.burn_rate[i] >= 0)) return fault_is(fault, "particle %u gains mass by burning", i);
    if (!(state->burn.release[i] >= 0)) return fault_is(fault, "particle %u is cooled by burning", i);

    for (int k = 0; k < 3; k++)
        if (!isfinite(state->dynamics.position[i][k]) || !isfinite(state->dynamics.velocity[i][k]))
            return fault_is(fault, "particle %u has a position or velocity that is not finite", i);

    return true;
}

bool state_validate(const Shell *shell, const State *state, ShellFault *fault) {
    // springs and cells are alive or gone; degrees count the ends of those alive
    uint64_t ends = 0, degrees = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t s = 0; s < shell->springs[colour].count; s++) {
            uint8_t flags = state->ablate.spring_flags[colour][s];
            if (flags & ~SINGE_ALIVE) return fault_is(fault, "%s spring %u has flags 0x%x", COLOURS[colour], s, flags);
            if (flags && !(shell->springs[colour].rest[s] > 0))
                return fault_is(fault, "%s spring %u is alive, but has no length at rest", COLOURS[colour], s);
            ends += flags ? 2 : 0;
        }

    for (uint32_t c = 0; c < shell->cell_count; c++)
        if (state->ablate.cell_flags[c] & ~SINGE_ALIVE)
            return fault_is(fault, "cell %u has flags 0x%x", c, state->ablate.cell_flags[c]);
    for (uint32_t i = 0; i < shell->particle_count; i++) degrees += state->ablate.degree[i];
    if (ends != degrees)
        return fault_is(fault, "live springs have %llu ends, the particles' degrees sum to %llu",
                        (unsigned long long)ends, (unsigned long long)degrees);

    for (uint32_t i = 0; i < shell->particle_count; i++)
        if (!validate_particle(state, i, fault)) return false;
    if (shell->spare_count && state->tear.split_count != shell->split_count)
        return fault_is(fault, "the state lists %u splits, the shell has %u", state->tear.split_count,
                        shell->split_count);

    return true;
}

void shell_assert(const Shell *shell, const State *state) {
#ifdef SINGE_ASSERTIONS
    ShellFault fault;
    if (!shell_validate(shell, &fault) || !state_validate(shell, state, &fault))
        assertion_failed(fault.text, __FILE__, __LINE__);
#else
    (void)shell;
    (void)state;
#endif
}
