// Shared by the mesh readers.
#pragma once

#include "formats/formats.h"

/// Limits for files that instance their meshes: bytes of positions, corners and uv, absolute and as a multiple of the
/// size of the file and of the files that it refers to.
enum { MESH_ANSWER_BASE = 16 << 20, MESH_ANSWER_TIMES = 64 };

/// Whether a file's name has this ending (".obj"), in any case.
bool mesh_name_ends(const char *name, const char *ending);

/// Whether a file's name is that of an OpenUSD stage, and what is said of one.
bool mesh_name_is_stage(const char *name);
#define MESH_STAGE_HELP                                                                                              \
    "is an OpenUSD stage, which only the Python package reads: python3 -m singe.usd STAGE --sheets /PRIM -o FOLDER " \
    "makes a scene of it"

// ---- the answer of a reader in a child process: polygons, all of which the parent validates
//
//     MeshCounts
//     float     positions[3 * vertices]
//     uint32_t  sizes[faces]               corners of each face
//     uint32_t  corners[corners]           vertices, from 0
//     float     uv[2 * corners]            where there are any

typedef struct MeshCounts {
    uint64_t vertices, faces, corners;
    uint64_t uv; ///< 1 or 0
} MeshCounts;

/// Makes polygons from an answer. Inconsistent sizes and indices out of range are SINGE_ERROR_FORMAT; positions that
/// are not finite, or no faces, are SINGE_ERROR_MESH; uv that are not finite become 0.
SINGE_NODISCARD SingeResult mesh_answer_take(const char *name, const uint8_t *bytes, size_t size,
                                             SingeAllocator allocator, Polygons *polygons, SingeError *error);
