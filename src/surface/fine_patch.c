// The smooth surface over the corners of the cells: one bicubic Bezier patch per cell,
//
//   S(u, v) = sum B_i(u) B_j(v) b_ij,   u along the cell's side 0, v along its side 3 backwards
//
// It approximates the Catmull-Clark limit surface (Loop and Schaefer, Approximating Catmull-Clark subdivision surfaces
// with bicubic patches, 2008), and equals it where four cells meet, so that positions and tangent planes agree with
// those of the next cell. For a corner x of n cells, its neighbours e, e' in the cell and the opposite corner f:
//
//   inner point    p = (n x + 2 (e + e') + f) / (n + 5)
//   on a side      mean of p of both cells;   at a border (2 x + e) / 3
//   corner         mean of p of all cells;    at a border (4 x + e_1 + e_2) / 6, of its two neighbours along it
//
// At a border n is twice the number of cells, and at least 4. The corners of torn cells move independently: other cells
// ignore torn cells, which are drawn flat. Where the surface may not be this far from a corner, all points around the
// corner are moved by the same vector. This keeps tangent planes; moved by the whole distance, the patches pass through
// the corners.
#include "common/real.h"
#include "surface/surface_fine.h"

static Float3 corner_of(const Fine *fine, uint32_t vertex) { return float3_load(fine->corner[vertex]); }

/// Sums over the sound cells around a vertex.
typedef struct Ring {
    uint32_t cells, borders; ///< sound cells; their sides at the vertex with no sound cell across
    Float3 along;            ///< sum of the vertex's neighbours along these sides
    Float3 inner;            ///< sum of the cells' inner points
} Ring;

static Ring ring_of(const Fine *fine, uint32_t vertex) {
    const Shell *shell = fine->shell;
    Ring ring = {0};
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++) {
        uint32_t cell = shell->fan[k];
        if (!fine->sound[cell]) continue;

        int i = 0;
        while (shell->cells[cell][i] != vertex) i++;
        ring.cells++;
        ring.inner = float3_add(ring.inner, float3_load(fine->inner[cell][i]));

        // its two sides at the vertex, where no sound cell is across
        for (int turn = 0; turn < 2; turn++) {
            uint32_t other = shell_neighbour(shell, cell, turn ? (i + 3) & 3 : i);
            if (other != SHELL_NONE && fine->sound[other]) continue;
            ring.borders++;
            ring.along = float3_add(ring.along, corner_of(fine, shell->cells[cell][(i + (turn ? 3 : 1)) & 3]));
        }
    }

    return ring;
}

static void find_sound(void *context, int begin, int end) {
    Fine *fine = context;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        bool sound = fine->state->ablate.cell_flags[c] & SINGE_ALIVE;
        for (int side = 0; side < 4 && sound; side++) sound = !fine_is_torn(fine, c, side);
        fine->sound[c] = sound;
    }
}

static void count_cells(void *context, int begin, int end) {
    Fine *fine = context;
    for (int v = begin; v < end; v++) {
        Ring ring = ring_of(fine, (uint32_t)v);
        bool closed = ring.borders == 0 && ring.cells > 0;
        fine->valence[v] = closed ? (float)ring.cells : 2 * float_max((float)ring.cells, 2);
        fine->regular[v] = fine->valence[v] == 4;
    }
}

static void put_inner(void *context, int begin, int end) {
    Fine *fine = context;
    for (int c = begin; c < end; c++) {
        const uint32_t *at = fine->shell->cells[c];
        for (int i = 0; i < 4; i++) {
            float n = fine->valence[at[i]];
            Float3 beside = float3_add(corner_of(fine, at[(i + 1) & 3]), corner_of(fine, at[(i + 3) & 3]));
            Float3 sum = float3_mad(float3_scale(corner_of(fine, at[i]), n), beside, 2);
            sum = float3_add(sum, corner_of(fine, at[(i + 2) & 3]));
            float3_store(fine->inner[c][i], float3_scale(sum, 1 / (n + 5)));
        }
    }
}

/// The two points within each side, in the order of its spring's ends.
static void put_rails(void *context, int begin, int end) {
    Fine *fine = context;
    const Shell *shell = fine->shell;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++)
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(shell, c, i), blue = shell->cell_springs[c].blue[i];
            if (other != SHELL_NONE && other < c) continue;
            const uint32_t ends[2] = {shell->cells[c][i], shell->cells[c][(i + 1) & 3]};
            const bool both = other != SHELL_NONE && fine->sound[c] && fine->sound[other];
            const bool forwards = shell->springs[SINGE_BLUE].ends[blue][0] == ends[0];
            for (int k = 0; k < 2; k++) {
                Float3 x = corner_of(fine, ends[k]), point;
                point = float3_scale(float3_mad(corner_of(fine, ends[1 - k]), x, 2), 1 / 3.0f);
                if (both) {
                    int j = 0;
                    while (shell->cells[other][j] != ends[k]) j++;
                    point = float3_add(float3_load(fine->inner[c][(i + k) & 3]), float3_load(fine->inner[other][j]));
                    point = float3_scale(point, 0.5f);
                }

                float3_store(fine->rail[blue][forwards ? k : 1 - k], point);
            }
        }
}

/// The point where the patches meet at a vertex, and the shift that keeps them within its max distance.
static void put_limits(void *context, int begin, int end) {
    Fine *fine = context;
    for (uint32_t v = (uint32_t)begin; v < (uint32_t)end; v++) {
        Ring ring = ring_of(fine, v);
        Float3 x = corner_of(fine, v), limit = x, normal = float3_load(fine->normal[v]);
        if (ring.cells > 0 && ring.borders == 0) limit = float3_scale(ring.inner, 1 / (float)ring.cells);
        if (ring.cells > 1 && ring.borders == 2) limit = float3_scale(float3_mad(ring.along, x, 4), 1 / 6.0f);
        float max = fine->max[v] * fine->share[v], left = float3_dot(float3_sub(limit, x), normal);
        Float3 shift = float3_scale(normal, float_max(-max, float_min(left, max)) - left);
        float3_store(fine->shift[v], shift);
        float3_store(fine->limit[v], float3_add(limit, shift));
    }
}

void fine_find_sound(Fine *fine) { pool_for(fine->pool, (int)fine->shell->cell_count, 1024, find_sound, fine); }

void fine_patches(Fine *fine) {
    const int cells = (int)fine->shell->cell_count, vertices = (int)fine->shell->vertex_count;
    pool_for(fine->pool, vertices, 1024, count_cells, fine);
    pool_for(fine->pool, cells, 1024, put_inner, fine);
    pool_for(fine->pool, cells, 1024, put_rails, fine);
    pool_for(fine->pool, vertices, 1024, put_limits, fine);
}

// ---- a patch

/// Indices in the net of corner i, of the points next to it along the side that begins there and along the side before,
/// and of the inner point.
static const uint8_t net_locations[4][4][2] = {{{0, 0}, {1, 0}, {0, 1}, {1, 1}},
                                               {{3, 0}, {3, 1}, {2, 0}, {2, 1}},
                                               {{3, 3}, {2, 3}, {3, 2}, {2, 2}},
                                               {{0, 3}, {0, 2}, {1, 3}, {1, 2}}};

static Float4 float4_at(Float3 p) { return (Float4){p.x, p.y, p.z, 0}; }

static Float3 float4_point(Float4 p) { return float3(p[0], p[1], p[2]); }

FinePatch fine_patch(const Fine *fine, uint32_t cell) {
    const Shell *shell = fine->shell;
    const uint32_t *at = shell->cells[cell], *sides = shell->cell_springs[cell].blue;
    const uint32_t(*ends)[2] = (const uint32_t(*)[2])shell->springs[SINGE_BLUE].ends;
    FinePatch patch;

    for (int i = 0; i < 4; i++) {
        uint32_t next = sides[i], last = sides[(i + 3) & 3];
        Float3 shift = float3_load(fine->shift[at[i]]);
        const uint8_t(*location)[2] = net_locations[i];
        patch.net[location[0][0]][location[0][1]] = float4_at(float3_load(fine->limit[at[i]]));
        patch.net[location[1][0]][location[1][1]] =
            float4_at(float3_add(shift, float3_load(fine->rail[next][ends[next][0] != at[i]])));
        patch.net[location[2][0]][location[2][1]] =
            float4_at(float3_add(shift, float3_load(fine->rail[last][ends[last][0] != at[i]])));
        patch.net[location[3][0]][location[3][1]] = float4_at(float3_add(shift, float3_load(fine->inner[cell][i])));
    }

    return patch;
}

/// Bernstein polynomials of degree 3 and their derivatives.
static void bernstein(float t, float value[4], float slope[4]) {
    float s = 1 - t;
    value[0] = s * s * s;
    value[1] = 3 * s * s * t;
    value[2] = 3 * s * t * t;
    value[3] = t * t * t;
    slope[0] = -3 * s * s;
    slope[1] = 3 * s * (s - 2 * t);
    slope[2] = 3 * t * (2 * s - t);
    slope[3] = 3 * t * t;
}

FinePoint fine_patch_at(const FinePatch *patch, float u, float v) {
    float bu[4], du[4], bv[4], dv[4];
    Float4 position = {0}, along_u = {0}, along_v = {0};
    bernstein(u, bu, du);
    bernstein(v, bv, dv);

    for (int i = 0; i < 4; i++) {
        Float4 row = {0}, slope = {0};
        for (int j = 0; j < 4; j++) {
            row += patch->net[i][j] * bv[j];
            slope += patch->net[i][j] * dv[j];
        }

        position += row * bu[i];
        along_u += row * du[i];
        along_v += slope * bu[i];
    }

    return (FinePoint){float4_point(position), float4_point(along_u), float4_point(along_v)};
}
