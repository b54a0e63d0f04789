// A count of crossings that shares nothing with the library: every pair of a surface's triangles whose boxes meet,
// edges against triangles, in double precision.
#pragma once

#include "singe/sim.h"

/// Pairs of triangles without a common vertex that pass through each other; and with one, those whose opposite edge
/// passes through the other triangle.
long crossings_count(const SingeSurface *surface);
