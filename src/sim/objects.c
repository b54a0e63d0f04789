// Sources, colliders, pins and wind: added, moved and removed at any time after the commit.
#include "sim/sim_internal.h"

#include <string.h>

/// The part of a caller's Def that it knows, over the defaults; fails where its struct_size is not set.
#define OBJECT_DEF(sim, stage, local, given, defaults)                                        \
    do {                                                                                      \
        (local) = (defaults)();                                                               \
        if (!sim_read_def(&(local), sizeof(local), (given), SIZE_MAX))                        \
            return sim_fail((sim), SINGE_ERROR_ARGUMENT, (stage), -1,                         \
                            "struct_size is not set; start from " #defaults "()");            \
    } while (0)

static SingeResult object_check(SingeSim *sim, const char *stage) {
    if (sim->committed) return SINGE_OK;
    return sim_fail(sim, SINGE_ERROR_STATE, stage, -1, "singe_sim_commit comes before sources, colliders and pins");
}

static SingeResult object_stale(SingeSim *sim, const char *stage, uint32_t index) {
    return error_set(&sim->error, SINGE_ERROR_HANDLE, stage, index, "the handle is stale or was never given out");
}

/// Finds an object by its handle; NULL when stale.
#define OBJECT_FIND(list, id) \
    ((id).generation != 0 && (id).index < (list).count && (list).items[(id).index].generation == (id).generation \
         ? &(list).items[(id).index] \
         : NULL)

// ---- sources

void sim_free_source(SingeSim *sim, Source *source) {
    source_free(&sim->memory, &sim->shell, source);
    memset(source, 0, sizeof *source);
}

SingeResult singe_sim_add_source(SingeSim *sim, const SingeSourceDef *given, SingeSourceId *id) {
    *id = (SingeSourceId){0, 0};
    TRY(object_check(sim, "source"));
    SingeSourceDef def;
    OBJECT_DEF(sim, "source", def, given, singe_default_source);
    uint32_t index;
    Source *source =
        sim_slot(sim, &sim->sources.items, &sim->sources.count, &sim->sources.capacity, sizeof *source, &index);
    if (!source) return sim_fail(sim, SINGE_ERROR_MEMORY, "source", -1, "out of memory");
    TRY(source_create(&sim->memory, &sim->shell, &def, source, &sim->error));
    source->generation = sim->next_generation++;
    *id = (SingeSourceId){index, source->generation};
    return SINGE_OK;
}

SingeResult singe_sim_remove_source(SingeSim *sim, SingeSourceId id) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    sim_free_source(sim, source);
    return SINGE_OK;
}

SingeResult singe_sim_set_source_callback(SingeSim *sim, SingeSourceId id, SingeFluxFn *callback, void *context) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    if (source->def.kind != SINGE_SOURCE_CALLBACK)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "not a callback source");
    source->def.callback = callback;
    source->def.callback_context = context;
    return SINGE_OK;
}

SingeResult singe_sim_move_source(SingeSim *sim, SingeSourceId id, uint32_t count, const SingePoseKey *path) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    if (source->def.kind != SINGE_SOURCE_BALL && source->def.kind != SINGE_SOURCE_SPOT)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "only balls and spots have a place");
    if (count == 0) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "the path needs at least one key");
    if (source->def.kind == SINGE_SOURCE_SPOT && count != 1)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "source", id.index, "the path of a spot has exactly one key");
    return path_set(&source->path, &sim->memory, count, path, "source", &sim->error);
}

// ---- colliders

SingeResult singe_sim_add_collider(SingeSim *sim, const SingeColliderDef *given, SingeColliderId *id) {
    *id = (SingeColliderId){0, 0};
    TRY(object_check(sim, "collider"));
    SingeColliderDef def;
    OBJECT_DEF(sim, "collider", def, given, singe_default_collider);
    uint32_t index;
    Collider *collider =
        sim_slot(sim, &sim->colliders.items, &sim->colliders.count, &sim->colliders.capacity, sizeof *collider, &index);
    if (!collider || !dynamics_plan_reserve(&sim->memory, sim->dynamics, sim->colliders.count))
        return sim_fail(sim, SINGE_ERROR_MEMORY, "collider", -1, "out of memory");
    TRY(collider_create(&sim->memory, &def, collider, &sim->error));
    if (collider->mesh.turned) sim_log_turned(sim, index);
    collider->generation = sim->next_generation++;
    *id = (SingeColliderId){index, collider->generation};
    return SINGE_OK;
}

SingeResult singe_sim_remove_collider(SingeSim *sim, SingeColliderId id) {
    Collider *collider = OBJECT_FIND(sim->colliders, id);
    if (!collider) return object_stale(sim, "collider", id.index);
    collider_free(&sim->memory, collider);
    return SINGE_OK;
}

SingeResult singe_sim_move_collider(SingeSim *sim, SingeColliderId id, uint32_t count, const SingePoseKey *path) {
    Collider *collider = OBJECT_FIND(sim->colliders, id);
    if (!collider) return object_stale(sim, "collider", id.index);
    if (count == 0) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "collider", id.index, "the path needs at least one key");
    return path_set(&collider->path, &sim->memory, count, path, "collider", &sim->error);
}

// ---- pins

static void pin_count(SingeSim *sim, const Pin *pin, int change) {
    for (uint32_t k = 0; k < pin->count; k++) {
        uint32_t particle = pin->particles[k];
        uint8_t *held = &sim->state.dynamics.pinned[particle];
        *held = (uint8_t)(*held + change);
        uint8_t *flags = &sim->state.ablate.particle_flags[particle];
        *flags = (uint8_t)(*held ? *flags | SINGE_PINNED : *flags & ~SINGE_PINNED);
    }
}

void sim_free_pin(SingeSim *sim, Pin *pin) {
    FREE(&sim->memory, pin->particles, pin->count);
    FREE(&sim->memory, pin->anchors, pin->count);
    path_free(&pin->path, &sim->memory);
    memset(pin, 0, sizeof *pin);
}

static float pin_distance2(const Shell *shell, uint32_t particle, const float *point) {
    Float3 d = float3_sub(float3_load(shell->rest_position[particle]), float3_load(point));
    return float3_dot(d, d);
}

/// Nearest vertex of the sheet to a point; the first of equals. Vertices without cells are not looked at.
static uint32_t pin_nearest(const Shell *shell, const Sheet *sheet, const float *point) {
    uint32_t best = sheet->vertex_first;
    float min = INFINITY;
    for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++) {
        float d = pin_distance2(shell, v, point);
        if (d < min && shell->matter.area[v] > 0) min = d, best = v;
    }
    return best;
}

/// Whether a pin takes a particle; `nearest` are the points' nearest vertices.
static bool pin_takes(const Shell *shell, const SingePinDef *def, const uint32_t *nearest, const uint8_t *listed,
                      uint32_t particle) {
    if (listed[particle]) return true;
    if (shell_is_corner(shell, particle) && shell_is_spare(shell, particle)) return false;
    // centres lie a thickness off the mesh, where points are given
    float reach = def->radius + (shell_is_corner(shell, particle) ? 0 : field_at(shell->matter.thickness, particle));
    for (uint32_t k = 0; k < def->point_count; k++)
        if (nearest[k] == particle ||
            (def->radius > 0 && pin_distance2(shell, particle, def->points + 3 * (size_t)k) <= reach * reach))
            return true;
    return false;
}

/// Points (m) up to this size have finite squared distances.
static const float pin_position_max = 1e9f;

static SingeResult pin_check(SingeSim *sim, const SingePinDef *def) {
    if (def->sheet.generation != 1 || def->sheet.index >= sim->sheet_count)
        return object_stale(sim, "pin", def->sheet.index);
    const Sheet *sheet = &sim->shell.sheets[def->sheet.index];
    if (!(def->radius >= 0 && def->radius <= 1e6f))
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "radius must be 0 or more");
    if (def->point_count == 0 && def->vertex_count == 0)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "neither points nor vertices are given");
    if (def->point_count && !def->points) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "points is NULL");
    if (def->vertex_count && !def->vertices) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "vertices is NULL");
    for (size_t k = 0; k < 3 * (size_t)def->point_count; k++)
        if (!(fabsf(def->points[k]) <= pin_position_max))
            return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "pin", (int64_t)(k / 3),
                             "point %u is not finite or beyond 1e9 m", (uint32_t)(k / 3));
    for (uint32_t k = 0; k < def->vertex_count; k++)
        if (def->vertices[k] >= sheet->vertex_count - sheet->spare_count)
            return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "pin", k,
                             "vertex %u is out of range: sheet \"%s\" has %u", def->vertices[k], sheet->name,
                             sheet->vertex_count - sheet->spare_count);
    return SINGE_OK;
}

/// Lists the particles of a checked pin, in order, and their anchors.
static bool pin_gather(SingeSim *sim, const SingePinDef *def, Pin *pin) {
    const Shell *shell = &sim->shell;
    const Sheet *sheet = &shell->sheets[def->sheet.index];
    Memory *memory = &sim->memory;
    uint32_t *nearest = NULL;
    uint8_t *listed = NULL;
    bool ok = NEW(memory, nearest, def->point_count) && NEW(memory, listed, shell->particle_count);
    if (ok) {
        for (uint32_t k = 0; k < def->point_count; k++)
            nearest[k] = pin_nearest(shell, sheet, def->points + 3 * (size_t)k);
        for (uint32_t k = 0; k < def->vertex_count; k++) listed[sheet->vertex_first + def->vertices[k]] = 1;
        uint32_t count = 0;
        for (uint32_t i = 0; i < shell->particle_count; i++) {
            listed[i] = shell->matter.sheet[i] == def->sheet.index && pin_takes(shell, def, nearest, listed, i);
            count += listed[i];
        }
        ok = NEW(memory, pin->particles, count) && NEW(memory, pin->anchors, count);
        pin->count = count;
    }
    if (ok) {
        Pose pose = path_pose(&pin->path, sim->state.time);
        uint32_t k = 0;
        for (uint32_t i = 0; i < shell->particle_count; i++) {
            if (!listed[i]) continue;
            pin->particles[k] = i;
            float3_store(pin->anchors[k++], pose_unapply(&pose, float3_load(sim->state.dynamics.position[i])));
        }
    }
    FREE(memory, nearest, def->point_count);
    FREE(memory, listed, shell->particle_count);
    return ok;
}

SingeResult singe_sim_add_pin(SingeSim *sim, const SingePinDef *given, SingePinId *id) {
    *id = (SingePinId){0, 0};
    TRY(object_check(sim, "pin"));
    SingePinDef def;
    OBJECT_DEF(sim, "pin", def, given, singe_default_pin);
    TRY(pin_check(sim, &def));
    uint32_t index;
    Pin *pin = sim_slot(sim, &sim->pins.items, &sim->pins.count, &sim->pins.capacity, sizeof *pin, &index);
    if (!pin) return sim_fail(sim, SINGE_ERROR_MEMORY, "pin", -1, "out of memory");
    TRY(path_set(&pin->path, &sim->memory, def.path_count, def.path, "pin", &sim->error));
    if (!pin_gather(sim, &def, pin)) {
        sim_free_pin(sim, pin);
        return sim_fail(sim, SINGE_ERROR_MEMORY, "pin", -1, "out of memory");
    }
    for (uint32_t k = 0; k < pin->count; k++) {
        uint32_t particle = pin->particles[k];
        if (sim->state.dynamics.pinned[particle] < UINT8_MAX) continue;
        sim_free_pin(sim, pin);
        return error_set(&sim->error, SINGE_ERROR_LIMIT, "pin", particle, "particle %u is held by 255 pins already",
                         particle);
    }
    pin_count(sim, pin, 1);
    dynamics_plan_hold(sim->dynamics, &sim->shell, &sim->state);
    pin->generation = sim->next_generation++;
    *id = (SingePinId){index, pin->generation};
    return SINGE_OK;
}

SingeResult singe_sim_remove_pin(SingeSim *sim, SingePinId id) {
    Pin *pin = OBJECT_FIND(sim->pins, id);
    if (!pin) return object_stale(sim, "pin", id.index);
    pin_count(sim, pin, -1);
    dynamics_plan_hold(sim->dynamics, &sim->shell, &sim->state);
    sim_free_pin(sim, pin);
    return SINGE_OK;
}

SingeResult singe_sim_move_pin(SingeSim *sim, SingePinId id, uint32_t count, const SingePoseKey *path) {
    Pin *pin = OBJECT_FIND(sim->pins, id);
    if (!pin) return object_stale(sim, "pin", id.index);
    // anchors are relative to the pose at which the pin was added: carry them over to the new path's frame
    Pose before = path_pose(&pin->path, sim->state.time);
    TRY(path_set(&pin->path, &sim->memory, count, path, "pin", &sim->error));
    Pose after = path_pose(&pin->path, sim->state.time);
    for (uint32_t k = 0; k < pin->count; k++)
        float3_store(pin->anchors[k], pose_unapply(&after, pose_apply(&before, float3_load(pin->anchors[k]))));
    return SINGE_OK;
}

// ---- wind

SingeResult singe_sim_set_wind(SingeSim *sim, const SingeWindDef *given) {
    SingeWindDef def;
    OBJECT_DEF(sim, "wind", def, given, singe_default_wind);
    TRY(wind_check(&def, &sim->error));
    sim->def.wind = def;
    return SINGE_OK;
}
