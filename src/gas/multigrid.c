// Multigrid for the pressure (Brandt 1977), on cells: sum over a cell's faces of w (p_beyond - p) = rhs.
//
// A cell of the next level is eight of this one; the weights of its faces are the means of the four that they consist
// of, its rhs half the sum of its cells' residuals (a face is four times as large and twice as far). Its solution is
// added to each of its cells. Smoothing is by Gauss and Seidel, alternating red and black cells: cells of a colour do
// not see each other.
#include "gas/gas_plan.h"

enum { SWEEPS = 2, SWEEPS_COARSEST = 10 };

/// Residual of a cell's equation.
static inline float grid_residual(const GasLevel *level, size_t c) {
    const float *p = level->p;
    size_t y = level->grid.stride[1], z = level->grid.stride[2];
    const float *wx = level->weight[0], *wy = level->weight[1], *wz = level->weight[2];
    float sum = wx[c] * (p[c - 1] - p[c]) + wx[c + 1] * (p[c + 1] - p[c]) + wy[c] * (p[c - y] - p[c]) +
                wy[c + y] * (p[c + y] - p[c]) + wz[c] * (p[c - z] - p[c]) + wz[c + z] * (p[c + z] - p[c]);
    return level->rhs[c] - sum;
}

static void grid_invert(void *context, int begin, int end) {
    const GasLevel *level = ((const GasPass *)context)->level;
    size_t y = level->grid.stride[1], z = level->grid.stride[2];
    const float *wx = level->weight[0], *wy = level->weight[1], *wz = level->weight[2];

    for (int k = begin; k < end; k++)
        for (int j = 0; j < level->grid.n[1]; j++) {
            size_t c = gas_at(&level->grid, 0, j, k);
            for (int i = 0; i < level->grid.n[0]; i++, c++) {
                float sum = wx[c] + wx[c + 1] + wy[c] + wy[c + y] + wz[c] + wz[c + z];
                level->inverse[c] = sum > 1e-4f ? 1 / sum : 0;
            }
        }
}

static void grid_sweep(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasLevel *level = pass->level;
    float *p = level->p;
    size_t y = level->grid.stride[1], z = level->grid.stride[2];
    const float *wx = level->weight[0], *wy = level->weight[1], *wz = level->weight[2];

    for (int k = begin; k < end; k++)
        for (int j = 0; j < level->grid.n[1]; j++) {
            int first = (j + k + pass->colour) % 2;
            size_t c = gas_at(&level->grid, first, j, k);
            for (int i = first; i < level->grid.n[0]; i += 2, c += 2) {
                float sum = wx[c] * p[c - 1] + wx[c + 1] * p[c + 1] + wy[c] * p[c - y] + wy[c + y] * p[c + y] +
                            wz[c] * p[c - z] + wz[c + z] * p[c + z];
                p[c] = (sum - level->rhs[c]) * level->inverse[c];
            }
        }
}

/// The first cell of the finer level in a cell of the pass's level.
static inline size_t grid_fine(const GasLevel *fine, int i, int j, int k) {
    return gas_at(&fine->grid, 2 * i, 2 * j, 2 * k);
}

static void grid_weigh(void *context, int begin, int end) {
    const GasLevel *level = ((const GasPass *)context)->level, *fine = level - 1;
    for (int d = 0; d < 3; d++) {
        size_t e = fine->grid.stride[(d + 1) % 3], f = fine->grid.stride[(d + 2) % 3];
        const float *w = fine->weight[d];
        int rows = level->grid.n[1] + (d == 1), columns = level->grid.n[0] + (d == 0);
        for (int k = begin; k < end; k++)
            for (int j = 0; j < rows; j++) {
                size_t c = gas_at(&level->grid, 0, j, k), a = grid_fine(fine, 0, j, k);
                for (int i = 0; i < columns; i++, c++, a += 2)
                    level->weight[d][c] = 0.25f * (w[a] + w[a + e] + w[a + f] + w[a + e + f]);
            }
    }
}

static void grid_restrict(void *context, int begin, int end) {
    const GasLevel *level = ((const GasPass *)context)->level, *fine = level - 1;
    size_t y = fine->grid.stride[1], z = fine->grid.stride[2];

    for (int k = begin; k < end; k++)
        for (int j = 0; j < level->grid.n[1]; j++) {
            size_t c = gas_at(&level->grid, 0, j, k), a = grid_fine(fine, 0, j, k);
            for (int i = 0; i < level->grid.n[0]; i++, c++, a += 2) {
                float sum = 0;
                for (size_t e = 0; e < 8; e++)
                    sum += grid_residual(fine, a + (e & 1) + (e & 2 ? y : 0) + (e & 4 ? z : 0));
                level->rhs[c] = 0.5f * sum;
                level->p[c] = 0;
            }
        }
}

static void grid_prolong(void *context, int begin, int end) {
    const GasLevel *level = ((const GasPass *)context)->level, *fine = level - 1;
    size_t y = fine->grid.stride[1], z = fine->grid.stride[2];

    for (int k = begin; k < end; k++)
        for (int j = 0; j < level->grid.n[1]; j++) {
            size_t c = gas_at(&level->grid, 0, j, k), a = grid_fine(fine, 0, j, k);
            for (int i = 0; i < level->grid.n[0]; i++, c++, a += 2)
                for (size_t e = 0; e < 8; e++) {
                    size_t b = a + (e & 1) + (e & 2 ? y : 0) + (e & 4 ? z : 0);
                    fine->p[b] += fine->inverse[b] > 0 ? level->p[c] : 0;
                }
        }
}

static void grid_smooth(GasPass *pass, GasLevel *level, int sweeps, int first) {
    pass->level = level;
    for (int s = 0; s < 2 * sweeps; s++) {
        pass->colour = (s + first) % 2;
        gas_planes(pass, &level->grid, grid_sweep);
    }
}

static void grid_cycle(GasPass *pass, int l) {
    GasPlan *plan = pass->plan;
    GasLevel *level = &plan->level[l];

    if (l + 1 == plan->levels) {
        grid_smooth(pass, level, SWEEPS_COARSEST, 0);
        return;
    }

    grid_smooth(pass, level, SWEEPS, 0);
    pass->level = level + 1;
    gas_planes(pass, &level[1].grid, grid_restrict);
    grid_cycle(pass, l + 1);
    pass->level = level + 1;
    gas_planes(pass, &level[1].grid, grid_prolong);
    grid_smooth(pass, level, SWEEPS, 1);
}

void gas_solve(GasPass *pass, int cycles) {
    GasPlan *plan = pass->plan;
    for (int l = 0; l < plan->levels; l++) {
        pass->level = &plan->level[l];
        if (l > 0) {
            gas_planes(pass, &pass->level->grid, grid_weigh);
            grid_weigh(pass, pass->level->grid.n[2], pass->level->grid.n[2] + 1);
        }
        gas_planes(pass, &pass->level->grid, grid_invert);
    }

    for (int cycle = 0; cycle < cycles; cycle++) grid_cycle(pass, 0);
}
