// The fields of the fine surface's vertices. Positions and what belongs to them lie on the cell's triangle, straight
// between its corners and its virtual centre; temperatures and rates follow their splines; the mass is what the level
// was taken with. Of times to ignition, those of corners that have ignited count, by their weights.
#include "ablate/surface_fine.h"

/// A triangle's corners: two particles, and the mean of four for the virtual centre.
static Vec blend(const uint32_t at[4], const FinePlace *place, const float (*field)[4]) {
    int a = place->side, b = (a + 1) & 3;
    Vec centre = vec_scale(vec_add(vec_add(vec_load(field[at[0]]), vec_load(field[at[1]])),
                                   vec_add(vec_load(field[at[2]]), vec_load(field[at[3]]))), 0.25f);
    Vec sum = vec_scale(vec_load(field[at[a]]), place->weight[0]);
    return vec_mad(vec_mad(sum, vec_load(field[at[b]]), place->weight[1]), centre, place->weight[2]);
}

static float blend_times(const float *time, const uint32_t particle[3], const float weight[3]) {
    float sum = 0, total = 0;
    for (int i = 0; i < 3; i++)
        if (time[particle[i]] >= 0) sum += weight[i] * time[particle[i]], total += weight[i];
    return total > 0 ? sum / total : -1;
}

static void fill(const Fine *fine, uint32_t v) {
    const FineVertex *vertex = &fine->vertices[v];
    const FinePlace *place = &vertex->place;
    const Shell *shell = fine->shell;
    const State *state = fine->state;
    const uint32_t *at = shell->cells[place->cell];
    SingeSurface *surface = fine->surface;
    uint32_t centre = shell_centre(shell, place->cell);
    const uint32_t particle[3] = {at[place->side], at[(place->side + 1) & 3], centre};
    vec_store(surface->position[v], blend(at, place, (const float (*)[4])state->dynamics.position));
    vec_store(surface->velocity[v], blend(at, place, (const float (*)[4])state->dynamics.velocity));
    vec_store(surface->rest_position[v], blend(at, place, (const float (*)[4])shell->rest_position));
    float mass_min = 0, u = 0, w = 0;
    for (int i = 0; i < 3; i++) {
        u += place->weight[i] * shell->uv[particle[i]][0], w += place->weight[i] * shell->uv[particle[i]][1];
        mass_min += place->weight[i] * field_at(shell->matter.mass_min, particle[i]);
    }
    surface->uv[v][0] = u, surface->uv[v][1] = w;
    surface->temperature[v] = fine_spline_at(shell, &fine->splines[SPLINE_TEMPERATURE], *place);
    surface->temperature_peak[v] = fine_spline_at(shell, &fine->splines[SPLINE_PEAK], *place);
    surface->burn_rate[v] = fine_spline_at(shell, &fine->splines[SPLINE_RATE], *place);
    surface->mass[v] = vertex->mass;
    surface->burn[v] = shell_burn_progress(vertex->mass, mass_min);
    surface->time_ignited[v] = blend_times(state->burn.time_ignited, particle, place->weight);
    surface->piece[v] = state->ablate.piece[particle[0]];
    surface->sheet[v] = shell->matter.sheet[centre];
    surface->source_vertex[v] = vertex->source == SHELL_NONE ? -1 : (int32_t)vertex->source;
}

static void fill_range(void *context, int begin, int end) {
    for (int v = begin; v < end; v++) fill(context, (uint32_t)v);
}

void fine_vertices(const Fine *fine) {
    pool_for(fine->pool, (int)fine->vertex_count, 256, fill_range, (void *)(uintptr_t)fine);
    fine->surface->vertex_count = fine->vertex_count;
}
