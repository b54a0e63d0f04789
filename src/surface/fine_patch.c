// The smooth surface that the corners of the cells stand for: a bicubic Bezier patch a cell,
//
//   S(u, v) = sum B_i(u) B_j(v) b_ij,   u along the cell's side 0, v along its side 3 backwards
//
// Near the Catmull-Clark limit surface (Loop and Schaefer, Approximating Catmull-Clark subdivision surfaces with bicubic
// patches, 2008), and this itself where four cells meet, so that places and tangent planes are those of the cell across.
// With a corner x that n cells have, its neighbours e, e' in the cell and the corner f across:
//
//   inner point    p = (n x + 2 (e + e') + f) / (n + 5)
//   on a side      mean of p of both cells;   at a border (2 x + e) / 3
//   corner         mean of p of all cells;    at a border (4 x + e_1 + e_2) / 6, of its two neighbours along it
//
// At a border n is twice the number of cells, and 4 at least. Cells that are torn have corners that go their own
// ways: to others they are not there, and they are drawn flat. A surface that may not leave a corner so far is moved there with all points
// about it by the same vector: that keeps tangent planes, and with the whole way the patches go through the corners.
#include "surface/surface_fine.h"


static bool is_sound(const Fine *fine, uint32_t cell) {
    bool sound = fine->state->ablate.cell_flags[cell] & SINGE_ALIVE;
    for (int side = 0; side < 4 && sound; side++) sound = !fine_is_torn(fine, cell, side);
    return sound;
}

static Vec corner_of(const Fine *fine, uint32_t vertex) { return vec_load(fine->corner[vertex]); }

/// What the cells around a vertex say of it.
typedef struct Ring {
    uint32_t cells, borders; ///< sound ones; their sides at the vertex that have none across
    Vec along;               ///< sum of the neighbours along these
    Vec inner;               ///< sum of the cells' inner points
} Ring;

static void add_borders(const Fine *fine, uint32_t cell, int corner, Ring *ring) {
    const uint32_t *at = fine->shell->cells[cell];
    for (int turn = 0; turn < 2; turn++) {
        uint32_t other = shell_neighbour(fine->shell, cell, turn ? (corner + 3) & 3 : corner);
        if (other != SHELL_NONE && fine->sound[other]) continue;
        ring->borders++;
        ring->along = vec_add(ring->along, corner_of(fine, at[(corner + (turn ? 3 : 1)) & 3]));
    }
}

static Ring ring_of(const Fine *fine, uint32_t vertex) {
    const Shell *shell = fine->shell;
    Ring ring = {0};
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++) {
        uint32_t cell = shell->fan[k];
        if (!fine->sound[cell]) continue;
        int i = 0;
        while (shell->cells[cell][i] != vertex) i++;
        ring.cells++;
        ring.inner = vec_add(ring.inner, vec_load(fine->inner[cell][i]));
        add_borders(fine, cell, i, &ring);
    }
    return ring;
}

static void find_sound(void *context, int begin, int end) {
    Fine *fine = context;
    for (int c = begin; c < end; c++) fine->sound[c] = is_sound(fine, (uint32_t)c);
}

static void count_cells(void *context, int begin, int end) {
    Fine *fine = context;
    for (int v = begin; v < end; v++) {
        Ring ring = ring_of(fine, (uint32_t)v);
        bool closed = ring.borders == 0 && ring.cells > 0;
        fine->valence[v] = closed ? (float)ring.cells : 2 * fmaxf((float)ring.cells, 2);
        fine->regular[v] = fine->valence[v] == 4;
    }
}

static void place_inner(void *context, int begin, int end) {
    Fine *fine = context;
    for (int c = begin; c < end; c++) {
        const uint32_t *at = fine->shell->cells[c];
        for (int i = 0; i < 4; i++) {
            float n = fine->valence[at[i]];
            Vec beside = vec_add(corner_of(fine, at[(i + 1) & 3]), corner_of(fine, at[(i + 3) & 3]));
            Vec sum = vec_mad(vec_scale(corner_of(fine, at[i]), n), beside, 2);
            sum = vec_add(sum, corner_of(fine, at[(i + 2) & 3]));
            vec_store(fine->inner[c][i], vec_scale(sum, 1 / (n + 5)));
        }
    }
}

/// The two points of side i of a cell, in the order of its corners.
static void place_rail(const Fine *fine, uint32_t cell, int i, Vec point[2]) {
    const Shell *shell = fine->shell;
    const uint32_t end[2] = {shell->cells[cell][i], shell->cells[cell][(i + 1) & 3]};
    uint32_t other = shell_neighbour(shell, cell, i);
    bool both = other != SHELL_NONE && fine->sound[cell] && fine->sound[other];
    for (int k = 0; k < 2; k++) {
        point[k] = vec_scale(vec_mad(corner_of(fine, end[1 - k]), corner_of(fine, end[k]), 2), 1 / 3.0f);
        if (!both) continue;
        int j = 0;
        while (shell->cells[other][j] != end[k]) j++;
        point[k] = vec_scale(vec_add(vec_load(fine->inner[cell][(i + k) & 3]), vec_load(fine->inner[other][j])), 0.5f);
    }
}

static void place_rails(void *context, int begin, int end) {
    Fine *fine = context;
    const Shell *shell = fine->shell;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++)
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(shell, c, i), blue = shell->cell_springs[c].blue[i];
            if (other != SHELL_NONE && other < c) continue;
            Vec point[2];
            place_rail(fine, c, i, point);
            bool forwards = shell->springs[SINGE_BLUE].ends[blue][0] == shell->cells[c][i];
            for (int k = 0; k < 2; k++) vec_store(fine->rail[blue][forwards ? k : 1 - k], point[k]);
        }
}

/// Where the patches meet at a vertex, and how they are moved there to stay within reach of it.
static void place_limits(void *context, int begin, int end) {
    Fine *fine = context;
    for (uint32_t v = (uint32_t)begin; v < (uint32_t)end; v++) {
        Ring ring = ring_of(fine, v);
        Vec x = corner_of(fine, v), limit = x, normal = vec_load(fine->normal[v]);
        if (ring.cells > 0 && ring.borders == 0) limit = vec_scale(ring.inner, 1 / (float)ring.cells);
        if (ring.cells > 1 && ring.borders == 2) limit = vec_scale(vec_mad(ring.along, x, 4), 1 / 6.0f);
        float most = fine->most[v] * fine->share[v], left = vec_dot(vec_sub(limit, x), normal);
        Vec shift = vec_scale(normal, fmaxf(-most, fminf(left, most)) - left);
        vec_store(fine->shift[v], shift);
        vec_store(fine->limit[v], vec_add(limit, shift));
    }
}

void fine_find_sound(Fine *fine) { pool_for(fine->pool, (int)fine->shell->cell_count, 1024, find_sound, fine); }

void fine_patches(Fine *fine) {
    const int cells = (int)fine->shell->cell_count, vertices = (int)fine->shell->vertex_count;
    pool_for(fine->pool, vertices, 1024, count_cells, fine);
    pool_for(fine->pool, cells, 1024, place_inner, fine);
    pool_for(fine->pool, cells, 1024, place_rails, fine);
    pool_for(fine->pool, vertices, 1024, place_limits, fine);
}

// ---- a patch

/// Where corner i is in the net, the points next to it along the side that begins there and along the one before, and
/// the inner one.
static const uint8_t net_places[4][4][2] = {
    {{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {{3, 0}, {3, 1}, {2, 0}, {2, 1}},
    {{3, 3}, {2, 3}, {3, 2}, {2, 2}}, {{0, 3}, {0, 2}, {1, 3}, {1, 2}}};

FinePatch fine_patch(const Fine *fine, uint32_t cell) {
    const Shell *shell = fine->shell;
    const uint32_t *at = shell->cells[cell], *sides = shell->cell_springs[cell].blue;
    const uint32_t (*ends)[2] = (const uint32_t (*)[2])shell->springs[SINGE_BLUE].ends;
    FinePatch patch;
    for (int i = 0; i < 4; i++) {
        uint32_t next = sides[i], last = sides[(i + 3) & 3];
        Vec shift = vec_load(fine->shift[at[i]]);
        const uint8_t (*place)[2] = net_places[i];
        patch.net[place[0][0]][place[0][1]] = vec_load(fine->limit[at[i]]);
        patch.net[place[1][0]][place[1][1]] = vec_add(shift, vec_load(fine->rail[next][ends[next][0] != at[i]]));
        patch.net[place[2][0]][place[2][1]] = vec_add(shift, vec_load(fine->rail[last][ends[last][0] != at[i]]));
        patch.net[place[3][0]][place[3][1]] = vec_add(shift, vec_load(fine->inner[cell][i]));
    }
    return patch;
}

/// Bernstein polynomials of degree 3 and their derivatives.
static void bernstein(float t, float value[4], float slope[4]) {
    float s = 1 - t;
    value[0] = s * s * s, value[1] = 3 * s * s * t, value[2] = 3 * s * t * t, value[3] = t * t * t;
    slope[0] = -3 * s * s, slope[1] = 3 * s * (s - 2 * t), slope[2] = 3 * t * (2 * s - t), slope[3] = 3 * t * t;
}

FinePoint fine_patch_at(const FinePatch *patch, float u, float v) {
    float bu[4], du[4], bv[4], dv[4];
    FinePoint point = {0};
    bernstein(u, bu, du), bernstein(v, bv, dv);
    for (int i = 0; i < 4; i++) {
        Vec row = {0, 0, 0}, slope = {0, 0, 0};
        for (int j = 0; j < 4; j++) {
            row = vec_mad(row, patch->net[i][j], bv[j]);
            slope = vec_mad(slope, patch->net[i][j], dv[j]);
        }
        point.position = vec_mad(point.position, row, bu[i]);
        point.along_u = vec_mad(point.along_u, row, du[i]);
        point.along_v = vec_mad(point.along_v, slope, bu[i]);
    }
    return point;
}
