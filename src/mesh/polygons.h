// Polygons: the mesh of a file, before it becomes the quads of a sheet.
#pragma once

#include "singe/material.h"

/// The largest number of vertices, faces or corners: they are numbered by int32_t.
enum { MESH_COUNT_LIMIT = 0x7fffffff };

/// The mesh of a file: faces of three corners or more, in the file's order. mesh_make (mesh/to_quads.h) makes the mesh
/// of a sheet from it.
typedef struct Polygons {
    uint32_t vertex_count, face_count, corner_count, attribute_count;
    float *positions;           ///< [3 * vertex_count], file units
    uint32_t *first;            ///< [face_count + 1] where a face's corners begin
    uint32_t *corners;          ///< [corner_count] vertices
    float *uv;                  ///< [2 * corner_count], of each corner, or NULL
    uint32_t *lines;            ///< [face_count] the file's line of each, from 1 (OBJ, OFF), or NULL
    SingeAttribute *attributes; ///< scalar float properties other than position, normal, uv, by name (PLY)
    SingeAllocator allocator;
} Polygons;

void polygons_free(Polygons *polygons);
