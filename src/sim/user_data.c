// Lists of the existing objects, and the callers' data for them.
#include "sim/objects.h"

/// The handles of a list's objects, at most `capacity` of them, in the order of their slots. Returns how many there
/// are.
#define OBJECTS_LIST(list, ids, capacity)                             \
    do {                                                              \
        uint32_t count = 0;                                           \
        for (uint32_t i = 0; i < (list).count; i++) {                 \
            if ((list).items[i].generation == 0) continue;            \
            if (count < (capacity)) {                                 \
                (ids)[count].index = i;                               \
                (ids)[count].generation = (list).items[i].generation; \
            }                                                         \
            count++;                                                  \
        }                                                             \
        return count;                                                 \
    } while (0)

uint32_t singe_sim_sources(const SingeSim *sim, SingeSourceId *ids, uint32_t capacity) {
    OBJECTS_LIST(sim->sources, ids, capacity);
}

uint32_t singe_sim_colliders(const SingeSim *sim, SingeColliderId *ids, uint32_t capacity) {
    OBJECTS_LIST(sim->colliders, ids, capacity);
}

uint32_t singe_sim_pins(const SingeSim *sim, SingePinId *ids, uint32_t capacity) {
    OBJECTS_LIST(sim->pins, ids, capacity);
}

uint32_t singe_sim_sheets(const SingeSim *sim, SingeSheetId *ids, uint32_t capacity) {
    for (uint32_t i = 0; i < sim->sheet_count && i < capacity; i++) ids[i] = (SingeSheetId){i, 1};
    return sim->sheet_count;
}

static bool sheet_is_there(const SingeSim *sim, SingeSheetId id) {
    return id.generation == 1 && id.index < sim->sheet_count;
}

void *singe_sim_sheet_user_data(const SingeSim *sim, SingeSheetId id) {
    return sheet_is_there(sim, id) ? sim->sheets[id.index].user_data : NULL;
}

void *singe_sim_source_user_data(const SingeSim *sim, SingeSourceId id) {
    const Source *source = OBJECT_FIND(sim->sources, id);
    return source ? source->def.user_data : NULL;
}

void *singe_sim_collider_user_data(const SingeSim *sim, SingeColliderId id) {
    const Collider *collider = OBJECT_FIND(sim->colliders, id);
    return collider ? collider->def.user_data : NULL;
}

void *singe_sim_pin_user_data(const SingeSim *sim, SingePinId id) {
    const Pin *pin = OBJECT_FIND(sim->pins, id);
    return pin ? pin->user_data : NULL;
}

SingeResult singe_sim_set_sheet_user_data(SingeSim *sim, SingeSheetId id, void *user_data) {
    if (!sheet_is_there(sim, id)) return object_stale(sim, "sheet", id.index);
    sim->sheets[id.index].user_data = user_data;
    return SINGE_OK;
}

SingeResult singe_sim_set_source_user_data(SingeSim *sim, SingeSourceId id, void *user_data) {
    Source *source = OBJECT_FIND(sim->sources, id);
    if (!source) return object_stale(sim, "source", id.index);
    source->def.user_data = user_data;
    return SINGE_OK;
}

SingeResult singe_sim_set_collider_user_data(SingeSim *sim, SingeColliderId id, void *user_data) {
    Collider *collider = OBJECT_FIND(sim->colliders, id);
    if (!collider) return object_stale(sim, "collider", id.index);
    collider->def.user_data = user_data;
    return SINGE_OK;
}

SingeResult singe_sim_set_pin_user_data(SingeSim *sim, SingePinId id, void *user_data) {
    Pin *pin = OBJECT_FIND(sim->pins, id);
    if (!pin) return object_stale(sim, "pin", id.index);
    pin->user_data = user_data;
    return SINGE_OK;
}

void sim_copy_hooks(const SingeSim *from, SingeSim *to) {
    for (uint32_t i = 0; i < from->sheet_count; i++) to->sheets[i].user_data = from->sheets[i].user_data;
    for (uint32_t i = 0; i < from->sources.count; i++) {
        to->sources.items[i].def.callback = from->sources.items[i].def.callback;
        to->sources.items[i].def.callback_context = from->sources.items[i].def.callback_context;
        to->sources.items[i].def.user_data = from->sources.items[i].def.user_data;
    }
    for (uint32_t i = 0; i < from->colliders.count; i++)
        to->colliders.items[i].def.user_data = from->colliders.items[i].def.user_data;
    for (uint32_t i = 0; i < from->pins.count; i++) to->pins.items[i].user_data = from->pins.items[i].user_data;
}
