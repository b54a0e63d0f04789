// A colour's strands in lanes: the arrays that kernels read.
#include "dynamics/strand/strand_lanes.h"

/// Particles along every strand, and one of no mass everywhere else.
static void set_write_nodes(StrandSet *set, const SpringSet *springs, uint32_t nowhere) {
    for (uint32_t f = 0; f < set->family_count; f++)
        for (uint32_t g = set->family_first[f]; g < set->family_first[f + 1]; g++) {
            const StrandGroup *group = &set->groups[g];
            uint32_t *node = set->node + (size_t)group->row * STRAND_LANES;
            // groups that are solved side by side write to positions of their own
            for (uint32_t i = 0; i < (group->rows + 1) * STRAND_LANES; i++)
                node[i] = 4 * (nowhere + g - set->family_first[f]);
        }
    for (uint32_t s = 0; s < set->strand_count; s++) {
        uint32_t *node = set->node + set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, node += STRAND_LANES) {
            node[0] = 4 * springs->ends[k][0];
            node[STRAND_LANES] = 4 * springs->ends[k][1];
        }
    }
}

/// Notes the rows whose particles have consecutive numbers.
static void set_write_contiguous(StrandSet *set, const StrandGroup *group) {
    for (uint32_t row = group->row; row <= group->row + group->rows; row++) {
        const uint32_t *node = set->node + (size_t)row * STRAND_LANES;
        set->contiguous[row] = node[0];
        for (uint32_t c = 0; c < group->width; c++)
            if (node[strand_lane(group->width, c)] != node[0] + 4 * c) set->contiguous[row] = STRAND_GATHERED;
    }
}

/// Words of the block: four arrays, each on a boundary of STRAND_LANES words, and one more.
static size_t set_words(const StrandSet *set) {
    return (4 * (size_t)set->row_count + 1) * STRAND_LANES + set->row_count;
}

static bool set_take_block(Memory *memory, StrandSet *set) {
    size_t slots = (size_t)set->row_count * STRAND_LANES;
    float *words = memory_new(memory, set_words(set), sizeof *words);
    if (!words) return false;
    set->block = words;
    words += (64 - (uintptr_t)words % 64) % 64 / sizeof *words;
    set->length = words;
    set->weight = words + slots;
    set->compliance = words + 2 * slots;
    set->node = (uint32_t *)(void *)(words + 3 * slots);
    set->contiguous = set->node + slots;
    return true;
}

bool strand_set_create(Memory *memory, const SpringSet *springs, uint32_t nowhere, bool pulls, StrandSet *set) {
    *set = (StrandSet){.family_count = springs->family_count, .strand_count = springs->strand_count};
    set->group_capacity = set->strand_count; // a strand has a group of its own at most
    if (!NEW(memory, set->groups, set->group_capacity) ||
        !NEW(memory, set->family_first, (size_t)set->family_count + 1) ||
        !NEW(memory, set->strand_slot, set->strand_count) || !strand_lay(memory, springs, nowhere, set) ||
        !memory_grow(memory, &set->groups, set->group_capacity, set->group_count, sizeof *set->groups))
        return false;
    set->group_capacity = set->group_count;
    if (set->row_count > UINT32_MAX / STRAND_LANES) return false; // slots are numbered in 32 bits
    if (!set_take_block(memory, set)) return false;
    if (pulls && !NEW(memory, set->pull, (size_t)set->row_count * STRAND_LANES)) return false;
    set_write_nodes(set, springs, nowhere);
    for (uint32_t g = 0; g < set->group_count; g++) {
        if (set->longest < set->groups[g].rows) set->longest = set->groups[g].rows;
        set_write_contiguous(set, &set->groups[g]);
    }
    return true;
}

void strand_set_free(Memory *memory, StrandSet *set) {
    FREE(memory, set->groups, set->group_capacity);
    FREE(memory, set->family_first, (size_t)set->family_count + 1);
    FREE(memory, set->strand_slot, set->strand_count);
    memory_free(memory, &set->block, set_words(set), sizeof(float));
    FREE(memory, set->pull, (size_t)set->row_count * STRAND_LANES);
    FREE(memory, set->bend_limit, (size_t)set->row_count * STRAND_LANES);
    *set = (StrandSet){0};
}
