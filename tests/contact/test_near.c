// Distances against dense sampling, and sweeps against small steps.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "contact/touch_near.h"

static uint32_t seed = 1;

static float uniform(void) {
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) * (1.0f / 16777216) * 2 - 1;
}

static Quad point(float size) { return (Quad){size * uniform(), size * uniform(), size * uniform(), 0}; }

static float length(Quad a) { return sqrtf(quad_dot(a, a)); }

static void triangle_distance(void **unused) {
    (void)unused;
    enum { SPLITS = 60 };
    for (int trial = 0; trial < 2000; trial++) {
        Quad p = point(1), a = point(1), b = point(1), c = point(1);
        if (trial % 7 == 0) c = a + 1e-4f * point(1); // a sliver
        float weight[3], least = INFINITY, got = length(touch_from_triangle(p, a, b, c, weight));
        assert_true(weight[0] > -1e-3f && weight[1] > -1e-3f && weight[2] > -1e-3f);
        for (int i = 0; i <= SPLITS; i++)
            for (int j = 0; i + j <= SPLITS; j++) {
                float u = (float)i / SPLITS, v = (float)j / SPLITS;
                least = fminf(least, length(p - ((1 - u - v) * a + u * b + v * c)));
            }
        assert_true(got <= least + 1e-3f && got >= least - 4.0f / SPLITS);
    }
}

static void segment_distance(void **unused) {
    (void)unused;
    enum { SPLITS = 100 };
    for (int trial = 0; trial < 2000; trial++) {
        Quad a = point(1), b = point(1), c = point(1), d = point(1);
        if (trial % 5 == 0) d = c + (b - a) * uniform(); // parallel
        if (trial % 11 == 0) b = a;                      // a point
        float s, t, least = INFINITY, got = length(touch_from_segment(a, b, c, d, &s, &t));
        for (int i = 0; i <= SPLITS; i++)
            for (int j = 0; j <= SPLITS; j++)
                least = fminf(least, length(a + (float)i / SPLITS * (b - a) - c - (float)j / SPLITS * (d - c)));
        assert_true(got <= least + 1e-3f && got >= least - 4.0f / SPLITS);
    }
}

/// The time at which distance first falls below `near`, by small steps; 2 for never.
static float stepped(const TouchSweep *sweep, float near) {
    enum { STEPS = 2000 };
    for (int k = 0; k <= STEPS; k++) {
        Quad x[4];
        float s, t, weight[3], time = (float)k / STEPS;
        for (int i = 0; i < 4; i++) x[i] = sweep->place[i] + time * sweep->way[i];
        Quad apart = sweep->edges ? touch_from_segment(x[0], x[1], x[2], x[3], &s, &t)
                                  : touch_from_triangle(x[0], x[1], x[2], x[3], weight);
        if (length(apart) < near) return time;
    }
    return 2;
}

static void sweeps_stop_in_time(void **unused) {
    (void)unused;
    int met = 0, free_ways = 0;
    for (int trial = 0; trial < 3000; trial++) {
        TouchSweep sweep = {.edges = trial & 1};
        for (int i = 0; i < 4; i++) sweep.place[i] = point(1), sweep.way[i] = point(1.5f);
        if (stepped(&sweep, 0.05f) == 0) continue; // near from the start
        float hit = touch_sweep(&sweep, 0.01f, 0), first = stepped(&sweep, 0.01f);
        // never later than they are as near as the gap, and only if they come near at all
        if (first <= 1) assert_true(hit <= first);
        if (hit <= 1) assert_true(stepped(&sweep, 0.25f) <= 1);
        met += hit <= 1, free_ways += hit > 1;
    }
    assert_true(met > 100 && free_ways > 1000);
}

static void what_is_near_may_only_part(void **unused) {
    (void)unused;
    TouchSweep sweep = {.place = {{0, 0, 1e-3f, 0}, {-1, -1, 0, 0}, {1, -1, 0, 0}, {0, 1, 0, 0}}};
    sweep.way[0] = (Quad){0, 0, 1e-2f, 0};
    assert_true(touch_sweep(&sweep, 1e-3f, 0) > 1);
    sweep.way[0] = (Quad){0, 0, -1e-4f, 0};
    assert_true(touch_sweep(&sweep, 1e-3f, 0) == 0);
    sweep.way[0] = (Quad){0, 0, -1e-2f, 0}; // right through
    assert_true(touch_sweep(&sweep, 1e-3f, 0) == 0);
    for (int i = 0; i < 4; i++) sweep.way[i] = (Quad){5, 6, 7, 0}; // all together
    assert_true(touch_sweep(&sweep, 1e-3f, 1e-6f) > 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangle_distance),
        cmocka_unit_test(segment_distance),
        cmocka_unit_test(sweeps_stop_in_time),
        cmocka_unit_test(what_is_near_may_only_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
