// Lays strands into lanes so that particles of consecutive numbers are contiguous, where kernels load them at once. A
// run begins with the longest strand that is left, in a lane of its own. The lane to its right takes, row by row, the
// strands through the next particles, p + 1 next to p, and so on until too few are found. In a mesh that is numbered
// row by row, a strand across the rows thus gets its neighbour next to it; and where a diagonal leaves the mesh on one
// side, the row's last particle is followed by the first of the next row, where a diagonal enters on the other side:
// lanes stay full. Strands outside all runs fill the rest of the lanes, then lanes of their own, longest first. Rings
// keep a lane each, and only rings of one length share a group.
#include "common/assertion.h"
#include "dynamics/strand/strand_lanes.h"

/// Where a strand's first node is.
typedef struct Laid {
    uint32_t strand, group, column, row;
} Laid;

typedef struct Lay {
    const SpringSet *springs;
    StrandSet *set;
    uint32_t particle_count, frame; ///< frame: nodes that a lane may have
    // the strands of a family by length
    uint32_t *head;  ///< [longest + 1] a strand of that length, SHELL_NONE for none
    uint32_t *next;  ///< [strands] the next of the same length
    uint32_t *below; ///< [longest + 1] a length at most this one that may have strands; path-compressed
    // the family's particles
    uint32_t *owner; ///< [particles] the family's strand through it, SHELL_NONE for none
    uint32_t *index; ///< [particles] which node of the strand it is
    // lanes
    uint32_t *left, *right; ///< [frame capacity] particles of a lane and of the one being laid to its right
    uint32_t *tried;        ///< [strands] the last lane that the strand was tried for
    uint32_t lane_serial;
    Laid *laid; ///< [strands]
    uint32_t laid_count;
} Lay;

/// Min lanes of a run; rows that a run may have above and below its first strand, besides a thirty-second of it.
enum { LAY_RUN_MIN = 12, LAY_MARGIN = 4 };

static uint32_t strand_length(const SpringSet *springs, uint32_t s) {
    return springs->strand_first[s + 1] - springs->strand_first[s];
}

/// LaneNode k of a chain.
static uint32_t strand_node(const SpringSet *springs, uint32_t s, uint32_t k) {
    uint32_t first = springs->strand_first[s];
    return k ? springs->ends[first + k - 1][1] : springs->ends[first][0];
}

static bool lay_is_laid(const Lay *lay, uint32_t s) { return lay->set->strand_slot[s] != SHELL_NONE; }

/// Puts a strand into its column. Its slot is written when its family is whole.
static void lay_put(Lay *lay, uint32_t s, uint32_t group, uint32_t column, uint32_t row) {
    lay->set->strand_slot[s] = 0;
    lay->laid[lay->laid_count++] = (Laid){s, group, column, row};
}

// ---- strands left, by length

/// Lists the chains or the rings of a family that are not laid; true where there are any.
static bool lay_list(Lay *lay, uint32_t family, bool ring) {
    const SpringSet *springs = lay->springs;
    for (uint32_t length = 0; length <= springs->longest; length++) {
        lay->head[length] = SHELL_NONE;
        lay->below[length] = length ? length - 1 : 0;
    }

    bool any = false;
    for (uint32_t s = springs->family_first[family + 1]; s-- > springs->family_first[family];) {
        if ((springs->strand_ring[s] != 0) != ring || lay_is_laid(lay, s)) continue;

        uint32_t length = strand_length(springs, s);
        lay->next[s] = lay->head[length];
        lay->head[length] = s;
        any = true;
    }

    return any;
}

/// The longest length with a strand that is at most `max`; 0 for none. Forgets strands laid meanwhile.
static uint32_t lay_longest(Lay *lay, uint32_t max) {
    uint32_t found = max;
    while (found > 0) {
        while (lay->head[found] != SHELL_NONE && lay_is_laid(lay, lay->head[found]))
            lay->head[found] = lay->next[lay->head[found]];
        if (lay->head[found] != SHELL_NONE) break;
        found = lay->below[found];
    }

    while (max > found) {
        uint32_t next = lay->below[max];
        lay->below[max] = found;
        max = next;
    }

    return found;
}

static uint32_t lay_take(Lay *lay, uint32_t length) {
    uint32_t s = lay->head[length];
    lay->head[length] = lay->next[s];
    return s;
}

// ---- groups

static StrandGroup *lay_open_group(Lay *lay, bool ring) {
    StrandGroup *group = &lay->set->groups[lay->set->group_count++];
    *group = (StrandGroup){.ring = ring};
    return group;
}

/// Counts the rows of the last group, whose strands are `laid` from `first` on; moves them up to its row 0.
static void lay_close_group(Lay *lay, uint32_t first) {
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t i = first; i < lay->laid_count; i++) {
        uint32_t row = lay->laid[i].row, end = row + strand_length(lay->springs, lay->laid[i].strand);
        low = low < row ? low : row;
        high = high > end ? high : end;
    }

    for (uint32_t i = first; i < lay->laid_count; i++) lay->laid[i].row -= low;
    lay->set->groups[lay->set->group_count - 1].rows = high - low;
}

// ---- runs

/// Writes the particles of the family's chains, or removes them again.
static void lay_own(Lay *lay, uint32_t family, bool own) {
    const SpringSet *springs = lay->springs;
    for (uint32_t s = springs->family_first[family]; s < springs->family_first[family + 1]; s++) {
        if (springs->strand_ring[s]) continue;

        for (uint32_t k = 0; k <= strand_length(springs, s); k++) {
            uint32_t p = strand_node(springs, s, k);
            lay->owner[p] = own ? s : SHELL_NONE;
            lay->index[p] = k;
        }
    }
}

/// Lays a strand into the lane on the right if its slot there is free.
static void lay_put_right(Lay *lay, uint32_t s, uint32_t column, uint32_t row) {
    uint32_t length = strand_length(lay->springs, s);
    if (row + length >= lay->frame) return;

    for (uint32_t k = 0; k <= length; k++)
        if (lay->right[row + k] != SHELL_NONE) return;
    for (uint32_t k = 0; k <= length; k++) lay->right[row + k] = strand_node(lay->springs, s, k);
    lay_put(lay, s, lay->set->group_count - 1, column, row);
}

/// Lays the run that begins with `s`, and takes it back when it has few lanes.
static bool lay_run(Lay *lay, uint32_t s) {
    uint32_t length = strand_length(lay->springs, s), margin = LAY_MARGIN + length / 32, contiguous = length, lanes = 0;
    uint32_t groups = lay->set->group_count, start = lay->laid_count, first = start, before = start;
    StrandGroup *group = lay_open_group(lay, false);

    // the first lane
    lay->frame = length + 1 + 2 * margin;
    for (uint32_t k = 0; k < lay->frame; k++) lay->right[k] = SHELL_NONE;
    lay_put_right(lay, s, 0, margin);

    // lanes to the right while most particles are contiguous
    for (; 2 * contiguous > length; lanes++) {
        group->columns++;
        uint32_t *lane = lay->left;
        lay->left = lay->right;
        lay->right = lane;
        if (group->columns == STRAND_LANES) {
            lay_close_group(lay, first);
            group = lay_open_group(lay, false);
            first = lay->laid_count;
        }

        before = lay->laid_count;

        // fill it with strands next to those of the lane on its left; count the particles that have p + 1 next to them
        contiguous = 0;
        lay->lane_serial++;
        for (uint32_t k = 0; k < lay->frame; k++) lay->right[k] = SHELL_NONE;
        for (uint32_t k = 0; k < lay->frame; k++) {
            if (lay->left[k] == SHELL_NONE || lay->left[k] + 1 >= lay->particle_count) continue;

            uint32_t p = lay->left[k] + 1, next = lay->owner[p];
            if (next == SHELL_NONE || lay_is_laid(lay, next) || lay->tried[next] == lay->lane_serial ||
                lay->index[p] > k)
                continue;
            lay->tried[next] = lay->lane_serial;
            lay_put_right(lay, next, group->columns, k - lay->index[p]);
        }

        for (uint32_t k = 0; k < lay->frame; k++)
            contiguous += lay->left[k] != SHELL_NONE && lay->right[k] == lay->left[k] + 1;
    }

    // keep the run if it is long enough
    const uint32_t kept = lanes < LAY_RUN_MIN ? start : before;
    while (lay->laid_count > kept) lay->set->strand_slot[lay->laid[--lay->laid_count].strand] = SHELL_NONE;
    if (first < lay->laid_count) lay_close_group(lay, first);
    else lay->set->group_count = lanes < LAY_RUN_MIN ? groups : lay->set->group_count - 1;
    return lanes >= LAY_RUN_MIN;
}

static void lay_runs(Lay *lay, uint32_t family) {
    uint32_t length = lay->springs->longest;
    if (!lay_list(lay, family, false)) return;

    lay_own(lay, family, true);
    while ((length = lay_longest(lay, length)) > 0) {
        // from the longest to the left while the strands are equally long
        const uint32_t start = lay->head[length];
        uint32_t s = start;
        for (;;) {
            uint32_t p = strand_node(lay->springs, s, 0), t = p > 0 ? lay->owner[p - 1] : SHELL_NONE;
            if (t == SHELL_NONE || t == start || lay_is_laid(lay, t) || lay->index[p - 1] != 0) break;
            if (strand_length(lay->springs, t) != length) break;
            s = t;
        }

        if (!lay_run(lay, s)) lay_take(lay, length);
    }

    lay_own(lay, family, false);
}

// ---- strands outside runs

/// Lays strands that fit into `nodes` free rows of a column from `row` on, longest first. Returns the row after the
/// last node.
static uint32_t lay_fill(Lay *lay, uint32_t group, uint32_t column, uint32_t row, uint32_t nodes) {
    while (nodes > 1) {
        uint32_t longest = lay->springs->longest, length = lay_longest(lay, nodes - 1 < longest ? nodes - 1 : longest);
        if (length == 0) break;
        lay_put(lay, lay_take(lay, length), group, column, row);
        row += length + 1;
        nodes -= length + 1;
    }

    return row;
}

/// Fills the gaps of the family's groups, then their empty columns, then new groups.
static void lay_rest(Lay *lay, uint32_t family, uint32_t first) {
    StrandSet *set = lay->set;
    if (!lay_list(lay, family, false)) return;

    // gaps between the strands laid from `first` on, which lie column after column from the top down
    const uint32_t count = lay->laid_count;
    for (uint32_t i = first, row = 0; i < count; i++) {
        Laid laid = lay->laid[i];
        lay_fill(lay, laid.group, laid.column, row, laid.row - row);
        row = laid.row + strand_length(lay->springs, laid.strand) + 1;
        if (i + 1 < count && lay->laid[i + 1].group == laid.group && lay->laid[i + 1].column == laid.column) continue;

        lay_fill(lay, laid.group, laid.column, row, set->groups[laid.group].rows + 1 - row);
        row = 0;
    }

    // empty columns
    for (uint32_t g = set->family_first[family]; g < set->group_count; g++)
        for (StrandGroup *group = &set->groups[g]; group->columns < STRAND_LANES; group->columns++) {
            uint32_t rows = group->rows < lay->springs->longest ? group->rows : lay->springs->longest;
            if (lay_longest(lay, rows) == 0) break;
            lay_fill(lay, g, group->columns, 0, group->rows + 1);
        }

    // every lane up to the longest: diagonals of a rectangle thus pair up
    for (uint32_t longest = lay_longest(lay, lay->springs->longest); lay_longest(lay, longest) > 0;) {
        StrandGroup *group = lay_open_group(lay, false);
        for (; group->columns < STRAND_LANES && lay_longest(lay, longest) > 0; group->columns++) {
            uint32_t end = lay_fill(lay, set->group_count - 1, group->columns, 0, longest + 1);
            if (end - 1 > group->rows) group->rows = end - 1;
        }
    }
}

/// Gives every strand its slot, and writes groups, families and rows. False when out of memory.
static bool lay_strands(Memory *memory, const SpringSet *springs, uint32_t particle_count, StrandSet *set) {
    const size_t lengths = (size_t)springs->longest + 1;
    const size_t frame = lengths + 2 * (LAY_MARGIN + springs->longest / 32);
    Lay lay = {.springs = springs, .set = set, .particle_count = particle_count};
    bool done = NEW(memory, lay.head, lengths) && NEW(memory, lay.below, lengths) &&
                NEW(memory, lay.next, springs->strand_count) && NEW(memory, lay.tried, springs->strand_count) &&
                NEW(memory, lay.laid, springs->strand_count) && NEW(memory, lay.owner, particle_count) &&
                NEW(memory, lay.index, particle_count) && NEW(memory, lay.left, frame) && NEW(memory, lay.right, frame);
    for (uint32_t p = 0; p < particle_count && done; p++) lay.owner[p] = SHELL_NONE;
    for (uint32_t s = 0; s < springs->strand_count && done; s++) set->strand_slot[s] = SHELL_NONE;

    for (uint32_t f = 0; f < springs->family_count && done; f++) {
        const uint32_t first = lay.laid_count;
        set->family_first[f] = set->group_count;
        lay_runs(&lay, f);
        lay_rest(&lay, f, first);

        // rings, in groups of equal lengths
        StrandGroup *open = NULL;
        const bool rings = lay_list(&lay, f, true);
        for (uint32_t length = springs->longest; rings && (length = lay_longest(&lay, length)) > 0;) {
            if (!open || open->columns == STRAND_LANES || open->rows != length) open = lay_open_group(&lay, true);
            open->rows = length;
            lay_put(&lay, lay_take(&lay, length), set->group_count - 1, open->columns++, 0);
        }

        // widths and rows of its groups, and the slots of its strands
        for (uint32_t g = set->family_first[f]; g < set->group_count; g++) {
            StrandGroup *group = &set->groups[g];
            group->width = group->columns <= 4 ? 4 : group->columns <= 8 ? 8 : STRAND_LANES;
            group->row = set->row_count;
            set->row_count += group->rows + 1; // one more for the last node
        }

        for (uint32_t i = first; i < lay.laid_count; i++) {
            const Laid *laid = &lay.laid[i];
            const StrandGroup *group = &set->groups[laid->group];
            uint32_t lane = strand_lane(group->width, laid->column);
            set->strand_slot[laid->strand] = (group->row + laid->row) * STRAND_LANES + lane;
        }

        set->family_first[f + 1] = set->group_count;
    }

    SINGE_ASSERT(!done || lay.laid_count == springs->strand_count); // in runs, gaps, empty columns or rings
    FREE(memory, lay.head, lengths);
    FREE(memory, lay.below, lengths);
    FREE(memory, lay.next, springs->strand_count);
    FREE(memory, lay.tried, springs->strand_count);
    FREE(memory, lay.laid, springs->strand_count);
    FREE(memory, lay.owner, particle_count);
    FREE(memory, lay.index, particle_count);
    FREE(memory, lay.left, frame);
    FREE(memory, lay.right, frame);
    return done;
}

// ---- the arrays that kernels read

/// Words of the block: four arrays, each on a boundary of STRAND_LANES words, and one more.
static size_t set_words(const StrandSet *set) {
    return (4 * (size_t)set->row_count + 1) * STRAND_LANES + set->row_count;
}

bool strand_set_create(Memory *memory, const SpringSet *springs, uint32_t nowhere, bool pulls, StrandSet *set) {
    *set = (StrandSet){.family_count = springs->family_count, .strand_count = springs->strand_count};
    set->group_capacity = set->strand_count; // a strand has a group of its own at most
    if (!NEW(memory, set->groups, set->group_capacity) ||
        !NEW(memory, set->family_first, (size_t)set->family_count + 1) ||
        !NEW(memory, set->strand_slot, set->strand_count) || !NEW(memory, set->strand_group, set->strand_count) ||
        !lay_strands(memory, springs, nowhere, set) ||
        !memory_grow(memory, &set->groups, set->group_capacity, set->group_count, sizeof *set->groups))
        return false;
    set->group_capacity = set->group_count;
    if (set->row_count > UINT32_MAX / STRAND_LANES) return false; // slots are numbered in 32 bits

    // one block for five arrays
    const size_t slots = (size_t)set->row_count * STRAND_LANES;
    float *words = memory_new(memory, set_words(set), sizeof *words);
    if (!words) return false;

    set->block = words;
    words += (64 - (uintptr_t)words % 64) % 64 / sizeof *words;
    set->target = words;
    set->weight = words + slots;
    set->compliance = words + 2 * slots;
    set->node = (uint32_t *)(void *)(words + 3 * slots);
    set->contiguous = set->node + slots;
    if (pulls && !NEW(memory, set->pull, slots)) return false;

    // a particle of no mass everywhere: groups that are solved side by side write to positions of their own
    for (uint32_t f = 0; f < set->family_count; f++)
        for (uint32_t g = set->family_first[f]; g < set->family_first[f + 1]; g++) {
            const StrandGroup *group = &set->groups[g];
            uint32_t *node = set->node + (size_t)group->row * STRAND_LANES;
            for (uint32_t i = 0; i < (group->rows + 1) * STRAND_LANES; i++)
                node[i] = 4 * (nowhere + g - set->family_first[f]);
        }

    // but for the particles along every strand
    for (uint32_t s = 0; s < set->strand_count; s++) {
        uint32_t end = set->group_count; // groups are in order of rows
        while (end - set->strand_group[s] > 1) {
            const uint32_t middle = (set->strand_group[s] + end) / 2;
            if (set->groups[middle].row <= set->strand_slot[s] / STRAND_LANES) set->strand_group[s] = middle;
            else end = middle;
        }

        uint32_t *node = set->node + set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, node += STRAND_LANES) {
            node[0] = 4 * springs->ends[k][0];
            node[STRAND_LANES] = 4 * springs->ends[k][1];
        }
    }

    // runs of springs that are prepared together
    set->run_count = springs->strand_first[set->strand_count] / PREPARE_RUN + 1;
    if (!NEW(memory, set->stale, set->run_count) || !NEW(memory, set->creased, set->run_count) ||
        !NEW(memory, set->seen, (size_t)set->run_count * PREPARE_RUN) || !NEW(memory, set->run_strand, set->run_count))
        return false;

    for (uint32_t r = 0, s = 0; r < set->run_count; r++) {
        while (s + 1 < set->strand_count && springs->strand_first[s + 1] <= r * PREPARE_RUN) s++;
        set->run_strand[r] = s;
    }

    // rows whose particles have consecutive numbers
    for (uint32_t g = 0; g < set->group_count; g++) {
        const StrandGroup *group = &set->groups[g];
        if (set->longest < group->rows) set->longest = group->rows;
        set->rings |= group->ring;
        for (uint32_t row = group->row; row <= group->row + group->rows; row++) {
            const uint32_t *node = set->node + (size_t)row * STRAND_LANES;
            set->contiguous[row] = node[0];
            for (uint32_t c = 0; c < group->width; c++)
                if (node[strand_lane(group->width, c)] != node[0] + 4 * c) set->contiguous[row] = STRAND_GATHERED;
        }
    }

    return true;
}

void strand_set_free(Memory *memory, StrandSet *set) {
    FREE(memory, set->stale, set->run_count);
    FREE(memory, set->run_strand, set->run_count);
    FREE(memory, set->creased, set->run_count);
    FREE(memory, set->seen, (size_t)set->run_count * PREPARE_RUN);
    FREE(memory, set->groups, set->group_capacity);
    FREE(memory, set->family_first, (size_t)set->family_count + 1);
    FREE(memory, set->strand_slot, set->strand_count);
    FREE(memory, set->strand_group, set->strand_count);
    memory_free(memory, &set->block, set_words(set), sizeof(float));
    FREE(memory, set->pull, (size_t)set->row_count * STRAND_LANES);
    FREE(memory, set->bend_limit, (size_t)set->row_count * STRAND_LANES);
    *set = (StrandSet){0};
}
