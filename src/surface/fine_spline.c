// A smooth field over the sheet from its values at the particles.
//
// In the body-centred square the cells' triangles form a four-direction mesh. On it the Zwart-Powell element, centred
// on the cells, gives a C1 piecewise quadratic. With the value q of a cell, and the corners A, B and the centre C of
// its triangle:
//
//   q    = f_C / 2 + (f_1 + f_2 + f_3 + f_4) / 8
//   b_AB = (q + q') / 2             q' of the cell across the side; (f_A + f_B) / 2 where there is none
//   b_A  = mean of b of the sides at A;                                f_A at the sheet's border
//   b_AC = (b_AB + b_A'A) / 2       of the two sides of the cell at A
//   b_C  = mean of b of the cell's four sides
//
//   S = b_A x^2 + b_B y^2 + b_C z^2 + 2 (b_AB x y + b_AC x z + b_BC y z)     (Bernstein-Bezier, barycentric x, y, z)
//
// (Zwart 1973; Peters and Reif, The simplest subdivision scheme for smoothing polyhedra, 1997, for meshes that are not
// regular: C1 except at their irregular vertices). All weights are positive: if no particle's mass grows, S does not
// grow. It is exact for linear fields on parallelograms, and its isolines have no corners where cells meet.
#include "common/real.h"
#include "surface/surface_fine.h"

#include <string.h>

/// Numbers of a cell's corners or sides in another order.
#define TURNED(a, i, j, k, l) FLOAT4_SHUFFLE(a, a, i, j, k, l)

/// The cells' values are in place. Without values at the particles, the field is constant across the sheet's border.
static void side_coefficients(const Fine *fine, const float *values, float *edge) {
    const Shell *shell = fine->shell;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const uint32_t *at = shell->cells[c];
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(shell, c, i), blue = shell->cell_springs[c].blue[i];
            if (other != SHELL_NONE) edge[blue] = 0.5f * (fine->cell_value[c] + fine->cell_value[other]);
            else edge[blue] = values ? 0.5f * (values[at[i]] + values[at[(i + 1) & 3]]) : fine->cell_value[c];
        }
    }
}

static void corner_coefficients(const Fine *fine, const float *values, Spline *spline) {
    const Shell *shell = fine->shell;
    const SpringSet *blue = &shell->springs[SINGE_BLUE];
    memset(spline->corner, 0, shell->vertex_count * sizeof *spline->corner);
    for (uint32_t s = 0; s < blue->count; s++)
        for (int end = 0; end < 2; end++) spline->corner[blue->ends[s][end]] += spline->edge[s];

    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        uint32_t cells = shell->fan_first[v + 1] - shell->fan_first[v];
        uint32_t sides = cells + fine->rim[v]; // one more at the border
        if (cells == 0 || (values && fine->rim[v])) spline->corner[v] = values ? values[v] : 0;
        else spline->corner[v] /= (float)sides;
    }
}

void fine_spline(const Fine *fine, const float *values, Spline *spline) {
    const Shell *shell = fine->shell;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const uint32_t *at = shell->cells[c];
        float corners = values[at[0]] + values[at[1]] + values[at[2]] + values[at[3]];
        fine->cell_value[c] = 0.5f * values[shell_centre(shell, c)] + 0.125f * corners;
    }

    side_coefficients(fine, values, spline->edge);
    corner_coefficients(fine, values, spline);
}

void fine_spline_cells(const Fine *fine, Spline *spline) {
    const uint8_t *flags = fine->state->ablate.cell_flags;
    for (uint32_t c = 0; c < fine->shell->cell_count; c++) fine->cell_value[c] = flags[c] & SINGE_ALIVE ? 1 : -1;
    side_coefficients(fine, NULL, spline->edge);
    corner_coefficients(fine, NULL, spline);
}

void fine_spline_bounds(const Shell *shell, const Spline *spline, uint32_t cell, float *low, float *high) {
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < 4; i++) { // the other coefficients are means of these
        float side = spline->edge[shell->cell_springs[cell].blue[i]], corner = spline->corner[shell->cells[cell][i]];
        *low = float_min(*low, float_min(side, corner));
        *high = float_max(*high, float_max(side, corner));
    }
}

Float4 fine_spline_quarters(const Shell *shell, const Spline *spline, uint32_t cell) {
    const Float4 corner = float4_gather(spline->corner, shell->cells[cell]);
    const Float4 side = float4_gather(spline->edge, shell->cell_springs[cell].blue), before = TURNED(side, 3, 0, 1, 2);
    const Float4 inner = 0.5f * (side + before), centre = float4_all(0.5f * (inner[0] + inner[2]));

    // the triangles at the sides, halved from a side's middle to the centre
    Float4 half = float4_min(0.25f * (corner + TURNED(corner, 1, 2, 3, 0)) + 0.5f * side,
                             0.5f * (inner + TURNED(inner, 1, 2, 3, 0)));
    half = float4_min(half, TURNED(half, 3, 0, 1, 2));
    const Float4 beside = float4_min(inner, 0.5f * (corner + float4_min(side, before)));
    return float4_min(float4_min(half, centre), float4_min(beside, corner));
}

float fine_spline_at(const Shell *shell, const Spline *spline, const FineLocation *location) {
    const uint32_t *at = shell->cells[location->cell], *sides = shell->cell_springs[location->cell].blue;
    int a = location->side, b = (a + 1) & 3, opposite = (a + 2) & 3, before = (a + 3) & 3;
    float ab = spline->edge[sides[a]], bb = spline->edge[sides[b]], aa = spline->edge[sides[before]];
    float centre = 0.25f * ((ab + bb) + (aa + spline->edge[sides[opposite]]));
    float x = location->weight[0], y = location->weight[1], z = location->weight[2];
    return spline->corner[at[a]] * x * x + spline->corner[at[b]] * y * y + centre * z * z + 2 * ab * x * y +
           (aa + ab) * x * z + (ab + bb) * y * z;
}

// `out` is the distance from the centre towards a side, `along` runs from its first corner to its second.

void fine_coordinates(const FineLocation *location, float *x, float *y) {
    float out = 0.5f * (location->weight[0] + location->weight[1]),
          along = 0.5f * (location->weight[1] - location->weight[0]);
    const bool upright = location->side & 1, reverse = location->side & 2;
    const float first = upright ? out : along, second = upright ? along : -out;
    *x = reverse ? -first : first;
    *y = reverse ? -second : second;
}

void fine_walk(const Shell *shell, const FineLocation *location, float dx, float dy, FineLocation *there) {
    uint32_t cell = location->cell;
    float x, y;
    fine_coordinates(location, &x, &y);
    x += dx;
    y += dy;

    for (int crossing = 0; crossing < 2 && float_max(fabsf(x), fabsf(y)) > 0.5f; crossing++) {
        int side = fabsf(x) > fabsf(y) ? (x > 0 ? 1 : 3) : (y > 0 ? 2 : 0);
        uint32_t other = shell_neighbour(shell, cell, side);
        if (other == SHELL_NONE) {
            if (side & 1) x = float_max(-0.5f, float_min(x, 0.5f));
            else y = float_max(-0.5f, float_min(y, 0.5f));
            continue;
        }

        // the neighbour's centre is the new origin; then quarter turns until the side that was crossed lies behind
        if (side & 1) x += side == 1 ? -1.0f : 1.0f;
        else y += side == 2 ? -1.0f : 1.0f;
        int behind = 0;
        while (behind < 3 && shell->cell_springs[other].blue[behind] != shell->cell_springs[cell].blue[side]) behind++;

        for (int turns = (behind + 2 - side) & 3; turns > 0; turns--) {
            float turned = -y;
            y = x;
            x = turned;
        }

        cell = other;
    }

    x = float_max(-0.5f, float_min(x, 0.5f));
    y = float_max(-0.5f, float_min(y, 0.5f));

    // the position as weights
    const bool across = fabsf(x) > fabsf(y);
    const float out = across ? fabsf(x) : fabsf(y), along = across ? (x > 0 ? y : -y) : (y > 0 ? -x : x);
    *there = (FineLocation){.cell = cell,
                            .side = (uint8_t)(across ? (x > 0 ? 1 : 3) : (y > 0 ? 2 : 0)),
                            .weight = {out - along, out + along, 1 - 2 * out}};
}

FineLocation fine_move(const Shell *shell, const FineLocation *location, Float3 displacement) {
    Float3 corner[4];
    for (int i = 0; i < 4; i++) corner[i] = float3_load(shell->rest_position[shell->cells[location->cell][i]]);
    Float3 along = float3_scale(float3_sub(float3_add(corner[1], corner[2]), float3_add(corner[0], corner[3])), 0.5f);
    Float3 up = float3_scale(float3_sub(float3_add(corner[3], corner[2]), float3_add(corner[0], corner[1])), 0.5f);
    FineLocation there;
    fine_walk(shell, location, float3_dot(displacement, along) / float3_dot(along, along),
              float3_dot(displacement, up) / float3_dot(up, up), &there);
    return there;
}
