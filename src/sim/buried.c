// Whether sheets begin inside colliders. A collider throws particles inside it out in the first step, over their whole
// depth in one time step, each vertex by a different distance.
#include "common/real.h"
#include "sim/sim_internal.h"

enum { BURIED_SAMPLES = 4096 }; // vertices that are looked at, evenly spread

void sim_find_buried(const SingeSim *sim) {
    const uint32_t count = sim->shell.vertex_count, stride = count / BURIED_SAMPLES + 1;
    float cell = INFINITY;
    for (uint32_t s = 0; s < sim->shell.sheet_count; s++) cell = float_min(cell, sim->shell.sheets[s].cell_size);

    for (uint32_t i = 0; sim->def.log.write && i < sim->colliders.count; i++) {
        const Collider *collider = &sim->colliders.items[i];
        if (collider->generation == 0) continue;

        const float offset = collider->def.offset;
        const Pose pose = path_pose(&collider->path, 0);
        uint32_t inside = 0, looked_at = 0;
        float deepest = 0; // m
        Float3 where = {0};
        for (uint32_t v = 0; v < count; v += stride) {
            if (shell_is_spare(&sim->shell, v)) continue;

            Float3 normal, position = float3_load(sim->state.dynamics.position[v]);
            float depth = offset - collider_distance(collider, pose_unapply(&pose, position), offset + 1e-6f, &normal);
            looked_at++;
            inside += depth > 0;

            if (depth > deepest) {
                deepest = depth;
                where = position;
            }
        }
        if (deepest > cell) sim_log_buried(sim, i, (double)inside / looked_at, deepest, where);
    }
}
