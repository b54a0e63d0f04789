// The fields of the fine surface's vertices. Velocity, uv and rest position are interpolated linearly between the
// corners of the cell's triangle and its virtual centre. Temperatures and rates follow their splines. The mass is the
// one found with the level. The time of ignition is the weighted mean over the corners that have ignited. Positions and
// normals come from fine_position.c.
#include "surface/surface_fine.h"

/// Interpolates between a triangle's corners: two particles, and the mean of four for the virtual centre.
static Float3 blend(const uint32_t at[4], const FineLocation *location, const float (*field)[4]) {
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        float weight = 0.25f * location->weight[2];
        if (i == location->side) weight += location->weight[0];
        if (i == ((location->side + 1) & 3)) weight += location->weight[1];
        sum = float3_mad(sum, float3_load(field[at[i]]), weight);
    }
    return sum;
}

static float blend_times(const float *time, const uint32_t particle[3], const float weight[3]) {
    float sum = 0, total = 0;
    for (int i = 0; i < 3; i++)
        if (time[particle[i]] >= 0) sum += weight[i] * time[particle[i]], total += weight[i];
    return total > 0 ? sum / total : -1;
}

static void vertices_fill(const Fine *fine, const FinePatch *patch, uint32_t v) {
    const FineVertex *vertex = &fine->vertices[v];
    const FineLocation *location = &vertex->location;
    const Shell *shell = fine->shell;
    const State *state = fine->state;
    const uint32_t *at = shell->cells[location->cell];
    SingeSurface *surface = fine->surface;
    uint32_t centre = shell_centre(shell, location->cell);
    const uint32_t particle[3] = {at[location->side], at[(location->side + 1) & 3], centre};

    // position, velocity, rest position
    fine_position_at(fine, patch, location, surface->position[v], surface->normal[v]);
    float3_store(surface->velocity[v], blend(at, location, (const float(*)[4])state->dynamics.velocity));
    float3_store(surface->rest_position[v], blend(at, location, (const float(*)[4])shell->rest_position));

    // means over the triangle's corners
    float mass_min = 0, yield = 0, u = 0, w = 0;
    for (int i = 0; i < 3; i++) {
        u += location->weight[i] * shell->uv[particle[i]][0];
        w += location->weight[i] * shell->uv[particle[i]][1];
        mass_min += location->weight[i] * field_at(shell->matter.mass_min, particle[i]);
        yield += location->weight[i] * field_at(shell->matter.char_yield, particle[i]);
    }
    surface->uv[v][0] = u;
    surface->uv[v][1] = w;

    // fields by splines
    surface->temperature[v] = fine_spline_at(shell, &fine->splines[SPLINE_TEMPERATURE], *location);
    surface->temperature_peak[v] = fine_spline_at(shell, &fine->splines[SPLINE_PEAK], *location);
    surface->burn_rate[v] = fine_spline_at(shell, &fine->splines[SPLINE_RATE], *location);
    surface->mass[v] = vertex->mass;
    float fuel = fminf(fmaxf(fine_spline_at(shell, &fine->splines[SPLINE_FUEL], *location), 0), 1);
    surface->char_fraction[v] = yield * shell_char(vertex->mass, fuel, mass_min, yield);
    surface->ash_fraction[v] = fmaxf(vertex->mass - fuel - surface->char_fraction[v], 0);
    surface->burn[v] = shell_burn_progress(vertex->mass, mass_min);

    // fields that are not interpolated smoothly
    surface->time_ignited[v] = blend_times(state->burn.time_ignited, particle, location->weight);
    surface->piece[v] = state->ablate.piece[particle[0]];
    surface->sheet[v] = shell->matter.sheet[centre];
    surface->source_vertex[v] = vertex->source == SHELL_NONE ? -1 : shell->source_vertex[vertex->source];
}

static void fill_range(void *context, int begin, int end) {
    const Fine *fine = context;
    FinePatch patch;
    uint32_t cell = SHELL_NONE;
    for (int v = begin; v < end; v++) {
        if (fine->vertices[v].location.cell != cell) {
            cell = fine->vertices[v].location.cell;
            patch = fine_patch(fine, cell);
        }
        vertices_fill(fine, &patch, (uint32_t)v);
    }
}

void fine_vertices(const Fine *fine) {
    pool_for(fine->pool, (int)fine->vertex_count, 256, fill_range, (void *)(uintptr_t)fine);
    fine->surface->vertex_count = fine->vertex_count;
}
