// Which positions are drawn: burnt edges crumble, and the edges of tears fray.
//
// Burnt edges. A noise r(x) of the rest position, from 0 to `reach` and fixed to the paper, is the depth to which the
// edge is eroded at x:
//
//   L(x) = min { S(x), S(x + r u_1), S(x + r u_2), S(x + r u_3) },   u_i three directions 120 degrees apart
//
// with S the lesser of the smooth level m' and the level of the remaining cells (fine_spline.c); the angle of the
// directions is another noise. Positions with L >= 0 are drawn: about those farther than r from the edge of S. As S
// never grows, L never grows, whatever the front's width and speed: burnt parts do not return, the edge stops where the
// fire stops, and the noise displaces the edge by a length. Nothing is drawn outside S >= 0. The mass drawn is that of
// the point at which the minimum is taken, so that char follows the edge.
//
// r is a sum of octaves, each half the size of the one before, down to the size of the fine triangles. Its lattice is
// rotated out of the sheet's plane and grid.
//
// Tears. A sheet tears along the sides of its cells (src/tear): drawn as they are, tears would be straight cuts and
// staircases. So their edges are drawn slightly inside their cells, where a smooth field S is 0.3:
//
//   S    a spline of fine_spline.c, with b = 1 for a side, 0 if it is torn; for a vertex at a tear b =
//        min(3/4, A/pi - 1), with A the angle of the cells that it still has, doubled at the border of the sheet: 0
//        beside a straight tear, -1/2 at a convex corner, 1/2 at a concave corner, 3/4 at the tear's end
//   L(x) = max(S(x + D(x)) - 0.3, z(x + D(x)) - 0.45)/2
//
// D is a vector noise of the rest position. It is the same at both tear edges, which lie on different sides, so each
// keeps the material that the other loses: the tear meanders, frays at small scales, and its edges fit together. x + D
// stays on the edge's own side, as no walk crosses a torn side: it ends there, where S is 0 (fine_walk). S is that of
// the torn sheet, so its isolines run diagonally where a tear runs in stairs. z is the weight of a cell's centroid: a
// cell torn off on all sides is drawn, too.
//
// Nothing is drawn outside the cells, so tear edges intersect only what the cells intersect.
#include "common/random.h"
#include "common/real.h"
#include "surface/surface_fine.h"

#define PI 3.14159265f

/// The largest features of the noise, m; its mean depth over the reach; an octave's strength over that of the one
/// before; the first octave's strength.
#define NOISE_SIZE 3e-3f
#define NOISE_MEAN 0.45f
#define NOISE_STRENGTH 0.7f
#define NOISE_GAIN 2.3f

int fine_octaves(float spacing) {
    int octaves = 1;
    for (float size = 0.5f * NOISE_SIZE; size >= 1.6f * spacing && octaves < 8; size *= 0.5f) octaves++;
    return octaves;
}

static Float3 fine_rest(const Shell *shell, const FineLocation *location) {
    const uint32_t *at = shell->cells[location->cell];
    float quarter = 0.25f * location->weight[2];
    Float3 sum = {0, 0, 0};

    for (int i = 0; i < 4; i++) {
        float weight = quarter;
        if (i == location->side) weight += location->weight[0];
        if (i == ((location->side + 1) & 3)) weight += location->weight[1];
        sum = float3_mad(sum, float3_load(shell->rest_position[at[i]]), weight);
    }

    return sum;
}

static Float3 fine_askew(Float3 p) {
    return float3(0.7447f * p.x - 0.5389f * p.y + 0.3937f * p.z, 0.6325f * p.x + 0.7574f * p.y - 0.1598f * p.z,
                  -0.2121f * p.x + 0.3680f * p.y + 0.9053f * p.z);
}

/// A length in cells, at most a half.
static float half_max(float length, float axis) { return length < 0.5f * axis ? length / axis : length > 0 ? 0.5f : 0; }

/// S at a position.
static float smooth_level(const Fine *fine, const FineLocation *location) {
    float level = fine_spline_at(fine->shell, &fine->splines[SPLINE_LEVEL], location);
    if (fine->flags[location->cell] & FINE_WHOLE) return level;
    return float_min(level, fine_whole_level(fine_spline_at(fine->shell, &fine->splines[SPLINE_WHOLE], location)));
}

// ---- the edges of tears

static const float TEAR_EDGE_MIN = 0.3f;       ///< S at the tear edge: 0.16 of a cell's side beside a straight tear
static const float TEAR_EDGE_CENTROID = 0.45f; ///< min z that is drawn whatever S is
static const float TEAR_EDGE_WANDERS = 0.25f;  ///< max |D|, over a cell's side
static const float TEAR_EDGE_WAVE = 2.2f;      ///< largest features of D, over a cell's side
static const float TEAR_EDGE_STRENGTH = 0.6f,
                   TEAR_EDGE_GAIN = 2.4f; ///< of an octave over that of the one before; of the first

/// b of a vertex at a tear; marks its cells.
static void tear_edge_vertex(Fine *fine, uint32_t vertex) {
    const Shell *shell = fine->shell;
    const Spline *spline = &fine->splines[SPLINE_TEAR_EDGE];
    float angle = 0;
    bool border = false;

    if (shell->fan_first[vertex] == shell->fan_first[vertex + 1]) return;
    if (fine_splits(fine, shell->fan[shell->fan_first[vertex]]) == 1) return; // too coarse to be drawn any finer

    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++) {
        uint32_t cell = shell->fan[k];
        int i = 0;
        while (shell->cells[cell][i] != vertex) i++;

        const uint32_t *at = shell->cells[cell];
        Float3 p = float3_load(shell->rest_position[vertex]);
        Float3 a = float3_unit(float3_sub(float3_load(shell->rest_position[at[(i + 1) & 3]]), p));
        Float3 b = float3_unit(float3_sub(float3_load(shell->rest_position[at[(i + 3) & 3]]), p));
        angle += real_atan2f(float3_length(float3_cross(a, b)), float3_dot(a, b));
        for (int side = i, turn = 0; turn < 2; turn++, side = (i + 3) & 3)
            border |= shell_neighbour(shell, cell, side) == SHELL_NONE &&
                      spline->edge[shell->cell_springs[cell].blue[side]] > 0;
        fine->flags[cell] = (uint8_t)((fine->flags[cell] | FINE_TEAR_EDGE) & ~FINE_EVEN);
    }

    spline->corner[vertex] = float_max(-0.5f, float_min((border ? 2 : 1) * angle / PI - 1, 0.75f));
}

void fine_tear_edges(Fine *fine) {
    const Shell *shell = fine->shell;
    const SpringSet *blue = &shell->springs[SINGE_BLUE];
    const Spline *spline = &fine->splines[SPLINE_TEAR_EDGE];
    uint32_t first = blue->count - shell->edge_spare_count;

    if (shell->edge_spare_used == 0) return;

    for (uint32_t s = 0; s < blue->count; s++) spline->edge[s] = 1;
    for (uint32_t v = 0; v < shell->vertex_count; v++) spline->corner[v] = 1;
    for (uint32_t k = 0; k < shell->edge_spare_used; k++)
        spline->edge[first + k] = spline->edge[shell->edge_origin[k]] = 0;
    for (uint32_t k = 0; k < shell->edge_spare_used; k++)
        for (int end = 0; end < 2; end++) {
            tear_edge_vertex(fine, blue->ends[first + k][end]);
            tear_edge_vertex(fine, blue->ends[shell->edge_origin[k]][end]);
        }
}

static float fine_tear_level(const Fine *fine, const FineLocation *location) {
    const Shell *shell = fine->shell;
    uint32_t index = shell->matter.sheet[shell_centre(shell, location->cell)];
    const FineSheet *sheet = &fine->sheets[index];
    float size = shell->sheets[index].cell_size, reach = float_min(sheet->reach, TEAR_EDGE_WANDERS * size);
    FineLocation there = *location;

    if (reach > 0) {
        // D, at most `reach` long
        Float3 p = float3_scale(fine_askew(fine_rest(shell, location)), 1 / (TEAR_EDGE_WAVE * size)), sum = {0, 0, 0};
        float strength = TEAR_EDGE_GAIN;
        for (int octave = 0; octave < sheet->octaves; octave++) {
            const uint32_t seed = sheet->seed + 3 * (uint32_t)octave + 101;
            Float3 noise = float3(random_noise(p.x, p.y, p.z, seed), random_noise(p.x, p.y, p.z, seed + 1),
                                  random_noise(p.x, p.y, p.z, seed + 2));
            sum = float3_mad(sum, float3_sub(noise, float3(0.5f, 0.5f, 0.5f)), strength);
            strength *= TEAR_EDGE_STRENGTH;
            p = float3_add(float3_scale(p, 2), float3(11.83f, 17.31f, 5.77f));
        }

        float length = float3_length(sum);
        const Float3 displacement = float3_scale(sum, length > 1 ? reach / length : reach);
        there = fine_move(shell, location, displacement);
    }

    float field = fine_spline_at(shell, &fine->splines[SPLINE_TEAR_EDGE], &there);
    return 0.5f * float_max(field - TEAR_EDGE_MIN, there.weight[2] - TEAR_EDGE_CENTROID);
}

// ---- the level

FineValue fine_value(const Fine *fine, const FineLocation *location) {
    const Shell *shell = fine->shell;
    uint32_t sheet = shell->matter.sheet[shell_centre(shell, location->cell)];
    FineLocation walked[3];
    const FineLocation *least = location;
    float min = smooth_level(fine, location), angle = 0, x, y;

    if (fine->sheets[sheet].reach > 0) {
        // the noise: the depth of erosion, m, and the direction, as an angle
        const FineSheet *own = &fine->sheets[sheet];
        Float3 p = float3_scale(fine_askew(fine_rest(shell, location)), 1 / NOISE_SIZE);
        float sum = 0, strength = NOISE_GAIN;
        for (int octave = 0; octave < own->octaves; octave++) {
            float noise = random_noise(p.x, p.y, p.z, own->seed + (uint32_t)octave);
            if (octave <= 1) angle = 3 * (2 * PI) * noise;
            sum += strength * (noise - 0.5f);
            strength *= NOISE_STRENGTH;
            p = float3_add(float3_scale(p, 2), float3(17.31f, 5.77f, 11.83f));
        }

        float depth = fabsf(NOISE_MEAN + sum); // reflected into 0 to 1, so that no edge is smooth
        if (depth > 1) depth = float_max(2 - depth, 0);
        depth *= own->reach;
        x = half_max(depth, fine->axes[location->cell][0]);
        y = half_max(depth, fine->axes[location->cell][1]);

        // the min over three directions
        float c = real_cosf(angle), s = real_sinf(angle);
        const float across = 0.8660254f; // of 120 degrees
        const float direction[3][2] = {
            {c, s}, {-0.5f * c - across * s, across * c - 0.5f * s}, {-0.5f * c + across * s, -across * c - 0.5f * s}};
        for (int i = 0; i < 3; i++) {
            fine_walk(shell, location, x * direction[i][0], y * direction[i][1], &walked[i]);
            float value = smooth_level(fine, &walked[i]);
            if (value < min) {
                min = value;
                least = &walked[i];
            }
        }
    }

    // edges of tears
    if (fine->flags[location->cell] & FINE_TEAR_EDGE) min = float_min(min, fine_tear_level(fine, location));
    return (FineValue){min, fine_spline_at(shell, &fine->splines[SPLINE_MASS], least)};
}
