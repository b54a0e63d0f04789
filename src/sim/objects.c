// Sources, colliders and wind: added, moved and removed at any time.
#include "sim/objects.h"

#include "common/def_table.h"

#include <math.h>
#include <string.h>

// ---- sources

void sim_free_source(SingeSim *sim, Source *source) {
    source_free(&sim->memory, &sim->shell, source);
    memset(source, 0, sizeof *source);
}

SingeResult call_add_source(SingeSim *sim, const SingeSourceDef *given, SingeSourceId *id) {
    if (id) *id = (SingeSourceId){0, 0};
    SingeSourceDef def;
    OBJECT_DEF(sim, "source", def, given, singe_default_source);

    uint32_t index;
    Source *source =
        sim_slot(sim, &sim->sources.items, &sim->sources.count, &sim->sources.capacity, sizeof *source, &index);
    if (!source) return sim_fail(sim, SINGE_ERROR_MEMORY, "source", -1, "out of memory");

    TRY(source_create(&sim->memory, &sim->shell, &def, source, &sim->error));
    source->generation = sim_take_slot(sim, &sim->sources.count, index);
    if (id) *id = (SingeSourceId){index, source->generation};
    return SINGE_OK;
}

SingeResult call_remove_source(SingeSim *sim, SingeSourceId id) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    sim_free_source(sim, source);
    return SINGE_OK;
}

SingeResult call_set_source_callback(SingeSim *sim, SingeSourceId id, SingeFluxFn *callback, void *context) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    if (source->def.kind != SINGE_SOURCE_CALLBACK)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "not a callback source");
    source->def.callback = callback;
    source->def.callback_context = context;
    return SINGE_OK;
}

SingeResult call_move_source(SingeSim *sim, SingeSourceId id, uint32_t count, const SingePoseKey *path) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    if (!source->path.count)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "a source of this kind has no position");
    if (count == 0) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "the path needs at least one key");
    if (source->def.kind == SINGE_SOURCE_SPOT && count != 1)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "the path of a spot has exactly one key");
    return path_set(&source->path, &sim->memory, count, path, "source", &sim->error);
}

// ---- colliders

SingeResult call_add_collider(SingeSim *sim, const SingeColliderDef *given, SingeColliderId *id) {
    if (id) *id = (SingeColliderId){0, 0};
    SingeColliderDef def;
    OBJECT_DEF(sim, "collider", def, given, singe_default_collider);

    uint32_t index;
    Collider *collider =
        sim_slot(sim, &sim->colliders.items, &sim->colliders.count, &sim->colliders.capacity, sizeof *collider, &index);
    if (!collider || (sim->dynamics && !dynamics_plan_reserve(&sim->memory, sim->dynamics, index + 1)))
        return sim_fail(sim, SINGE_ERROR_MEMORY, "collider", -1, "out of memory");

    TRY(collider_create(&sim->memory, &def, collider, &sim->error));
    if (collider->mesh.turned || (collider->deform.pose && deform_solid(&collider->deform)->turned))
        sim_log_turned(sim, index);
    collider->generation = sim_take_slot(sim, &sim->colliders.count, index);
    if (id) *id = (SingeColliderId){index, collider->generation};
    return SINGE_OK;
}

SingeResult call_remove_collider(SingeSim *sim, SingeColliderId id) {
    Collider *collider = OBJECT_FIND(sim->colliders, id);
    if (!collider) return object_stale(sim, "collider", id.index);
    collider_free(&sim->memory, collider);
    return SINGE_OK;
}

SingeResult call_move_collider(SingeSim *sim, SingeColliderId id, uint32_t count, const SingePoseKey *path) {
    Collider *collider = OBJECT_FIND(sim->colliders, id);
    if (!collider) return object_stale(sim, "collider", id.index);
    if (count == 0) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "collider", id.index, "the path needs at least one key");
    return path_set(&collider->path, &sim->memory, count, path, "collider", &sim->error);
}

SingeResult call_set_collider_vertices(SingeSim *sim, SingeColliderId id, const float *vertices, double time) {
    Collider *collider = OBJECT_FIND(sim->colliders, id);
    if (!collider) return object_stale(sim, "collider", id.index);
    if (collider->def.kind != SINGE_COLLIDER_DEFORMING)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "collider", id.index, "not a deforming collider");
    if (!isfinite(time)) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "collider", -1, "the time is not finite");

    TRY(motion_check(collider->deform.motion.count, vertices, 1e4f, "collider", &sim->error));
    motion_set(&collider->deform.motion, vertices, sim->state.time, time);
    deform_forget(&collider->deform);
    return SINGE_OK;
}

// ---- wind

SingeResult call_set_wind(SingeSim *sim, const SingeWindDef *given) {
    SingeWindDef def;
    OBJECT_DEF(sim, "wind", def, given, singe_default_wind);
    TRY(def_check(&wind_table, &def, &sim->error));
    sim->def.wind = def;
    return SINGE_OK;
}
