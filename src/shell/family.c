// Greedy colouring of the conflict graph whose vertices are items and whose edges are shared nodes.
//
// The graph is never built: each node keeps the set of families already at it as the bits of a word, and an item takes
// the lowest family that none of its nodes has. If 64 families are not enough, the remaining items are coloured in
// further rounds, each with 64 new ones.
//
// Items are visited breadth-first, from item to item that share a node. This colours every two-colourable part with two
// families, whatever the mesh's numbering: an item's neighbours that are already coloured all lie one level nearer to
// the start and share one colour. Index order and longest-first do not.
#include "shell/family.h"

/// Items at each node, the transpose of ItemNodes.
typedef struct NodeItems {
    uint32_t *first, *items;
} NodeItems;

static bool transpose(Memory *memory, const ItemNodes *items, NodeItems *at) {
    uint32_t total = items->first[items->item_count];
    if (!NEW(memory, at->first, (size_t)items->node_count + 2) || !NEW(memory, at->items, total)) return false;
    // counted two entries on, summed, then advanced by one while filling: first[n] ends as the start of n
    for (uint32_t k = 0; k < total; k++) at->first[items->nodes[k] + 2]++;
    for (uint32_t n = 0; n < items->node_count; n++) at->first[n + 2] += at->first[n + 1];
    for (uint32_t i = 0; i < items->item_count; i++)
        for (uint32_t k = items->first[i]; k < items->first[i + 1]; k++)
            at->items[at->first[items->nodes[k] + 1]++] = i;
    return true;
}

/// Writes items in breadth-first order. `seen` is zeroed, [item_count + node_count].
static void order_by_breadth(const ItemNodes *items, const NodeItems *at, uint8_t *seen, uint32_t *order) {
    uint8_t *opened = seen + items->item_count;
    uint32_t tail = 0;
    for (uint32_t seed = 0; seed < items->item_count; seed++) {
        if (seen[seed]) continue;
        uint32_t head = tail;
        order[tail++] = seed;
        seen[seed] = 1;
        for (; head < tail; head++) {
            for (uint32_t k = items->first[order[head]]; k < items->first[order[head] + 1]; k++) {
                uint32_t node = items->nodes[k];
                if (opened[node]) continue;
                opened[node] = 1;
                for (uint32_t j = at->first[node]; j < at->first[node + 1]; j++) {
                    if (seen[at->items[j]]) continue;
                    seen[at->items[j]] = 1, order[tail++] = at->items[j];
                }
            }
        }
    }
}

static bool find_order(Memory *memory, const ItemNodes *items, uint32_t *order) {
    NodeItems at = {0};
    uint8_t *seen = NULL;
    size_t seen_count = (size_t)items->item_count + items->node_count;
    bool done = transpose(memory, items, &at) && NEW(memory, seen, seen_count);
    if (done) order_by_breadth(items, &at, seen, order);
    FREE(memory, seen, seen_count);
    FREE(memory, at.items, items->first[items->item_count]);
    FREE(memory, at.first, (size_t)items->node_count + 2);
    return done;
}

/// One round: gives families base..base + 63 to items of `order` and keeps, in order, those for which
/// none is free. Returns how many are kept and raises *used to one past the highest family given.
static uint32_t colour_round(const ItemNodes *items, uint32_t *order, uint32_t count, uint32_t base, uint64_t *taken,
                             uint32_t *family, uint32_t *used) {
    uint32_t kept = 0;
    for (uint32_t n = 0; n < items->node_count; n++) taken[n] = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t item = order[k], bit = 0;
        uint64_t mask = 0;
        for (uint32_t j = items->first[item]; j < items->first[item + 1]; j++) mask |= taken[items->nodes[j]];
        if (mask == UINT64_MAX) {
            order[kept++] = item;
            continue;
        }
        while (mask >> bit & 1) bit++;
        for (uint32_t j = items->first[item]; j < items->first[item + 1]; j++)
            taken[items->nodes[j]] |= UINT64_C(1) << bit;
        family[item] = base + bit;
        if (family[item] >= *used) *used = family[item] + 1;
    }
    return kept;
}

uint32_t family_colour(Memory *memory, const ItemNodes *items, uint32_t *family) {
    uint32_t *order = NULL, used = 1;
    uint64_t *taken = NULL;
    bool ready = NEW(memory, order, items->item_count) && NEW(memory, taken, items->node_count) &&
                 find_order(memory, items, order);
    uint32_t left = ready ? items->item_count : 0;
    for (uint32_t base = 0; left; base += 64) left = colour_round(items, order, left, base, taken, family, &used);
    FREE(memory, order, items->item_count);
    FREE(memory, taken, items->node_count);
    return ready ? used : 0;
}

void family_sort(uint32_t item_count, const uint32_t *family, uint32_t family_count, uint32_t *family_first,
                 uint32_t *sorted) {
    for (uint32_t f = 0; f <= family_count; f++) family_first[f] = 0;
    for (uint32_t i = 0; i < item_count; i++) family_first[family[i] + 1]++;
    for (uint32_t f = 0; f < family_count; f++) family_first[f + 1] += family_first[f];
    // filling moves each start to its end, the next one's start; they are moved back afterwards
    for (uint32_t i = 0; i < item_count; i++) sorted[family_first[family[i]]++] = i;
    for (uint32_t f = family_count; f > 0; f--) family_first[f] = family_first[f - 1];
    family_first[0] = 0;
}
