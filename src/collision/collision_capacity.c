// Room for pairs and repulsions. The lists have room for folds and heaps; in denser crowds they grow as needed, up to a
// max that only sheets lying within each other reach. Items beyond that are dropped and counted.
//
// The size of a list does not affect results: any sufficient size gives the same items, so that a run continued from a
// snapshot, where lists begin small again, has the same bytes.
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

/// A quarter more than needed, so that lists do not grow at every step.
static uint32_t with_margin(uint64_t wanted, uint32_t max) {
    wanted += wanted / 4;
    return wanted < max ? (uint32_t)wanted : max;
}

bool collision_grow_pairs(Memory *memory, CollisionPlan *plan, uint64_t wanted) {
    uint32_t before = plan->pair_capacity, after = with_margin(wanted, plan->sizes.pair_max);
    if (wanted <= before || before >= plan->sizes.pair_max) return true;
    const Room room[ROOMS] = {
        {&plan->pairs, before, after, sizeof *plan->pairs},
        {&plan->active, before, after, sizeof *plan->active},
        {&plan->around, 2 * (size_t)before, 2 * (size_t)after, sizeof *plan->around},
        {&plan->partial, (size_t)pool_blocks((int)before), (size_t)pool_blocks((int)after), sizeof *plan->partial},
    };
    BlockList *pairs = &plan->found_pairs, *repulsions = &plan->found;
    if (!block_list_grow(memory, pairs, after, pairs->block_count) ||
        !block_list_grow(memory, repulsions, repulsions->capacity, collision_look_blocks(after)) ||
        !grow_rooms(memory, room, ROOMS))
        return false;
    plan->pair_capacity = after;
    return true;
}

bool collision_grow_repulsions(Memory *memory, CollisionPlan *plan, uint64_t wanted) {
    uint32_t before = plan->repulsion_capacity, after = with_margin(wanted, plan->sizes.repulsion_max);
    if (wanted <= before || before >= plan->sizes.repulsion_max) return true;
    const Room room = {&plan->repulsions, before, after, sizeof *plan->repulsions};
    if (!block_list_grow(memory, &plan->found, after, plan->found.block_count) || !grow_rooms(memory, &room, 1))
        return false;
    plan->repulsion_capacity = after;
    return true;
}
