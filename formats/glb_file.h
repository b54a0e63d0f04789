// A binary glTF 2.0 file in the making: its buffer and the parts of its JSON.
#ifndef FORMATS_GLB_FILE_H
#define FORMATS_GLB_FILE_H

#include "formats/output.h"
#include "formats/sink.h"

typedef struct GlbFile {
    Sink text, data, views, accessors, meshes, nodes, animations;
    const OutputScene *scene;
    uint32_t view_count, mesh_count, node_count;
} GlbFile;

/// What an accessor is of; animations have no target.
typedef enum GlbUse { GLB_OF_VERTICES, GLB_OF_CORNERS, GLB_OF_ANIMATION } GlbUse;

void glb_begin(GlbFile *file, const OutputScene *scene, SingeAllocator allocator);
void glb_free(GlbFile *file);

/// A string in quotes.
void glb_put_string(Sink *sink, const char *text);
/// The view and the accessor of what has come into the data since `begin`: `count` times `width` floats, or corners.
/// `box`: [2][width] least and greatest, or NULL. Returns the accessor's number.
uint32_t glb_put_accessor(GlbFile *file, size_t begin, uint32_t count, int width, GlbUse use, const float *box);

/// A vector of the cache in axes of which y is up.
static inline void glb_turn(const float from[3], float to[3]) { to[0] = from[0], to[1] = from[2], to[2] = -from[1]; }
/// glTF wants normals of length one; what has none points up.
void glb_make_unit(float v[3]);

/// The file whole: all meshes by their nodes, the sheets' materials and pictures, whose paths are from `up` ("../").
/// `extras` is JSON for the asset.
SINGE_NODISCARD SingeResult glb_finish(GlbFile *file, const char *up, const char *extras, const char *path,
                                       SingeError *error);

#endif
