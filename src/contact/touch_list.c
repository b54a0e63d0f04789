#include "contact/touch_list.h"

bool touch_list_create(Memory *memory, TouchList *list, size_t size, uint32_t capacity, uint32_t block_count) {
    list->size = size;
    list->block_count = block_count;
    list->chunk_count = capacity / TOUCH_CHUNK + block_count;
    return (list->items = memory_new(memory, (size_t)list->chunk_count * TOUCH_CHUNK, size)) &&
           NEW(memory, list->next, list->chunk_count) && NEW(memory, list->blocks, block_count);
}

void touch_list_free(Memory *memory, TouchList *list) {
    memory_free(memory, (void *)&list->items, (size_t)list->chunk_count * TOUCH_CHUNK, list->size);
    FREE(memory, list->next, list->chunk_count);
    FREE(memory, list->blocks, list->block_count);
}

typedef struct Job {
    TouchList *list;
    TouchWriteFn *write;
    TouchReadFn *read;
    void *context;
    uint32_t count;
} Job;

static void write_blocks(void *task, int begin, int end) {
    const Job *job = task;
    for (int block = begin; block < end; block++) job->write(job->context, job->list, block);
}

static uint64_t number_blocks(TouchList *list, int blocks) {
    uint64_t sum = 0;
    for (int b = 0; b < blocks; b++) {
        list->blocks[b].start = (uint32_t)(sum < UINT32_MAX ? sum : UINT32_MAX);
        sum += list->blocks[b].count;
    }
    return sum;
}

uint64_t touch_list_write(TouchList *list, Pool *pool, int blocks, uint32_t capacity, TouchWriteFn *write,
                          void *context) {
    Job job = {.list = list, .write = write, .context = context};
    atomic_store(&list->taken, 0);
    pool_for(pool, blocks, 1, write_blocks, &job);
    uint64_t count = number_blocks(list, blocks);
    if (count <= capacity) return count;
    // which blocks found no room hung on the threads
    atomic_store(&list->taken, 0);
    write_blocks(&job, 0, blocks);
    return count;
}

static void read_blocks(void *task, int begin, int end) {
    const Job *job = task;
    const TouchList *list = job->list;
    for (int b = begin; b < end; b++) {
        const TouchBlock *block = &list->blocks[b];
        uint32_t chunk = block->first;
        for (uint32_t k = 0; k < block->count && block->start + k < job->count; k++) {
            if (k > 0 && k % TOUCH_CHUNK == 0) chunk = list->next[chunk];
            const uint8_t *items = list->items + (size_t)chunk * TOUCH_CHUNK * list->size;
            job->read(job->context, items + k % TOUCH_CHUNK * list->size, block->start + k);
        }
    }
}

void touch_list_read(const TouchList *list, Pool *pool, int blocks, uint32_t count, TouchReadFn *read, void *context) {
    Job job = {.list = (TouchList *)list, .read = read, .context = context, .count = count};
    pool_for(pool, blocks, 1, read_blocks, &job);
}
