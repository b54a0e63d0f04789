// The effect of a split on the State: the new particle copies the old one, and the edges of a tear separate slightly.
#include "shell/cross.h"
#include "tear/tear_plan.h"

#include <string.h>

/// How far each edge of a tear moves towards the centroid of its own cells, as a fraction of the distance: they never
/// coincide, so that contact can tell their sides from the start. It is less than the gap that contact keeps
/// (collision/collision_plan.h), as contact does not check this displacement.
static const float TEAR_EDGE_GAP = 0.002f;

#define COPY(array, to, from) memcpy((array) + (to), (array) + (from), sizeof *(array))

static uint16_t split_alive(const State *state, SingeColour colour, uint32_t spring) {
    return state->ablate.spring_flags[colour][spring] & SINGE_ALIVE;
}

/// Counts the live springs at a corner.
static void count_degree(const Shell *shell, State *state, uint32_t vertex) {
    uint16_t degree = 0;
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++) {
        uint32_t cell = shell->fan[k];
        const CellSprings *springs = &shell->cell_springs[cell];
        int i = 0;
        while (shell->cells[cell][i] != vertex) i++;

        int after = (i + 3) & 3;
        degree = (uint16_t)(degree + split_alive(state, SINGE_RED, springs->red[i]) +
                            split_alive(state, SINGE_YELLOW, springs->yellow[i & 1]) +
                            split_alive(state, SINGE_BLUE, springs->blue[i]));
        if (springs->green[after] == SHELL_NONE)
            degree = (uint16_t)(degree + split_alive(state, SINGE_BLUE, springs->blue[after]));
    }

    state->ablate.degree[vertex] = degree;
}

/// From a tear edge to the mean of its cells' corners.
static Float3 tear_edge_displacement(const Shell *shell, const State *state, uint32_t vertex) {
    Float3 sum = {0, 0, 0};
    uint32_t first = shell->fan_first[vertex], last = shell->fan_first[vertex + 1];
    for (uint32_t k = first; k < last; k++)
        for (int i = 0; i < 4; i++)
            sum = float3_add(sum, float3_load(state->dynamics.position[shell->cells[shell->fan[k]][i]]));
    return float3_sub(float3_scale(sum, 0.25f / (float)(last - first)), float3_load(state->dynamics.position[vertex]));
}

static bool tear_edges_cross(const Shell *shell, const State *state, uint32_t one, uint32_t two) {
    const uint32_t *first = shell->fan_first, *fan = shell->fan;
    const uint8_t *flags = state->ablate.cell_flags;

    for (uint32_t k = first[one]; k < first[one + 1]; k++)
        for (uint32_t l = first[two]; l < first[two + 1]; l++)
            if ((flags[fan[k]] & flags[fan[l]] & SINGE_ALIVE) &&
                cross_cells(shell, (const float(*)[4])state->dynamics.position, fan[k], fan[l]))
                return true;

    return false;
}

void tear_split(Shell *shell, State *state, const Fan *fan, const ShellSplit *split, SplitResult *result) {
    *result = split_vertex(shell, fan, split);
    uint32_t from = split->vertex, to = result->spare;
    state->tear.splits[state->tear.split_count++] = (ShellSplit){from, split->cells, to};
    COPY(state->heat.temperature, to, from);
    COPY(state->heat.temperature_peak, to, from);
    if (state->heat.water) COPY(state->heat.water, to, from);

    COPY(state->burn.mass, to, from);
    COPY(state->burn.fuel, to, from);
    COPY(state->burn.ash, to, from);
    COPY(state->burn.volume, to, from);
    COPY(state->burn.burn_rate, to, from);
    COPY(state->burn.release, to, from);
    COPY(state->burn.time_ignited, to, from);
    COPY(state->burn.time_burnt, to, from);
    COPY(state->ablate.piece, to, from);
    COPY(state->ablate.particle_flags, to, from);
    COPY(state->dynamics.position, to, from);
    COPY(state->dynamics.velocity, to, from);
    COPY(state->dynamics.earlier, to, from);

    // a torn edge gets a second spring, and the green spring across it is removed
    for (int k = 0; k < result->torn_count; k++) {
        const TornEdge *torn = &result->torn[k];
        COPY(state->ablate.spring_flags[SINGE_BLUE], torn->spare, torn->edge);
        COPY(state->burn.spring_length[SINGE_BLUE], torn->spare, torn->edge);
        if (!split_alive(state, SINGE_GREEN, torn->green)) continue;
        state->ablate.spring_flags[SINGE_GREEN][torn->green] &= (uint8_t)~SINGE_ALIVE;
        for (int end = 0; end < 2; end++) state->ablate.degree[shell->springs[SINGE_GREEN].ends[torn->green][end]]--;
    }

    for (int k = 0; k < result->torn_count; k++) count_degree(shell, state, result->torn[k].far);
    count_degree(shell, state, from);
    count_degree(shell, state, to);

    // Each of two coincident edges of a tear moves towards its cells. If the sheet is crumpled there, they may then
    // intersect: they move along the first of 26 directions in which they do not.
    enum { DIRECTIONS = 27 };
    float *x = state->dynamics.position[from], *y = state->dynamics.position[to];
    Float3 position = float3_load(x),
           displacements[2] = {tear_edge_displacement(shell, state, from), tear_edge_displacement(shell, state, to)};
    float length = TEAR_EDGE_GAP * 0.5f * (float3_length(displacements[0]) + float3_length(displacements[1]));

    float3_store(x, float3_mad(position, displacements[0], TEAR_EDGE_GAP));
    float3_store(y, float3_mad(position, displacements[1], TEAR_EDGE_GAP));

    for (int k = 0; k < DIRECTIONS && tear_edges_cross(shell, state, from, to); k++) {
        Float3 displacement = float3_unit(float3((float)(k % 3 - 1), (float)(k / 3 % 3 - 1), (float)(k / 9 - 1)));
        float3_store(x, float3_mad(position, displacement, length));
        float3_store(y, float3_mad(position, displacement, -length));
    }
}
