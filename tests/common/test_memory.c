// Memory: what is held is counted, sizes that overflow are refused, failure leaves arrays as they were.
#include "support/support.h"

#include "common/memory.h"

TEST(memory_in_use_is_counted) {
    TestAllocator hook = {0};
    Memory memory = memory_make(test_allocator(&hook));
    double *array;

    assert_non_null(NEW(&memory, array, 10));
    for (int i = 0; i < 10; i++) assert_true(array[i] == 0);
    assert_int_equal(memory.held, 80);
    assert_int_equal(hook.bytes, 80);
    array[9] = 5;
    assert_true(memory_grow(&memory, &array, 10, 100, sizeof *array));
    assert_true(array[9] == 5);
    assert_int_equal(memory.held, 800);

    assert_true(memory_grow(&memory, &array, 100, 3, sizeof *array));
    assert_int_equal(memory.held, 24);
    FREE(&memory, array, 3);
    assert_null(array);
    FREE(&memory, array, 3);
    assert_int_equal(memory.held, 0);
    assert_int_equal(hook.blocks, 0);
    assert_int_equal(hook.frees, 1);
    assert_int_equal(hook.faults, 0);
}

TEST(empty_arrays_can_be_freed) {
    TestAllocator hook = {0};
    Memory memory = memory_make(test_allocator(&hook));
    int *array;

    assert_non_null(NEW(&memory, array, 0));
    assert_true(memory_grow(&memory, &array, 0, 4, sizeof *array));
    assert_true(memory_grow(&memory, &array, 4, 0, sizeof *array));
    FREE(&memory, array, 0);

    void *block = memory_new(&memory, 7, 0);
    assert_non_null(block);
    memory_free(&memory, &block, 7, 0);
    assert_int_equal(memory.held, 0);
    assert_int_equal(hook.blocks, 0);
    assert_int_equal(hook.faults, 0);
}

TEST(overflow_is_refused) {
    TestAllocator hook = {0};
    Memory memory = memory_make(test_allocator(&hook));
    assert_null(memory_new(&memory, SIZE_MAX / 8 + 1, 8)); // wraps to 0
    assert_null(memory_new(&memory, SIZE_MAX / 8 + 2, 8)); // wraps to 8
    assert_null(memory_new(&memory, SIZE_MAX, SIZE_MAX));
    assert_int_equal(hook.calls, 0);

    uint64_t *array;
    assert_non_null(NEW(&memory, array, 2));
    array[1] = 77;
    uint64_t *before = array;

    assert_false(memory_grow(&memory, &array, 2, SIZE_MAX / 8 + 2, sizeof *array));
    assert_ptr_equal(array, before);
    assert_int_equal(array[1], 77);
    assert_int_equal(memory.held, 16);
    FREE(&memory, array, 2);
}

TEST(failure_changes_nothing) {
    TestAllocator hook = {.fail_at = 2};
    Memory memory = memory_make(test_allocator(&hook));
    int *array, *other;

    assert_non_null(NEW(&memory, array, 4));
    array[3] = 9;
    assert_false(memory_grow(&memory, &array, 4, 8, sizeof *array));
    assert_int_equal(array[3], 9);
    assert_null(NEW(&memory, other, 1));
    assert_int_equal(memory.held, 16);
    FREE(&memory, array, 4);
    assert_int_equal(hook.blocks, 0);
    assert_int_equal(memory.held, 0);
}

TEST(libc_serves_without_a_hook) {
    Memory memory = memory_make((SingeAllocator){0});
    int *array;
    assert_non_null(NEW(&memory, array, 1000));
    assert_true(memory_grow(&memory, &array, 1000, 2000, sizeof *array));
    assert_int_equal(array[999], 0);
    assert_int_equal(memory.held, 8000);
    FREE(&memory, array, 2000);
    assert_int_equal(memory.held, 0);
}
