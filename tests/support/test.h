// A test is a program of cases. Each case adds itself to its program, and tests/support/test.c runs them.
// The headers of the C library that tests need again and again are here.
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/// A case: TEST(paper_burns) { ... }. The name is a sentence that the case shows.
#define TEST(name)                                                                       \
    static void name(void **unused_);                                                    \
    __attribute__((constructor)) static void add_##name(void) { test_add(#name, name); } \
    static void name(__attribute__((unused)) void **unused_)

/// Runs `before` ahead of the first case, with the program's arguments, and `after` behind the last, which returns the
/// number of faults that it finds. `after` may be NULL.
#define TEST_AROUND(before, after) \
    __attribute__((constructor)) static void add_around(void) { test_around(before, after); }

/// What is declared with it is released at the end of its block by a function that takes its address: OWNED(rig_close)
/// Rig rig. Types that tests often own have a name for that, as OwnRig.
#define OWNED(release) __attribute__((cleanup(release)))
#define OwnSurface OWNED(singe_surface_free) SingeSurface
#define OwnBytes OWNED(bytes_free) Bytes

/// s of processors' time of all threads of the program.
double test_seconds(void);

void test_add(const char *name, CMUnitTestFunction run);
void test_around(void (*before)(int argc, char **argv), int (*after)(void));

// cmocka's own takes what is no number, and inf, for equal to any number
void test_float_equal(float value, float expected, float tolerance, const char *file, int line);
#undef assert_float_equal
#define assert_float_equal(value, expected, tolerance) \
    test_float_equal((float)(value), (float)(expected), (float)(tolerance), __FILE__, __LINE__)
