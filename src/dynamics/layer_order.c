// The last pass of a step: no cell is left inverted. height.c keeps centres up softly, as it moves corners as well and
// must not throw them about; this pass corrects what is left at the end of the step, by moving the centre alone. With
// the height z of a centre over its corners and the cell's unit normal n as there, where z < z_low
//
//   x_centre += (z_low - z) n,   u = (v_centre - mean of v_corners) . n,   v_centre -= min(u, 0) n
//
// so that the centre does not run back at once. Only centres move: they are not drawn, and each belongs to one cell. So
// this pass makes no drawn surfaces cross, depends on no order, and needs no families. The corners do not react: only
// height.c conserves momentum. A pinned centre moves too, and its pin puts it back in the next substep; over corners
// that its pins have turned it would otherwise be out of order for good. So does a centre held by a collider, to at
// most z_low beyond the mean of its corners.
//
// A cell whose diagonals are parallel has no normal, and no front for its centre to be on: it is left as it is and
// counts neither as inverted nor as in order (sim/sim_stats.c).
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

/// z_low over height_min thicknesses: well below where height.c acts, so that this pass stays the exception.
static const float ORDER_MIN = 0.1f;

typedef struct Order {
    const DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    DynamicsState *dynamics;
} Order;

/// Removes the velocity that leads a centre back through its corners.
static void order_calm(const Order *job, const uint32_t *corner, uint32_t centre, Float4 normal) {
    float(*v)[4] = job->dynamics->velocity;
    Float4 mean = 0.25f * (float4_load(v[corner[0]]) + float4_load(v[corner[1]]) +
                           (float4_load(v[corner[2]]) + float4_load(v[corner[3]])));
    float away = float4_dot(float4_load(v[centre]) - mean, normal);
    if (away < 0) float4_store(v[centre], float4_load(v[centre]) - away * normal);
}

static inline void order_cell(const Order *job, uint32_t c) {
    float(*x)[4] = job->dynamics->position;
    uint32_t centre = shell_centre(job->shell, c);
    const uint32_t *corner = job->shell->cells[c];
    Float4 p0 = float4_load(x[corner[0]]), p1 = float4_load(x[corner[1]]);
    Float4 p2 = float4_load(x[corner[2]]), p3 = float4_load(x[corner[3]]);
    Float4 normal = float4_cross(p2 - p0, p3 - p1), mean = 0.25f * (p0 + p1 + (p2 + p3));
    normal[3] = 0; // positions hold masses there
    float min = ORDER_MIN * job->plan->settings.solver.height_min * field_at(job->shell->matter.thickness, centre);
    float above = float4_dot(float4_load(x[centre]) - mean, normal), square = float4_dot(normal, normal);
    if (above > 0 && above * above >= min * min * square) return;
    if (!(square > 0)) return;
    float length = sqrtf(square);
    normal = normal * (1 / length);
    float4_store(x[centre], float4_load(x[centre]) + (min - above / length) * normal);
    if (x[centre][3] > 0) order_calm(job, corner, centre, normal);
}

static void order_cells(void *task, int begin, int end) {
    const Order *job = task;
    for (int c = begin; c < end; c++)
        if (job->ablate->cell_flags[c] & SINGE_ALIVE) order_cell(job, (uint32_t)c);
}

void dynamics_order(const DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics) {
    if (plan->settings.solver.height_min <= 0) return;
    Order job = {plan, shell, ablate, dynamics};
    pool_for(pool, (int)shell->cell_count, POOL_BLOCK, order_cells, &job);
}
