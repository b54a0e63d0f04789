#include "support.h"

/// In front of every block: its size and a mark, so that wrong old sizes and foreign blocks are noticed.
typedef struct BlockHead {
    size_t size;
    uint64_t mark;
} BlockHead;
static const uint64_t block_mark = 0x53494e4745424c4bu;

static void *allocator_resize(void *context, void *block, size_t old_size, size_t new_size) {
    TestAllocator *allocator = context;
    BlockHead *old = block ? (BlockHead *)block - 1 : NULL;
    if ((old && (old->mark != block_mark || old->size != old_size)) || (!old && old_size)) allocator->faults++;

    if (new_size == 0) {
        if (!old) return NULL;
        allocator->frees++;
        allocator->blocks--;
        allocator->bytes -= old->size;
        old->mark = 0;
        free(old);
        return NULL;
    }

    allocator->calls++;
    if (new_size > allocator->largest) allocator->largest = new_size;
    if (allocator->fail_at &&
        (allocator->once ? allocator->calls == allocator->fail_at : allocator->calls >= allocator->fail_at))
        return NULL;

    BlockHead *head = malloc(sizeof *head + new_size);
    if (!head) return NULL;

    // fresh bytes are rubbish, and a resized block always moves
    memset(head + 1, 0xA5, new_size);
    if (old) {
        memcpy(head + 1, block, old_size < new_size ? old_size : new_size);
        allocator->bytes -= old->size;
        old->mark = 0;
        free(old);
    } else {
        allocator->blocks++;
    }

    *head = (BlockHead){new_size, block_mark};
    allocator->bytes += new_size;
    if (allocator->bytes > allocator->peak) allocator->peak = allocator->bytes;
    return head + 1;
}

SingeAllocator test_allocator(TestAllocator *allocator) { return (SingeAllocator){allocator_resize, allocator}; }

void test_allocator_check(const TestAllocator *allocator) {
    assert_int_equal(allocator->bytes, 0);
    assert_int_equal(allocator->faults, 0);
}
