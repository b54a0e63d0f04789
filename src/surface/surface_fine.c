// The drawn surface, refined near the front.
//
// The level of a burning sheet's particles is smoothed (fine_spline.c) and eroded by noise (fine_level.c). Where it
// changes sign within a cell, the cell's triangles are split into k^2 fine ones, k = side / (sqrt(2) detail): their
// points form a square lattice at 45 degrees to the cell with this spacing (fine_points.c). Marching triangles cut them
// (fine_march.c). Nothing of this feeds back into the simulation.
//
// Of a vertex, velocity, uv and rest position are interpolated linearly between the corners of the cell's triangle and
// its virtual centre. Temperatures and rates follow their splines. The mass is the one found with the level. The time of
// ignition is the weighted mean over the corners that have ignited. fine_position.c gives position and normal.
#include "common/real.h"
#include "common/random.h"
#include "surface/surface_fine.h"

#define LEVEL_GONE 0.12f

typedef struct FineArray {
    size_t offset, size, count;
} FineArray;

/// Lists the arrays whose sizes are known from the start, except the splines'. Returns their number.
static int list_arrays(const Fine *fine, FineArray arrays[]) {
    const Shell *shell = fine->shell;
    const size_t cells = shell->cell_count, sides = shell->springs[SINGE_BLUE].count, corners = shell->vertex_count;
    int count = 0;
#define ARRAY(field, number) \
    arrays[count++] = (FineArray) { offsetof(Fine, field), sizeof *fine->field, number }
    if (shell->corner_uv) ARRAY(cell_triangle, cells + 1);
    ARRAY(sheets, shell->sheet_count), ARRAY(raw_level, shell->particle_count);
    ARRAY(normal, shell->particle_count), ARRAY(share, corners), ARRAY(max, corners), ARRAY(corner, corners),
        ARRAY(bend, corners), ARRAY(mesh_room, corners), ARRAY(least, corners);
    ARRAY(sound, cells), ARRAY(valence, corners), ARRAY(regular, corners), ARRAY(inner, cells), ARRAY(rail, sides);
    ARRAY(limit, corners), ARRAY(shift, corners), ARRAY(bent, cells), ARRAY(bent_point, cells), ARRAY(bent_side, sides);
    ARRAY(splits, cells), ARRAY(parts, sides), ARRAY(cell_value, cells), ARRAY(flags, cells);
    ARRAY(axes, cells), ARRAY(cell_point, cells), ARRAY(near, cells), ARRAY(side_point, sides);
    ARRAY(side_owner, sides), ARRAY(side_cut, sides + 1);
#undef ARRAY
    return count;
}

enum { FINE_ARRAYS_MAX = 32 };

// ---- vertices

// Two particles, and the mean of four for the virtual centre.
Float3 fine_blend(const uint32_t at[4], const FineLocation *location, const float (*field)[4]) {
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        float weight = 0.25f * location->weight[2];
        if (i == location->side) weight += location->weight[0];
        if (i == ((location->side + 1) & 3)) weight += location->weight[1];
        sum = float3_mad(sum, float3_load(field[at[i]]), weight);
    }

    return sum;
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
    const DynamicsState *dynamics = &state->dynamics;
    float3_store(surface->velocity[v],
                 surface_velocity(state, fine_blend(at, location, (const float(*)[4])dynamics->position),
                                  fine_blend(at, location, (const float(*)[4])dynamics->earlier),
                                  fine_blend(at, location, (const float(*)[4])dynamics->velocity)));
    float3_store(surface->rest_position[v], fine_blend(at, location, (const float(*)[4])shell->rest_position));

    // means over the triangle's corners
    float mass_min = 0, yield = 0, u = 0, w = 0, water = 0;
    for (int i = 0; i < 3; i++) {
        u += location->weight[i] * shell->uv[particle[i]][0];
        w += location->weight[i] * shell->uv[particle[i]][1];
        mass_min += location->weight[i] * field_at(shell->matter.mass_min, particle[i]);
        yield += location->weight[i] * field_at(shell->matter.char_yield, particle[i]);
        if (state->heat.water) water += location->weight[i] * state->heat.water[particle[i]];
    }
    surface->water[v] = water;

    surface->uv[v][0] = u;
    surface->uv[v][1] = w;

    // fields by splines
    surface->temperature[v] = fine_spline_at(shell, &fine->splines[SPLINE_TEMPERATURE], location);
    surface->temperature_peak[v] = fine_spline_at(shell, &fine->splines[SPLINE_PEAK], location);
    surface->burn_rate[v] = fine_spline_at(shell, &fine->splines[SPLINE_RATE], location);
    surface->mass[v] = vertex->mass;

    float fuel = float_min(float_max(fine_spline_at(shell, &fine->splines[SPLINE_FUEL], location), 0), 1);
    surface->char_fraction[v] = yield * shell_char(vertex->mass, fuel, mass_min, yield);
    surface->ash_fraction[v] = float_max(vertex->mass - fuel - surface->char_fraction[v], 0);
    surface->burn[v] = shell_burn_progress(vertex->mass, mass_min);

    // fields that are not interpolated smoothly
    const float *ignited = state->burn.time_ignited;
    float sum = 0, total = 0;
    for (int i = 0; i < 3; i++) {
        if (!(ignited[particle[i]] >= 0)) continue;

        sum += location->weight[i] * ignited[particle[i]];
        total += location->weight[i];
    }

    surface->time_ignited[v] = total > 0 ? sum / total : -1;
    surface->piece[v] = state->ablate.piece[particle[0]];
    surface->sheet[v] = shell->matter.sheet[centre];
    surface->source_vertex[v] = vertex->source == SHELL_NONE ? -1 : shell->source_vertex[vertex->source];
    if (vertex->render) render_place(fine, vertex, v);
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

// ---- the drawing

SingeResult fine_open(Fine *fine, const SurfaceDetail *detail, SingeError *error) {
    const Shell *shell = fine->shell;
    FineArray arrays[FINE_ARRAYS_MAX];
    const int count = list_arrays(fine, arrays);
    bool ok = true;

    for (int i = 0; i < count && ok; i++) {
        void *block = memory_new(fine->memory, arrays[i].count, arrays[i].size);
        ok = block != NULL;
        memcpy((char *)fine + arrays[i].offset, &block, sizeof block);
    }

    for (int f = 0; f < SPLINE_COUNT && ok; f++)
        ok = NEW(fine->memory, fine->splines[f].edge, shell->springs[SINGE_BLUE].count) &&
             NEW(fine->memory, fine->splines[f].corner, shell->vertex_count);
    if (!ok) return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");

    // how each sheet's cells are split
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const float cell = shell->sheets[s].cell_size, splits = roundf(cell / (1.4142136f * detail->size));
        FineSheet *sheet = &fine->sheets[s];
        sheet->splits = splits < 1 ? 1 : splits > FINE_SPLITS_MAX ? FINE_SPLITS_MAX : (int)splits;
        sheet->reach = float_min(detail->raggedness, 0.5f * cell);
        sheet->octaves = fine_octaves(cell / (1.4142136f * (float)sheet->splits));
        sheet->seed = random_hash(s, 0, 0, detail->seed);
    }

    fine_position(fine);
    return SINGE_OK;
}

void fine_close(Fine *fine) {
    FineArray arrays[FINE_ARRAYS_MAX];
    const int count = list_arrays(fine, arrays);
    for (int i = 0; i < count; i++)
        memory_free(fine->memory, (char *)fine + arrays[i].offset, arrays[i].count, arrays[i].size);

    for (int f = 0; f < SPLINE_COUNT; f++) {
        FREE(fine->memory, fine->splines[f].edge, fine->shell->springs[SINGE_BLUE].count);
        FREE(fine->memory, fine->splines[f].corner, fine->shell->vertex_count);
    }

    FREE(fine->memory, fine->values, fine->point_count);
    FREE(fine->memory, fine->drawn, fine->point_count);
    FREE(fine->memory, fine->cuts, fine->cut_count);
    FREE(fine->memory, fine->vertices, fine->vertex_capacity);
    render_release(fine);
}

static SingeResult fine_draw(Fine *fine, const SurfaceDetail *detail, SingeError *error) {
    const State *state = fine->state;
    TRY(fine_open(fine, detail, error));

    // The level that is smoothed. The mass of a removed particle keeps its value from when it was removed, just below
    // m_loss. There the level keeps falling at its previous rate, so that the edge moves evenly and does not stick to
    // particles:
    //
    //   m' <- min(m', -(1 - m_loss) (t - t_burnt)/(t_burnt - t_ignited)),   to LEVEL_GONE at most
    const BurnState *burn = &state->burn;
    float now = (float)state->time;

    for (uint32_t i = 0; i < fine->shell->particle_count; i++) {
        float level = fine->level[i], burnt = burn->time_burnt[i];
        if (!(state->ablate.particle_flags[i] & SINGE_ALIVE)) level = float_min(level, -1e-4f); // also in a loose piece
        if (level < 0 && burnt >= 0) {
            float loss = 1 - field_at(fine->shell->matter.mass_loss, i), took = burnt - burn->time_ignited[i];
            float gone = loss * (now - burnt);
            level = float_min(level, gone < LEVEL_GONE * took ? -gone / took : -LEVEL_GONE);
        }

        fine->raw_level[i] = level;
    }

    // splines of the fields
    const float *const fields[SPLINE_COUNT] = {[SPLINE_LEVEL] = fine->raw_level,
                                               [SPLINE_MASS] = state->burn.mass,
                                               [SPLINE_FUEL] = state->burn.fuel,
                                               [SPLINE_TEMPERATURE] = state->heat.temperature,
                                               [SPLINE_PEAK] = state->heat.temperature_peak,
                                               [SPLINE_RATE] = state->burn.burn_rate};
    for (int f = 0; f < SPLINE_COUNT; f++)
        if (fields[f]) fine_spline(fine, fields[f], &fine->splines[f]);
    fine_spline_cells(fine, &fine->splines[SPLINE_WHOLE]);

    // points, triangles, vertices, seams
    TRY(fine_points(fine, error));
    TRY(render_levels(fine, error));
    TRY(fine_march(fine, error));
    render_march(fine);

    TRY(surface_reserve_vertices(fine->surface, fine->vertex_count, error));
    pool_for(fine->pool, (int)fine->vertex_count, 256, fill_range, fine);
    fine->surface->vertex_count = fine->vertex_count;
    if (fine->cell_triangle) TRY(surface_seams(fine->shell, fine->cell_triangle, fine->surface, error));
    return SINGE_OK;
}

SingeResult surface_draw_fine(AblatePlan *plan, const Shell *shell, const State *state, const SurfaceDetail *detail,
                              Memory *memory, Pool *pool, SingeSurface *surface, SingeError *error) {
    Fine fine = {.shell = shell, .state = state, .memory = memory, .pool = pool, .surface = surface};
    fine.room = detail->room;
    fine.bulge_max = detail->bulge_max > 0 ? detail->bulge_max : INFINITY;
    fine.level = ablate_levels(plan, shell, &state->burn);
    fine.rim = ablate_rim(plan);

    surface->vertex_count = surface->triangle_count = surface->fine_triangle_count = 0;
    surface->wet = state->heat.water != NULL;
    fine.meshes = detail->meshes;
    fine.mesh_count = detail->mesh_count;
    SingeResult result = fine_draw(&fine, detail, error);

    fine_close(&fine);
    if (result) surface_clear(surface);
    return result;
}
