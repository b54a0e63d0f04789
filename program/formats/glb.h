// A binary glTF 2.0 file in the making: its buffer and the parts of its JSON.
#pragma once

#include "formats/output.h"
#include "formats/sink.h"

typedef struct GlbFile {
    Sink text, data, views, accessors, meshes, nodes, animations, scratch;
    Sink corners; ///< of the triangles of the mesh in the making: vertices of the surface
    const OutputScene *scene;
    uint32_t view_count, mesh_count, node_count;
    bool packed;            ///< vertices and corners are rounded and packed
    bool pictures_inside;   ///< and not beside the file
    uint32_t first_picture; ///< the view of the first picture inside
    int grid;               ///< of packed positions: multiples of two to this power, m
    size_t unpacked;        ///< bytes of what is packed
} GlbFile;

/// The target of an accessor; animations have none.
typedef enum GlbUse { GLB_OF_VERTICES, GLB_OF_CORNERS, GLB_OF_ANIMATION } GlbUse;

void glb_begin(GlbFile *file, const OutputScene *scene, SingeAllocator allocator);
void glb_free(GlbFile *file);

/// A string in quotes.
void glb_put_string(Sink *sink, const char *text);
/// Adds the view and the accessor of the data written since `begin`: `count` times `width` floats, or corners. `box`:
/// [2][width] min and max, or NULL. Returns the accessor's number.
uint32_t glb_put_accessor(GlbFile *file, size_t begin, uint32_t count, int width, GlbUse use, const float *box);
/// Ends the accessor in the making with its box, as above, and returns its number.
uint32_t glb_end_accessor(GlbFile *file, int width, const float *box);

// ---- packed: by meshoptimizer, where the build has it

/// How values are rounded before they are packed.
typedef struct GlbRounding {
    enum {
        GLB_GRID, ///< floats; multiples of two to the power of `bits`, or coarser where they are too large for that
        GLB_DIRECTION, ///< unit vectors, in 8 bits a component
        GLB_TRIANGLES, ///< corners of triangles with `vertices` vertices: whole numbers
    } kind;
    int bits;
    uint32_t vertices;
} GlbRounding;

bool glb_pack_available(void);
/// Puts triangles that share vertices next to each other; `vertices` bounds the numbers of corners[count].
void glb_sort_triangles(GlbFile *file, uint32_t *corners, size_t count, uint32_t vertices);
/// Packs the `count` times `width` floats, or corners, written since `begin`, and adds their view and accessor. `box`:
/// with min and max. Returns the accessor's number.
uint32_t glb_put_packed(GlbFile *file, size_t begin, uint32_t count, int width, GlbRounding rounding, bool box);

/// A vector of the cache, rotated to y up.
static inline void glb_turn(const float from[3], float to[3]) { to[0] = from[0], to[1] = from[2], to[2] = -from[1]; }
/// glTF needs unit normals; a zero normal becomes up.
void glb_make_unit(float v[3]);

/// Completes the file: nodes of all meshes, the sheets' materials and pictures, with paths relative to `up` ("../").
/// `extras` is JSON for the asset.
SINGE_NODISCARD SingeResult glb_finish(GlbFile *file, const char *up, const char *extras, const char *path,
                                       SingeError *error);
