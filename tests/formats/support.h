// What the tests of the formats share: cmocka, an allocator that counts and fails, a folder for files.
#ifndef TESTS_FORMATS_SUPPORT_H
#define TESTS_FORMATS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/formats.h"

/// Counts what is allocated, checks that old sizes are told truly, and refuses the call number `fail_at` (from 1).
typedef struct Counter {
    long calls, fail_at;
    size_t held, largest;
    int wrong_sizes;
} Counter;

static inline void *counter_resize(void *context, void *block, size_t old_size, size_t new_size) {
    Counter *counter = context;
    size_t *head = block ? (size_t *)block - 2 : NULL;
    if (head && *head != old_size) counter->wrong_sizes++;
    if (!head && old_size) counter->wrong_sizes++;
    if (new_size == 0) {
        if (head) counter->held -= *head;
        free(head);
        return NULL;
    }
    if (++counter->calls == counter->fail_at) return NULL;
    if (new_size > counter->largest) counter->largest = new_size;
    size_t before = head ? *head : 0;
    size_t *moved = realloc(head, new_size + 16);
    if (!moved) return NULL;
    *moved = new_size;
    counter->held += new_size - before;
    return moved + 2;
}

static inline SingeAllocator counter_allocator(Counter *counter) {
    return (SingeAllocator){counter_resize, counter};
}

static inline void counter_check(const Counter *counter) {
    assert_int_equal(counter->held, 0);
    assert_int_equal(counter->wrong_sizes, 0);
}

static inline char *test_folder(void) {
    static char folder[] = "/tmp/singe-formats-XXXXXX";
    assert_non_null(mkdtemp(folder));
    return folder;
}

static inline void assert_message(const SingeError *error, const char *part) {
    if (!strstr(error->message, part)) fail_msg("\"%s\" is not in \"%s\"", part, error->message);
}

#endif
