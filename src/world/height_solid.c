// Signed distance from the solid below a grid of heights over its own x-y rectangle: all (x, y, z) with z < h(x, y).
// Each cell of the grid is two triangles, with the diagonal from its node of smallest x and y to the opposite one.
// Walls go down from the rectangle's edges without end.
//
// The surface straight above or below is |z - h| away, so only cells within this distance can contain the foot; blocks
// of cells whose heights are farther away are skipped.
#include "common/real.h"
#include "world/height_solid.h"
#include "world/triangle.h"

enum { HEIGHT_BLOCK = 8 };

static uint32_t height_solid_min(uint32_t a, uint32_t b) { return a < b ? a : b; }

SingeResult height_solid_create(Memory *memory, uint32_t columns, uint32_t rows, const float *heights,
                                const float size[2], HeightSolid *solid, SingeError *error) {
    *solid = (HeightSolid){.columns = columns, .rows = rows, .low = INFINITY, .high = -INFINITY};
    const char *what = NULL;
    if (columns < 2 || rows < 2 || columns > 32768 || rows > 32768)
        what = "columns and rows must be between 2 and 32768";
    for (int d = 0; d < 2; d++)
        if (!(size[d] >= 1e-6f && size[d] <= 1e4f)) what = "size must be between 1e-6 and 10000 m";
    if (!heights) what = "heights are missing";
    if (what) return error_set(error, SINGE_ERROR_ARGUMENT, "collider", -1, "%s", what);

    // heights
    size_t count = (size_t)columns * rows;
    for (size_t k = 0; k < count; k++)
        if (!(fabsf(heights[k]) <= 1e4f))
            return error_set(error, SINGE_ERROR_ARGUMENT, "collider", (int64_t)k,
                             "height %zu (column %zu, row %zu) is not finite or beyond 10 km", k, k % columns,
                             k / columns);

    // grid and blocks
    const uint32_t n[2] = {columns, rows};
    for (int d = 0; d < 2; d++) {
        solid->half[d] = size[d] / 2;
        solid->step[d] = size[d] / (float)(n[d] - 1);
        solid->blocks[d] = (n[d] - 1 + HEIGHT_BLOCK - 1) / HEIGHT_BLOCK;
    }

    size_t blocks = (size_t)solid->blocks[0] * solid->blocks[1];
    if (!NEW(memory, solid->heights, count) || !NEW(memory, solid->ranges, blocks)) {
        height_solid_free(memory, solid);
        return error_set(error, SINGE_ERROR_MEMORY, "collider", -1, "out of memory for the heights");
    }

    // copy, and the range of each block
    for (size_t k = 0; k < count; k++) {
        solid->heights[k] = heights[k];
        solid->low = float_min(solid->low, heights[k]);
        solid->high = float_max(solid->high, heights[k]);
    }

    for (uint32_t bj = 0; bj < solid->blocks[1]; bj++)
        for (uint32_t bi = 0; bi < solid->blocks[0]; bi++) {
            uint32_t i_last = height_solid_min((bi + 1) * HEIGHT_BLOCK, columns - 1);
            uint32_t j_last = height_solid_min((bj + 1) * HEIGHT_BLOCK, rows - 1);
            float *range = solid->ranges[bj * solid->blocks[0] + bi];
            range[0] = INFINITY;
            range[1] = -INFINITY;
            for (uint32_t j = bj * HEIGHT_BLOCK; j <= j_last; j++)
                for (uint32_t i = bi * HEIGHT_BLOCK; i <= i_last; i++) {
                    float h = heights[(size_t)j * columns + i];
                    range[0] = float_min(range[0], h);
                    range[1] = float_max(range[1], h);
                }
        }

    return SINGE_OK;
}

void height_solid_free(Memory *memory, HeightSolid *solid) {
    FREE(memory, solid->heights, (size_t)solid->columns * solid->rows);
    FREE(memory, solid->ranges, (size_t)solid->blocks[0] * solid->blocks[1]);
    *solid = (HeightSolid){0};
}

static Float3 height_node(const HeightSolid *solid, uint32_t i, uint32_t j) {
    return float3((float)i * solid->step[0] - solid->half[0], (float)j * solid->step[1] - solid->half[1],
                  solid->heights[(size_t)j * solid->columns + i]);
}

/// The upper or lower triangle of a cell; all face up.
static void height_triangle(const HeightSolid *solid, uint32_t i, uint32_t j, bool upper, Float3 corner[3]) {
    corner[0] = height_node(solid, i, j);
    corner[1] = upper ? height_node(solid, i + 1, j + 1) : height_node(solid, i + 1, j);
    corner[2] = upper ? height_node(solid, i, j + 1) : height_node(solid, i + 1, j + 1);
}

/// The cell along an axis that contains x, the first or last beyond the ends; *part is the position of x in it, 0 to 1.
static uint32_t height_cell(const HeightSolid *solid, int axis, float x, float *part) {
    uint32_t last = (axis ? solid->rows : solid->columns) - 2;
    float at = (x + solid->half[axis]) / solid->step[axis];
    uint32_t cell = at > 0 ? at < (float)last ? (uint32_t)at : last : 0;
    *part = float_min(float_max(at - (float)cell, 0), 1);
    return cell;
}

/// Height of the surface at a position, clamped to the rectangle, and its normal there.
static float height_at(const HeightSolid *solid, float x, float y, Float3 *normal) {
    float s, t;
    uint32_t i = height_cell(solid, 0, x, &s), j = height_cell(solid, 1, y, &t);
    Float3 corner[3];

    height_triangle(solid, i, j, t > s, corner);
    *normal = float3_unit(float3_cross(float3_sub(corner[1], corner[0]), float3_sub(corner[2], corner[0])));

    // the corners are a, b = a + (1, 0) or (1, 1) and c
    float b = t > s ? s : s - t, c = t > s ? t - s : t;
    return corner[0].z + b * (corner[1].z - corner[0].z) + c * (corner[2].z - corner[0].z);
}

/// Finds the foot on the surface, if it is nearer than *best.
static void height_surface(const HeightSolid *solid, Float3 p, TriangleClosest *best) {
    const float x[2] = {p.x, p.y}, reach = (float)sqrt(best->square) * 1.0001f;
    uint32_t from[2], to[2];
    float part;

    for (int d = 0; d < 2; d++) {
        from[d] = height_cell(solid, d, x[d] - reach, &part);
        to[d] = height_cell(solid, d, x[d] + reach, &part);
    }

    for (uint32_t bj = from[1] / HEIGHT_BLOCK; bj <= to[1] / HEIGHT_BLOCK; bj++)
        for (uint32_t bi = from[0] / HEIGHT_BLOCK; bi <= to[0] / HEIGHT_BLOCK; bi++) {
            uint32_t first[2] = {bi * HEIGHT_BLOCK, bj * HEIGHT_BLOCK};
            uint32_t end[2] = {height_solid_min(first[0] + HEIGHT_BLOCK, solid->columns - 1),
                               height_solid_min(first[1] + HEIGHT_BLOCK, solid->rows - 1)};

            // square of the distance to the block's box
            const float *range = solid->ranges[bj * solid->blocks[0] + bi];
            double sum = 0;
            for (int d = 0; d < 2; d++) {
                double low = (double)((float)first[d] * solid->step[d] - solid->half[d]) - (double)x[d];
                double high = (double)x[d] - (double)((float)end[d] * solid->step[d] - solid->half[d]);
                double out = double_max(double_max(low, high), 0);
                sum += out * out;
            }

            double out = double_max(double_max((double)range[0] - (double)p.z, (double)p.z - (double)range[1]), 0);
            if (sum + out * out >= best->square) continue;

            // the triangles of its cells that are within reach
            for (int d = 0; d < 2; d++) {
                if (first[d] < from[d]) first[d] = from[d];
                if (end[d] > to[d] + 1) end[d] = to[d] + 1;
            }

            for (uint32_t j = first[1]; j < end[1]; j++)
                for (uint32_t i = first[0]; i < end[0]; i++)
                    for (int upper = 0; upper < 2; upper++) {
                        Float3 corner[3];
                        height_triangle(solid, i, j, upper, corner);
                        TriangleClosest foot = triangle_closest(p, corner[0], corner[1], corner[2]);
                        if (foot.square < best->square) *best = foot;
                    }
        }
}

float height_solid_distance(const HeightSolid *solid, Float3 p, float limit, Float3 *normal) {
    float dx = fabsf(p.x) - solid->half[0], dy = fabsf(p.y) - solid->half[1];
    bool over = dx <= 0 && dy <= 0;
    Float3 out = float3(float_max(dx, 0), float_max(dy, 0), float_max(p.z - solid->high, 0));
    float bound = float3_length(out);

    *normal = float3(0, 0, 1);
    if (bound > 0 && bound >= limit) return bound;
    if (!isfinite(p.x + p.y + p.z)) return INFINITY;

    float above = p.z - height_at(solid, p.x, p.y, normal);
    bool inside = over && above < 0;
    if (limit == 0) return inside ? -1 : 1;

    // upper bound: the surface above or below the nearest position of the rectangle
    double slack = 1e-6 * (double)(solid->half[0] + solid->half[1] + float3_length(p)); // heights are rounded
    double max = (double)float3_length(float3(out.x, out.y, above)) + slack;
    if (!inside) max = double_min(max, (double)limit); // surface beyond the limit need not be found
    TriangleClosest best = {.square = max * max};
    double unfound = best.square;

    // the foot on the walls, then on the surface
    for (int wall = 0; wall < 4; wall++) {
        float side = wall & 1 ? 1 : -1, at[2] = {p.x, p.y};
        int axis = wall >> 1;
        at[axis] = side * solid->half[axis];
        at[1 - axis] = float_min(float_max(at[1 - axis], -solid->half[1 - axis]), solid->half[1 - axis]);
        Float3 unused;
        TriangleClosest foot = {.away = {(double)p.x - (double)at[0], (double)p.y - (double)at[1], 0}};
        foot.square = dot3(foot.away, foot.away);
        if (foot.square < best.square && p.z <= height_at(solid, at[0], at[1], &unused)) best = foot;
    }

    height_surface(solid, p, &best);
    if (!(best.square < unfound)) return inside ? above : (float)max;

    double distance = sqrt(best.square), sign = inside ? -1 : 1;
    if (distance > 1e-7 * (1 + (double)float3_length(p)))
        *normal = float3((float)(sign * best.away[0] / distance), (float)(sign * best.away[1] / distance),
                         (float)(sign * best.away[2] / distance));

    return (float)(sign * distance);
}
