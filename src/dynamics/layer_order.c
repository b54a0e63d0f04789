// The last pass of a step: no cell is left inverted. height.c keeps centres up softly, for it moves corners as well and
// may not throw them about; what it has not mended when the step ends is mended here, by the centre alone. With the
// height z of a centre over its corners and the cell's unit normal n as there, where z < z_least
//
//   x_centre += (z_least - z) n,   u = (v_centre - mean of v_corners) . n,   v_centre -= min(u, 0) n
//
// so that the centre does not run back at once. Only centres move: they are not drawn, each belongs to one cell, and so
// this pass makes no crossing of what is drawn, depends on no order, and needs no families. The corners do not answer,
// so that momentum is kept by height.c only. A pinned centre gives way too, and is put back where its pin has it in
// the next substep; over corners that its pins have turned it would else be out of order for good. So does one that a
// collider holds, by z_least at most beyond the mean of its corners.
//
// A cell whose diagonals are parallel has no normal, and no front that its centre could be on: it is left as it is and
// counts as inverted no more than as in order (sim/sim_stats.c).
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

/// z_least over height_min thicknesses: well under where height.c mends, so that this pass stays the exception.
static const float ORDER_LEAST = 0.1f;

typedef struct Order {
    const DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    DynamicsState *dynamics;
} Order;

/// Takes from a centre's velocity what leads it back through its corners.
static void order_calm(const Order *job, const uint32_t *corner, uint32_t centre, Quad normal) {
    float(*v)[4] = job->dynamics->velocity;
    Quad mean = 0.25f * (quad_load(v[corner[0]]) + quad_load(v[corner[1]]) +
                         (quad_load(v[corner[2]]) + quad_load(v[corner[3]])));
    float away = quad_dot(quad_load(v[centre]) - mean, normal);
    if (away < 0) quad_store(v[centre], quad_load(v[centre]) - away * normal);
}

static inline void order_cell(const Order *job, uint32_t c) {
    float(*x)[4] = job->dynamics->position;
    uint32_t centre = shell_centre(job->shell, c);
    const uint32_t *corner = job->shell->cells[c];
    Quad p0 = quad_load(x[corner[0]]), p1 = quad_load(x[corner[1]]);
    Quad p2 = quad_load(x[corner[2]]), p3 = quad_load(x[corner[3]]);
    Quad normal = quad_cross(p2 - p0, p3 - p1), mean = 0.25f * (p0 + p1 + (p2 + p3));
    normal[3] = 0; // positions hold masses there
    float least = ORDER_LEAST * job->plan->settings.solver.height_min * field_at(job->shell->matter.thickness, centre);
    float above = quad_dot(quad_load(x[centre]) - mean, normal), square = quad_dot(normal, normal);
    if (above > 0 && above * above >= least * least * square) return;
    if (!(square > 0)) return;
    float length = sqrtf(square);
    normal = normal * (1 / length);
    quad_store(x[centre], quad_load(x[centre]) + (least - above / length) * normal);
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
