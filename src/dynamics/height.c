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
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

/// Substeps to wait, and cells that wait together.
enum { HEIGHT_WAIT = 5, HEIGHT_BLOCK = 64 };

/// Max correction at once, over the square root of |n|, which is 1.4 cells: otherwise shells thicker than their cells
/// would be thrown about.
static const float HEIGHT_MAX = 0.05f;

typedef struct Height {
    DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    float (*position)[4];
    const uint32_t *cells; ///< of the family
    uint32_t count;
    uint8_t *wait; ///< of its blocks
} Height;

/// Whether a height is enough, by its square: `above` is the height times |n|, `square` is |n|^2.
static bool height_is_enough(float above, float square, float enough) {
    return above > 0 && above * above >= enough * enough * square;
}

/// Projects a centre that is too low.
static void height_mend(const Height *job, uint32_t c, Float4 normal, float square, float missing) {
    float(*x)[4] = job->position;
    const uint32_t *corner = job->shell->cells[c];
    float *centre = x[shell_centre(job->shell, c)], length = sqrtf(square), max = HEIGHT_MAX * sqrtf(length);
    float w[4] = {x[corner[0]][3], x[corner[1]][3], x[corner[2]][3], x[corner[3]][3]};
    float weight = centre[3] + (w[0] + w[1] + w[2] + w[3]) / 16;
    if (weight <= 0) return;
    float gain = job->plan->settings.solver.height_gain;
    Float4 correction = gain * (missing < max ? missing : max) / (weight * length) * normal;
    float4_store(centre, float4_load(centre) + centre[3] * correction);
    for (int i = 0; i < 4; i++) float4_store(x[corner[i]], float4_load(x[corner[i]]) - 0.25f * w[i] * correction);
}

/// Returns whether the centre is twice as high as it must be.
static inline bool height_cell(const Height *job, uint32_t c) {
    const float(*x)[4] = (const float(*)[4])job->position;
    uint32_t centre = shell_centre(job->shell, c);
    const uint32_t *corner = job->shell->cells[c];
    Float4 p0 = float4_load(x[corner[0]]), p1 = float4_load(x[corner[1]]);
    Float4 p2 = float4_load(x[corner[2]]), p3 = float4_load(x[corner[3]]);
    Float4 normal = float4_cross(p2 - p0, p3 - p1), mean = 0.25f * (p0 + p1 + (p2 + p3));
    normal[3] = 0; // positions hold masses there
    float enough = job->plan->settings.solver.height_min * field_at(job->shell->matter.thickness, centre);
    float above = float4_dot(float4_load(x[centre]) - mean, normal), square = float4_dot(normal, normal);
    if (height_is_enough(above, square, 2 * enough)) return true;
    if (!height_is_enough(above, square, enough) && square > 0)
        height_mend(job, c, normal, square, enough - above / sqrtf(square));
    return false;
}

/// Blocks of the family's cells.
static void height_blocks(void *task, int begin, int end) {
    const Height *job = task;
    for (int b = begin; b < end; b++) {
        uint8_t *wait = &job->wait[b];
        if (*wait > 0) {
            --*wait;
            continue;
        }
        bool all_high = true;
        uint32_t first = (uint32_t)b * HEIGHT_BLOCK, last = first + HEIGHT_BLOCK;
        for (uint32_t k = first; k < (last < job->count ? last : job->count); k++)
            if (job->ablate->cell_flags[job->cells[k]] & SINGE_ALIVE) all_high &= height_cell(job, job->cells[k]);
        if (all_high) *wait = HEIGHT_WAIT;
    }
}

size_t height_wait_count(const Shell *shell) { return shell->cell_count / HEIGHT_BLOCK + shell->cell_family_count + 1; }

void height_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics) {
    if (plan->settings.solver.height_min <= 0) return;
    uint8_t *wait = plan->height_wait;
    for (uint32_t f = 0; f < shell->cell_family_count; f++) {
        uint32_t first = shell->cell_family_first[f], count = shell->cell_family_first[f + 1] - first;
        uint32_t blocks = (count + HEIGHT_BLOCK - 1) / HEIGHT_BLOCK;
        Height job = {plan, shell, ablate, dynamics->position, shell->cell_order + first, count, wait};
        pool_for(pool, (int)blocks, POOL_BLOCK / HEIGHT_BLOCK, height_blocks, &job);
        wait += blocks;
    }
}
