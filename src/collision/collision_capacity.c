// Room for what is found. The lists have room for what folds and heaps come to; where sheets crowd more than that they
// grow to what is needed, up to a most that only sheets lying within each other reach. What is found beyond that is
// dropped and counted.
//
// What a list has grown to decides nothing: the same is found with as much room or with more, so that a run which goes
// on from a snapshot, where lists begin small again, has the same bytes.
#include "collision/collision_plan.h"

#include <string.h>

typedef struct Room {
    void *at; ///< the plan's pointer
    size_t before, after, size;
} Room;

enum { ROOMS = 4 };

/// Grows all of them or none.
static bool grow_rooms(Memory *memory, const Room *room, int count) {
    void *grown[ROOMS], *old;
    for (int k = 0; k < count; k++) {
        grown[k] = memory_new(memory, room[k].after, room[k].size);
        if (grown[k]) continue;
        while (k-- > 0) memory_free(memory, (void *)&grown[k], room[k].after, room[k].size);
        return false;
    }
    for (int k = 0; k < count; k++) {
        memcpy(&old, room[k].at, sizeof old);
        memcpy(grown[k], old, room[k].before * room[k].size);
        memory_free(memory, (void *)&old, room[k].before, room[k].size);
        memcpy(room[k].at, &grown[k], sizeof old);
    }
    return true;
}

/// A quarter more than is needed, so that it does not come to growing at every step.
static uint32_t with_margin(uint64_t wanted, uint32_t most) {
    wanted += wanted / 4;
    return wanted < most ? (uint32_t)wanted : most;
}

bool touch_grow_pairs(TouchPlan *plan, uint64_t wanted) {
    uint32_t before = plan->pair_capacity, after = with_margin(wanted, plan->sizes.pair_most);
    if (wanted <= before || before >= plan->sizes.pair_most) return true;
    const Room room[ROOMS] = {
        {&plan->pairs, before, after, sizeof *plan->pairs},
        {&plan->active, before, after, sizeof *plan->active},
        {&plan->around, 2 * (size_t)before, 2 * (size_t)after, sizeof *plan->around},
        {&plan->partial, (size_t)pool_blocks((int)before), (size_t)pool_blocks((int)after), sizeof *plan->partial},
    };
    TouchList *pairs = &plan->found_pairs, *pushes = &plan->found;
    if (!touch_list_grow(plan->memory, pairs, after, pairs->block_count) ||
        !touch_list_grow(plan->memory, pushes, pushes->capacity, touch_look_blocks(after)) ||
        !grow_rooms(plan->memory, room, ROOMS))
        return false;
    plan->pair_capacity = after;
    return true;
}

bool touch_grow_pushes(TouchPlan *plan, uint64_t wanted) {
    uint32_t before = plan->push_capacity, after = with_margin(wanted, plan->sizes.push_most);
    if (wanted <= before || before >= plan->sizes.push_most) return true;
    const Room room = {&plan->pushes, before, after, sizeof *plan->pushes};
    if (!touch_list_grow(plan->memory, &plan->found, after, plan->found.block_count) ||
        !grow_rooms(plan->memory, &room, 1))
        return false;
    plan->push_capacity = after;
    return true;
}
