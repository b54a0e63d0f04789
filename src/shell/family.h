// Families: sets of items (strands, cells) of which no two share a particle.
#pragma once

#include "common/error.h"
#include "common/memory.h"

/// Items and the nodes they touch: item i touches nodes[first[i]] up to nodes[first[i + 1]], each once.
typedef struct ItemNodes {
    uint32_t node_count, item_count;
    uint32_t *first; ///< [item_count + 1]
    uint32_t *nodes; ///< [first[item_count]]
} ItemNodes;

/// Greedy colouring. Writes family[item] and returns the number of families, or 0 when out of memory
/// (there is at least one family, even of no items).
uint32_t family_colour(Memory *memory, const ItemNodes *items, uint32_t *family);

/// Sorts items by family, in order of index within one: sorted[family_first[f]...]. `family_first` has
/// family_count + 1 entries.
void family_sort(uint32_t item_count, const uint32_t *family, uint32_t family_count, uint32_t *family_first,
                 uint32_t *sorted);
