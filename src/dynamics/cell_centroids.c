// Contact of the cells between particles. Particles of a layer are a cell apart: a collider smaller than a cell would
// reach through it. So the mean of a cell's corners,
//
//   x = (x_0 + x_1 + x_2 + x_3)/4,
//
// is kept out of colliders like a particle, with friction, and its corners move with it; held corners stay. Cells of
// one family share no corner; families follow each other. Contact of the particles comes after it and has the last
// word.
#include "dynamics/dynamics_plan.h"

typedef struct Centroid {
    const DynamicsPlan *plan;
    const Shell *shell;
    const AblateState *ablate;
    DynamicsState *dynamics;
    const uint32_t *cells; ///< of the family
    uint32_t collider_count;
    float h;
} Centroid;

/// Share of the offset that cells keep: less than all, so that a sheet on something flat is left to its particles.
static const float CENTROID_SHARE = 0.875f;

/// Whether a point is nearer to a collider than `limit`.
static bool centroid_is_near(const MovingCollider *moving, float limit, Float3 point) {
    const Collider *collider = moving->collider;
    Float3 from = float3_sub(point, moving->after.position), normal;
    for (int i = 2; i >= 0; i--) {
        float along = float3_dot(from, moving->axis[i]);
        if (!(along < moving->high[i] && along > moving->low[i])) return false;
    }
    return collider_distance(collider, quat_unrotate(moving->after.rotation, from), limit, &normal) < limit;
}

static Float3 centroid_previous(const Centroid *job, const uint32_t corner[4]) {
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        Float3 predicted = float3_load(job->plan->predicted[corner[i]]);
        sum = float3_add(sum, float3_mad(predicted, float3_load(job->dynamics->velocity[corner[i]]), -job->h));
    }
    return float3_scale(sum, 0.25f);
}

static void centroid_cell(const Centroid *job, const uint32_t corner[4]) {
    float(*position)[4] = job->dynamics->position;
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) sum = float3_add(sum, float3_load(position[corner[i]]));
    Float3 mean = float3_scale(sum, 0.25f);
    float point[3];
    bool touched = false;
    float3_store(point, mean);
    for (uint32_t c = 0; c < job->collider_count; c++) {
        const MovingCollider *collider = &job->plan->colliders[c];
        // no part of a plane lies between points outside it
        if (collider->collider->def.kind == SINGE_COLLIDER_PLANE) continue;
        float offset = CENTROID_SHARE * collider->collider->def.offset;
        if (centroid_is_near(collider, offset, float3_load(point)))
            touched |= contact_particle(collider, offset, centroid_previous(job, corner), point);
    }
    if (!touched) return;
    Float3 moved = float3_sub(float3_load(point), mean);
    for (int i = 0; i < 4; i++) {
        float *x = position[corner[i]];
        if (x[3] > 0) float3_store(x, float3_add(float3_load(x), moved));
    }
}

static void centroid_cells(void *task, int begin, int end) {
    const Centroid *job = task;
    for (int k = begin; k < end; k++)
        if (job->ablate->cell_flags[job->cells[k]] & SINGE_ALIVE) centroid_cell(job, job->shell->cells[job->cells[k]]);
}

void contact_centroids(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, uint32_t collider_count,
                       Pool *pool, float h, DynamicsState *dynamics) {
    bool any = false;
    for (uint32_t c = 0; c < collider_count; c++) any |= plan->colliders[c].collider->def.kind != SINGE_COLLIDER_PLANE;
    for (uint32_t f = 0; any && f < shell->cell_family_count; f++) {
        uint32_t first = shell->cell_family_first[f], count = shell->cell_family_first[f + 1] - first;
        Centroid job = {plan, shell, ablate, dynamics, shell->cell_order + first, collider_count, h};
        pool_for(pool, (int)count, POOL_BLOCK, centroid_cells, &job);
    }
}
