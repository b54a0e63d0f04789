#include "collision/block_list.h"

bool block_list_create(Memory *memory, BlockList *list, BlockItems *items, size_t size, uint32_t capacity,
                       uint32_t block_count) {
    *list = (BlockList){.items = items, .size = size};
    return block_list_grow(memory, list, capacity, block_count);
}

void block_list_free(Memory *memory, BlockList *list) {
    FREE(memory, list->next, list->next_length);
    FREE(memory, list->blocks, list->block_count);
}

void block_items_free(Memory *memory, BlockItems *items) { FREE(memory, items->at, items->bytes); }

bool block_list_grow(Memory *memory, BlockList *list, uint32_t capacity, uint32_t block_count) {
    if (capacity < list->capacity) capacity = list->capacity;
    if (block_count < list->block_count) block_count = list->block_count;

    const uint32_t chunks = capacity / BLOCK_CHUNK + block_count; // a block's last chunk may be almost empty
    const size_t bytes = (size_t)chunks * BLOCK_CHUNK * list->size;
    if (bytes > list->items->bytes) {
        if (!memory_grow(memory, &list->items->at, list->items->bytes, bytes, 1)) return false;
        list->items->bytes = bytes;
    }

    if (chunks > list->next_length) {
        if (!memory_grow(memory, &list->next, list->next_length, chunks, sizeof *list->next)) return false;
        list->next_length = chunks;
    }

    if (block_count > list->block_count) {
        if (!memory_grow(memory, &list->blocks, list->block_count, block_count, sizeof *list->blocks)) return false;
        list->block_count = block_count;
    }

    list->capacity = capacity;
    list->chunk_count = chunks;
    return true;
}

typedef struct Job {
    BlockList *list;
    BlockWriteFn *write;
    BlockReadFn *read;
    void *context;
    uint32_t count; ///< items to read, or to write again, or max per block
    bool again;
} Job;

static void write_blocks(void *task, int begin, int end) {
    const Job *job = task;
    for (int b = begin; b < end; b++) {
        ListBlock *block = &job->list->blocks[b];
        if (job->again) block->room = block->start < job->count ? job->count - block->start : 0;
        else *block = (ListBlock){.room = job->count};
        if (block->room > 0) job->write(job->context, job->list, b);
        else block->count = 0;
    }
}

static uint64_t number_blocks(BlockList *list, int blocks) {
    uint64_t sum = 0;
    for (int b = 0; b < blocks; b++) {
        list->blocks[b].start = (uint32_t)(sum < UINT32_MAX ? sum : UINT32_MAX);
        sum += list->blocks[b].count;
    }

    return sum;
}

uint64_t block_list_write(BlockList *list, Pool *pool, int blocks, uint32_t max, BlockWriteFn *write, void *context) {
    Job job = {.list = list, .write = write, .context = context, .count = max + 1};
    atomic_store(&list->taken, 0);
    pool_for(pool, blocks, 1, write_blocks, &job);
    uint64_t count = number_blocks(list, blocks);
    list->whole = count <= list->capacity;
    return count;
}

uint32_t block_list_settle(BlockList *list, Pool *pool, int blocks, uint64_t count, uint32_t room, BlockWriteFn *write,
                           void *context) {
    uint32_t kept = count < room ? (uint32_t)count : room;
    if (list->whole) return kept;

    // which blocks found no room depended on the threads: now each has its own
    Job job = {.list = list, .write = write, .context = context, .count = kept, .again = true};
    atomic_store(&list->taken, 0);
    pool_for(pool, blocks, 1, write_blocks, &job);
    number_blocks(list, blocks);
    list->whole = true;
    return kept;
}

static void read_blocks(void *task, int begin, int end) {
    const Job *job = task;
    const BlockList *list = job->list;
    for (int b = begin; b < end; b++) {
        const ListBlock *block = &list->blocks[b];
        uint32_t chunk = block->first;
        for (uint32_t k = 0; k < block->count && block->start + k < job->count; k++) {
            if (k > 0 && k % BLOCK_CHUNK == 0) chunk = list->next[chunk];
            const uint8_t *items = list->items->at + (size_t)chunk * BLOCK_CHUNK * list->size;
            job->read(job->context, items + k % BLOCK_CHUNK * list->size, block->start + k);
        }
    }
}

void block_list_read(const BlockList *list, Pool *pool, int blocks, uint32_t count, BlockReadFn *read, void *context) {
    Job job = {.list = (BlockList *)list, .read = read, .context = context, .count = count};
    pool_for(pool, blocks, 1, read_blocks, &job);
}
