// The drawn surface, refined near the front.
//
// The level of a burning sheet's particles is smoothed (fine_spline.c) and eroded by noise (fine_noise.c). Where it
// changes sign within a cell, the cell's triangles are split into k^2 fine ones, k = side / (sqrt(2) detail): their
// points form a square lattice at 45 degrees to the cell with this spacing (fine_points.c). Marching triangles cut them
// (fine_march.c), and fields are evaluated at the vertices (fine_vertices.c). Nothing of this feeds back into the
// simulation.
#include "surface/surface_fine.h"
#include "common/random.h"

#include <string.h>

#define LEVEL_GONE 0.12f

static FineSheet fine_describe(const SurfaceDetail *detail, const Sheet *sheet, uint32_t index) {
    float splits = roundf(sheet->cell_size / (1.4142136f * detail->size));
    FineSheet fine = {.splits = splits < 1 ? 1 : splits > FINE_SPLITS_MAX ? FINE_SPLITS_MAX : (int)splits};
    float spacing = sheet->cell_size / (1.4142136f * (float)fine.splits);
    fine.reach = fminf(detail->raggedness, 0.5f * sheet->cell_size);
    fine.octaves = fine_octaves(spacing);
    fine.seed = random_hash(index, 0, 0, detail->seed);
    return fine;
}

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
    ARRAY(normal, shell->particle_count), ARRAY(share, corners), ARRAY(max, corners), ARRAY(corner, corners);
    ARRAY(sound, cells), ARRAY(valence, corners), ARRAY(regular, corners), ARRAY(inner, cells), ARRAY(rail, sides);
    ARRAY(limit, corners), ARRAY(shift, corners), ARRAY(bent, cells), ARRAY(bent_point, cells), ARRAY(bent_side, sides);
    ARRAY(splits, cells), ARRAY(parts, sides), ARRAY(cell_value, cells), ARRAY(low, cells), ARRAY(flags, cells);
    ARRAY(axes, cells), ARRAY(cell_point, cells), ARRAY(near, cells), ARRAY(side_point, sides);
    ARRAY(side_owner, sides), ARRAY(side_cut, sides + 1);
#undef ARRAY
    return count;
}

enum { FINE_ARRAYS_MAX = 32 };

static bool fine_allocate(Fine *fine) {
    FineArray arrays[FINE_ARRAYS_MAX];
    int count = list_arrays(fine, arrays);
    for (int i = 0; i < count; i++) {
        void *block = memory_new(fine->memory, arrays[i].count, arrays[i].size);
        if (!block) return false;
        memcpy((char *)fine + arrays[i].offset, &block, sizeof block);
    }
    for (int f = 0; f < SPLINE_COUNT; f++)
        if (!NEW(fine->memory, fine->splines[f].edge, fine->shell->springs[SINGE_BLUE].count) ||
            !NEW(fine->memory, fine->splines[f].corner, fine->shell->vertex_count))
            return false;
    return true;
}

static void fine_release(Fine *fine) {
    FineArray arrays[FINE_ARRAYS_MAX];
    int count = list_arrays(fine, arrays);
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
}

/// The level that is smoothed. The mass of a removed particle keeps its value from when it was removed, just below
/// m_loss. There the level keeps falling at its previous rate, so that the edge moves evenly and does not stick to
/// particles:
///
///   m' <- min(m', -(1 - m_loss) (t - t_burnt)/(t_burnt - t_ignited)),   to LEVEL_GONE at most
static void fill_levels(Fine *fine) {
    const State *state = fine->state;
    const BurnState *burn = &state->burn;
    float now = (float)state->time;
    for (uint32_t i = 0; i < fine->shell->particle_count; i++) {
        float level = fine->plan->level[i], burnt = burn->time_burnt[i];
        if (!(state->ablate.particle_flags[i] & SINGE_ALIVE)) level = fminf(level, -1e-4f); // also in a loose piece
        if (level < 0 && burnt >= 0) {
            float loss = 1 - field_at(fine->shell->matter.mass_loss, i), took = burnt - burn->time_ignited[i];
            float gone = loss * (now - burnt);
            level = fminf(level, gone < LEVEL_GONE * took ? -gone / took : -LEVEL_GONE);
        }
        fine->raw_level[i] = level;
    }
}

static SingeResult fine_draw(Fine *fine, const SurfaceDetail *detail, SingeError *error) {
    const State *state = fine->state;
    if (!fine_allocate(fine))
        return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");
    for (uint32_t s = 0; s < fine->shell->sheet_count; s++)
        fine->sheets[s] = fine_describe(detail, &fine->shell->sheets[s], s);
    fill_levels(fine);

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
    fine_position(fine);
    TRY(fine_points(fine, error));
    TRY(fine_march(fine, error));
    TRY(surface_reserve_vertices(fine->surface, fine->vertex_count, error));
    fine_vertices(fine);
    if (fine->cell_triangle) TRY(surface_seams(fine->shell, fine->cell_triangle, fine->surface, error));
    return SINGE_OK;
}

SingeResult ablate_surface_fine(AblatePlan *plan, const Shell *shell, const State *state, const SurfaceDetail *detail,
                                Memory *memory, Pool *pool, SingeSurface *surface, SingeError *error) {
    Fine fine = {.plan = plan, .shell = shell, .state = state, .memory = memory, .pool = pool, .surface = surface};
    fine.room = detail->room;
    fine.bulge_max = detail->bulge_max > 0 ? detail->bulge_max : INFINITY;
    ablate_levels(plan, shell, &state->burn);
    surface->vertex_count = surface->triangle_count = surface->fine_triangle_count = 0;
    SingeResult result = fine_draw(&fine, detail, error);
    fine_release(&fine);
    if (result) surface_clear(surface);
    return result;
}
