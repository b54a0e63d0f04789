// Pairs of triangles that cross in what is drawn, by the exact test of `singe verify`, which shares nothing with the
// solver (program/analysis/crossings.c).
#pragma once

#include "analysis/crossings.h"
#include "support/test.h"

static inline long surface_crossings(const SingeSurface *surface) {
    uint64_t pairs;
    float at[3];
    assert_true(crossings_count(surface, &pairs, at));
    return (long)pairs;
}

static inline long crossings(SingeSim *sim) {
    SingeSurface surface = {0};
    assert_int_equal(singe_sim_surface(sim, &surface), SINGE_OK);
    const long count = surface_crossings(&surface);
    singe_surface_free(&surface);
    return count;
}
