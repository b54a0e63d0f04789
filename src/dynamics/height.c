// Layers stay in order. The height of a cell's centre over its corners,
//
//   z = (x_centre - mean of corners) . n,   n the cell's unit normal,
//
// must not fall below height_min thicknesses; where it does, the centre is moved along n by
// height_gain of what is missing. Only centres move: they belong to one cell each, so all cells can be
// treated at once, and they are not drawn, so that no drawn surface can be pushed through another.
#include "dynamics/plan.h"

typedef struct Height {
    DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    DynamicsState *dynamics;
} Height;

static void height_cells(void *task, int begin, int end) {
    Height *job = task;
    const SingeSolverDef *solver = &job->plan->settings.solver;
    float(*x)[4] = job->dynamics->position;
    for (int c = begin; c < end; c++) {
        uint32_t centre = shell_centre(job->shell, (uint32_t)c);
        if (!(job->ablate->cell_flags[c] & SINGE_ALIVE) || job->plan->inverse_mass[centre] == 0) continue;
        const uint32_t *corner = job->shell->cells[c];
        Vec p0 = vec_load(x[corner[0]]), p1 = vec_load(x[corner[1]]), p2 = vec_load(x[corner[2]]), p3 = vec_load(x[corner[3]]);
        Vec normal = vec_unit(vec_cross(vec_sub(p2, p0), vec_sub(p3, p1)));
        Vec mean = vec_scale(vec_add(vec_add(p0, p1), vec_add(p2, p3)), 0.25f);
        float height = vec_dot(vec_sub(vec_load(x[centre]), mean), normal);
        float missing = solver->height_min * job->shell->matter.thickness[centre] - height;
        if (missing > 0) vec_store(x[centre], vec_mad(vec_load(x[centre]), normal, solver->height_gain * missing));
    }
}

void height_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool, DynamicsState *dynamics) {
    if (plan->settings.solver.height_min <= 0) return;
    Height job = {plan, shell, ablate, dynamics};
    pool_for(pool, (int)shell->cell_count, POOL_BLOCK, height_cells, &job);
}
