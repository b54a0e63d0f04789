// No cell of a mesh that does not stretch ends a step far larger than it should be. Strands are projected once a substep:
// what meets at vertices where no strand runs on, among cells far smaller than their neighbours or in threads of char that
// something heavy hangs on, may be left several times as long. So after the substeps sides and diagonals longer than
// LIMIT_SIDE or LIMIT_DIAGONAL times their targets l, here s l, are shortened one by one:
//
//   C = |d| - s l > 0,   u = d/|d|,   lambda = C/(w_a + w_b),   x_a += w_a lambda u,   x_b -= w_b lambda u
//
// and what still draws them out is taken from the velocities, without bounce: v_a += w_a mu u, v_b -= w_b mu u with
// mu = max((v_b - v_a) . u, 0)/(w_a + w_b). Both keep linear and angular momentum. Rounds go over the blocks of cells in
// which a count has found some; nearly all steps end with that count.
#include "base/quad.h"
#include "dynamics/plan.h"

#include <math.h>

/// Times the target length. A square cell of inextensible sides that collapses has a diagonal of 1.41.
#define LIMIT_SIDE 1.25f
#define LIMIT_DIAGONAL 1.45f
/// Rounds, every so many steps: frames end with one of these.
enum { LIMIT_ROUNDS = 12, LIMIT_PERIOD = 4 };

typedef struct Limit {
    const Shell *shell;
    const State *state;
    DynamicsState *dynamics;
    const AttachSpread *spread;
} Limit;

static uint32_t limit_corner(int i) { return i < 4 ? (uint32_t)i : (uint32_t)i - 4; }

/// How long side 0 to 3 or diagonal 4 to 5 of a cell may be, and its ends. Where a spring has burnt, what hangs on the cell
/// may pull it open: held there, it would stretch what is whole beside it.
static float limit_of(const Limit *job, uint32_t c, int i, uint32_t ends[2]) {
    const uint32_t *corner = job->shell->cells[c];
    const CellSprings *springs = &job->shell->cell_springs[c];
    float *const *length = job->state->burn.spring_length;
    ends[0] = corner[limit_corner(i)], ends[1] = corner[i < 4 ? (i + 1) & 3 : i - 2];
    if (i < 4 && !(job->state->ablate.spring_flags[SINGE_BLUE][springs->blue[i]] & SINGE_ALIVE)) return INFINITY;
    return i < 4 ? LIMIT_SIDE * length[SINGE_BLUE][springs->blue[i]]
                 : LIMIT_DIAGONAL * length[SINGE_YELLOW][springs->yellow[i - 4]];
}

/// Whether two vertices are farther apart than `most`, and may be brought together.
static bool limit_is_over(const Limit *job, const uint32_t ends[2], float most) {
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    const Field compliance = job->shell->matter.compliance[SINGE_BLUE];
    Quad way = quad_load(x[ends[1]]) - quad_load(x[ends[0]]);
    return quad_dot(way, way) > most * most * 1.0001f && x[ends[0]][3] + x[ends[1]][3] > 0 &&
           field_at(compliance, ends[0]) + field_at(compliance, ends[1]) == 0;
}

/// Whether any of a cell's sides or diagonals is too long: all at once, for nearly none is.
static inline bool limit_cell_is_over(const Limit *job, uint32_t c) {
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    const uint32_t *corner = job->shell->cells[c];
    const CellSprings *springs = &job->shell->cell_springs[c];
    const float *blue = job->state->burn.spring_length[SINGE_BLUE], *yellow = job->state->burn.spring_length[SINGE_YELLOW];
    Quad p[4] = {quad_load(x[corner[0]]), quad_load(x[corner[1]]), quad_load(x[corner[2]]), quad_load(x[corner[3]])};
    Quad across[2] = {p[2] - p[0], p[3] - p[1]}, side[4] = {p[1] - p[0], p[2] - p[1], p[3] - p[2], p[0] - p[3]};
    quad_transpose(side);
    Quad length = {blue[springs->blue[0]], blue[springs->blue[1]], blue[springs->blue[2]], blue[springs->blue[3]]};
    length *= LIMIT_SIDE;
    QuadMask over = side[0] * side[0] + side[1] * side[1] + side[2] * side[2] > length * length;
    float first = LIMIT_DIAGONAL * yellow[springs->yellow[0]], second = LIMIT_DIAGONAL * yellow[springs->yellow[1]];
    return ((over[0] | over[1]) | (over[2] | over[3])) || quad_dot(across[0], across[0]) > first * first ||
           quad_dot(across[1], across[1]) > second * second;
}

/// Cells of sheets that are not left to their springs.
static double limit_count(void *task, int begin, int end) {
    const Limit *job = task;
    double over = 0;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        if (!(job->state->ablate.cell_flags[c] & SINGE_ALIVE) || !limit_cell_is_over(job, c)) continue;
        if (job->spread[job->shell->matter.sheet[shell_centre(job->shell, c)]].tight) continue;
        for (int i = 0; i < 6; i++) {
            uint32_t ends[2];
            float most = limit_of(job, c, i, ends);
            over += limit_is_over(job, ends, most);
        }
    }
    return over;
}

static void limit_shorten(const Limit *job, const uint32_t ends[2], float most) {
    float(*x)[4] = job->dynamics->position, (*v)[4] = job->dynamics->velocity;
    const uint32_t a = ends[0], b = ends[1];
    float wa = x[a][3], wb = x[b][3];
    Quad way = quad_load(x[b]) - quad_load(x[a]), relative = quad_load(v[b]) - quad_load(v[a]);
    way[3] = 0;
    float length = sqrtf(quad_dot(way, way)), opens = quad_dot(relative, way) / length;
    Quad unit = way / length, shift = (length - most) / (wa + wb) * unit;
    Quad slow = (opens > 0 ? opens : 0) / (wa + wb) * unit;
    quad_store(x[a], quad_load(x[a]) + wa * shift);
    quad_store(x[b], quad_load(x[b]) - wb * shift);
    quad_store(v[a], quad_load(v[a]) + wa * slow);
    quad_store(v[b], quad_load(v[b]) - wb * slow);
}

/// The blocks of cells with a count above 0, one after another.
static void limit_blocks(const Limit *job, const double *over) {
    for (uint32_t c = 0; c < job->shell->cell_count; c++) {
        if (c % POOL_BLOCK == 0 && over[c / POOL_BLOCK] == 0) {
            c += POOL_BLOCK - 1;
            continue;
        }
        if (!(job->state->ablate.cell_flags[c] & SINGE_ALIVE) || !limit_cell_is_over(job, c)) continue;
        if (job->spread[job->shell->matter.sheet[shell_centre(job->shell, c)]].tight) continue;
        for (int i = 0; i < 6; i++) {
            uint32_t ends[2];
            float most = limit_of(job, c, i, ends);
            if (limit_is_over(job, ends, most)) limit_shorten(job, ends, most);
        }
    }
}

bool dynamics_limit(DynamicsPlan *plan, const Shell *shell, const State *state, Pool *pool, DynamicsState *dynamics) {
    Limit job = {shell, state, dynamics, plan->attachments.spread};
    if (plan->paper || (state->step + 1) % LIMIT_PERIOD) return false;
    for (int round = 0; round < LIMIT_ROUNDS; round++) {
        if (pool_sum(pool, (int)shell->cell_count, limit_count, &job, plan->partial) == 0) return round > 0;
        limit_blocks(&job, plan->partial);
    }
    return true;
}
