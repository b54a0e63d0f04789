// Tests whether drawn cells cross each other.
#pragma once

#include "common/float4.h"
#include "shell/shell.h"

/// Whether segment p-q passes through triangle a, b, c. The fourth numbers must be 0.
bool cross_pierces(Float4 p, Float4 q, Float4 a, Float4 b, Float4 c);

/// Whether the triangles of two cells around their virtual centres cross each other, other than at shared nodes.
/// `x` is [vertices] m.
bool cross_cells(const Shell *shell, const float (*x)[4], uint32_t a, uint32_t b);
