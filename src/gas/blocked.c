// Obstacles of the gas: cells whose centre is inside a collider have no gas, and a sheet's cell of area A and normal n
// covers A |n_d| of the nearest faces across axis d, shared among the four about it.
#include "gas/gas_plan.h"

#include <string.h>

/// Cells of a row that are looked at together: where a collider is farther from their middle than half of them are long,
/// it has all of them or none.
enum { BLOCKED_RUN = 8 };

/// Marks cells [first, first + BLOCKED_RUN) of a row, up to `end`, whose centre is inside the collider.
static void blocked_run(const GasPlan *plan, const Collider *collider, const Pose *pose, const int at[3], int end,
                        uint8_t *solid) {
    const float half = 0.5f * BLOCKED_RUN * plan->cell;
    Float3 x = {plan->origin[0] + plan->cell * ((float)at[0] + 0.5f * BLOCKED_RUN),
                plan->origin[1] + plan->cell * ((float)at[1] + 0.5f),
                plan->origin[2] + plan->cell * ((float)at[2] + 0.5f)},
           normal;
    const float middle = collider_distance(collider, pose_unapply(pose, x), half, &normal);
    if (middle >= half) return;

    for (int i = at[0]; i < at[0] + BLOCKED_RUN && i < end; i++) {
        x.x = plan->origin[0] + plan->cell * ((float)i + 0.5f);
        solid[i] |= middle <= -half || collider_distance(collider, pose_unapply(pose, x), 0, &normal) < 0;
    }
}

static void blocked_planes(void *context, int begin, int end) {
    const GasPass *pass = context;
    GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;

    for (int k = begin; k < end; k++)
        for (int j = 0; j < grid->n[1]; j++) {
            size_t c = gas_at(grid, 0, j, k);
            memset(plan->solid + c, 0, (size_t)grid->n[0]);

            // cells whose centre is inside a collider
            for (uint32_t s = 0; s < pass->colliders->count; s++) {
                const Collider *collider = &pass->colliders->items[s];
                if (collider->generation == 0) continue;
                Pose pose = path_pose(&collider->path, pass->state->time);
                for (int i = 0; i < grid->n[0]; i += BLOCKED_RUN)
                    blocked_run(plan, collider, &pose, (const int[3]){i, j, k}, grid->n[0], plan->solid + c);
            }
        }
}

/// Converts the covered share to the open one.
static void blocked_open(void *context, int begin, int end) {
    const GasPass *pass = context;
    GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;

    for (int d = 0; d < 3; d++)
        for (int k = begin; k < end; k++)
            for (int j = 0; j <= grid->n[1]; j++) {
                size_t c = gas_at(grid, 0, j, k);
                float *open = plan->open[d];
                const uint8_t *solid = plan->solid;
                for (int i = 0; i <= grid->n[0]; i++, c++) {
                    float left = solid[c] | solid[c - grid->stride[d]] ? 0 : 1 - open[c];
                    open[c] = left > 0.02f ? left : 0;
                }
            }
}

void gas_blocked(GasPass *pass) {
    GasPlan *plan = pass->plan;
    const GasGrid *grid = &plan->grid;
    const Shell *shell = pass->shell;

    for (int d = 0; d < 3; d++) memset(plan->open[d], 0, grid->cells * sizeof(float));
    gas_planes(pass, grid, blocked_planes);

    // share of the faces that each cell of a sheet covers
    float face = 1 / (plan->cell * plan->cell), position[3], part[3];
    for (uint32_t cell = 0; cell < shell->cell_count; cell++) {
        if (!(pass->state->ablate->cell_flags[cell] & SINGE_ALIVE)) continue;
        uint32_t i = shell_centre(shell, cell);
        if (!gas_position(plan, float3_load(pass->state->dynamics->position[i]), position)) continue;
        for (int d = 0; d < 3; d++) {
            float share = shell->matter.area[i] * face * fabsf(plan->normal[i][d]);
            int e = (d + 1) % 3, f = (d + 2) % 3, at[3];
            at[d] = (int)floorf(position[d] + 1); // the nearest face: the cell's lower one, or that of the cell above
            for (int q = 0; q < 3; q++) {
                if (q == d) continue;
                at[q] = (int)(position[q] + 1) - 1;
                part[q] = position[q] - (float)at[q];
            }

            float *open = plan->open[d] + gas_at(grid, at[0], at[1], at[2]);
            open[0] += share * (1 - part[e]) * (1 - part[f]);
            open[grid->stride[e]] += share * part[e] * (1 - part[f]);
            open[grid->stride[f]] += share * (1 - part[e]) * part[f];
            open[grid->stride[e] + grid->stride[f]] += share * part[e] * part[f];
        }
    }

    gas_planes(pass, grid, blocked_open);
    blocked_open(pass, grid->n[2], grid->n[2] + 1); // the upper faces of the last plane
}
