// A solid below a height field.
#pragma once

#include "common/error.h"
#include "common/memory.h"
#include "common/float3.h"

typedef struct HeightSolid {
    uint32_t columns, rows;
    float *heights; ///< [rows * columns] m, rows along x, in order of y
    // derived from them
    float half[2];   ///< m, of the rectangle about the origin
    float step[2];   ///< m, from node to node
    float low, high; ///< of the heights
    uint32_t blocks[2];
    float (*ranges)[2]; ///< [blocks] min and max height of HEIGHT_BLOCK by HEIGHT_BLOCK cells
} HeightSolid;

SingeResult height_solid_create(Memory *memory, uint32_t columns, uint32_t rows, const float *heights,
                                const float size[2], HeightSolid *solid, SingeError *error);
void height_solid_free(Memory *memory, HeightSolid *solid);

/// See collider_distance.
float height_solid_distance(const HeightSolid *solid, Float3 p, float limit, Float3 *normal);
