// Draws triangles of uv on a square picture, and dilates values beyond them.
#pragma once

#include "formats/formats.h"

/// Called for each pixel whose centre lies in a triangle, with the weights of the triangle's corners.
typedef void UvPixel(void *context, size_t pixel, const float weight[3]);

/// Draws one triangle on size × size pixels, rows from the top: v = 1 is the upper side of the first row. Pixels
/// outside the picture are skipped.
void uv_triangle(int size, const float uv[3][2], UvPixel *draw, void *context);

enum { UV_NONE = UINT32_MAX };

/// Finds the nearest covered pixel of each uncovered pixel within `reach` pixels (across sides); of several the first
/// in search order. A covered pixel is its own nearest; others have UV_NONE. `queue` has room for size * size.
void uv_spread(int size, int reach, const uint8_t *covered, uint32_t *nearest, uint32_t *queue);
