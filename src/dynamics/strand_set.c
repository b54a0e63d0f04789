// Laying strands into lanes. Strands of a family, longest first, fill lanes up to the length of the longest: into
// what is left of a lane goes the longest strand that fits, after a row without a spring. Diagonals of a
// rectangle so pair up to full lanes. Lanes are then taken sixteen at a time. Rings keep a lane each, and only
// rings of one length share a group.
#include "dynamics/strand.h"

#include <string.h>

/// The strands of a family by length, as lists.
typedef struct Lists {
    uint32_t longest;
    uint32_t *head;  ///< [longest + 1] a strand of that length, SHELL_NONE for none
    uint32_t *next;  ///< [strands] the next of the same length
    uint32_t *below; ///< [longest + 1] a length at most this one that may have strands; path-compressed
} Lists;

static uint32_t strand_length(const SpringSet *springs, uint32_t s) {
    return springs->strand_first[s + 1] - springs->strand_first[s];
}

/// The longest length with a strand that is at most `most`; 0 for none.
static uint32_t lists_longest(Lists *lists, uint32_t most) {
    uint32_t found = most;
    while (found > 0 && lists->head[found] == SHELL_NONE) found = lists->below[found];
    while (most > found) {
        uint32_t next = lists->below[most];
        lists->below[most] = found;
        most = next;
    }
    return found;
}

static uint32_t lists_take(Lists *lists, uint32_t length) {
    uint32_t s = lists->head[length];
    lists->head[length] = lists->next[s];
    return s;
}

/// Fills the lists with the chains or the rings of a family; true where there are any.
static bool lists_fill(Lists *lists, const SpringSet *springs, uint32_t family, bool ring) {
    for (uint32_t length = 0; length <= lists->longest; length++)
        lists->head[length] = SHELL_NONE, lists->below[length] = length ? length - 1 : 0;
    bool any = false;
    for (uint32_t s = springs->family_first[family + 1]; s-- > springs->family_first[family];) {
        if ((springs->strand_ring[s] != 0) != ring) continue;
        uint32_t length = strand_length(springs, s);
        lists->next[s] = lists->head[length];
        lists->head[length] = s;
        any = true;
    }
    return any;
}

static bool lists_create(Memory *memory, const SpringSet *springs, Lists *lists) {
    *lists = (Lists){.longest = springs->longest};
    return NEW(memory, lists->head, (size_t)lists->longest + 1) && NEW(memory, lists->below, (size_t)lists->longest + 1) &&
           NEW(memory, lists->next, springs->strand_count);
}

static void lists_free(Memory *memory, const SpringSet *springs, Lists *lists) {
    FREE(memory, lists->head, (size_t)lists->longest + 1);
    FREE(memory, lists->below, (size_t)lists->longest + 1);
    FREE(memory, lists->next, springs->strand_count);
}

/// A new lane; in a new group where there is none, the last is full, or rings of another length are in it.
static StrandGroup *set_add_lane(StrandSet *set, uint32_t family, bool ring, uint32_t length) {
    StrandGroup *group = set->group_count > set->family_first[family] ? &set->groups[set->group_count - 1] : NULL;
    bool room = group && group->lane_count < STRAND_LANES &&
                group->ring == ring && (!ring || group->rows == length);
    if (!room) {
        group = &set->groups[set->group_count++];
        *group = (StrandGroup){.row = set->row_count, .ring = ring};
    }
    group->lane_count++;
    return group;
}

/// Fills a lane with chains, or with one ring, from the longest down.
static void set_fill_lane(StrandSet *set, StrandGroup *group, Lists *lists, uint32_t length, uint32_t capacity) {
    uint32_t used = 0, lane = group->lane_count - 1;
    while (length > 0) {
        set->strand_slot[lists_take(lists, length)] = (group->row + used) * STRAND_LANES + lane;
        used += length;
        length = used + 1 < capacity ? lists_longest(lists, capacity - used - 1) : 0;
        if (length > 0) used++;
    }
    if (used > group->rows) group->rows = used;
    set->row_count = group->row + group->rows + 1; // one more for the last node
}

static void set_place_family(StrandSet *set, const SpringSet *springs, uint32_t family, Lists *lists) {
    set->family_first[family] = set->group_count;
    for (int ring = 0; ring <= 1; ring++) {
        if (!lists_fill(lists, springs, family, ring)) continue;
        uint32_t longest = lists_longest(lists, lists->longest), length = longest;
        for (; length > 0; length = lists_longest(lists, length)) {
            StrandGroup *group = set_add_lane(set, family, ring, length);
            set_fill_lane(set, group, lists, length, ring ? length : longest);
        }
    }
    set->family_first[family + 1] = set->group_count;
}

/// Particles along every strand, and one of no mass everywhere else.
static void set_write_nodes(StrandSet *set, const SpringSet *springs, uint32_t nowhere) {
    for (size_t i = 0; i < (size_t)set->row_count * STRAND_LANES; i++) set->node[i] = 4 * nowhere;
    for (uint32_t s = 0; s < set->strand_count; s++) {
        uint32_t *node = set->node + set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, node += STRAND_LANES) {
            node[0] = 4 * springs->ends[k][0];
            node[STRAND_LANES] = 4 * springs->ends[k][1];
        }
    }
}

/// Words of the block: four arrays, each on a boundary of STRAND_LANES words.
static size_t set_words(const StrandSet *set) { return (4 * (size_t)set->row_count + 1) * STRAND_LANES; }

static bool set_take_block(Memory *memory, StrandSet *set) {
    size_t slots = (size_t)set->row_count * STRAND_LANES;
    float *words = memory_new(memory, set_words(set), sizeof *words);
    if (!words) return false;
    set->block = words;
    words += (64 - (uintptr_t)words % 64) % 64 / sizeof *words;
    set->length = words, set->weight = words + slots, set->compliance = words + 2 * slots;
    set->node = (uint32_t *)(void *)(words + 3 * slots);
    return true;
}

bool strand_set_create(Memory *memory, const SpringSet *springs, uint32_t nowhere, StrandSet *set) {
    Lists lists = {0};
    *set = (StrandSet){.family_count = springs->family_count, .strand_count = springs->strand_count};
    bool done = lists_create(memory, springs, &lists) && NEW(memory, set->groups, set->strand_count) &&
                NEW(memory, set->family_first, (size_t)set->family_count + 1) &&
                NEW(memory, set->strand_slot, set->strand_count);
    set->group_capacity = set->strand_count; // a strand has a group of its own at most
    for (uint32_t f = 0; done && f < set->family_count; f++) set_place_family(set, springs, f, &lists);
    lists_free(memory, springs, &lists);
    if (!done || !memory_grow(memory, &set->groups, set->group_capacity, set->group_count, sizeof *set->groups))
        return false;
    set->group_capacity = set->group_count;
    if (!set_take_block(memory, set)) return false;
    for (uint32_t g = 0; g < set->group_count; g++)
        if (set->longest < set->groups[g].rows) set->longest = set->groups[g].rows;
    set_write_nodes(set, springs, nowhere);
    return true;
}

void strand_set_free(Memory *memory, StrandSet *set) {
    FREE(memory, set->groups, set->group_capacity);
    FREE(memory, set->family_first, (size_t)set->family_count + 1);
    FREE(memory, set->strand_slot, set->strand_count);
    memory_free(memory, &set->block, set_words(set), sizeof(float));
    *set = (StrandSet){0};
}
