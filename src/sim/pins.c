// Pins: added, moved and removed at any time. A pin added before the commit waits for it as it was given, as the
// textures of sources do, and its particles are found there.
#include "common/assertion.h"
#include "common/def_table.h"
#include "common/real.h"
#include "sim/objects.h"

#include <math.h>
#include <string.h>

static void pin_stop_waiting(SingeSim *sim, Pin *pin) {
    float *points = (float *)(uintptr_t)pin->waiting.points; // owned by the pin, as are the vertices
    uint32_t *vertices = (uint32_t *)(uintptr_t)pin->waiting.vertices;
    FREE(&sim->memory, points, 3 * (size_t)pin->waiting.point_count);
    FREE(&sim->memory, vertices, pin->waiting.vertex_count);
    pin->waiting = (SingePinDef){0};
}

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
    motion_free(&sim->memory, &pin->motion);
    pin_stop_waiting(sim, pin);
    memset(pin, 0, sizeof *pin);
}

static float pin_distance2(const Shell *shell, uint32_t particle, const float *point) {
    SINGE_ASSERT(particle < shell->particle_count);
    Float3 d = float3_sub(float3_load(shell->rest_position[particle]), float3_load(point));
    return float3_dot(d, d);
}

/// Points (m) up to this size have finite squared distances.
static const float pin_position_max = 1e9f;

static SingeResult pin_check(SingeSim *sim, const SingePinDef *def) {
    if (def->sheet.generation != 1 || def->sheet.index >= sim->sheet_count)
        return object_stale(sim, "pin", def->sheet.index);

    const Sheet *sheet = &sim->sheets[def->sheet.index].sheet;
    TRY(def_check(&pin_table, def, &sim->error));
    if (def->point_count == 0 && def->vertex_count == 0)
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "neither points nor vertices are given");
    if (def->point_count && !def->points) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "points is NULL");
    if (def->vertex_count && !def->vertices) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "vertices is NULL");

    // points and vertices
    for (size_t k = 0; k < 3 * (size_t)def->point_count; k++)
        if (!(fabsf(def->points[k]) <= pin_position_max))
            return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "pin", (int64_t)(k / 3),
                             "point %u is not finite or beyond 1e9 m", (uint32_t)(k / 3));
    for (uint32_t k = 0; k < def->vertex_count; k++)
        if (def->vertices[k] >= sheet->vertex_count)
            return error_set(&sim->error, SINGE_ERROR_ARGUMENT, "pin", k,
                             "vertex %u is out of range: sheet \"%s\" has %u", def->vertices[k], sheet->name,
                             sheet->vertex_count);

    return SINGE_OK;
}

/// The vertex with cells that is nearest to each point, the first of equals. Warns of the first point that misses the
/// sheet: farther from it beyond the radius than a tenth of its diagonal, as one a cell or two off is still meant so.
static void pin_aim(const SingeSim *sim, const SingePinDef *def, const Pin *pin, uint32_t *nearest) {
    const Shell *shell = &sim->shell;
    const Sheet *sheet = &shell->sheets[def->sheet.index];
    const uint32_t end = sheet->vertex_first + sheet->vertex_count;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    bool warned = false;

    for (uint32_t v = sheet->vertex_first; v < end; v++)
        for (int i = 0; i < 3 && shell->matter.area[v] > 0; i++) {
            low[i] = float_min(low[i], shell->rest_position[v][i]);
            high[i] = float_max(high[i], shell->rest_position[v][i]);
        }
    const float diagonal = float3_length(float3_sub(float3_load(high), float3_load(low)));

    for (uint32_t k = 0; k < def->point_count; k++) {
        const float *point = def->points + 3 * (size_t)k;
        float min = INFINITY;

        nearest[k] = sheet->vertex_first;
        for (uint32_t v = sheet->vertex_first; v < end; v++) {
            const float d = pin_distance2(shell, v, point);
            if (d >= min || !(shell->matter.area[v] > 0)) continue;
            min = d;
            nearest[k] = v;
        }

        if (warned || !(sqrtf(min) > def->radius + 0.1f * diagonal)) continue;
        sim_log_missed(sim, (uint32_t)(pin - sim->pins.items), def->sheet.index, point, sqrtf(min));
        warned = true;
    }
}

/// Lists the particles of a checked pin, in order, and their anchors.
static bool pin_gather(SingeSim *sim, const SingePinDef *def, Pin *pin) {
    const Shell *shell = &sim->shell;
    const uint32_t first = shell->sheets[def->sheet.index].vertex_first;
    Memory *memory = &sim->memory;
    uint32_t *nearest = NULL;
    uint8_t *listed = NULL;
    bool ok = NEW(memory, nearest, def->point_count) && NEW(memory, listed, shell->particle_count);

    if (ok) {
        pin_aim(sim, def, pin, nearest);

        // those listed, the nearest, and what is within the radius: centres lie a thickness off the mesh, on which points are
        for (uint32_t k = 0; k < def->vertex_count; k++) listed[first + def->vertices[k]] = 1;
        uint32_t count = 0;
        for (uint32_t i = 0; i < shell->particle_count; i++) {
            const bool corner = shell_is_corner(shell, i), spare = corner && shell_is_spare(shell, i);
            const bool may = shell->matter.sheet[i] == def->sheet.index && !spare;
            const float reach = def->radius + (corner ? 0 : field_at(shell->matter.thickness, i));
            for (uint32_t k = 0; k < def->point_count && may && !listed[i]; k++)
                listed[i] = nearest[k] == i ||
                            (def->radius > 0 && pin_distance2(shell, i, def->points + 3 * (size_t)k) <= reach * reach);
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

/// Finds the particles of a pin's Def, and holds them.
static SingeResult pin_hold(SingeSim *sim, const SingePinDef *def, Pin *pin) {
    if (!pin_gather(sim, def, pin)) return sim_fail(sim, SINGE_ERROR_MEMORY, "pin", -1, "out of memory");

    for (uint32_t k = 0; k < pin->count; k++) {
        uint32_t particle = pin->particles[k];
        if (sim->state.dynamics.pinned[particle] == UINT8_MAX)
            return error_set(&sim->error, SINGE_ERROR_LIMIT, "pin", particle, "particle %u is held by 255 pins already",
                             particle);
    }

    pin_count(sim, pin, 1);
    return SINGE_OK;
}

SingeResult call_add_pin(SingeSim *sim, const SingePinDef *given, SingePinId *id) {
    if (id) *id = (SingePinId){0, 0};
    SingePinDef def;
    OBJECT_DEF(sim, "pin", def, given, singe_default_pin);
    TRY(pin_check(sim, &def));

    uint32_t index;
    Pin *pin = sim_slot(sim, &sim->pins.items, &sim->pins.count, &sim->pins.capacity, sizeof *pin, &index);
    if (!pin) return sim_fail(sim, SINGE_ERROR_MEMORY, "pin", -1, "out of memory");
    TRY(path_set(&pin->path, &sim->memory, def.path_count, def.path, "pin", &sim->error));
    pin->user_data = def.user_data;
    pin->end = def.end;

    // find particles now, or at the commit
    SingeResult result = SINGE_OK;
    if (sim->committed) {
        result = pin_hold(sim, &def, pin);
    } else {
        float *points = NULL;
        uint32_t *vertices = NULL;
        bool ok =
            NEW(&sim->memory, points, 3 * (size_t)def.point_count) && NEW(&sim->memory, vertices, def.vertex_count);
        if (ok && def.point_count) memcpy(points, def.points, 3 * (size_t)def.point_count * sizeof *points);
        if (ok && def.vertex_count) memcpy(vertices, def.vertices, def.vertex_count * sizeof *vertices);

        pin->waiting = def;
        pin->waiting.points = points;
        pin->waiting.vertices = vertices;
        pin->waiting.path_count = 0;
        pin->waiting.path = NULL;
        if (!ok) result = sim_fail(sim, SINGE_ERROR_MEMORY, "pin", -1, "out of memory");
    }

    if (result) {
        sim_free_pin(sim, pin);
        return result;
    }

    // take the slot last, as nothing can fail any more
    if (sim->committed) dynamics_plan_hold(sim->dynamics, &sim->shell, &sim->state);
    pin->generation = sim_take_slot(sim, &sim->pins.count, index);
    if (id) *id = (SingePinId){index, pin->generation};
    return SINGE_OK;
}

SingeResult call_remove_pin(SingeSim *sim, SingePinId id) {
    Pin *pin = OBJECT_FIND(sim->pins, id);
    if (!pin) return object_stale(sim, "pin", id.index);
    pin_count(sim, pin, -1);
    if (sim->committed) dynamics_plan_hold(sim->dynamics, &sim->shell, &sim->state);
    sim_free_pin(sim, pin);
    return SINGE_OK;
}

SingeResult call_move_pin(SingeSim *sim, SingePinId id, uint32_t count, const SingePoseKey *path) {
    Pin *pin = OBJECT_FIND(sim->pins, id);
    if (!pin) return object_stale(sim, "pin", id.index);

    // anchors are relative to the pose at which the pin was added: carry them over to the new path's frame
    Pose before = path_pose(&pin->path, sim->state.time);
    TRY(path_set(&pin->path, &sim->memory, count, path, "pin", &sim->error));
    Pose after = path_pose(&pin->path, sim->state.time);
    const float share = motion_share(&pin->motion, sim->state.time);
    for (uint32_t k = 0; k < pin->count; k++)
        float3_store(pin->anchors[k], pose_unapply(&after, pin_point(pin, &before, k, share)));
    motion_free(&sim->memory, &pin->motion);
    return SINGE_OK;
}

void sim_end_pins(SingeSim *sim) {
    bool any = false;
    for (uint32_t i = 0; i < sim->pins.count; i++) {
        Pin *pin = &sim->pins.items[i];
        if (pin->count == 0 || sim->state.time + 0.5 * (double)sim->def.time_step < (double)pin->end) continue;
        any = true;
        pin_count(sim, pin, -1);
        motion_free(&sim->memory, &pin->motion);
        FREE(&sim->memory, pin->particles, pin->count);
        FREE(&sim->memory, pin->anchors, pin->count);
        pin->count = 0;
    }
    if (any) dynamics_plan_hold(sim->dynamics, &sim->shell, &sim->state);
}

const uint32_t *singe_sim_pin_particles(const SingeSim *sim, SingePinId id, uint32_t *count) {
    const Pin *pin = OBJECT_FIND(sim->pins, id);
    *count = pin ? pin->count : 0;
    return pin && pin->count ? pin->particles : NULL;
}

SingeResult call_set_pin_positions(SingeSim *sim, SingePinId id, const float *positions, double time) {
    Pin *pin = OBJECT_FIND(sim->pins, id);
    if (!pin) return object_stale(sim, "pin", id.index);
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "pin", -1,
                        "call singe_sim_commit first: it chooses the particles that a pin holds");
    if (!isfinite(time)) return sim_fail(sim, SINGE_ERROR_ARGUMENT, "pin", -1, "the time is not finite");

    TRY(motion_check(pin->count, positions, pin_position_max, "pin", &sim->error));
    if (pin->count == 0) return SINGE_OK;

    // a motion that begins at the particles' present positions on the path
    if (!pin->motion.to) {
        float(*now)[3] = NULL;
        bool ok = NEW(&sim->memory, now, pin->count) != NULL;
        const Pose pose = path_pose(&pin->path, sim->state.time);
        for (uint32_t k = 0; ok && k < pin->count; k++)
            float3_store(now[k], pose_apply(&pose, float3_load(pin->anchors[k])));
        ok = ok && motion_create(&sim->memory, pin->count, now[0], &pin->motion);
        FREE(&sim->memory, now, pin->count);
        if (!ok) return sim_fail(sim, SINGE_ERROR_MEMORY, "pin", -1, "out of memory");
    }

    motion_set(&pin->motion, positions, sim->state.time, time);
    return SINGE_OK;
}

// ---- the commit

SingeResult sim_settle_objects(SingeSim *sim) {
    SingeResult result = SINGE_OK;
    for (uint32_t i = 0; i < sim->sources.count && !result; i++)
        result = source_settle(&sim->memory, &sim->shell, &sim->sources.items[i], &sim->error);
    for (uint32_t i = 0; i < sim->pins.count && !result; i++)
        if (sim->pins.items[i].generation) result = pin_hold(sim, &sim->pins.items[i].waiting, &sim->pins.items[i]);

    // all objects wait again if one fails: the State is about to be freed
    if (result) {
        for (uint32_t i = 0; i < sim->sources.count; i++)
            source_unsettle(&sim->memory, &sim->shell, &sim->sources.items[i]);
        for (uint32_t i = 0; i < sim->pins.count; i++) {
            Pin *pin = &sim->pins.items[i];
            FREE(&sim->memory, pin->particles, pin->count);
            FREE(&sim->memory, pin->anchors, pin->count);
            pin->count = 0;
        }

        return result;
    }

    for (uint32_t i = 0; i < sim->sources.count; i++) source_settled(&sim->memory, &sim->sources.items[i]);
    for (uint32_t i = 0; i < sim->pins.count; i++) pin_stop_waiting(sim, &sim->pins.items[i]);
    if (sim->pins.count) dynamics_plan_hold(sim->dynamics, &sim->shell, &sim->state);
    return SINGE_OK;
}
