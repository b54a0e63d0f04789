// Where the surface is drawn. A position of a cell lies on one of its four flat triangles, at T. It is displaced to the
// patch S of fine_patch.c in the direction m, a blend of the flat triangles' normals at the corners, as far as the
// tangent plane of S at (u, v), which has the normal n:
//
//   x = T + s h m,   h = ((S(u, v) - T) . n)/(m . n)
//
// So prints on the sheet keep their positions. Both cells at a side give the same result, so there are no steps. Near
// vertices where the patches' tangents differ slightly, n is m. The drawn normal is that of S nearest to T: at (u, v)
// plus the step along the tangents that brings S there. s is 1 except where corners' shares fade.
//
// Sheets that do not intersect must not intersect as drawn. So a displacement is at most a tenth of the shortest side,
// less than half the contact thickness, and less than half the distance to another surface. Shares fade
//
//   where a triangle at the corner is tilted from its normal, or is thin, as when a cell collapses or is crumpled;
//   at the edges of a tear until they have separated.
//
// Both edges of a tear coincide until they separate. They are cut differently on either side, so their corners are
// drawn back from each other, by a small fraction of a cell's side.
#include "common/real.h"
#include "surface/render_parts.h"

#include <string.h>

/// Max displacement of a position, over the shortest side at its corners, and over the distance to another surface; the
/// latter beneath a render mesh, whose thickness takes some of it (render_draw.c).
#define BULGE_MAX 0.1f
#define ROOM_SHARE 0.4f
#define ROOM_UNDER 0.15f
/// How far the corners of coincident tear edges are drawn back, over the cell's side: less than the gap that contact
/// keeps.
#define TEAR_EDGE 1e-3f
/// Distances of tear edges over the cell's side: below the first they coincide, from the second their shares are full.
#define TEAR_EDGES_CLOSED 1e-2f
#define TEAR_EDGES_OPEN 0.2f
/// Displacements smaller than this, over the cell's side, are omitted.
#define FLAT 1e-5f
/// The longest step along a patch, in sides: beyond its end it continues as the next cell's, except for third
/// derivatives.
#define STEP_MAX 0.25f
/// A cell's sides get one part more for each such chord between its corners' normals; a part turns by about 10 degrees.
#define TURN_A_PART 0.3f

static Float3 centre_of(const uint32_t at[4], const float (*field)[4]) {
    return float3_scale(float3_add(float3_add(float3_load(field[at[0]]), float3_load(field[at[1]])),
                                   float3_add(float3_load(field[at[2]]), float3_load(field[at[3]]))),
                        0.25f);
}

static bool is_alive(const Fine *fine, uint32_t cell) { return fine->state->ablate.cell_flags[cell] & SINGE_ALIVE; }

/// 0 up to `low`, 1 from `high` on, linear between.
static float fade(float value, float low, float high) {
    return float_max(0, float_min((value - low) / (high - low), 1));
}

static void lessen(float *value, float max) { *value = float_min(*value, max); }

/// A torn side with its two tear edges: draws vertices that were one back from each other, and limits their shares. Where
/// both edges end at one vertex, the tip of a tear, the share is that of the other end.
static void part_side(Fine *fine, const uint32_t one[2], const uint32_t other[2]) {
    const Shell *shell = fine->shell;
    const float(*position)[4] = (const float(*)[4])fine->state->dynamics.position;
    float share[2] = {1, 1}, min = 0;

    for (int end = 0; end < 2; end++) {
        if (one[end] == other[end]) continue;

        const uint32_t vertex[2] = {one[end], other[end]};
        const float side = shell->sheets[shell->matter.sheet[vertex[0]]].cell_size;
        float apart = float3_length(float3_sub(float3_load(position[vertex[0]]), float3_load(position[vertex[1]])));

        // towards the centroids of their cells
        for (int i = 0; i < 2 && apart < TEAR_EDGES_CLOSED * side; i++) {
            const uint32_t v = vertex[i];
            Float3 location = float3_load(position[v]), sum = {0, 0, 0};
            for (uint32_t k = shell->fan_first[v]; k < shell->fan_first[v + 1]; k++)
                sum = float3_add(sum, float3_sub(centre_of(shell->cells[shell->fan[k]], position), location));
            float3_store(fine->corner[v], float3_mad(location, float3_unit(sum), TEAR_EDGE * side));
        }

        share[end] = fade(apart, TEAR_EDGES_CLOSED * side, TEAR_EDGES_OPEN * side);
        min = float_max(min, share[end]);
    }

    for (int end = 0; end < 2; end++) {
        if (one[end] == other[end]) share[end] = min;
        lessen(&fine->share[one[end]], share[end]);
        lessen(&fine->share[other[end]], share[end]);
    }
}

/// The share that a triangle allows, from its normal 2 A n and the square of its longest edge.
static float allowed(Float3 doubled, float longest, Float3 normal) {
    float area = float3_length(doubled);
    if (!(area > 0)) return 0;
    return fade(float3_dot(doubled, normal) / area, 0.7f, 0.85f) * fade(area / longest, 0.1f, 0.25f);
}

/// Reduces the shares where triangles are tilted from the normals or thin, and limits displacements to a fraction of
/// the shortest side. The normals are in place.
static void gather_shares(Fine *fine) {
    const Shell *shell = fine->shell;
    const float(*position)[4] = (const float(*)[4])fine->corner;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (!is_alive(fine, c)) continue;

        const uint32_t *at = shell->cells[c];
        Float3 centre = centre_of(at, position);
        float whole = fine->sound[c]; // the share that the normal at the virtual centre allows

        // limits of the corners' shares and heights by each side
        for (int i = 0; i < 4; i++) {
            const uint32_t corner[2] = {at[i], at[(i + 1) & 3]};
            Float3 a = float3_sub(float3_load(position[corner[0]]), centre),
                   b = float3_sub(float3_load(position[corner[1]]), centre);
            Float3 doubled = float3_cross(a, b), side = float3_sub(b, a);
            float longest = float_max(float3_dot(side, side), float_max(float3_dot(a, a), float3_dot(b, b)));
            for (int k = 0; k < 2; k++) {
                lessen(&fine->share[corner[k]], allowed(doubled, longest, float3_load(fine->normal[corner[k]])));
                lessen(&fine->max[corner[k]], BULGE_MAX * float3_length(side));
            }

            lessen(&whole, allowed(doubled, longest, float3_load(fine->normal[shell_centre(shell, c)])));
        }

        for (int i = 0; i < 4; i++) lessen(&fine->share[at[i]], whole);
    }
}

void fine_position(Fine *fine) {
    const Shell *shell = fine->shell;
    const SpringSet *blue = &shell->springs[SINGE_BLUE];
    const uint32_t spare = blue->count - shell->edge_spare_count;

    // the corners' positions, their shares, and the surface's max distance from them
    memcpy(fine->corner, fine->state->dynamics.position, shell->vertex_count * sizeof *fine->corner);
    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        fine->share[v] = 1;
        fine->max[v] = fine->room ? float_min(fine->bulge_max, ROOM_SHARE * fine->room[v]) : fine->bulge_max;
    }

    // what is drawn in place of a sheet needs room beside it
    for (uint32_t m = 0; m < fine->mesh_count && fine->room; m++)
        for (uint32_t c = 0; c < fine->meshes[m]->cell_count; c++) {
            const uint32_t *at = shell->cells[fine->meshes[m]->cell_first + c];
            for (int i = 0; i < 4; i++) lessen(&fine->max[at[i]], ROOM_UNDER * fine->room[at[i]]);
        }

    for (uint32_t k = 0; k < shell->edge_spare_used; k++)
        part_side(fine, blue->ends[spare + k], blue->ends[shell->edge_origin[k]]);

    // unit normals of corners and virtual centres: those of the triangles around them, weighted by area
    const float(*position)[4] = (const float(*)[4])fine->corner;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        if (!is_alive(fine, c)) continue;

        const uint32_t *at = shell->cells[c];
        Float3 centre = centre_of(at, position);
        for (int i = 0; i < 4; i++) {
            const uint32_t corner[3] = {at[i], at[(i + 1) & 3], shell_centre(shell, c)};
            Float3 a = float3_sub(float3_load(position[corner[0]]), centre),
                   b = float3_sub(float3_load(position[corner[1]]), centre);
            Float3 doubled = float3_cross(a, b);
            for (int k = 0; k < 3; k++)
                float3_store(fine->normal[corner[k]], float3_add(float3_load(fine->normal[corner[k]]), doubled));
        }
    }

    for (uint32_t i = 0; i < shell->particle_count; i++)
        float3_store(fine->normal[i], float3_unit(float3_load(fine->normal[i])));

    fine_find_sound(fine);
    gather_shares(fine);
    fine_patches(fine);

    // the number of parts in which the sides of a cell's triangles are drawn, to show its bending
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        fine->bent[c] = 1;
        if (!is_alive(fine, c)) continue;

        const uint32_t *at = shell->cells[c];
        float turn = 0, freedom = 0;
        for (int i = 0; i < 4; i++) {
            freedom = float_max(freedom, fine->share[at[i]] * fine->max[at[i]]);
            for (int k = 0; k < i; k++) {
                Float3 turned = float3_sub(float3_load(fine->normal[at[i]]), float3_load(fine->normal[at[k]]));
                turn = float_max(turn, float3_length(turned));
            }
        }

        int parts = 1 + (int)(turn / TURN_A_PART), max = fine_splits(fine, c);
        if (freedom > 0) fine->bent[c] = (uint8_t)(parts < max ? parts : max);
    }
}

// ---- one position

static Float3 weigh(const Float3 corner[3], const float weight[3]) {
    return float3_mad(float3_mad(float3_scale(corner[0], weight[0]), corner[1], weight[1]), corner[2], weight[2]);
}

static Float3 across(const FinePoint *point) { return float3_unit(float3_cross(point->along_u, point->along_v)); }

/// Interpolates a field of the vertices: linear between the corners, the mean of all four at the centre.
static float blend_corners(const uint32_t at[4], const FineLocation *location, const float *value) {
    float centre = 0.25f * ((value[at[0]] + value[at[1]]) + (value[at[2]] + value[at[3]]));
    return location->weight[0] * value[at[location->side]] + location->weight[1] * value[at[(location->side + 1) & 3]] +
           location->weight[2] * centre;
}

static Float3 unit_or_up(Float3 normal) {
    Float3 unit = float3_unit(normal);
    return float3_dot(unit, unit) > 0.5f ? unit : float3(0, 0, 1);
}

/// Fills the position; `normal` is of any length.
static void place(const Fine *fine, const FinePatch *patch, const FineLocation *location, float position[3],
                  Float3 *normal) {
    const uint32_t *at = fine->shell->cells[location->cell];
    const float(*corners)[4] = (const float(*)[4])fine->corner;
    const uint32_t particle[3] = {at[location->side], at[(location->side + 1) & 3],
                                  shell_centre(fine->shell, location->cell)};
    const Float3 corner[3] = {float3_load(corners[particle[0]]), float3_load(corners[particle[1]]),
                              centre_of(at, corners)};

    // the flat triangle
    Float3 normals[3], flat = weigh(corner, location->weight);
    for (int i = 0; i < 3; i++) normals[i] = float3_load(fine->normal[particle[i]]);
    Float3 lean = float3_unit(weigh(normals, location->weight));
    float share = blend_corners(at, location, fine->share), max = blend_corners(at, location, fine->max), x, y;

    float3_store(position, flat);
    *normal = lean;
    if (!(share * max > 0)) return;

    // the smooth patch beneath the point
    fine_coordinates(location, &x, &y);
    const float u = x + 0.5f, v = y + 0.5f;
    FinePoint point = fine_patch_at(patch, u, v);
    const float regular = blend_corners(at, location, fine->regular);
    Float3 beneath = float3_mad(float3_scale(lean, 1 - regular * regular), across(&point), regular * regular);
    share *= fade(float3_dot(beneath, lean), 0.6f, 0.85f);
    if (!(share > 0)) return;

    // position, limited in height
    float height = share * float3_dot(float3_sub(point.position, flat), beneath) / float3_dot(beneath, lean);
    if (fabsf(height) > max) {
        share *= max / fabsf(height);
        height = copysignf(max, height);
    }

    if (fabsf(height) > FLAT * float3_length(float3_sub(corner[1], corner[0])))
        float3_store(position, float3_mad(flat, lean, height));

    // the step along the patch to the point nearest to the flat one, approximately, and the normal at its end
    Float3 left = float3_sub(flat, point.position);
    float uu = float3_dot(point.along_u, point.along_u), vv = float3_dot(point.along_v, point.along_v);
    float uv = float3_dot(point.along_u, point.along_v), det = uu * vv - uv * uv;
    float to_u = float3_dot(left, point.along_u), to_v = float3_dot(left, point.along_v);
    float du = det > 0 ? (to_u * vv - to_v * uv) / det : 2 * STEP_MAX;
    float dv = det > 0 ? (to_v * uu - to_u * uv) / det : 0;
    share *= 1 - fade(float_max(fabsf(du), fabsf(dv)), 0.5f * STEP_MAX, STEP_MAX);

    point = fine_patch_at(patch, u + float_max(-STEP_MAX, float_min(du, STEP_MAX)),
                          v + float_max(-STEP_MAX, float_min(dv, STEP_MAX)));
    *normal = float3_mad(float3_scale(lean, 1 - share), across(&point), share);
}

void fine_position_at(const Fine *fine, const FinePatch *patch, const FineLocation *location, float position[3],
                      float normal[3]) {
    Float3 any;
    place(fine, patch, location, position, &any);
    float3_store(normal, unit_or_up(any));
}

FineFrame fine_frame(const Fine *fine, uint32_t cell, Float3 normal) {
    const uint32_t *at = fine->shell->cells[cell];
    Float3 corner[4];
    for (int i = 0; i < 4; i++) corner[i] = float3_load(fine->corner[at[i]]);
    Float3 along = float3_sub(float3_add(corner[1], corner[2]), float3_add(corner[0], corner[3]));
    along = float3_unit(float3_mad(along, normal, -float3_dot(along, normal)));
    return (FineFrame){{along, float3_cross(normal, along), normal}};
}
