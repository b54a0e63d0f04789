// Contact of particles with a plane, in lanes (collider_contact.c, plane_kernel.h).
#pragma once

#include "world/path.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Quadruples of all particles, and a plane at the two ends of a substep.
typedef struct PlaneLanes {
    float *position;        ///< m; fourth: inverse mass, 0 for what does not move
    const float *velocity;  ///< m/s
    const float *predicted; ///< m
    float h;                ///< s
    Pose before, after;
    bool is_still; ///< before and after are the same
    float offset;  ///< m
    float friction;
} PlaneLanes;

/// Contact and friction of particles [begin, end), a multiple of four of them. Returns how many touch.
typedef uint64_t PlaneRange(const PlaneLanes *plane, size_t begin, size_t end);
PlaneRange plane_range_four, plane_range_v3, plane_range_v4;
