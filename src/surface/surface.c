// The drawn surface as the cells are, by marching triangles (section 6, Fig 6). Every remaining cell is drawn as four triangles around its virtual centre; the
// level set m' cuts them:
//
//   corners inside   3          2                1              0
//   drawn            all of it  a quadrilateral  a triangle     nothing
//
// m' >= 0 is inside. Each triangle is clipped into a polygon of keys (SurfaceKeys), one key per vertex that neighbouring
// triangles share, so that they meet without cracks. The keys in use are then numbered in order: corners in the input's
// order, virtual centres, cuts. A cut at its inside end becomes that end; polygons with fewer than three corners are
// dropped. Cuts keep a distance from ends, and quadrilaterals are divided along the diagonal that gives the rounder
// triangles, so that no triangle is as thin as the rounding of its vertices.
//
// Vertices are corners, virtual centres, and points cut by eq 7:
//
//   x = x0 + (x1 - x0) t,   t = m'0 / (m'0 - m'1)
//
// with end 0 inside (m' >= 0) and end 1 outside, for the position and every other field alike. A virtual
// centre lies at the mean of its cell's four corners, in space, at rest and in velocity; temperature,
// mass and times are those of the cell's centre particle.
#include "common/assertion.h"
#include "common/float3.h"
#include "common/real.h"
#include "surface/surface_parts.h"

#include <string.h>

/// Corners, virtual centres, cuts of blue springs and cuts of red springs, numbered in this order: every vertex that a
/// surface may have.
typedef struct SurfaceKeys {
    uint32_t centre, blue, red; ///< the first of each; corners begin at 0
    uint32_t count;
} SurfaceKeys;

typedef struct Drawing {
    const Shell *shell;
    const State *state;
    const float *level; ///< [particles] m'
    SurfaceKeys keys;
    uint32_t *output;     ///< [keys.count] first 1 where a vertex is drawn, then its index in the surface
    uint32_t *cell_first; ///< [cells + 1] first of a cell's triangles, where the sheets have seams; else NULL
    SingeSurface *surface;
} Drawing;

// ---- clipping

float surface_cut(float inside, float outside, float nearest) {
    float t = inside / (inside - outside);
    return t < nearest ? 0 : t > 1 - nearest ? 1 - nearest : t;
}

int surface_fan(const float level[3], float nearest) {
    for (int outside = 0; outside < 3; outside++) {
        int a = (outside + 1) % 3, b = (outside + 2) % 3;
        if (level[outside] >= 0 || level[a] < 0 || level[b] < 0) continue;

        float cut_a = surface_cut(level[a], level[outside], nearest);
        return cut_a < surface_cut(level[b], level[outside], nearest) ? b : a;
    }

    return 0;
}

/// Draws the cells with keys as vertices, and marks these keys.
static void draw_cells(const Drawing *drawing) {
    const Shell *shell = drawing->shell;
    SingeSurface *surface = drawing->surface;
    uint32_t *cell_first = drawing->cell_first;

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        for (int side = 0; side < 4 && drawing->state->ablate.cell_flags[c] & SINGE_ALIVE; side++) {
            uint32_t polygon[4];

            // a triangle, clipped: along the cell's side, to the virtual centre and back
            const CellSprings *springs = &shell->cell_springs[c];
            const uint32_t *at = shell->cells[c];
            const SurfaceKeys *keys = &drawing->keys;
            const int next = (side + 1) & 3;
            const uint32_t corner[3] = {at[side], at[next], shell_centre(shell, c)};
            const uint32_t edge[3] = {keys->blue + springs->blue[side], keys->red + springs->red[next],
                                      keys->red + springs->red[side]};
            const float level[3] = {drawing->level[corner[0]], drawing->level[corner[1]], drawing->level[corner[2]]};
            const int first = surface_fan(level, SURFACE_NEAREST);
            int count = 0;

            // corners inside and cuts, without repetitions
            for (int i = 0; i < 3; i++) {
                const int a = (first + i) % 3, b = (a + 1) % 3;
                const bool inside = level[a] >= 0;
                uint32_t vertex[2];
                int made = 0;
                if (inside) vertex[made++] = corner[a];

                if (inside != (level[b] >= 0)) {
                    const int in = inside ? a : b, out = inside ? b : a;
                    vertex[made++] = surface_cut(level[in], level[out], SURFACE_NEAREST) > 0 ? edge[a] : corner[in];
                }

                for (int m = 0; m < made; m++)
                    if (!count || polygon[count - 1] != vertex[m]) polygon[count++] = vertex[m];
            }

            if (count > 1 && polygon[count - 1] == polygon[0]) count--;

            for (int k = 2; k < count; k++) {
                uint32_t *triangle = surface->triangles[surface->triangle_count++];
                triangle[0] = polygon[0];
                triangle[1] = polygon[k - 1];
                triangle[2] = polygon[k];
                for (int i = 0; i < 3; i++) drawing->output[triangle[i]] = 1;
            }
        }

        if (cell_first) cell_first[c + 1] = surface->triangle_count;
    }
}

// ---- vertices

typedef struct Sample {
    Float3 position, velocity, rest;
    float u, v, temperature, temperature_peak, mass, burn_rate, coal, ash, burn, time_ignited, water;
    int32_t piece, sheet;
} Sample;

static Float3 mean_of_corners(const uint32_t corners[4], const float (*field)[4]) {
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) sum = float3_add(sum, float3_load(field[corners[i]]));
    return float3_scale(sum, 0.25f);
}

static Sample sample_particle(const Shell *shell, const State *state, uint32_t particle) {
    const float(*position)[4] = (const float(*)[4])state->dynamics.position;
    const float(*earlier)[4] = (const float(*)[4])state->dynamics.earlier;
    const float(*velocity)[4] = (const float(*)[4])state->dynamics.velocity;
    Float3 was, first;
    const float(*rest)[4] = (const float(*)[4])shell->rest_position;
    const BurnState *burn = &state->burn;
    float min = field_at(shell->matter.mass_min, particle), yield = field_at(shell->matter.char_yield, particle);
    float coal = yield * shell_char(burn->mass[particle], burn->fuel[particle], min, yield);
    Sample sample = {
        .u = shell->uv[particle][0],
        .v = shell->uv[particle][1],
        .temperature = state->heat.temperature[particle],
        .temperature_peak = state->heat.temperature_peak[particle],
        .mass = burn->mass[particle],
        .burn_rate = burn->burn_rate[particle],
        .coal = coal,
        .ash = float_max(burn->mass[particle] - burn->fuel[particle] - coal, 0),
        .burn = shell_burn_progress(burn->mass[particle], min),
        .time_ignited = burn->time_ignited[particle],
        .water = state->heat.water ? state->heat.water[particle] : 0,
        .piece = state->ablate.piece[particle],
        .sheet = shell->matter.sheet[particle],
    };

    // a vertex, or a virtual centre
    if (shell_is_corner(shell, particle)) {
        sample.position = float3_load(position[particle]);
        was = float3_load(earlier[particle]);
        first = float3_load(velocity[particle]);
        sample.rest = float3_load(rest[particle]);
    } else {
        const uint32_t *corners = shell->cells[particle - shell->vertex_count];
        sample.position = mean_of_corners(corners, position);
        was = mean_of_corners(corners, earlier);
        first = mean_of_corners(corners, velocity);
        sample.rest = mean_of_corners(corners, rest);
    }
    sample.velocity = surface_velocity(state, sample.position, was, first);

    return sample;
}

static float mix(float a, float b, float t) { return a + (b - a) * t; }
static Float3 mix_float3(Float3 a, Float3 b, float t) { return float3_mad(a, float3_sub(b, a), t); }

/// A cut, interpolated from the inside end, whose piece and sheet it has.
static Sample sample_cut(const Drawing *drawing, const uint32_t ends[2]) {
    const float *level = drawing->level;
    const int first = level[ends[0]] >= 0 ? 0 : 1;
    const uint32_t inside = ends[first], outside = ends[1 - first];
    const Sample a = sample_particle(drawing->shell, drawing->state, inside);
    const Sample b = sample_particle(drawing->shell, drawing->state, outside);
    const float t = surface_cut(level[inside], level[outside], SURFACE_NEAREST);

    return (Sample){
        .position = mix_float3(a.position, b.position, t),
        .velocity = mix_float3(a.velocity, b.velocity, t),
        .rest = mix_float3(a.rest, b.rest, t),
        .u = mix(a.u, b.u, t),
        .v = mix(a.v, b.v, t),
        .temperature = mix(a.temperature, b.temperature, t),
        .temperature_peak = mix(a.temperature_peak, b.temperature_peak, t),
        .mass = mix(a.mass, b.mass, t),
        .burn_rate = mix(a.burn_rate, b.burn_rate, t),
        .coal = mix(a.coal, b.coal, t),
        .ash = mix(a.ash, b.ash, t),
        .burn = mix(a.burn, b.burn, t),
        .time_ignited = a.time_ignited < 0   ? b.time_ignited // -1, never
                        : b.time_ignited < 0 ? a.time_ignited
                                             : mix(a.time_ignited, b.time_ignited, t),
        .water = mix(a.water, b.water, t),
        .piece = a.piece,
        .sheet = a.sheet,
    };
}

/// The normalised sum of 2 A n over the triangles around each vertex; +z where they cancel.
void surface_normals(SingeSurface *surface) {
    memset(surface->normal, 0, surface->vertex_count * sizeof *surface->normal);
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *triangle = surface->triangles[t];
        Float3 corner = float3_load(surface->position[triangle[0]]);
        Float3 doubled = float3_cross(float3_sub(float3_load(surface->position[triangle[1]]), corner),
                                      float3_sub(float3_load(surface->position[triangle[2]]), corner));
        for (int i = 0; i < 3; i++) {
            float *normal = surface->normal[triangle[i]];
            float3_store(normal, float3_add(float3_load(normal), doubled));
        }
    }

    for (uint32_t v = 0; v < surface->vertex_count; v++) {
        Float3 normal = float3_unit(float3_load(surface->normal[v]));
        bool unit = float3_dot(normal, normal) > 0.5f;
        float3_store(surface->normal[v], unit ? normal : float3(0, 0, 1));
    }
}

// ---- the surface

static SingeResult draw(Drawing *drawing, SingeError *error) {
    const Shell *shell = drawing->shell;
    SingeSurface *surface = drawing->surface;

    // at most four triangles per remaining cell, or eight where the level set may cross it
    uint64_t max = 0;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (!(drawing->state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;

        bool whole = drawing->level[shell_centre(shell, c)] >= 0;
        for (int i = 0; i < 4; i++) whole = whole && drawing->level[shell->cells[c][i]] >= 0;
        max += whole ? 4 : 8;
    }

    TRY(surface_reserve_triangles(surface, max, error));
    draw_cells(drawing);
    SINGE_ASSERT(surface->triangle_count <= max);

    // number the keys in use, and fill their vertices
    uint32_t count = 0;
    for (uint32_t key = 0; key < drawing->keys.count; key++) count += drawing->output[key];
    TRY(surface_reserve_vertices(surface, count, error));

    for (uint32_t key = 0; key < drawing->keys.count; key++) {
        if (!drawing->output[key]) continue;
        drawing->output[key] = surface->vertex_count++;

        // all but its normal
        const uint32_t v = drawing->output[key];
        const SurfaceKeys *keys = &drawing->keys;
        const Sample sample = key < keys->blue  ? sample_particle(shell, drawing->state, key)
                              : key < keys->red ? sample_cut(drawing, shell->springs[SINGE_BLUE].ends[key - keys->blue])
                                                : sample_cut(drawing, shell->springs[SINGE_RED].ends[key - keys->red]);
        float3_store(surface->position[v], sample.position);
        float3_store(surface->velocity[v], sample.velocity);
        float3_store(surface->rest_position[v], sample.rest);

        surface->uv[v][0] = sample.u;
        surface->uv[v][1] = sample.v;
        surface->temperature[v] = sample.temperature;
        surface->temperature_peak[v] = sample.temperature_peak;
        surface->mass[v] = sample.mass;
        surface->burn_rate[v] = sample.burn_rate;
        surface->char_fraction[v] = sample.coal;
        surface->ash_fraction[v] = sample.ash;
        surface->burn[v] = sample.burn;
        surface->time_ignited[v] = sample.time_ignited;
        surface->water[v] = sample.water;
        surface->piece[v] = sample.piece;
        surface->sheet[v] = sample.sheet;
        surface->source_vertex[v] = key < keys->centre ? shell->source_vertex[key] : -1;
    }

    for (uint32_t t = 0; t < surface->triangle_count; t++)
        for (int i = 0; i < 3; i++) surface->triangles[t][i] = drawing->output[surface->triangles[t][i]];

    if (surface->vertex_count) surface_normals(surface);
    return drawing->cell_first ? surface_seams(shell, drawing->cell_first, surface, error) : SINGE_OK;
}

SingeResult surface_draw(AblatePlan *plan, const Shell *shell, const State *state, SingeSurface *surface,
                         SingeError *error) {
    const size_t cells = (size_t)shell->cell_count + 1;
    Memory memory = memory_make(surface->allocator);
    Drawing drawing = {.shell = shell, .state = state, .surface = surface};
    drawing.level = ablate_levels(plan, shell, &state->burn);
    drawing.keys = (SurfaceKeys){.centre = shell->vertex_count, .blue = shell->particle_count};
    drawing.keys.red = drawing.keys.blue + shell->springs[SINGE_BLUE].count;
    drawing.keys.count = drawing.keys.red + shell->springs[SINGE_RED].count;
    surface->vertex_count = surface->triangle_count = surface->fine_triangle_count = 0;
    surface->wet = state->heat.water != NULL;

    SingeResult result;
    if (NEW(&memory, drawing.output, drawing.keys.count) &&
        (!shell->corner_uv || NEW(&memory, drawing.cell_first, cells))) {
        result = draw(&drawing, error);
    } else {
        surface_clear(surface);
        result = error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface");
    }

    FREE(&memory, drawing.output, drawing.keys.count);
    FREE(&memory, drawing.cell_first, cells);
    return result;
}
