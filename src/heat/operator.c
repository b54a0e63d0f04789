// The discrete Laplacians of the heat equation, eq 2, as one conductance per spring:
//
//   D_i dT_i/dt = sum over springs (i, j) of c_ij (T_j - T_i)
//
// T   K      temperature
// D   capacity of the operator: area (m2) for `surface`, length (m) for `umbrella`
// c   D per second, symmetric, so that sum D_i T_i is constant and a uniform T stays uniform
// a   m2/s   diffusivity alpha of eq 2 times r: the mean of the spring's ends, times the front thickening F
// r          capacity per area over its mean in the sheet; 1 for the umbrella, and wherever grammage and specific heat
//            do not vary. What is conducted is heat, k grad T with k = alpha C'', so D holds r too: sum D T is the heat
//
// `surface`: finite volumes in each layer, lumped (D = r times the area of the particle in its own layer).
//   Corner layer: linear finite elements on triangles, averaged over both ways to split each quad; on an
//   edge, c = a (cot A + cot B)/2 with the angles opposite to it (MacNeal 1949; Pinkall & Polthier 1993).
//   Exact for linear T on flat meshes; on rectangles the diagonals drop out and the five-point Laplacian
//   remains, for any dx : dy.
//   Centre layer: two-point fluxes through the edge e that two cells share, their centres d apart,
//   c = a |e x d|/|d|^2. On rectangles |e|/|d|, exact. On skewed cells the trace of the diffusion tensor is
//   right, but what one sees of the skew is lost: the error is a factor 1 -+ cos(skew) along the diagonals.
//   Through the thickness: each red spring carries c = X S/2, X = r layer_exchange/F, the mean of the spring's ends, S
//   the share of the cell's area that its corner has. The shares at a centre sum to its area, those at a corner to its
//   own, so two layers of uniform T1 and T2 each change at the rate X/2 towards the other: T1 - T2 decays as exp(-X t).
//   Red springs lean: what goes through the thickness also moves half a cell sideways and back, which diffuses along
//   a side of length dx like a further X dx^2/16. So much is taken from blue (X S/32 for each cell beside the
//   spring) and green (X/32 times the areas of both cells), which makes the sum exact on parallelograms; at most
//   nine tenths of a spring's conductance, which is reached where X dx^2 > 14 a.
//
// `umbrella`: eq 3 as printed, over all springs with their initial lengths d_ij:
//   L(T_i) = (2/E_i) sum (T_j - T_i)/d_ij, E_i = sum d_ij; so D_i = E_i/2 and c = a/d_ij.
//   It is not a Laplacian in general. On a regular BCS grid with spacings dx, dy, diagonal q, and red length
//   r = sqrt(q^2/4 + t^2), smooth T diffuses along x with
//     a_x/a = (2 dx + 2 dx^2/q + dx^2/r)/(2 dx + 2 dy + 2 q + 4 r),
//   one half for dx = dy and t = 0; less for thick shells, and a_x/a_y is not 1 where dx is not dy.
//   What it keeps is sum D_i T_i, which is not the heat sum C_i T_i, as D is not in proportion to the
//   area: corners hold yellow springs too. See heat_conduct for what the ledger makes of that.
#include <math.h>

#include "heat/plan.h"

/// |(b - a) x (c - a)| signed along `normal`, and the cotangent of the angle at a.
static double operator_cot(Vec a, Vec b, Vec c) {
    Vec u = vec_sub(b, a), v = vec_sub(c, a);
    double area = vec_length(vec_cross(u, v)), cot = area > 0 ? vec_dot(u, v) / area : 0;
    return fmin(fmax(cot, -50), 50);
}

static double operator_triangle(Vec a, Vec b, Vec c, Vec normal) {
    return vec_dot(vec_cross(vec_sub(b, a), vec_sub(c, a)), normal);
}

/// Adds a cell's cotangents to its sides' and diagonals' weights. A split that turns a triangle over, or leaves one
/// without area, is left out (arrow-shaped cells, three corners in line).
static void operator_cotangents(const Vec x[4], double side[4], double diagonal[2]) {
    Vec normal = vec_unit(vec_cross(vec_sub(x[2], x[0]), vec_sub(x[3], x[1])));
    double least[2], total = 0, share[2];
    for (int split = 0; split < 2; split++) {
        int a = split, b = split + 1, c = split + 2, d = (split + 3) % 4;
        double one = operator_triangle(x[a], x[b], x[c], normal), two = operator_triangle(x[a], x[c], x[d], normal);
        least[split] = fmin(one, two);
        total = fmax(total, one + two);
    }
    bool good[2] = {least[0] > 1e-3 * total, least[1] > 1e-3 * total};
    for (int split = 0; split < 2; split++) share[split] = good[0] == good[1] ? 0.5 : good[split];
    for (int split = 0; split < 2; split++) {
        // triangles (a, b, c) and (a, c, d); sides are numbered by their first corner
        int a = split, b = split + 1, c = split + 2, d = (split + 3) % 4;
        double half = share[split] / 2;
        side[a] += half * operator_cot(x[c], x[a], x[b]);
        side[b] += half * operator_cot(x[a], x[b], x[c]);
        side[c] += half * operator_cot(x[a], x[c], x[d]);
        side[d] += half * operator_cot(x[c], x[d], x[a]);
        diagonal[split] += half * (operator_cot(x[b], x[c], x[a]) + operator_cot(x[d], x[a], x[c]));
    }
}

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

/// Exchange between the layers, as it is at both particles in the mean, 1/s.
static float operator_rate(const HeatPlan *plan, const Shell *shell, uint32_t a, uint32_t b) {
    const Matter *matter = &shell->matter;
    float mean = 0.5f * (field_at(matter->layer_exchange, a) * field_at(matter->capacity_ratio, a) +
                         field_at(matter->layer_exchange, b) * field_at(matter->capacity_ratio, b));
    return mean / plan->thickening[matter->sheet[a]];
}

/// A weight less what the red springs carry beside it, `leak` in m2/s.
static double operator_less(double weight, double leak, float diffusivity) {
    return weight > 0 && diffusivity > 0 ? fmax(0.1 * weight, weight - leak / (double)diffusivity) : weight;
}

static void operator_corners(const Shell *shell, uint32_t cell, Vec x[4]) {
    for (int k = 0; k < 4; k++) x[k] = vec_load(shell->rest_position[shell->cells[cell][k]]);
}

/// What a cell whose side has the weight gives to the spring along it.
static float operator_side(const HeatPlan *plan, const Shell *shell, uint32_t cell, int side, double weight) {
    uint32_t centre = shell_centre(shell, cell);
    double lean = (double)operator_rate(plan, shell, centre, centre) / 32, area = (double)shell->matter.area[centre];
    float diffusivity = operator_spring(plan, shell, SINGE_BLUE, shell->cell_springs[cell].blue[side]);
    return (float)operator_less(weight, lean * area, diffusivity);
}

/// The geometry of one cell of the surface operator, without diffusivity and F.
static void operator_cell(HeatPlan *plan, const Shell *shell, uint32_t cell) {
    const CellSprings *springs = &shell->cell_springs[cell];
    const uint32_t *first = plan->spring_first;
    float *conductance = plan->conductance;
    Vec x[4], y[4];
    operator_corners(shell, cell, x);
    double side[4] = {0}, diagonal[2] = {0}, largest = 0;
    uint32_t centre = shell_centre(shell, cell);
    double area = (double)shell->matter.area[centre];
    operator_cotangents(x, side, diagonal);
    for (int k = 0; k < 4; k++) {
        conductance[first[SINGE_BLUE] + springs->blue[k]] += operator_side(plan, shell, cell, k, side[k]);
        largest = fmax(largest, fabs(side[k]));
    }
    // what rounding leaves of a right angle needs no entry in the matrix
    for (int k = 0; k < 2; k++)
        if (fabs(diagonal[k]) > 3e-5 * largest)
            conductance[first[SINGE_YELLOW] + springs->yellow[k]] = (float)diagonal[k];
    Vec middle = vec_scale(vec_add(vec_add(x[0], x[1]), vec_add(x[2], x[3])), 0.25f);
    for (int k = 0; k < 4; k++) {
        uint32_t other = shell_neighbour(shell, cell, k);
        if (other == SHELL_NONE || springs->green[k] == SHELL_NONE) continue;
        operator_corners(shell, other, y);
        Vec d = vec_sub(vec_scale(vec_add(vec_add(y[0], y[1]), vec_add(y[2], y[3])), 0.25f), middle);
        float square = vec_dot(d, d);
        float face = vec_length(vec_cross(vec_sub(x[(k + 1) % 4], x[k]), d));
        uint32_t beyond = shell_centre(shell, other);
        double both = (double)operator_rate(plan, shell, centre, beyond) / 32;
        double leak = both * (area + (double)shell->matter.area[beyond]);
        float diffusivity = operator_spring(plan, shell, SINGE_GREEN, springs->green[k]);
        conductance[first[SINGE_GREEN] + springs->green[k]] =
            square > 0 ? (float)operator_less((double)(face / square), leak, diffusivity) : 0;
    }
}

/// The red springs of a cell: nothing of the diffusivity. A corner's share is half of the two triangles at it
/// that meet in the cell's middle, or a quarter where a corner is turned inwards.
static void operator_exchange(HeatPlan *plan, const Shell *shell, uint32_t cell) {
    uint32_t centre = shell_centre(shell, cell);
    float area = shell->matter.area[centre];
    Vec x[4];
    operator_corners(shell, cell, x);
    Vec normal = vec_unit(vec_cross(vec_sub(x[2], x[0]), vec_sub(x[3], x[1])));
    Vec middle = vec_scale(vec_add(vec_add(x[0], x[1]), vec_add(x[2], x[3])), 0.25f);
    double triangle[4];
    bool even = false;
    for (int k = 0; k < 4; k++) triangle[k] = operator_triangle(x[k], x[(k + 1) % 4], middle, normal) / 2;
    for (int k = 0; k < 4; k++) even |= !(triangle[k] + triangle[(k + 3) % 4] > area / 16);
    for (int k = 0; k < 4; k++) {
        double share = even ? area / 4 : (triangle[k] + triangle[(k + 3) % 4]) / 2;
        float rate = operator_rate(plan, shell, centre, shell->cells[cell][k]);
        plan->conductance[plan->spring_first[SINGE_RED] + shell->cell_springs[cell].red[k]] = (float)(rate * share / 2);
    }
}

static void operator_umbrella(HeatPlan *plan, const Shell *shell, uint32_t sheet) {
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        const SpringSet *set = &shell->springs[c];
        for (uint32_t k = 0; k < set->count; k++) {
            uint32_t a = set->ends[k][0], b = set->ends[k][1];
            if (shell->matter.sheet[a] != sheet) continue;
            plan->measure[a] += set->rest[k] / 2;
            plan->measure[b] += set->rest[k] / 2;
            plan->conductance[plan->spring_first[c] + k] = set->rest[k] > 0 ? 1 / set->rest[k] : 0;
        }
    }
}

/// Multiplies by alpha F what is not an exchange rate already.
static void operator_diffusivity(HeatPlan *plan, const Shell *shell) {
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < shell->springs[c].count; k++) {
            uint32_t sheet = shell->matter.sheet[shell->springs[c].ends[k][0]];
            if (c == SINGE_RED && shell->sheets[sheet].material.heat_operator == SINGE_HEAT_SURFACE) continue;
            plan->conductance[plan->spring_first[c] + k] *= operator_spring(plan, shell, (SingeColour)c, k);
        }
}

void heat_operator(HeatPlan *plan, const Shell *shell) {
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        if (sheet->material.heat_operator == SINGE_HEAT_UMBRELLA) {
            operator_umbrella(plan, shell, s);
            continue;
        }
        for (uint32_t i = 0; i < shell->particle_count; i++)
            if (shell->matter.sheet[i] == s)
                plan->measure[i] = shell->matter.area[i] * field_at(shell->matter.capacity_ratio, i);
        for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++) {
            operator_cell(plan, shell, c);
            operator_exchange(plan, shell, c);
        }
    }
    operator_diffusivity(plan, shell);
}

/// A cell's part of the conductance along a side, without diffusivity and F.
static float operator_part(const HeatPlan *plan, const Shell *shell, uint32_t cell, int side) {
    double weight[4] = {0}, diagonal[2] = {0};
    Vec x[4];
    operator_corners(shell, cell, x);
    operator_cotangents(x, weight, diagonal);
    return operator_side(plan, shell, cell, side, weight[side]);
}

void heat_operator_torn(HeatPlan *plan, const Shell *shell, uint32_t cell, int corner) {
    const CellSprings *springs = &shell->cell_springs[cell];
    uint32_t vertex = shell->cells[cell][corner];
    plan->measure[vertex] = shell->matter.area[vertex] * field_at(shell->matter.capacity_ratio, vertex);
    for (int turn = 0; turn < 2; turn++) {
        int side = turn ? (corner + 3) & 3 : corner;
        uint32_t spring = springs->blue[side], other = shell_neighbour(shell, cell, side);
        float sum = operator_part(plan, shell, cell, side);
        for (int k = 0; other != SHELL_NONE && k < 4; k++)
            if (shell->cell_springs[other].blue[k] == spring) sum += operator_part(plan, shell, other, k);
        plan->conductance[plan->spring_first[SINGE_BLUE] + spring] =
            sum * operator_spring(plan, shell, SINGE_BLUE, spring);
    }
}
