// The pressure's part of the step:
//
//   u = u* - dt/rho grad p,   div u = q/GAS_HEAT
//
// on faces, of which the share `open` is uncovered. u* of a face is the mean of its cells. With p in m/s for a face's
// difference in air of the ambient density, and the face's weight w = open rho_a/rho = open/(1 - L),
//
//   u_face = open u* - w (p_upper - p_lower)
//   sum over a cell's faces of w (p_beyond - p) = sum(open u*) - cell q/GAS_HEAT
//
// Beyond the border p = 0, half a cell away. A cell's velocity changes by the mean of its faces' changes, so that
// averaging removes little of it (as FLIP does for particles), and takes a small part of the faces' own mean, for
// motion too short for faces to see.
#include "gas/gas_plan.h"

#include <string.h>

static const float PROJECT_OWN = 0.05f, PROJECT_FASTEST = 20;
enum { PROJECT_CYCLES = 1 };

/// Speed of the face below cell c along axis d before the pressure; at the border that of the cell inside.
static inline float project_face(const float *u, size_t c, size_t beyond, bool first, bool last) {
    return first ? u[c] : last ? u[c - beyond] : 0.5f * (u[c] + u[c - beyond]);
}

/// Faces' speeds before the pressure, and their weights.
static void project_faces(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const float *L = pass->to->field[GAS_LIGHTNESS];

    for (int d = 0; d < 3; d++) {
        const float *u = pass->to->field[GAS_VELOCITY + d], *open = plan->open[d];
        float *through = pass->to->field[GAS_THROUGH + d], *weight = plan->level[0].weight[d];
        size_t beyond = grid->stride[d];
        int rows = grid->n[1] + (d == 1), columns = grid->n[0] + (d == 0);

        // mean of the two cells at each face, weight of its pressure gradient
        for (int k = begin; k < end; k++)
            for (int j = 0; j < rows; j++) {
                size_t c = gas_at(grid, 0, j, k);
                for (int i = 0; i < columns; i++, c++) {
                    int at = d == 0 ? i : d == 1 ? j : k;
                    bool first = at == 0, last = at == grid->n[d];
                    float light = project_face(L, c, beyond, first, last);
                    through[c] = project_face(u, c, beyond, first, last);
                    weight[c] = open[c] * (first || last ? 2 : 1) / (1 - light);
                }
            }
    }
}

static void project_rhs(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    float *rhs = plan->level[0].rhs, scale = plan->cell / pass->dt;

    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            for (int i = 0; i < grid->n[0]; i++) rhs[c + (size_t)i] = -scale * plan->expansion[c + (size_t)i];
            for (int d = 0; d < 3; d++) {
                const float *u = pass->to->field[GAS_THROUGH + d], *open = plan->open[d];
                size_t e = c + grid->stride[d];
                for (size_t i = 0; i < (size_t)grid->n[0]; i++)
                    rhs[c + i] += open[e + i] * u[e + i] - open[c + i] * u[c + i];
            }
        }
}

/// Velocities of cells after the pressure.
static void project_cells(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const float *p = pass->to->field[GAS_PRESSURE];

    for (int d = 0; d < 3; d++) {
        const float *before = pass->to->field[GAS_THROUGH + d], *open = plan->open[d];
        const float *weight = plan->level[0].weight[d];
        float *u = pass->to->field[GAS_VELOCITY + d];
        size_t s = grid->stride[d];

        // change of the fluxes through both faces, added to the cell's velocity
        for (int k = begin; k < end; k++)
            for (int j = 0; j < grid->n[1]; j++) {
                size_t c = gas_at(grid, 0, j, k);
                for (int i = 0; i < grid->n[0]; i++, c++) {
                    float lower = open[c] * before[c] - weight[c] * (p[c] - p[c - s]);
                    float upper = open[c + s] * before[c + s] - weight[c + s] * (p[c + s] - p[c]);
                    float faces = 0.5f * (lower + upper), moved = u[c] + faces - 0.5f * (before[c] + before[c + s]);
                    u[c] = moved + PROJECT_OWN * (faces - moved);
                }
            }
    }
}

/// Speeds through faces after the pressure.
static void project_through(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const float *p = pass->to->field[GAS_PRESSURE];

    for (int d = 0; d < 3; d++) {
        float *through = pass->to->field[GAS_THROUGH + d];
        const float *open = plan->open[d], *weight = plan->level[0].weight[d];
        int rows = grid->n[1] + (d == 1), columns = grid->n[0] + (d == 0);
        for (int k = begin; k < end; k++)
            for (int j = 0; j < rows; j++) {
                size_t c = gas_at(grid, 0, j, k);
                for (int i = 0; i < columns; i++, c++) {
                    float u = open[c] * through[c] - weight[c] * (p[c] - p[c - grid->stride[d]]);
                    through[c] = u > -PROJECT_FASTEST ? u < PROJECT_FASTEST ? u : PROJECT_FASTEST : -PROJECT_FASTEST;
                }
            }
    }
}

/// Runs over the planes and once more for the upper faces of the last.
static void project_all_faces(GasPass *pass, SingeTaskFn *run) {
    gas_planes(pass, &pass->plan->grid, run);
    run(pass, pass->plan->grid.n[2], pass->plan->grid.n[2] + 1);
}

void gas_project(GasPass *pass) {
    GasPlan *plan = pass->plan;

    // the last pressure is close to the solution
    memcpy(pass->to->field[GAS_PRESSURE], pass->from->field[GAS_PRESSURE], plan->grid.cells * sizeof(float));
    plan->level[0].p = pass->to->field[GAS_PRESSURE];
    project_all_faces(pass, project_faces);
    gas_planes(pass, &plan->grid, project_rhs);
    gas_solve(pass, PROJECT_CYCLES);
    gas_planes(pass, &plan->grid, project_cells);
    project_all_faces(pass, project_through);
}
