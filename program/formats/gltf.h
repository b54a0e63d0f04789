// The parts of a glTF that form its meshes, as arrays (gltf.c); gltf_mesh.c makes polygons from them.
#pragma once

#include "formats/json.h"

typedef struct GltfAccessor GltfAccessor;
struct GltfAccessor {
    const uint8_t *bytes; ///< of the first element; all lie within the file or its buffers
    uint32_t count, stride;
    uint32_t type;  ///< of a component, 5120 to 5126
    uint32_t width; ///< components
    bool normalized;
    uint32_t sparse_count;       ///< elements with other values
    const uint8_t *sparse_index; ///< [sparse_count] of `sparse_type`
    const uint8_t *sparse_bytes; ///< [sparse_count] elements
    uint32_t sparse_type;
};

typedef struct GltfPrimitive {
    uint32_t number, mesh;         ///< from 0; the mesh
    uint32_t mode;                 ///< 0 to 6
    int64_t position, indices, uv; ///< accessors, or -1
} GltfPrimitive;

typedef struct GltfMesh {
    uint32_t first, count; ///< primitives
} GltfMesh;

typedef struct Gltf {
    const char *name;
    SingeAllocator allocator;
    SingeError *error;
    const uint8_t *chunk; ///< of a GLB, NULL without
    size_t chunk_size;
    Json json;
    uint32_t *views, *accessors, *buffers, *meshes, *nodes; ///< values of the JSON
    uint32_t view_count, accessor_count, buffer_count, mesh_count, node_count;
    Bytes *loaded;      ///< [buffer_count] of the buffers that were used
    size_t loaded_size; ///< of all of them
    size_t beside_size; ///< of those in other files
    GltfAccessor *read; ///< [accessor_count]; those used have a width
    GltfMesh *ranges;   ///< [mesh_count]
    GltfPrimitive *primitives;
    size_t primitive_count, primitive_capacity;
} Gltf;

SingeResult gltf_refuse(const Gltf *gltf, SingeResult code, const char *format, ...) SINGE_PRINTF(3, 4);

/// The index in a member, which must be below `count`; JSON_NONE without the member.
SINGE_NODISCARD SingeResult gltf_index(const Gltf *gltf, int64_t object, const char *key, uint32_t count,
                                       int64_t *index);

/// Bytes of a component.
uint32_t gltf_type_size(uint32_t type);

/// Makes polygons of the file's scene.
SINGE_NODISCARD SingeResult gltf_make(Gltf *gltf, uint64_t max, Polygons *polygons);
