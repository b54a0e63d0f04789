// A heap of pairs of triangles, cheapest first.
#ifndef MESH_PAIR_HEAP_H
#define MESH_PAIR_HEAP_H

#include "mesh/work.h"

typedef struct PairItem {
    double cost;
    uint32_t half; ///< the half-edge that the pair shares; decides between equal costs
} PairItem;

/// Zeroed at first. The work owns the memory.
typedef struct PairHeap {
    PairItem *items;
    uint32_t count, capacity;
} PairHeap;

/// Adds a pair; sets work->no_memory when out of memory.
void pair_heap_push(Work *work, PairHeap *heap, PairItem item);

/// Takes the cheapest; the heap must not be empty.
PairItem pair_heap_pop(PairHeap *heap);

#endif
