// Sheets that keep air from others: what burns within d of a live cell of another sheet, and a thickness more for the layer
// behind, gets no air, with that cell's `smother_distance` d.
//
// Cells with d > 0 lie in a grid by their centroids, filled in each step that asks.
#include "world/smother.h"

#include "common/real.h"
#include "world/triangle.h"

SingeResult smother_create(Memory *memory, const Shell *shell, Smother *smother) {
    const Matter *matter = &shell->matter;
    for (uint32_t c = 0; c < shell->cell_count; c++)
        smother->count += field_at(matter->smother_distance, shell_centre(shell, c)) > 0;
    if (smother->count == 0) return SINGE_OK;

    for (uint32_t i = 0; i < shell->particle_count; i++)
        smother->thickness = float_max(smother->thickness, field_at(matter->thickness, i));
    if (!NEW(memory, smother->cells, smother->count) || !NEW(memory, smother->balls, smother->count) ||
        !cube_grid_create(memory, smother->count, &smother->grid))
        return SINGE_ERROR_MEMORY;

    for (uint32_t c = 0, k = 0; c < shell->cell_count; c++)
        if (field_at(matter->smother_distance, shell_centre(shell, c)) > 0) smother->cells[k++] = c;
    return SINGE_OK;
}

void smother_free(Memory *memory, Smother *smother) {
    FREE(memory, smother->cells, smother->count);
    FREE(memory, smother->balls, smother->count);
    cube_grid_free(memory, &smother->grid);
}

typedef struct SmotherJob {
    const Smother *smother;
    const Shell *shell;
    const StateInput *state;
} SmotherJob;

/// Centroids, and how far about them the cells reach: 0 for those that are gone.
static void smother_balls(void *context, int begin, int end) {
    const SmotherJob *job = context;
    const Smother *smother = job->smother;
    const Shell *shell = job->shell;
    const float(*x)[4] = (const float(*)[4])job->state->dynamics->position;

    for (int k = begin; k < end; k++) {
        const uint32_t cell = smother->cells[k], *at = shell->cells[cell];
        float *ball = smother->balls[k], radius = 0;
        Float3 sum = {0, 0, 0};
        for (int i = 0; i < 4; i++) sum = float3_mad(sum, float3_load(x[at[i]]), 0.25f);
        for (int i = 0; i < 4; i++) radius = float_max(radius, float3_length(float3_sub(float3_load(x[at[i]]), sum)));
        float3_store(ball, sum);

        const bool alive = job->state->ablate->cell_flags[cell] & SINGE_ALIVE;
        const float distance = field_at(shell->matter.smother_distance, shell_centre(shell, cell));
        ball[3] = alive ? radius + distance + smother->thickness : 0;
    }
}

bool smother_place(Smother *smother, const Shell *shell, const StateInput *state, Pool *pool) {
    if (smother->count == 0) return false;

    SmotherJob job = {smother, shell, state};
    pool_for(pool, (int)smother->count, POOL_BLOCK, smother_balls, &job);
    float reach = 0;
    for (uint32_t k = 0; k < smother->count; k++) reach = float_max(reach, smother->balls[k][3]);
    if (!(reach > 0)) return false;

    cube_grid_clear(&smother->grid, reach);
    for (uint32_t k = 0; k < smother->count; k++)
        if (smother->balls[k][3] > 0) cube_grid_add(&smother->grid, k, smother->balls[k]);
    return true;
}

/// Whether a cell is within reach of a particle.
static bool smother_reaches(const Shell *shell, const StateInput *state, uint32_t cell, Float3 centroid,
                            uint32_t particle) {
    const float(*x)[4] = (const float(*)[4])state->dynamics->position;
    const float reach = field_at(shell->matter.smother_distance, shell_centre(shell, cell)) +
                        field_at(shell->matter.thickness, particle);
    const uint32_t *at = shell->cells[cell];
    const Float3 p = float3_load(x[particle]);
    for (int i = 0; i < 4; i++) {
        const Float3 a = float3_load(x[at[i]]), b = float3_load(x[at[(i + 1) & 3]]);
        if (triangle_closest(p, a, b, centroid).square <= (double)reach * (double)reach) return true;
    }

    return false;
}

bool smother_covers(const Smother *smother, const Shell *shell, const StateInput *state, uint32_t particle) {
    const uint16_t *sheet = shell->matter.sheet;
    const Float3 p = float3_load(((const float(*)[4])state->dynamics->position)[particle]);
    uint32_t first[27];
    cube_grid_around(&smother->grid, p, first);
    for (int n = 0; n < 27; n++) {
        for (uint32_t k = first[n]; k != CUBE_GRID_END; k = smother->grid.next[k]) {
            const Float3 centroid = float3_load(smother->balls[k]);
            const uint32_t cell = smother->cells[k];
            if (sheet[shell_centre(shell, cell)] == sheet[particle]) continue;
            if (float3_length(float3_sub(p, centroid)) > smother->balls[k][3]) continue;
            if (smother_reaches(shell, state, cell, centroid, particle)) return true;
        }
    }

    return false;
}
