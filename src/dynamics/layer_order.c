// Layers stay in order. The height of a cell's centre over its corners,
//
//   z = (x_centre - mean of corners) . n,   n the cell's unit normal,
//
// must not fall below height_min thicknesses. Where it does, the one-sided constraint C = z - z_min < 0 is
// projected with the gradients n at the centre and -n/4 at the corners (n taken as fixed):
//
//   lambda = gain C / (w_centre + sum w_i / 16),   x_centre -= w_centre lambda n,   x_i += w_i lambda n / 4
//
// which conserves linear momentum: the force that holds a centre up presses its corners down. It conserves angular
// momentum where the centre stands over the mean of its corners; a centre that leans aside gets a small moment. Cells
// of one family share no corner; families follow each other. Blocks of cells whose centres are all twice as high as
// they must be are skipped for some substeps.
//
// The last pass of a step leaves no cell inverted. The projection above keeps centres up softly, as it moves corners as
// well and must not throw them about; the last pass corrects what is left at the end of the step, by moving the centre alone. With
// the height z of a centre over its corners and the cell's unit normal n as there, where z < z_low
//
//   x_centre += (z_low - z) n,   u = (v_centre - mean of v_corners) . n,   v_centre -= min(u, 0) n
//
// so that the centre does not run back at once. Only centres move: they are not drawn, and each belongs to one cell. So
// this pass makes no drawn surfaces cross, depends on no order, and needs no families. The corners do not react: only
// projection conserves momentum. A pinned centre moves too, and its pin puts it back in the next substep; over corners
// that its pins have turned it would otherwise be out of order for good. So does a centre held by a collider, to at
// most z_low beyond the mean of its corners.
//
// A cell whose diagonals are parallel has no normal, and no front for its centre to be on: it is left as it is and
// counts neither as inverted nor as in order (sim/sim_stats.c).
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

/// Substeps to wait, and cells that wait together.
enum { HEIGHT_WAIT = 5, HEIGHT_BLOCK = 64 };

typedef struct Height {
    HeightRange *range;
    HeightLanes lanes;
    uint32_t count; ///< of the family's cells
    uint8_t *wait;  ///< of its blocks
} Height;

/// Blocks of the family's cells.
static void height_blocks(void *task, int begin, int end) {
    const Height *job = task;
    for (int b = begin; b < end; b++) {
        uint8_t *wait = &job->wait[b];
        if (*wait > 0) {
            --*wait;
            continue;
        }

        const uint32_t first = (uint32_t)b * HEIGHT_BLOCK, last = first + HEIGHT_BLOCK;
        if (job->range(&job->lanes, first, last < job->count ? last : job->count)) *wait = HEIGHT_WAIT;
    }
}

size_t height_wait_count(const Shell *shell) { return shell->cell_count / HEIGHT_BLOCK + shell->cell_family_count + 1; }

void height_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics) {
    const SingeSolverDef *solver = &plan->settings.solver;
    if (solver->height_min <= 0) return;

    HeightLanes lanes = {.position = dynamics->position[0],
                         .corner = (const uint32_t(*)[4])shell->cells,
                         .flags = ablate->cell_flags,
                         .first_centre = shell_centre(shell, 0),
                         .thickness = shell->matter.thickness,
                         .min = solver->height_min,
                         .gain = solver->height_gain};
    uint8_t *wait = plan->height_wait;
    for (uint32_t f = 0; f < shell->cell_family_count; f++) {
        uint32_t first = shell->cell_family_first[f], count = shell->cell_family_first[f + 1] - first;
        uint32_t blocks = (count + HEIGHT_BLOCK - 1) / HEIGHT_BLOCK;
        lanes.cells = shell->cell_order + first;
        Height job = {plan->kernels->height, lanes, count, wait};
        pool_for(pool, (int)blocks, POOL_GRAIN / HEIGHT_BLOCK, height_blocks, &job);
        wait += blocks;
    }
}

// ---- the last pass of a step

/// z_low over height_min thicknesses: well below where the projection acts, so that this pass stays the exception.
static const float ORDER_MIN = 0.1f;

typedef struct Order {
    const DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    DynamicsState *dynamics;
} Order;

static void order_cells(void *task, int begin, int end) {
    const Order *job = task;
    float(*x)[4] = job->dynamics->position, (*v)[4] = job->dynamics->velocity;
    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        if (!(job->ablate->cell_flags[c] & SINGE_ALIVE)) continue;

        uint32_t centre = shell_centre(job->shell, c);
        const uint32_t *corner = job->shell->cells[c];
        Float4 p0 = float4_load(x[corner[0]]), p1 = float4_load(x[corner[1]]);
        Float4 p2 = float4_load(x[corner[2]]), p3 = float4_load(x[corner[3]]);
        Float4 normal = float4_cross(p2 - p0, p3 - p1), mean = 0.25f * (p0 + p1 + (p2 + p3));
        normal[3] = 0; // positions hold masses there
        float min = ORDER_MIN * job->plan->settings.solver.height_min * field_at(job->shell->matter.thickness, centre);
        float above = float4_dot(float4_load(x[centre]) - mean, normal), square = float4_dot(normal, normal);
        if ((above > 0 && above * above >= min * min * square) || !(square > 0)) continue;

        // up to z_low
        float length = sqrtf(square);
        normal = normal * (1 / length);
        float4_store(x[centre], float4_load(x[centre]) + (min - above / length) * normal);
        if (!(x[centre][3] > 0)) continue;

        // without the velocity that leads it back through its corners
        Float4 drift = 0.25f * (float4_load(v[corner[0]]) + float4_load(v[corner[1]]) +
                                (float4_load(v[corner[2]]) + float4_load(v[corner[3]])));
        float away = float4_dot(float4_load(v[centre]) - drift, normal);
        if (away < 0) float4_store(v[centre], float4_load(v[centre]) - away * normal);
    }
}

void dynamics_order(const DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics) {
    if (plan->settings.solver.height_min <= 0) return;

    Order job = {plan, shell, ablate, dynamics};
    pool_for(pool, (int)shell->cell_count, POOL_GRAIN, order_cells, &job);
}
