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

#include "common/assertion.h"

/// Writes items in breadth-first order. False when out of memory.
static bool order_by_breadth(Memory *memory, const ItemNodes *items, uint32_t *order) {
    uint32_t total = items->first[items->item_count], nodes = items->node_count, tail = 0;
    uint32_t *first = NULL, *at = NULL; // items at each node, the transpose of ItemNodes
    uint8_t *seen = NULL, *opened = NULL;
    bool done = NEW(memory, first, (size_t)nodes + 2) && NEW(memory, at, total) &&
                NEW(memory, seen, items->item_count) && NEW(memory, opened, nodes);

    // counted two entries on, summed, then advanced by one while filling: first[n] ends as the start of n
    for (uint32_t k = 0; done && k < total; k++) first[items->nodes[k] + 2]++;
    for (uint32_t n = 0; done && n < nodes; n++) first[n + 2] += first[n + 1];
    for (uint32_t i = 0; done && i < items->item_count; i++)
        for (uint32_t k = items->first[i]; k < items->first[i + 1]; k++) at[first[items->nodes[k] + 1]++] = i;

    // from each item that no other one has reached
    for (uint32_t seed = 0; done && seed < items->item_count; seed++) {
        if (seen[seed]) continue;

        uint32_t head = tail;
        order[tail++] = seed;

        seen[seed] = 1;
        for (; head < tail; head++)
            for (uint32_t k = items->first[order[head]]; k < items->first[order[head] + 1]; k++) {
                uint32_t node = items->nodes[k];
                if (opened[node]) continue;
                opened[node] = 1;
                for (uint32_t j = first[node]; j < first[node + 1]; j++) {
                    if (seen[at[j]]) continue;
                    seen[at[j]] = 1;
                    order[tail++] = at[j];
                }
            }
    }

    SINGE_ASSERT(!done || tail == items->item_count);
    FREE(memory, opened, nodes);
    FREE(memory, seen, items->item_count);
    FREE(memory, at, total);
    FREE(memory, first, (size_t)nodes + 2);
    return done;
}

uint32_t family_colour(Memory *memory, const ItemNodes *items, uint32_t *family) {
    uint32_t *order = NULL, used = 1;
    uint64_t *taken = NULL;
    bool ready = NEW(memory, order, items->item_count) && NEW(memory, taken, items->node_count) &&
                 order_by_breadth(memory, items, order);
    uint32_t left = ready ? items->item_count : 0;

    // a round gives families base to base + 63, and keeps the items for which none is free, in order
    for (uint32_t base = 0, kept; left; base += 64, left = kept) {
        kept = 0;
        for (uint32_t n = 0; n < items->node_count; n++) taken[n] = 0;

        for (uint32_t k = 0; k < left; k++) {
            uint32_t item = order[k], begin = items->first[item], end = items->first[item + 1], bit = 0;
            uint64_t mask = 0;
            for (uint32_t j = begin; j < end; j++) mask |= taken[items->nodes[j]];

            if (mask == UINT64_MAX) {
                order[kept++] = item;
                continue;
            }

            while (mask >> bit & 1) bit++;
            for (uint32_t j = begin; j < end; j++) taken[items->nodes[j]] |= UINT64_C(1) << bit;
            family[item] = base + bit;
            if (family[item] >= used) used = family[item] + 1;
        }
    }

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
