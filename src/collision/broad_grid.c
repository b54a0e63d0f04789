// Pairs of cells whose swept boxes meet.
//
// Swept boxes are sorted into the cubes of a hashed grid (Teschner et al., Optimized spatial hashing, 2003), whose edge
// follows the boxes' mean extent, so the work is linear in the number of cells for any pile. Where most cells are long
// and lie along one axis the cubes are as slim as they are: else a cube would hold a row of thousands of cells. A pair that shares several
// cubes counts in the one where its common region begins: along each axis that cube is the first of one of the two.
// Within a bucket a box is tested against four others at once.
#include "collision/broad_grid.h"

#include "common/real.h"

#include <math.h>
#include <string.h>

/// Mean length over mean width of swept boxes above which the cubes are as slim as the boxes.
enum { SLIM = 4 };

typedef struct Find {
    CollisionPlan *plan;
    const Shell *shell;
} Find;

// ---- the grid

/// Calls for every cube of every swept box: counts the entries of buckets, or writes them.
static uint64_t fill_grid(CollisionPlan *plan, bool writing) {
    uint64_t count = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (!plan->alive[c]) continue;

        const CollisionBox *box = &plan->boxes[c];
        Cube first = collision_cube(plan, box->swept_low), last = collision_cube(plan, box->swept_high), at = first;
        count += collision_cubes(first, last, plan->sizes.entry_max);
        if (count > plan->sizes.entry_max) return count;

        for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
            for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
                for (at[2] = first[2]; at[2] <= last[2]; at[2]++) {
                    uint32_t key = collision_key(at);
                    if (!writing) {
                        plan->bucket_first[collision_bucket(plan, key) + 2]++;
                        continue;
                    }
                    plan->entries[plan->bucket_first[collision_bucket(plan, key) + 1]++] =
                        (CollisionEntry){c, key | (float4_bits(at == first) & 7) << 29};
                }
    }

    return count;
}

static void clear_buckets(CollisionPlan *plan) {
    memset(plan->bucket_first, 0, ((size_t)plan->bucket_count + 2) * sizeof *plan->bucket_first);
}

// ---- pairs

/// Gap between a's slab and b's corners along the slab's normal; negative if they overlap.
static inline float slab_gap(const CollisionSlab *a, const CollisionSlab *b) {
    Float4 n = a->normal;
    Float4 along = (b->x - a->x[0]) * n[0] + (b->y - a->y[0]) * n[1] + (b->z - a->z[0]) * n[2];
    const float above = float4_smallest(along) - a->high, below = a->low - float4_largest(along);
    return above > below ? above : below;
}

bool collision_is_listed(const CollisionPlan *plan, uint32_t a, uint32_t b, float *distance) {
    const CollisionBox *p = &plan->boxes[a], *q = &plan->boxes[b];
    Float4 displacement = q->displacement - p->displacement, zero = {0};

    // b's box, swept by its displacement relative to a
    Float4 low = q->low + float4_min(displacement, zero), high = q->high + float4_max(displacement, zero);
    if (!quads_meet(p->low - plan->reach, p->high + plan->reach, low, high)) return false;

    Float4 separation = float4_max(float4_max(q->low - p->high, p->low - q->high), zero);
    float boxes = float4_dot(separation, separation),
          far = plan->reach + sqrtf(float4_dot(displacement, displacement)) + p->displacement[3] + q->displacement[3];
    if (boxes > far * far) return false;

    const CollisionSlab *s = &plan->slabs[a], *t = &plan->slabs[b];
    float one = slab_gap(s, t), two = slab_gap(t, s), slabs = one > two ? one : two;
    if (slabs > far) return false;

    boxes = sqrtf(boxes);
    float min = (slabs > boxes ? slabs : boxes) - 4 * plan->noise;
    *distance = min > 0 ? min : 0;
    return true;
}

static inline uint32_t corners_shared(const uint32_t a[4], const uint32_t b[4]) {
    Float4Mask p, q;
    memcpy(&p, a, sizeof p), memcpy(&q, b, sizeof q);
    Float4Mask same = (p == q) + (p == FLOAT4_SHUFFLE(q, q, 1, 2, 3, 0)) + (p == FLOAT4_SHUFFLE(q, q, 2, 3, 0, 1)) +
                      (p == FLOAT4_SHUFFLE(q, q, 3, 0, 1, 2));
    return 0x4332322132212110u >> 4 * float4_bits(same < 0) & 7; // number of bits set; a cell's corners are distinct
}

uint32_t collision_bridge(const CollisionPlan *plan, const Shell *shell, uint32_t a, uint32_t b) {
    // across a tear or a hole two cells may share a corner and yet slide over each other
    uint32_t shared = corners_shared(shell->cells[a], shell->cells[b]);
    if (shared != 1) return shared ? a : SHELL_NONE;

    for (int side = 0; side < 4; side++) {
        uint32_t between = shell_neighbour(shell, a, side);
        if (between != SHELL_NONE && plan->alive[between] &&
            corners_shared(shell->cells[a], shell->cells[between]) > 1 &&
            corners_shared(shell->cells[between], shell->cells[b]) > 1)
            return between;
    }

    return SHELL_NONE;
}

/// Entries of a bucket, with one array per number: four are tested at once.
enum { TILE = 256 };
typedef struct Tile {
    float low[3][TILE], high[3][TILE];
    int32_t key[TILE], firsts[TILE];
    uint32_t count;
} Tile;

/// Bit k is set where the tile's entry j + k is in the same cube, which is where the two boxes' common region begins.
static inline unsigned meet_four(const Tile *tile, uint32_t j, const CollisionEntry *entry, const CollisionBox *box) {
    Float4Mask meet = float4_load_ints(tile->key + j) == (int32_t)(entry->key & COLLISION_KEY);
    meet &= (float4_load_ints(tile->firsts + j) | (int32_t)(entry->key >> 29)) == 7;
    for (int k = 0; k < 3; k++)
        meet &= (float4_load(tile->low[k] + j) <= float4_all(box->swept_high[k])) &
                (float4_load(tile->high[k] + j) >= float4_all(box->swept_low[k]));
    return float4_bits(meet);
}

/// Lists the pairs of a bucket.
static void bucket_pairs(const Find *find, const CollisionEntry *entries, uint32_t count, Tile *tile,
                         BlockWriter *writer) {
    const CollisionBox *boxes = find->plan->boxes;
    for (uint32_t first = 0; first < count; first += TILE) {
        tile->count = count - first < TILE ? count - first : TILE;
        for (uint32_t i = 0; i < tile->count; i++) {
            const CollisionEntry *entry = &entries[first + i];
            const CollisionBox *box = &boxes[entry->cell];
            for (int k = 0; k < 3; k++) {
                tile->low[k][i] = box->swept_low[k];
                tile->high[k][i] = box->swept_high[k];
            }
            tile->key[i] = (int32_t)(entry->key & COLLISION_KEY);
            tile->firsts[i] = (int32_t)(entry->key >> 29);
        }

        for (uint32_t i = tile->count; i & 3; i++) tile->key[i] = -1;

        // four of the tile at once against each entry up to them
        for (uint32_t i = 0; i < first + tile->count && !block_list_is_full(writer); i++) {
            const uint32_t after = i < first ? 0 : i - first + 1, a = entries[i].cell;
            for (uint32_t j = after & ~3u; j < tile->count; j += 4) {
                unsigned meet = meet_four(tile, j, &entries[i], &boxes[a]);
                if (j < after) meet &= 15u << (after - j);

                for (; meet; meet &= meet - 1) {
                    const uint32_t b = entries[first + j + (unsigned)__builtin_ctz(meet)].cell;
                    float distance;
                    if (!collision_is_listed(find->plan, a, b, &distance)) continue;
                    CollisionFound *found = block_list_add(writer);
                    if (found) *found = (CollisionFound){a, b, distance};
                }
            }
        }
    }
}

static void pair_block(void *context, BlockList *list, int block) {
    const Find *find = context;
    const CollisionPlan *plan = find->plan;
    BlockWriter writer = block_list_begin(list, block);
    Tile tile;
    uint32_t first = (uint32_t)block * COLLISION_BUCKETS, last = first + COLLISION_BUCKETS;
    if (last > plan->bucket_count) last = plan->bucket_count;

    for (uint32_t b = first; b < last && !block_list_is_full(&writer); b++) {
        uint32_t at = plan->bucket_first[b], count = plan->bucket_first[b + 1] - at;
        if (count > 1) bucket_pairs(find, plan->entries + at, count, &tile, &writer);
    }

    block_list_end(&writer);
}

static void note_first(void *context, const void *item, uint32_t number) {
    ((const Find *)context)->plan->around[number] = ((const CollisionFound *)item)->a;
}

static void keep_pair(void *context, const void *item, uint32_t number) {
    const Find *find = context;
    const CollisionFound *found = item;
    CollisionPair *pair = &find->plan->pairs[find->plan->active[number]];
    const uint32_t bridge = collision_bridge(find->plan, find->shell, found->a, found->b);
    *pair = (CollisionPair){.a = found->a, .b = found->b, .hit = 2, .bridge = bridge};
    if (bridge == SHELL_NONE) pair->distance = found->distance;
}

static int grid_blocks(const CollisionPlan *plan) {
    return (int)((plan->bucket_count + COLLISION_BUCKETS - 1) / COLLISION_BUCKETS);
}

SingeResult broad_grid_pairs(Memory *memory, CollisionPlan *plan, const Shell *shell, Pool *pool, uint64_t *pairs) {
    Find find = {plan, shell};

    // the cubes' initial edge: twice the boxes' mean longest side; 0 if no cell is left
    double sum = 0, along[3] = {0};
    uint32_t cells = 0;
    for (uint32_t c = 0; c < plan->cell_count; c++) {
        if (!plan->alive[c]) continue;

        Float4 size = plan->boxes[c].swept_high - plan->boxes[c].swept_low;
        float longest = size[0] > size[1] ? size[0] : size[1];
        sum += (double)(longest > size[2] ? longest : size[2]);
        for (int k = 0; k < 3; k++) along[k] += (double)size[k];
        cells++;
    }

    plan->edge = cells ? (float)(2 * sum / cells) : 0;

    // one over the part of it along each axis; all of it unless one axis has long cells and the others do not. A part is
    // a thousandth at least: boxes may be flat
    double most = double_max(along[0], double_max(along[1], along[2])),
           least = double_min(along[0], double_min(along[1], along[2]));
    double middle = along[0] + along[1] + along[2] - most - least;
    Float4 slim = float4_all(1);
    for (int k = 0; k < 3 && middle < most / SLIM; k++) slim[k] = (float)(sum / double_max(along[k], 1e-3 * most));

    // larger cubes until all entries have room; then the entries, sorted by buckets
    uint64_t count = 0;
    clear_buckets(plan);

    for (; plan->edge > 0; plan->edge *= 1.3f) {
        plan->inverse_edge = slim / plan->edge;
        if (!(plan->edge < 1e30f)) plan->edge = 0; // a position is not finite: the step will fail
        else if ((count = fill_grid(plan, false)) <= plan->sizes.entry_max) break;
        clear_buckets(plan);
    }

    plan->entry_count = 0;
    if (plan->edge > 0) {
        if (!collision_grow_entries(memory, plan, count)) return SINGE_ERROR_MEMORY;
        for (uint32_t k = 0; k < plan->bucket_count; k++) plan->bucket_first[k + 2] += plan->bucket_first[k + 1];
        fill_grid(plan, true);
        plan->entry_count = (uint32_t)count;
    }

    *pairs = block_list_write(&plan->found_pairs, pool, grid_blocks(plan), plan->sizes.pair_max, pair_block, &find);
    return SINGE_OK;
}

void broad_grid_keep(CollisionPlan *plan, const Shell *shell, Pool *pool, uint64_t count, uint32_t room) {
    Find find = {plan, shell};
    const int blocks = grid_blocks(plan);
    uint32_t *first = plan->pair_first;
    const uint32_t kept = block_list_settle(&plan->found_pairs, pool, blocks, count, room, pair_block, &find);
    block_list_read(&plan->found_pairs, pool, blocks, kept, note_first, &find);

    // sort them by their first cell
    memset(first, 0, ((size_t)plan->cell_count + 2) * sizeof *first);
    for (uint32_t k = 0; k < kept; k++) first[plan->around[k] + 2]++;
    for (uint32_t c = 0; c < plan->cell_count; c++) first[c + 2] += first[c + 1];
    for (uint32_t k = 0; k < kept; k++) plan->active[k] = first[plan->around[k] + 1]++;
    block_list_read(&plan->found_pairs, pool, blocks, kept, keep_pair, &find);
    plan->around_search = UINT64_MAX;
    plan->pair_count = kept;
}
