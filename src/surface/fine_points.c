// Which cells are split, and the points at which the level is evaluated.
//
// A cell is near the front if, by the bounds of the splines, the level may be positive in it, and negative in it or in
// one of the eight cells around it. Such a cell gets points: k - 1 within a side and within each line from a corner to
// the centre, (k - 1)(k - 2)/2 within a triangle. The level is evaluated there; on a side once, for both of its cells;
// and nowhere where the bounds about the cell's vertices show that noise finds no negative level from within it.
// A cell is split if these levels differ in sign; otherwise its four triangles suffice.
//
// A bent cell that is not split gets points to show its shape, in fewer parts. A side is drawn in the max of the
// numbers of parts of its two cells.
#include "common/real.h"
#include "surface/surface_fine.h"

#include <string.h>

/// A bound of the level that rounding cannot take below 0.
#define LEVEL_SAFE 1e-5f

static bool points_alive(const Fine *fine, uint32_t cell) { return fine->state->ablate.cell_flags[cell] & SINGE_ALIVE; }

// ---- numbering

static uint32_t side_of_cell(const Fine *fine, uint32_t cell, int side) {
    return fine->shell->cell_springs[cell].blue[side];
}

static int inner_points(int splits) { return 4 * (splits - 1) + 2 * (splits - 1) * (splits - 2); }

static SingeResult points_number(Fine *fine, SingeError *error) {
    const Shell *shell = fine->shell;
    const uint32_t sides = shell->springs[SINGE_BLUE].count;
    uint64_t point = shell->particle_count;

    // of cells near the front, and of their sides
    memset(fine->side_point, 0xff, sides * sizeof *fine->side_point);
    for (uint32_t c = 0; c < shell->cell_count && point <= INT32_MAX; c++) {
        const int splits = fine_splits(fine, c);
        if (!(fine->flags[c] & FINE_NEAR)) continue;

        // negative in it or in one around it
        bool near = (fine->flags[c] & FINE_TEAR_EDGE) != 0, crossed = near;
        for (int i = 0; i < 4; i++) {
            const float *least = fine->least[shell->cells[c][i]];
            near |= least[0] < 0;
            crossed |= least[1] < LEVEL_SAFE;
        }

        if (splits == 1 || !near) {
            fine->flags[c] &= (uint8_t)~FINE_NEAR;
            continue;
        }

        for (int i = 0; i < 4; i++) {
            const uint32_t blue = side_of_cell(fine, c, i);
            if (fine->side_point[blue] != SHELL_NONE) continue;
            fine->side_owner[fine->side_count++] = 4 * c + (uint32_t)i;
            fine->side_point[blue] = (uint32_t)point;
            point += (uint64_t)splits - 1;
        }

        // from within it noise finds no level below 0; a neighbour may need its sides
        if (!crossed) {
            fine->flags[c] &= (uint8_t)~FINE_NEAR;
            continue;
        }

        fine->cell_point[c] = (uint32_t)point;
        fine->near[fine->near_count++] = c;
        point += (uint64_t)inner_points(splits);
    }

    // of bent cells and of their sides, for the case that they are not split
    memset(fine->parts, 1, sides);
    for (uint32_t c = 0; c < shell->cell_count; c++)
        for (int i = 0; i < 4 && fine->bent[c] > 1; i++) {
            uint8_t *parts = &fine->parts[side_of_cell(fine, c, i)];
            if (*parts < fine->bent[c]) *parts = fine->bent[c];
        }

    for (uint32_t s = 0; s < sides; s++) {
        fine->bent_side[s] = (uint32_t)point;
        point += (uint64_t)fine->parts[s] - 1;
    }

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        fine->bent_point[c] = (uint32_t)point;
        point += (uint64_t)inner_points(fine->bent[c]);
    }

    if (point > INT32_MAX)
        return error_set(error, SINGE_ERROR_LIMIT, "surface", -1, "the drawn surface's detail is too fine");
    fine->point_count = (uint32_t)point;
    return SINGE_OK;
}

uint32_t fine_side_point(const Fine *fine, uint32_t cell, int side, int parts, int i) {
    const uint32_t *at = fine->shell->cells[cell];
    if (i == 0) return at[side];
    if (i == parts) return at[(side + 1) & 3];

    uint32_t blue = side_of_cell(fine, cell, side);
    bool forwards = fine->shell->springs[SINGE_BLUE].ends[blue][0] == at[side];
    return fine->side_point[blue] + (uint32_t)((forwards ? i : parts - i) - 1);
}

uint32_t fine_point(const Fine *fine, uint32_t cell, int side, int splits, int i, int j) {
    int next = (side + 1) & 3, line = splits - 1;
    if (j == splits) return shell_centre(fine->shell, cell);
    if (j == 0) return fine_side_point(fine, cell, side, splits, i);

    uint32_t first = fine->cell_point[cell];
    if (i == 0) return first + (uint32_t)(side * line + j - 1);
    if (i + j == splits) return first + (uint32_t)(next * line + j - 1);

    int row = (j - 1) * line - (j - 1) * j / 2;
    return first + (uint32_t)(4 * line + side * (line * (splits - 2) / 2) + row + i - 1);
}

FineLocation fine_point_location(uint32_t cell, int side, int splits, int i, int j) {
    float part = 1 / (float)splits;
    return (FineLocation){cell, (uint8_t)side, {(float)(splits - i - j) * part, (float)i * part, (float)j * part}};
}

// ---- evaluation

/// The value next to a cell that is gone: its level is limited to the linear interpolation of the side's ends.
static FineValue held_back(FineValue value, float level) {
    if (level < value.level) value.level = level;
    return value;
}

static FineValue particle_value(const Fine *fine, uint32_t particle) {
    return (FineValue){fine->raw_level[particle], fine->state->burn.mass[particle]};
}

static void evaluate_vertices(void *context, int begin, int end) {
    Fine *fine = context;
    const Shell *shell = fine->shell;
    for (uint32_t v = (uint32_t)begin; v < (uint32_t)end; v++) {
        uint32_t home = SHELL_NONE;
        bool gone = false, even = true;
        for (uint32_t k = shell->fan_first[v]; k < shell->fan_first[v + 1]; k++) {
            even &= (fine->flags[shell->fan[k]] & FINE_EVEN) != 0;
            if (!points_alive(fine, shell->fan[k])) gone = true;
            else if (home == SHELL_NONE) home = shell->fan[k];
        }

        // its value in one of the remaining cells
        fine->values[v] = (FineValue){-1, 0};
        if (home == SHELL_NONE) continue;

        fine->values[v] = particle_value(fine, v);
        if (even) continue;

        uint8_t corner = 0;
        while (shell->cells[home][corner] != v) corner++;
        fine->values[v] = fine_value(fine, &(FineLocation){home, corner, {1, 0, 0}});
        if (gone) fine->values[v] = held_back(fine->values[v], fine->raw_level[v]);
    }
}

static void evaluate_centres(void *context, int begin, int end) {
    Fine *fine = context;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        FineValue *value = &fine->values[shell_centre(fine->shell, c)];
        *value = (FineValue){-1, 0};
        if (!points_alive(fine, c)) continue;
        if (fine->flags[c] & FINE_EVEN) *value = particle_value(fine, shell_centre(fine->shell, c));
        else *value = fine_value(fine, &(FineLocation){c, 0, {0, 0, 1}});
    }
}

static void evaluate_sides(void *context, int begin, int end) {
    Fine *fine = context;
    for (int s = begin; s < end; s++) {
        uint32_t cell = fine->side_owner[s] / 4;
        int side = (int)(fine->side_owner[s] & 3), splits = fine_splits(fine, cell);
        const uint32_t *at = fine->shell->cells[cell];
        const uint32_t other = shell_neighbour(fine->shell, cell, side);
        const bool gone = other != SHELL_NONE && !points_alive(fine, other);
        if (!((fine->flags[cell] | (other == SHELL_NONE ? 0 : fine->flags[other])) & FINE_NEAR)) continue;
        for (int i = 1; i < splits; i++) {
            FineLocation location = fine_point_location(cell, side, splits, i, 0);
            FineValue value = fine_value(fine, &location);
            if (gone)
                value = held_back(value, location.weight[0] * fine->raw_level[at[side]] +
                                             location.weight[1] * fine->raw_level[at[(side + 1) & 3]]);
            fine->values[fine_point(fine, cell, side, splits, i, 0)] = value;
        }
    }
}

static void evaluate_cells(void *context, int begin, int end) {
    Fine *fine = context;
    for (int n = begin; n < end; n++) {
        uint32_t cell = fine->near[n];
        int splits = fine_splits(fine, cell);
        for (int side = 0; side < 4; side++)
            for (int j = 1; j < splits; j++)
                for (int i = 0; i + j < splits; i++) { // the line i + j = k is the next triangle's i = 0
                    const FineLocation location = fine_point_location(cell, side, splits, i, j);
                    fine->values[fine_point(fine, cell, side, splits, i, j)] = fine_value(fine, &location);
                }
    }
}

/// Cells whose points differ in the sign of the level are split. A pass of its own, as evaluation reads the flags of
/// other cells.
static void mark_split(void *context, int begin, int end) {
    Fine *fine = context;
    for (int n = begin; n < end; n++) {
        const uint32_t cell = fine->near[n];
        const int splits = fine_splits(fine, cell);
        bool inside = false, outside = false;
        for (int side = 0; side < 4 && !(inside && outside); side++)
            for (int j = 0; j <= splits && !(inside && outside); j++)
                for (int i = 0; i + j <= splits; i++) {
                    const float level = fine->values[fine_point(fine, cell, side, splits, i, j)].level;
                    inside |= level >= 0;
                    outside |= level < 0;
                }
        if (inside && outside) fine->flags[cell] |= FINE_SPLIT;
    }
}

// ---- bent cells that are not split

/// The value at a position of a cell that is not split. Its level has the sign of that at `particle`.
static FineValue bent_value(const Fine *fine, uint32_t particle, FineLocation location) {
    const FineValue *there = &fine->values[particle];
    if (fine->flags[location.cell] & FINE_EVEN) return *there;

    FineValue value = fine_value(fine, &location);
    value.level = there->level < 0 ? float_min(value.level, there->level) : float_max(value.level, 0);
    return value;
}

static void evaluate_bent(void *context, int begin, int end) {
    Fine *fine = context;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        int splits = fine->splits[c];
        if (!points_alive(fine, c) || fine_is_split(fine, c)) continue;

        for (int side = 0; side < 4; side++) {
            // the side's points, in one of its cells
            const int parts = fine_parts(fine, c, side);
            const uint32_t other = shell_neighbour(fine->shell, c, side);
            const bool own =
                other == SHELL_NONE || !points_alive(fine, other) || (c < other && !fine_is_split(fine, other));
            for (int i = 1; i < parts && own; i++)
                fine->values[fine_side_point(fine, c, side, parts, i)] =
                    bent_value(fine, fine->shell->cells[c][side], fine_point_location(c, side, parts, i, 0));

            // those within the triangle
            for (int j = 1; j < splits; j++)
                for (int i = 0; i + j < splits; i++)
                    fine->values[fine_point(fine, c, side, splits, i, j)] =
                        bent_value(fine, shell_centre(fine->shell, c), fine_point_location(c, side, splits, i, j));
        }
    }
}

/// Fills `least`. Noise looks half a cell along each axis at most, so from within a cell it stays in the quarters about
/// its vertices.
static void bound_vertices(Fine *fine, uint32_t cell, float low) {
    const Float4 level = fine_spline_quarters(fine->shell, &fine->splines[SPLINE_LEVEL], cell);
    const Float4 whole = fine_spline_quarters(fine->shell, &fine->splines[SPLINE_WHOLE], cell);
    for (int i = 0; i < 4; i++) {
        float *least = fine->least[fine->shell->cells[cell][i]];
        least[0] = float_min(least[0], low);
        least[1] = float_min(least[1], float_min(level[i], fine_whole_level(whole[i])));
    }
}

SingeResult fine_points(Fine *fine, SingeError *error) {
    const Shell *shell = fine->shell;

    // cells' flags, from the bounds of their splines, and their axes
    for (uint32_t v = 0; v < shell->vertex_count; v++) fine->least[v][0] = fine->least[v][1] = INFINITY;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        float low, high, whole, wholest, lightest, heaviest;
        fine_spline_bounds(shell, &fine->splines[SPLINE_LEVEL], c, &low, &high);
        fine_spline_bounds(shell, &fine->splines[SPLINE_WHOLE], c, &whole, &wholest);
        fine_spline_bounds(shell, &fine->splines[SPLINE_MASS], c, &lightest, &heaviest);
        low = float_min(low, fine_whole_level(whole));
        fine->flags[c] = low >= 0 && heaviest - lightest < 1e-5f ? FINE_EVEN : 0;
        if (whole == 1) fine->flags[c] |= FINE_WHOLE;
        if (low < 0) bound_vertices(fine, c, low);
        if (points_alive(fine, c) && high >= 0) fine->flags[c] |= FINE_NEAR; // until its neighbours are checked

        // lengths of the cell's two axes at rest
        const uint32_t *at = shell->cells[c];
        Float3 p[4];
        for (int i = 0; i < 4; i++) p[i] = float3_load(shell->rest_position[at[i]]);

        Float3 along = float3_sub(float3_add(p[1], p[2]), float3_add(p[0], p[3]));
        Float3 up = float3_sub(float3_add(p[3], p[2]), float3_add(p[0], p[1]));
        fine->axes[c][0] = 0.5f * float3_length(along);
        fine->axes[c][1] = 0.5f * float3_length(up);
    }

    fine_tear_edges(fine);
    TRY(points_number(fine, error));
    if (!NEW(fine->memory, fine->values, fine->point_count))
        return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the surface's detail");

    pool_for(fine->pool, (int)shell->vertex_count, 256, evaluate_vertices, fine);
    pool_for(fine->pool, (int)shell->cell_count, 256, evaluate_centres, fine);
    pool_for(fine->pool, (int)fine->side_count, 64, evaluate_sides, fine);
    pool_for(fine->pool, (int)fine->near_count, 8, evaluate_cells, fine);
    pool_for(fine->pool, (int)fine->near_count, 64, mark_split, fine);

    // how cells and their sides are drawn
    uint32_t *split_side = fine->bent_side; // swapped; sides of split cells get theirs back below
    fine->bent_side = fine->side_point;
    fine->side_point = split_side;

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        fine->splits[c] = fine->bent[c];
        if (!fine_is_split(fine, c)) fine->cell_point[c] = fine->bent_point[c];
    }

    for (uint32_t n = 0; n < fine->near_count; n++) {
        uint32_t c = fine->near[n];
        if (!fine_is_split(fine, c)) continue;

        fine->splits[c] = (uint8_t)fine_splits(fine, c);
        for (int i = 0; i < 4; i++) {
            uint32_t blue = side_of_cell(fine, c, i);
            fine->parts[blue] = fine->splits[c];
            fine->side_point[blue] = fine->bent_side[blue];
        }
    }

    pool_for(fine->pool, (int)shell->cell_count, 256, evaluate_bent, fine);
    return SINGE_OK;
}
