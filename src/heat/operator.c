// The discrete Laplacians of the heat equation, eq 2, as one conductance per spring:
//
//   D_i dT_i/dt = sum over springs (i, j) of c_ij (T_j - T_i)
//
// T   K      temperature
// D   capacity of the operator: area (m2) for `surface`, length (m) for `umbrella`
// c   D per second, symmetric, so that sum D_i T_i is constant and a uniform T stays uniform
// a   m2/s   diffusivity alpha of eq 2 times r: the mean of the spring's ends, times the front thickening F
// r          capacity per area over its mean in the sheet; 1 for the umbrella, and wherever grammage and specific heat
//            do not vary. Heat is conducted, k grad T with k = alpha C'', so D contains r, too: sum D T is the heat
//
// `surface`: finite volumes in each layer, lumped (D = r times the area of the particle in its own layer).
//   Corner layer: linear finite elements on triangles, exact for linear T on flat meshes. On cells whose angles would
//   make a conductance negative, positive weights replace them (weights.c). On rectangles the diagonals vanish and the
//   five-point Laplacian remains, for any dx : dy.
//   Centre layer: two-point fluxes through the edge e that two cells share, their centres d apart, c = a |e x d|/|d|^2.
//   On rectangles |e|/|d|, exact. On skewed cells the trace of the diffusion tensor is right, but the effect of the
//   skew is lost: the error is a factor 1 -+ cos(skew) along the diagonals.
//   Through the thickness: each red spring carries c = X S/2, X = r layer_exchange/F, the mean of the spring's ends, S
//   the corner's share of the cell's area. The shares at a centre sum to its area, those at a corner to its own, so two
//   layers of uniform T1 and T2 each change at the rate X/2 towards the other: T1 - T2 decays as exp(-X t).
//   Red springs are inclined: heat that flows through the thickness also moves half a cell sideways and back, which
//   adds X dx^2/16 to the diffusivity along a side of length dx. This is subtracted from blue springs (X S/32 for each
//   cell at the spring) and green ones (X/32 times the areas of both cells), which makes the sum exact on
//   parallelograms; at most nine tenths of a spring's conductance are subtracted, the limit where X dx^2 > 14 a.
//   No conductance is negative, on any mesh: (D + dt L) is an M-matrix, and stays one when springs are removed.
//
// `umbrella`: eq 3 as printed, over all springs with their initial lengths d_ij:
//   L(T_i) = (2/E_i) sum (T_j - T_i)/d_ij, E_i = sum d_ij; so D_i = E_i/2 and c = a/d_ij.
//   It is not a Laplacian in general. On a regular BCS grid with spacings dx, dy, diagonal q, and red length
//   r = sqrt(q^2/4 + t^2), smooth T diffuses along x with
//     a_x/a = (2 dx + 2 dx^2/q + dx^2/r)/(2 dx + 2 dy + 2 q + 4 r),
//   one half for dx = dy and t = 0; less for thick shells, and a_x/a_y is not 1 where dx is not dy.
//   `umbrella-live` is the letter of eq 3: d_ij are the lengths of the moment, of the springs that are left, so D and c
//   are made again at every step. A length counts as at least LIVE_LENGTH_MIN of the initial one, the least target.
//   It conserves sum D_i T_i, not the heat sum C_i T_i, as D is not proportional to the area: corners have yellow
//   springs, too. See heat_conduct for how the ledger accounts for that.
#include <math.h>

#include "common/assertion.h"
#include "common/real.h"
#include "heat/heat_plan.h"

/// The shortest length of eq 3 as printed, over the initial one: eq 6's least target (burn/shrink.c).
static const float LIVE_LENGTH_MIN = 0.05f;

/// Diffusivity of a spring with F and r, m2/s.
static float operator_spring(const HeatPlan *plan, const Shell *shell, SingeColour colour, uint32_t spring) {
    const uint32_t *ends = shell->springs[colour].ends[spring];
    const Matter *matter = &shell->matter;
    uint32_t sheet = matter->sheet[ends[0]];
    bool surface = shell->sheets[sheet].material.heat_operator == SINGE_HEAT_SURFACE;
    float end[2];

    for (int k = 0; k < 2; k++)
        end[k] = field_at(matter->diffusivity, ends[k]) * (surface ? field_at(matter->capacity_ratio, ends[k]) : 1);

    return 0.5f * (end[0] + end[1]) * plan->thickening[sheet];
}

/// Exchange rate between the layers, mean of both particles, 1/s.
static float operator_rate(const HeatPlan *plan, const Shell *shell, uint32_t a, uint32_t b) {
    const Matter *matter = &shell->matter;
    float mean = 0.5f * (field_at(matter->layer_exchange, a) * field_at(matter->capacity_ratio, a) +
                         field_at(matter->layer_exchange, b) * field_at(matter->capacity_ratio, b));
    return mean / plan->thickening[matter->sheet[a]];
}

/// A weight less the sideways conduction of the red springs next to it, `leak` in m2/s.
static double operator_less(double weight, double leak, float diffusivity) {
    return weight > 0 && diffusivity > 0 ? double_max(0.1 * weight, weight - leak / (double)diffusivity) : weight;
}

/// The exponent of a cell's width, m, as a power of two: division by this power changes no digits, and products of the
/// quotients fit a float, however large or small the cell is.
static int operator_scale(const Shell *shell, uint32_t cell) {
    const float *first = shell->rest_position[shell->cells[cell][0]];
    float widest = 0;
    for (int k = 1; k < 4; k++)
        for (int d = 0; d < 3; d++)
            widest = float_max(widest, fabsf(shell->rest_position[shell->cells[cell][k]][d] - first[d]));
    return ilogbf(widest);
}

static void operator_corners(const Shell *shell, uint32_t cell, int scale, Float3 x[4]) {
    SINGE_ASSERT(cell < shell->cell_count);
    for (int k = 0; k < 4; k++) {
        const float *position = shell->rest_position[shell->cells[cell][k]];
        x[k] = float3(ldexpf(position[0], -scale), ldexpf(position[1], -scale), ldexpf(position[2], -scale));
    }
}

/// Linear elements' weights of a cell; false if they do not suffice.
static bool operator_linear(const Shell *shell, uint32_t cell, Float3 x[4], double w[6]) {
    operator_corners(shell, cell, operator_scale(shell, cell), x);
    bool good = heat_cell_linear(x, w);
    for (int k = 0; k < 6; k++) good &= w[k] >= 0;
    return good;
}

/// Weights of a cell's sides and diagonals.
static void operator_weights(const Shell *shell, uint32_t cell, double w[6]) {
    const CellSprings *springs = &shell->cell_springs[cell];
    double across[4] = {0}, there[6];
    Float3 x[4], y[4];

    if (operator_linear(shell, cell, x, w)) return;

    for (int k = 0; k < 4; k++) {
        uint32_t other = shell_neighbour(shell, cell, k);
        if (other == SHELL_NONE) continue;
        operator_linear(shell, other, y, there);
        for (int j = 0; j < 4; j++)
            if (shell->cell_springs[other].blue[j] == springs->blue[k]) across[k] += there[j];
    }

    heat_cell_weights(x, across, w);
}

/// A cell's contribution to the spring along a side, from the side's weight.
static float operator_side(const HeatPlan *plan, const Shell *shell, uint32_t cell, int side, double weight) {
    uint32_t centre = shell_centre(shell, cell);
    double lean = (double)operator_rate(plan, shell, centre, centre) / 32, area = (double)shell->matter.area[centre];
    float diffusivity = operator_spring(plan, shell, SINGE_BLUE, shell->cell_springs[cell].blue[side]);
    return (float)operator_less(weight, lean * area, diffusivity);
}

/// The springs of one cell of the surface operator, without diffusivity and F.
static void operator_cell(HeatPlan *plan, const Shell *shell, uint32_t cell) {
    const CellSprings *springs = &shell->cell_springs[cell];
    const uint32_t *first = plan->spring_first;
    float *conductance = plan->conductance;
    double w[6];
    uint32_t centre = shell_centre(shell, cell);
    double area = (double)shell->matter.area[centre];

    operator_weights(shell, cell, w);

    // sides and diagonals, by the cell's weights
    for (int k = 0; k < 4; k++)
        conductance[first[SINGE_BLUE] + springs->blue[k]] += operator_side(plan, shell, cell, k, w[k]);
    for (int k = 0; k < 2; k++) conductance[first[SINGE_YELLOW] + springs->yellow[k]] = (float)w[4 + k];

    Float3 x[4];
    int scale = operator_scale(shell, cell);
    operator_corners(shell, cell, scale, x);
    Float3 centroid = float3_scale(float3_add(float3_add(x[0], x[1]), float3_add(x[2], x[3])), 0.25f);

    for (int k = 0; k < 4; k++) {
        uint32_t other = shell_neighbour(shell, cell, k);
        if (other == SHELL_NONE || springs->green[k] == SHELL_NONE) continue;

        // two-point flux through the side that two cells share
        Float3 y[4];
        operator_corners(shell, other, scale, y);
        Float3 d = float3_scale(float3_add(float3_add(y[0], y[1]), float3_add(y[2], y[3])), 0.25f);
        d = float3_sub(d, centroid);
        float square = float3_dot(d, d);
        float face = float3_length(float3_cross(float3_sub(x[(k + 1) % 4], x[k]), d));
        double flux = square > 0 ? (double)(face / square) : 0;

        uint32_t beyond = shell_centre(shell, other);
        double both = (double)operator_rate(plan, shell, centre, beyond) / 32;
        double leak = both * (area + (double)shell->matter.area[beyond]);
        float diffusivity = operator_spring(plan, shell, SINGE_GREEN, springs->green[k]);
        conductance[first[SINGE_GREEN] + springs->green[k]] = (float)operator_less(flux, leak, diffusivity);
    }

    // red springs, which do not depend on the diffusivity. A corner's share is half of the two triangles at it that
    // meet in the cell's centre, which are negative if they face away; or a quarter of the cell if a corner is concave
    const float own = shell->matter.area[centre];
    Float3 normal = float3_unit(float3_cross(float3_sub(x[2], x[0]), float3_sub(x[3], x[1])));
    double triangle[4];
    bool even = false;

    for (int k = 0; k < 4; k++) {
        Float3 cross = float3_cross(float3_sub(x[(k + 1) % 4], x[k]), float3_sub(centroid, x[k]));
        double twice = float3_dot(cross, normal);
        triangle[k] = ldexp(twice / 2, 2 * scale);
    }

    for (int k = 0; k < 4; k++) even |= !(triangle[k] + triangle[(k + 3) % 4] > own / 16);
    for (int k = 0; k < 4; k++) {
        double share = even ? own / 4 : (triangle[k] + triangle[(k + 3) % 4]) / 2;
        float rate = operator_rate(plan, shell, centre, shell->cells[cell][k]);
        plan->conductance[plan->spring_first[SINGE_RED] + shell->cell_springs[cell].red[k]] = (float)(rate * share / 2);
    }
}

/// The length of a spring in eq 3, m; 0 if heat no longer goes along it. `state` is NULL before the first step.
static float operator_length(const Shell *shell, const StateInput *state, SingeColour colour, uint32_t spring) {
    const SpringSet *set = &shell->springs[colour];
    const uint32_t a = set->ends[spring][0], b = set->ends[spring][1];
    const float rest = set->rest[spring];
    const bool live = shell->sheets[shell->matter.sheet[a]].material.heat_operator == SINGE_HEAT_UMBRELLA_LIVE;
    if (!live || !state) return rest;

    const AblateState *ablate = state->ablate;
    if (!(ablate->spring_flags[colour][spring] & ablate->particle_flags[a] & ablate->particle_flags[b] & SINGE_ALIVE))
        return 0;

    const float(*x)[4] = (const float(*)[4])state->dynamics->position;
    const float length = float3_length(float3_sub(float3_load(x[a]), float3_load(x[b])));
    return float_max(length, LIVE_LENGTH_MIN * rest);
}

/// A weight times alpha F. The sum of two cells' weights is 0 or more, unless mixing reduced one of them.
static float operator_conductance(const HeatPlan *plan, const Shell *shell, SingeColour colour, uint32_t spring,
                                  float weight) {
    SINGE_ASSERT(spring < shell->springs[colour].count);
    return weight > 0 ? weight * operator_spring(plan, shell, colour, spring) : 0;
}

void heat_operator(HeatPlan *plan, const Shell *shell, const StateInput *state) {
    const Matter *matter = &shell->matter;

    // surface: capacities, weights of the cells, exchange between the layers
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        if (sheet->material.heat_operator != SINGE_HEAT_SURFACE) continue;
        for (uint32_t i = 0; i < shell->particle_count; i++)
            if (matter->sheet[i] == s) plan->measure[i] = matter->area[i] * field_at(matter->capacity_ratio, i);
        for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++)
            operator_cell(plan, shell, c);
    }

    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        const SpringSet *set = &shell->springs[c];
        for (uint32_t k = 0; k < set->count; k++) {
            uint32_t a = set->ends[k][0], b = set->ends[k][1];
            float *conductance = &plan->conductance[plan->spring_first[c] + k];

            // umbrella: half the lengths of the springs at a particle, and their inverses
            bool surface = shell->sheets[matter->sheet[a]].material.heat_operator == SINGE_HEAT_SURFACE;
            if (!surface) {
                const float length = operator_length(shell, state, (SingeColour)c, k);
                plan->measure[a] += length / 2;
                plan->measure[b] += length / 2;
                *conductance = length > 0 ? 1 / length : 0;
            }

            // times alpha F, all but exchange rates
            if (c != SINGE_RED || !surface)
                *conductance = operator_conductance(plan, shell, (SingeColour)c, k, *conductance);
            SINGE_ASSERT(!(*conductance < 0)); // the matrix is an M-matrix on any mesh
        }
    }
}

void heat_operator_torn_vertex(HeatPlan *plan, const Shell *shell, uint32_t vertex) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    plan->measure[vertex] = shell->matter.area[vertex] * field_at(shell->matter.capacity_ratio, vertex);
}

void heat_operator_torn_cell(HeatPlan *plan, const Shell *shell, uint32_t cell) {
    SINGE_ASSERT(cell < shell->cell_count);
    const CellSprings *springs = &shell->cell_springs[cell];
    const uint32_t *first = plan->spring_first;
    double w[6], there[6];
    operator_weights(shell, cell, w);

    for (int side = 0; side < 4; side++) {
        uint32_t spring = springs->blue[side], other = shell_neighbour(shell, cell, side);
        float sum = operator_side(plan, shell, cell, side, w[side]);
        if (other != SHELL_NONE) operator_weights(shell, other, there);
        for (int k = 0; other != SHELL_NONE && k < 4; k++)
            if (shell->cell_springs[other].blue[k] == spring) sum += operator_side(plan, shell, other, k, there[k]);
        plan->conductance[first[SINGE_BLUE] + spring] = operator_conductance(plan, shell, SINGE_BLUE, spring, sum);
    }

    for (int k = 0; k < 2; k++)
        plan->conductance[first[SINGE_YELLOW] + springs->yellow[k]] =
            operator_conductance(plan, shell, SINGE_YELLOW, springs->yellow[k], (float)w[4 + k]);
}

bool heat_operator_may_change(const Shell *shell, uint32_t cell) {
    double w[6];
    Float3 x[4];
    return !operator_linear(shell, cell, x, w);
}
