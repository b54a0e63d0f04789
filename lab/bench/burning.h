// A burning sheet: it hangs upright from two corners while a hot ball crosses it. Its lower edge lies on the ground,
// and a sphere touches it from behind.
#pragma once

#include "bench/options.h"

/// Creates and commits it; `pace` is the fire's. On failure *sim is NULL.
SingeResult burning_build(const BenchOptions *options, const SingeAllocator *allocator, double springs, float pace,
                          SingeSim **sim, SingeError *error);
