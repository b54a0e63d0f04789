// A list that the blocks of a parallel job write at the same time, each into its own chunks, and that is read in the
// order of the blocks: the same for any number of threads. Items are not counted in advance. Only if there is no room
// for all of them are the blocks written again, each up to its share of the room.
#pragma once

#include "common/pool.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/// Items per chunk: few, as the last chunk of every block may be almost empty.
enum { BLOCK_CHUNK = 16 };

typedef struct ListBlock {
    uint32_t first; ///< chunk
    uint32_t count; ///< items; at the first writing also those that found no room
    uint32_t room;  ///< max items; those after them are not counted
    uint32_t start; ///< in the order of all blocks
} ListBlock;

/// Memory for the items of lists that are in use one after another: a list's items stay until another one is written.
typedef struct BlockItems {
    uint8_t *at;
    size_t bytes;
} BlockItems;

typedef struct BlockList {
    BlockItems *items; ///< chunk_count BLOCK_CHUNK size bytes at least
    size_t size;       ///< bytes of an item
    uint32_t capacity; ///< items, whatever blocks they are in
    uint32_t chunk_count, block_count;
    uint32_t next_length; ///< chunks; more than chunk_count where memory has run out
    atomic_uint taken;    ///< chunks
    bool whole;           ///< the last written items are all there
    uint32_t *next;       ///< [next_length] the next chunk of the same block
    ListBlock *blocks;    ///< [block_count]
} BlockList;

/// A list with room in `items` for `capacity` items of `size` bytes, whatever blocks they are in. False when out of memory.
bool block_list_create(Memory *memory, BlockList *list, BlockItems *items, size_t size, uint32_t capacity,
                       uint32_t block_count);

/// Makes room for at least `capacity` items and `block_count` blocks; the previous items stay.
/// When out of memory it returns false and the list is unchanged.
bool block_list_grow(Memory *memory, BlockList *list, uint32_t capacity, uint32_t block_count);
void block_list_free(Memory *memory, BlockList *list); ///< but for the items
void block_items_free(Memory *memory, BlockItems *items);

/// A block that is being written.
typedef struct BlockWriter {
    BlockList *list;
    ListBlock *target, block;
    uint32_t chunk;
} BlockWriter;

static inline BlockWriter block_list_begin(BlockList *list, int block) {
    ListBlock *target = &list->blocks[block];
    return (BlockWriter){.list = list, .target = target, .block = {.room = target->room, .start = target->start}};
}

/// Whether the block may stop, as further items do not count.
static inline bool block_list_is_full(const BlockWriter *writer) { return writer->block.count >= writer->block.room; }

/// Room for the block's next item, or NULL. If only the list is full, the item is counted all the same.
static inline void *block_list_add(BlockWriter *writer) {
    BlockList *list = writer->list;
    if (block_list_is_full(writer)) return NULL;

    uint32_t at = writer->block.count++ % BLOCK_CHUNK;
    if (at == 0) {
        uint32_t chunk = atomic_fetch_add(&list->taken, 1);
        if (writer->block.count == 1) writer->block.first = chunk;
        else if (writer->chunk < list->chunk_count) list->next[writer->chunk] = chunk;
        writer->chunk = chunk;
    }
    if (writer->chunk >= list->chunk_count) return NULL;

    return list->items->at + ((size_t)writer->chunk * BLOCK_CHUNK + at) * list->size;
}

static inline void block_list_end(const BlockWriter *writer) { *writer->target = writer->block; }

/// A job that writes blocks of a list.
typedef void BlockWriteFn(void *context, BlockList *list, int block);

/// Writes `blocks` blocks by `write`, at most block_count. Returns the number of items with or without room, at most
/// `max` and one per block. The list must not be read before block_list_settle.
uint64_t block_list_write(BlockList *list, Pool *pool, int blocks, uint32_t max, BlockWriteFn *write, void *context);

/// Returns how many of the `count` items that block_list_write has found can be read: the first `room` ones, which is
/// at most the list's capacity. If they had no room, or have been lost since, the blocks are written again.
uint32_t block_list_settle(BlockList *list, Pool *pool, int blocks, uint64_t count, uint32_t room, BlockWriteFn *write,
                           void *context);

/// Calls for each item, its number in the order of blocks, up to `count` of them.
typedef void BlockReadFn(void *context, const void *item, uint32_t number);
void block_list_read(const BlockList *list, Pool *pool, int blocks, uint32_t count, BlockReadFn *read, void *context);
