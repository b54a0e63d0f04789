// The State of a simulation lies in one block, so that saving, restoring and copying it is one memcpy.
#include "shell/shell.h"

#include <string.h>

enum { SLICE = 64 }; // bytes; a cache line, and the widest vector register

/// Takes `count` elements from the block; with a NULL base only the size is counted.
static void *state_take(char *base, size_t *used, size_t count, size_t element_size) {
    void *slice = base ? base + *used : NULL;
    *used += (count * element_size + SLICE - 1) / SLICE * SLICE;
    return slice;
}

#define TAKE(pointer, count) ((pointer) = state_take(base, &used, (count), sizeof *(pointer)))

uint32_t shell_nowhere_count(const Shell *shell) {
    uint32_t max = 1;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *set = &shell->springs[colour];
        for (uint32_t f = 0; f < set->family_count; f++) {
            uint32_t strands = set->family_first[f + 1] - set->family_first[f];
            if (max < strands) max = strands;
        }
    }

    return max;
}

/// Points the arrays into the block at `base`, and stores the block's sizes.
static void lay_out(const Shell *shell, State *state, char *base) {
    size_t used = 0, particles = shell->particle_count;

    // particles and cells
    TAKE(state->dynamics.position, particles + shell_nowhere_count(shell));
    TAKE(state->dynamics.velocity, particles);
    TAKE(state->heat.temperature, particles);
    TAKE(state->heat.temperature_peak, particles);
    if (shell_holds_water(shell)) TAKE(state->heat.water, particles);

    TAKE(state->burn.mass, particles);
    TAKE(state->burn.fuel, particles);
    TAKE(state->burn.burn_rate, particles);
    TAKE(state->burn.release, particles);
    TAKE(state->burn.time_ignited, particles);
    TAKE(state->burn.time_burnt, particles);
    TAKE(state->ablate.piece, particles);
    TAKE(state->ablate.degree, particles);
    TAKE(state->ablate.particle_flags, particles);
    TAKE(state->ablate.cell_flags, shell->cell_count);
    TAKE(state->dynamics.pinned, particles);

    if (shell->creases) {
        TAKE(state->dynamics.bend, shell->springs[SINGE_GREEN].count);
        TAKE(state->dynamics.crease, shell->springs[SINGE_GREEN].count);
    }

    // springs and tears
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        TAKE(state->ablate.spring_flags[colour], shell->springs[colour].count);
    TAKE(state->tear.line_force, shell->spare_count ? shell->cell_count : 0);
    TAKE(state->tear.splits, shell->spare_count);

    // omitted from backups: springs' lengths, and what is written when no stage can fail any more
    state->basic_size = used;
    TAKE(state->dynamics.earlier, shell->vertex_count);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        TAKE(state->burn.spring_length[colour], shell->springs[colour].count);

    // omitted from snapshots, too: what follows from the rest, and what only a step needs
    state->saved_size = used;
    TAKE(state->burn.ash, particles);
    TAKE(state->burn.volume, particles);
    TAKE(state->burn.burns, shell->cell_count);
    state->arena_size = used;
}

/// Bytes before an aligned block. The last one holds the block's offset in its allocation.
enum { LEAD = SLICE };

SingeResult state_create(Memory *memory, const Shell *shell, State *state) {
    *state = (State){0};
    lay_out(shell, state, NULL);
    char *block = memory_new(memory, state->arena_size + LEAD, 1);
    if (!block) {
        *state = (State){0};
        return SINGE_ERROR_MEMORY;
    }

    size_t lead = SLICE - (uintptr_t)block % SLICE; // 1 to 64
    block[lead - 1] = (char)lead;
    state->arena = block + lead;
    lay_out(shell, state, state->arena);

    // springs, except the spares of tears
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        const SpringSet *set = &shell->springs[colour];
        for (uint32_t s = 0; s < set->count; s++) {
            state->burn.spring_length[colour][s] = set->rest[s];
            if (set->rest[s] == 0) continue;
            state->ablate.spring_flags[colour][s] = SINGE_ALIVE;
            for (int k = 0; k < 2; k++) state->ablate.degree[set->ends[s][k]]++;
        }
    }

    // particles, alive if they have springs, and cells
    for (uint32_t p = 0; p < shell->particle_count; p++) {
        const Sheet *sheet = &shell->sheets[shell->matter.sheet[p]];
        bool alive = state->ablate.degree[p] > 0;
        for (int k = 0; k < 3; k++) {
            state->dynamics.position[p][k] = shell->rest_position[p][k];
            state->dynamics.velocity[p][k] = alive ? sheet->velocity[k] : 0;
        }

        state->heat.temperature[p] = state->heat.temperature_peak[p] = field_at(shell->matter.temperature, p);
        if (state->heat.water) state->heat.water[p] = field_at(shell->matter.moisture, p);
        state->burn.mass[p] = state->burn.fuel[p] = state->burn.volume[p] = 1;
        state->burn.time_ignited[p] = state->burn.time_burnt[p] = -1;
        state->ablate.particle_flags[p] = alive ? SINGE_ALIVE : 0;
        state->ablate.piece[p] = alive ? 0 : -1;
    }

    for (uint32_t c = 0; c < shell->cell_count; c++) state->ablate.cell_flags[c] = SINGE_ALIVE;
    state_remember(shell, state, state->arena);
    return SINGE_OK;
}

void state_free(Memory *memory, State *state) {
    if (state->arena) {
        char *arena = state->arena, *block = arena - arena[-1];
        FREE(memory, block, state->arena_size + LEAD);
    }
    *state = (State){0};
}

void state_remember(const Shell *shell, State *state, const void *arena) {
    const ptrdiff_t offset = (const char *)state->dynamics.position - (const char *)state->arena;
    memcpy(state->dynamics.earlier, (const char *)arena + offset,
           shell->vertex_count * sizeof *state->dynamics.earlier);
    state->dynamics.earlier_time = state->time;
}
