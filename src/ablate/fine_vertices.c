// The fields of the fine surface's vertices. Velocity, uv and rest position lie on the cell's triangle, straight between
// its corners and its virtual centre; temperatures and rates follow their splines; the mass is what the level was taken
// with. Of times to ignition, those of corners that have ignited count, by their weights. Normals are those of corners
// and centres, blended. Fine vertices leave the triangle for a rounder one (Boubekeur and Alexa, Phong tessellation,
// 2008), with P and N of the triangle's corners and weights w:
//
//   x = p - 1/2 sum w_i ((p - P_i) . N_i) N_i,   p = sum w_i P_i
//
// which is p at the corners and on flat sheets, and depends on a side's ends alone along the side; 1/2 lays it on a
// circle through the corners. So do virtual centres, from the cell's four corners.
//
// What does not cross as it is must not cross as it is drawn. So no vertex goes farther than a tenth of the
// shortest side and less than half the contact thickness, and corners' terms fade
//
//   where a triangle at the corner leans away from its normal: within the triangle the terms move points by a share of
//   1/2 sin^2 of that angle, and would turn fine triangles over;
//   where one is thin, as when a cell collapses;
//   where another surface is near: at once, and for the other lip of a tear as it comes nearer.
//
// Lips lie at one place until they part. What is drawn of them is cut otherwise on either side, so their corners are
// drawn back from each other, by a small share of a cell's side.
#include "ablate/surface_fine.h"

#include <string.h>

#define BULGE 0.5f
/// How far a vertex leaves its triangle at most, of the shortest side at its corners: where it is crumpled.
#define BULGE_MOST 0.1f
/// How far the corners of lips at one place are drawn back, of the cell's side: less than contact keeps free.
#define LIP 1e-3f
/// Lips this near are at one place; and apart, when their corners have their terms again.
#define LIPS_CLOSED 1e-2f
#define LIPS_OPEN 0.2f

static Vec centre_of(const uint32_t at[4], const float (*field)[4]) {
    return vec_scale(vec_add(vec_add(vec_load(field[at[0]]), vec_load(field[at[1]])),
                             vec_add(vec_load(field[at[2]]), vec_load(field[at[3]]))), 0.25f);
}

static Vec weigh(const Vec corner[3], const float weight[3]) {
    return vec_mad(vec_mad(vec_scale(corner[0], weight[0]), corner[1], weight[1]), corner[2], weight[2]);
}

/// Of a triangle's corners: two particles, and the mean of four for the virtual centre.
static Vec blend(const uint32_t at[4], const FinePlace *place, const float (*field)[4]) {
    const Vec corner[3] = {vec_load(field[at[place->side]]), vec_load(field[at[(place->side + 1) & 3]]),
                           centre_of(at, field)};
    return weigh(corner, place->weight);
}

/// 0 at `low` and below, 1 at `high`.
static float fade(float value, float low, float high) { return fmaxf(0, fminf((value - low) / (high - low), 1)); }

/// Towards the middle of the cells that a vertex has.
static Vec drawn_back(const Fine *fine, uint32_t vertex, float length) {
    const Shell *shell = fine->shell;
    const float (*position)[4] = (const float (*)[4])fine->state->dynamics.position;
    Vec place = vec_load(position[vertex]), sum = {0, 0, 0};
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++)
        sum = vec_add(sum, vec_sub(centre_of(shell->cells[shell->fan[k]], position), place));
    return vec_mad(place, vec_unit(sum), length);
}

/// Two vertices that were one.
static void part_lips(const Fine *fine, const uint32_t lip[2]) {
    const float (*position)[4] = (const float (*)[4])fine->state->dynamics.position;
    const float side = fine->shell->sheets[fine->shell->matter.sheet[lip[0]]].cell_size;
    float apart = vec_length(vec_sub(vec_load(position[lip[0]]), vec_load(position[lip[1]])));
    for (int i = 0; i < 2; i++) {
        if (apart < LIPS_CLOSED * side) vec_store(fine->corner[lip[i]], drawn_back(fine, lip[i], LIP * side));
        fine->share[lip[i]] = fminf(fine->share[lip[i]], fade(apart, LIPS_CLOSED * side, LIPS_OPEN * side));
    }
}

/// Where corners are drawn, and what of their terms they keep: those that have another surface near nothing.
static void place_corners(const Fine *fine) {
    const Shell *shell = fine->shell;
    const SpringSet *blue = &shell->springs[SINGE_BLUE];
    const uint32_t spare = blue->count - shell->edge_spare_count;
    memcpy(fine->corner, fine->state->dynamics.position, shell->vertex_count * sizeof *fine->corner);
    for (uint32_t i = 0; i < shell->particle_count; i++)
        fine->share[i] = fine->flat && i < shell->vertex_count && fine->flat[i] ? 0 : 1;
    for (uint32_t v = 0; v < shell->vertex_count; v++) fine->most[v] = fine->bulge_most;
    for (uint32_t k = 0; k < shell->edge_spare_used; k++)
        for (int end = 0; end < 2; end++) {
            const uint32_t lip[2] = {blue->ends[spare + k][end], blue->ends[shell->edge_origin[k]][end]};
            if (lip[0] != lip[1]) part_lips(fine, lip);
        }
}

/// Unit normals of corners and virtual centres: of the triangles around them, by their areas.
static void gather_normals(const Fine *fine) {
    const Shell *shell = fine->shell;
    const float (*position)[4] = (const float (*)[4])fine->corner;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (!(fine->state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;
        const uint32_t *at = shell->cells[c];
        Vec centre = centre_of(at, position);
        for (int i = 0; i < 4; i++) {
            const uint32_t corner[3] = {at[i], at[(i + 1) & 3], shell_centre(shell, c)};
            Vec a = vec_sub(vec_load(position[corner[0]]), centre), b = vec_sub(vec_load(position[corner[1]]), centre);
            Vec doubled = vec_cross(a, b);
            for (int k = 0; k < 3; k++)
                vec_store(fine->normal[corner[k]], vec_add(vec_load(fine->normal[corner[k]]), doubled));
        }
    }
    for (uint32_t i = 0; i < shell->particle_count; i++)
        vec_store(fine->normal[i], vec_unit(vec_load(fine->normal[i])));
}

/// How much of its corners' terms a triangle with this normal, 2 A n, and this square of its longest edge allows.
static float allowed(Vec doubled, float longest, Vec normal) {
    float area = vec_length(doubled);
    if (!(area > 0)) return 0;
    return fade(vec_dot(doubled, normal) / area, 0.7f, 0.85f) * fade(area / longest, 0.1f, 0.25f);
}

/// Lessens the shares where triangles lean away from the normals or are thin, and how far vertices may go to a part of
/// the shortest side. The normals are in place.
static void gather_shares(const Fine *fine) {
    const Shell *shell = fine->shell;
    const float (*position)[4] = (const float (*)[4])fine->corner;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (!(fine->state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;
        const uint32_t *at = shell->cells[c], middle = shell_centre(shell, c);
        Vec centre = centre_of(at, position);
        for (int i = 0; i < 4; i++) {
            const uint32_t corner[3] = {at[i], at[(i + 1) & 3], middle};
            Vec a = vec_sub(vec_load(position[corner[0]]), centre), b = vec_sub(vec_load(position[corner[1]]), centre);
            Vec doubled = vec_cross(a, b), side = vec_sub(b, a);
            float longest = fmaxf(vec_dot(side, side), fmaxf(vec_dot(a, a), vec_dot(b, b)));
            for (int k = 0; k < 3; k++) {
                float share = allowed(doubled, longest, vec_load(fine->normal[corner[k]]));
                fine->share[corner[k]] = fminf(fine->share[corner[k]], share);
            }
            for (int k = 0; k < 2; k++)
                fine->most[corner[k]] = fminf(fine->most[corner[k]], BULGE_MOST * vec_length(side));
            if (fine->flat && fine->flat[at[i]]) fine->share[middle] = 0;
        }
    }
}

/// How far a place leaves the straight mean of `count` vertices: the sum in the formula above. The virtual centre, a
/// further corner, has gone its own way.
static Vec bulge(const Fine *fine, Vec flat, int count, const uint32_t particle[], const Vec corner[],
                 const float weight[]) {
    Vec sum = {0, 0, 0};
    float most = 0;
    for (int i = 0; i < count; i++) {
        Vec normal = vec_load(fine->normal[particle[i]]);
        float strength = BULGE * fine->share[particle[i]] * weight[i];
        sum = vec_mad(sum, normal, -strength * vec_dot(vec_sub(flat, corner[i]), normal));
        if (shell_is_corner(fine->shell, particle[i])) most += weight[i] * fine->most[particle[i]];
    }
    float length = vec_length(sum);
    return length > most ? vec_scale(sum, most / length) : sum;
}

static void place_centres(const Fine *fine) {
    const float (*position)[4] = (const float (*)[4])fine->corner;
    const float quarters[4] = {0.25f, 0.25f, 0.25f, 0.25f};
    for (uint32_t c = 0; c < fine->shell->cell_count; c++) {
        const uint32_t *at = fine->shell->cells[c];
        Vec corner[4], flat = centre_of(at, position);
        for (int i = 0; i < 4; i++) corner[i] = vec_load(position[at[i]]);
        vec_store(fine->centre[c], vec_add(flat, bulge(fine, flat, 4, at, corner, quarters)));
    }
}

/// Position and normal.
static void place_vertex(const Fine *fine, const FinePlace *place, const uint32_t particle[3], uint32_t v) {
    const float (*position)[4] = (const float (*)[4])fine->corner;
    const Vec corner[3] = {vec_load(position[particle[0]]), vec_load(position[particle[1]]),
                           vec_load(fine->centre[place->cell])};
    Vec normal[3], flat = weigh(corner, place->weight);
    for (int i = 0; i < 3; i++) normal[i] = vec_load(fine->normal[particle[i]]);
    Vec unit = vec_unit(weigh(normal, place->weight));
    vec_store(fine->surface->position[v], vec_add(flat, bulge(fine, flat, 3, particle, corner, place->weight)));
    vec_store(fine->surface->normal[v], vec_dot(unit, unit) > 0.5f ? unit : vec(0, 0, 1));
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
    place_vertex(fine, place, particle, v);
    vec_store(surface->velocity[v], blend(at, place, (const float (*)[4])state->dynamics.velocity));
    vec_store(surface->rest_position[v], blend(at, place, (const float (*)[4])shell->rest_position));
    float mass_min = 0, yield = 0, u = 0, w = 0;
    for (int i = 0; i < 3; i++) {
        u += place->weight[i] * shell->uv[particle[i]][0], w += place->weight[i] * shell->uv[particle[i]][1];
        mass_min += place->weight[i] * field_at(shell->matter.mass_min, particle[i]);
        yield += place->weight[i] * field_at(shell->matter.char_yield, particle[i]);
    }
    surface->uv[v][0] = u, surface->uv[v][1] = w;
    surface->temperature[v] = fine_spline_at(shell, &fine->splines[SPLINE_TEMPERATURE], *place);
    surface->temperature_peak[v] = fine_spline_at(shell, &fine->splines[SPLINE_PEAK], *place);
    surface->burn_rate[v] = fine_spline_at(shell, &fine->splines[SPLINE_RATE], *place);
    surface->mass[v] = vertex->mass;
    float fuel = fminf(fmaxf(fine_spline_at(shell, &fine->splines[SPLINE_FUEL], *place), 0), 1);
    surface->char_fraction[v] = yield * shell_char(vertex->mass, fuel, mass_min, yield);
    surface->ash_fraction[v] = fmaxf(vertex->mass - fuel - surface->char_fraction[v], 0);
    surface->burn[v] = shell_burn_progress(vertex->mass, mass_min);
    surface->time_ignited[v] = blend_times(state->burn.time_ignited, particle, place->weight);
    surface->piece[v] = state->ablate.piece[particle[0]];
    surface->sheet[v] = shell->matter.sheet[centre];
    surface->source_vertex[v] = vertex->source == SHELL_NONE ? -1 : shell->source_vertex[vertex->source];
}

static void fill_range(void *context, int begin, int end) {
    for (int v = begin; v < end; v++) fill(context, (uint32_t)v);
}

void fine_vertices(const Fine *fine) {
    place_corners(fine);
    gather_normals(fine);
    gather_shares(fine);
    place_centres(fine);
    pool_for(fine->pool, (int)fine->vertex_count, 256, fill_range, (void *)(uintptr_t)fine);
    fine->surface->vertex_count = fine->vertex_count;
}
