// Polygons as the answer of a reader in a child process; the parent validates all of it.
//
//     MeshCounts
//     float     positions[3 * vertices]
//     uint32_t  sizes[faces]               corners of each face
//     uint32_t  corners[corners]           vertices, from 0
//     float     uv[2 * corners]            where there are any
#ifndef FORMATS_MESH_ANSWER_H
#define FORMATS_MESH_ANSWER_H

#include "formats/formats.h"

typedef struct MeshCounts {
    uint64_t vertices, faces, corners;
    uint64_t uv; ///< 1 or 0
} MeshCounts;

/// Makes polygons from an answer. Inconsistent sizes and indices out of range are SINGE_ERROR_FORMAT; positions that
/// are not finite, or no faces, are SINGE_ERROR_MESH; uv that are not finite become 0.
SINGE_NODISCARD SingeResult mesh_answer_take(const char *name, const uint8_t *bytes, size_t size,
                                             SingeAllocator allocator, Polygons *polygons, SingeError *error);

#endif
