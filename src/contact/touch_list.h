// A list that blocks of a parallel job write side by side, each into chunks of its own, and that is read in the order
// of the blocks: the same for any number of threads. Nothing is looked at twice to be counted first.
#ifndef CONTACT_TOUCH_LIST_H
#define CONTACT_TOUCH_LIST_H

#include "base/pool.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/// Items of a chunk.
enum { TOUCH_CHUNK = 64 };

typedef struct TouchBlock {
    uint32_t first; ///< chunk
    uint32_t count; ///< items, of which those that found no room are not written
    uint32_t start; ///< in the order of all blocks
} TouchBlock;

typedef struct TouchList {
    size_t size; ///< bytes of an item
    uint32_t chunk_count, block_count;
    atomic_uint taken;  ///< chunks
    uint8_t *items;     ///< [chunk_count * TOUCH_CHUNK * size]
    uint32_t *next;     ///< [chunk_count] the chunk after, of the same block
    TouchBlock *blocks; ///< [block_count]
} TouchList;

/// A list with room for `capacity` items of `size` bytes, whatever blocks they are in. False when out of memory.
bool touch_list_create(Memory *memory, TouchList *list, size_t size, uint32_t capacity, uint32_t block_count);
void touch_list_free(Memory *memory, TouchList *list);

/// A block that is being written.
typedef struct TouchWriter {
    TouchList *list;
    TouchBlock block;
    uint32_t chunk;
} TouchWriter;

static inline TouchWriter touch_list_begin(TouchList *list) { return (TouchWriter){.list = list}; }

/// Room for the block's next item; NULL when the list is full. The item is counted all the same.
static inline void *touch_list_add(TouchWriter *writer) {
    TouchList *list = writer->list;
    uint32_t at = writer->block.count++ % TOUCH_CHUNK;
    if (at == 0) {
        uint32_t chunk = atomic_fetch_add(&list->taken, 1);
        if (writer->block.count == 1) writer->block.first = chunk;
        else if (writer->chunk < list->chunk_count) list->next[writer->chunk] = chunk;
        writer->chunk = chunk;
    }
    if (writer->chunk >= list->chunk_count) return NULL;
    return list->items + ((size_t)writer->chunk * TOUCH_CHUNK + at) * list->size;
}

static inline void touch_list_end(const TouchWriter *writer, int block) {
    writer->list->blocks[block] = writer->block;
}

/// A job that writes blocks of a list.
typedef void TouchWriteFn(void *context, TouchList *list, int block);

/// Has `blocks` blocks written, at most block_count. Returns the number of items; where these are more than `capacity`,
/// those that come first in the order of blocks are there, at least `capacity`.
uint64_t touch_list_write(TouchList *list, Pool *pool, int blocks, uint32_t capacity, TouchWriteFn *write,
                          void *context);

/// Calls for each item, its number in the order of blocks, up to `count` of them.
typedef void TouchReadFn(void *context, const void *item, uint32_t number);
void touch_list_read(const TouchList *list, Pool *pool, int blocks, uint32_t count, TouchReadFn *read, void *context);

#endif
