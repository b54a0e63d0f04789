#include "mesh/pair_heap.h"

#include <string.h>

static bool is_before(const PairItem *a, const PairItem *b) {
    return a->cost < b->cost || (a->cost == b->cost && a->half < b->half);
}

void pair_heap_push(Work *work, PairHeap *heap, PairItem item) {
    if (heap->count == heap->capacity) {
        uint32_t capacity = 2 * heap->capacity + 64;
        PairItem *items = work_new(work, capacity, sizeof *items);
        if (!items) return;
        if (heap->count) memcpy(items, heap->items, heap->count * sizeof *items);
        heap->items = items;
        heap->capacity = capacity;
    }
    uint32_t i = heap->count++;
    for (; i > 0 && is_before(&item, &heap->items[(i - 1) / 2]); i = (i - 1) / 2)
        heap->items[i] = heap->items[(i - 1) / 2];
    heap->items[i] = item;
}

PairItem pair_heap_pop(PairHeap *heap) {
    PairItem top = heap->items[0], item = heap->items[--heap->count];
    uint32_t i = 0, count = heap->count;
    for (uint32_t child; (child = 2 * i + 1) < count; i = child) {
        if (child + 1 < count && is_before(&heap->items[child + 1], &heap->items[child])) child++;
        if (!is_before(&heap->items[child], &item)) break;
        heap->items[i] = heap->items[child];
    }
    heap->items[i] = item;
    return top;
}
