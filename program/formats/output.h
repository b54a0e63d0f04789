// Output for other programs: formats of frames, each in a source file of its own and one row here. A format writes a
// file per frame and may have a root: a file that refers to all frames. Writers are pure: the same frame and scene give
// the same bytes, whether they come from a simulation or from the cache.
#pragma once

#include "formats/formats.h"

#include <stddef.h>
#include <string.h>

/// A frame as passed to writers.
typedef struct OutputFrame {
    const SingeSurface *surface;
    double time; ///< s
    int number;  ///< from 1
} OutputFrame;

/// A sheet's uncut mesh at rest, of quads.
typedef struct OutputMesh {
    uint32_t vertex_count, cell_count;
    const float *positions; ///< [3 * vertex_count] m
    const float *uv;        ///< [2 * vertex_count] or NULL
    const float *corner_uv; ///< [8 * cell_count] of each cell's corners if there are seams; else NULL
    const uint32_t *cells;  ///< [4 * cell_count]
    const int32_t *source;  ///< [vertex_count] the file's vertex, -1 for a new one; NULL if they are the same
    const uint32_t *became; ///< [source_count] the vertex that the file's vertex is now; NULL with source
    uint32_t source_count;  ///< vertices of the file
} OutputMesh;

static inline bool output_mesh_has_uv(const OutputMesh *mesh) { return mesh->uv || mesh->corner_uv; }
/// The uv of a cell's corner, 0 to 3, of a mesh with uv.
static inline void output_mesh_uv(const OutputMesh *mesh, uint32_t cell, int corner, float uv[2]) {
    const size_t at = 4 * (size_t)cell + (size_t)corner;
    const float *from = mesh->corner_uv ? mesh->corner_uv + 2 * at : mesh->uv + 2 * (size_t)mesh->cells[at];
    uv[0] = from[0];
    uv[1] = from[1];
}

/// The appearance of a sheet besides its surface.
typedef struct OutputSheet {
    const char *name;    ///< as in the scene
    const char *picture; ///< path of its picture, relative paths from the root file; NULL: none
    const Image *image;  ///< the picture; NULL: none
    float colour[3];     ///< linear, multiplies the picture
    OutputMesh mesh;     ///< textures and VAT need it
} OutputSheet;

/// The pose of a shape in a frame.
typedef struct OutputPose {
    float position[3], rotation[4]; ///< m; quaternion x, y, z, w
    const float *vertices;          ///< [3 * OutputShape.vertex_count] m, of a mesh that deforms; NULL: the shape's
    bool visible;
} OutputPose;

/// A collider or a hot ball.
typedef struct OutputShape {
    SingeColliderKind kind;                ///< no plane
    float radius, half_size[3], height;    ///< m, as SingeColliderDef has them
    float colour[3];                       ///< linear
    float temperature;                     ///< K
    uint32_t vertex_count, triangle_count; ///< of a mesh or a heightfield, in its own frame
    const float *vertices;                 ///< [3 * vertex_count] m
    const uint32_t *triangles;             ///< [3 * triangle_count]
    const OutputPose *poses;               ///< [OutputScene.frames]
} OutputShape;

/// The data common to all frames. Writers of frames use only `name`, `fps`, `texture_size` and the sheets.
typedef struct OutputScene {
    const char *name; ///< of the files
    float fps;
    int frames;       ///< number of frames, from 1
    int texture_size; ///< pixels a side of textures
    bool plain;       ///< a single GLB: floats that every reader knows, not packed
    bool gas;         ///< gas/NAME.0001.vdb exist
    bool gas_detail;  ///< gas_detail/NAME.0001.vdb exist, too: the root refers to those
    bool wet;         ///< a sheet held water at the start: frames have the field `water`
    uint32_t sheet_count, shape_count;
    const OutputSheet *sheets;
    const OutputShape *shapes;
    float eye[3], target[3], up[3]; ///< m, of the camera
    float fov, aspect;              ///< radians, vertical; width over height
    float aperture, focus;          ///< m: of the lens, and the distance in focus; 0: everything is
    float light_direction[3], light_angle, light_colour[3]; ///< towards it; radians, radius; linear
    float sky[3];                                           ///< linear
    float ground_height, ground_colour[3];                  ///< m, -INFINITY for none; linear
} OutputScene;

SINGE_NODISCARD SingeResult ply_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                            SingeError *error);
SINGE_NODISCARD SingeResult vtp_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                            SingeError *error);
SINGE_NODISCARD SingeResult pvd_write_root(const char *path, const OutputScene *scene, SingeError *error);

SINGE_NODISCARD SingeResult usd_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                            SingeError *error);
SINGE_NODISCARD SingeResult usd_write_root(const char *path, const OutputScene *scene, SingeError *error);

SINGE_NODISCARD SingeResult glb_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                            SingeError *error);

SINGE_NODISCARD SingeResult textures_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                                 SingeError *error);

/// Max sheets with uv of a frame of textures.
enum { OUTPUT_TEXTURE_SHEETS = 64 };

/// The frames of a finished cache, from 1. The result of `read` is valid until the next call.
typedef struct OutputCache {
    int frames;
    SingeResult (*read)(void *context, int number, OutputFrame *frame, SingeError *error);
    void *context;
} OutputCache;

// Writers of all frames at once, for delivery.
SINGE_NODISCARD SingeResult glb_write_single(const char *path, const OutputScene *scene, const OutputCache *cache,
                                             SingeError *error);
SINGE_NODISCARD SingeResult usd_write_single(const char *path, const OutputScene *scene, const OutputCache *cache,
                                             SingeError *error);
SINGE_NODISCARD SingeResult usdz_write(const char *path, const OutputScene *scene, const OutputCache *cache,
                                       SingeError *error);
SINGE_NODISCARD SingeResult vat_write(const char *path, const OutputScene *scene, const OutputCache *cache,
                                      SingeError *error);

/// Reads the file of a sheet's picture. `path`: of the root or the archive, whose folder relative ones begin at. Free
/// the bytes.
SINGE_NODISCARD SingeResult output_picture_read(const char *path, const char *picture, Bytes *bytes, SingeError *error);

typedef SingeResult OutputWriteFrame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                     SingeError *error);
typedef SingeResult OutputWriteRoot(const char *path, const OutputScene *scene, SingeError *error);

/// ROW(name, ending of frames, writer, ending of the root or NULL, its writer or NULL): frames are in name/, the root
/// is next to that folder. The first is the cache, which every run writes and from which the others can be made.
#define OUTPUT_FORMATS(ROW)                                     \
    ROW(ply, ".ply", ply_write_frame, NULL, NULL)               \
    ROW(usd, ".usdc", usd_write_frame, ".usda", usd_write_root) \
    ROW(vtp, ".vtp", vtp_write_frame, ".pvd", pvd_write_root)   \
    ROW(glb, ".glb", glb_write_frame, NULL, NULL)               \
    ROW(textures, ".exr", textures_write_frame, NULL, NULL)

#define OUTPUT_ENUMERATOR(name, ...) OUTPUT_##name,
enum { OUTPUT_FORMATS(OUTPUT_ENUMERATOR) OUTPUT_COUNT };

typedef struct OutputFormat {
    const char *name, *ending;
    OutputWriteFrame *write_frame;
    const char *root_ending; ///< NULL: it has no root
    OutputWriteRoot *write_root;
} OutputFormat;

extern const OutputFormat output_formats[OUTPUT_COUNT];

typedef SingeResult OutputWriteSingle(const char *path, const OutputScene *scene, const OutputCache *cache,
                                      SingeError *error);

/// A form of delivery: all frames at once, made from a finished cache.
typedef struct OutputSingle {
    const char *name;
    bool by_option;     ///< written by `--single`: the format of frames has the same name
    const char *ending; ///< of the file next to the folders; NULL: several files in a folder of that name
    OutputWriteSingle *write;
} OutputSingle;
enum { OUTPUT_SINGLE_COUNT = 4 };
extern const OutputSingle output_singles[OUTPUT_SINGLE_COUNT];

/// A set of formats, a bit each.
typedef uint32_t OutputSet;
static inline bool output_has(OutputSet set, int format) { return set >> format & 1; }

// ---- the fields of a drawn vertex, by their names in every format

typedef struct SurfaceField {
    const char *name;
    size_t array; ///< offset of the array's pointer in SingeSurface
    bool integer;
    uint8_t width, index; ///< values a vertex in that array, and which of them
} SurfaceField;

/// The columns of the cache: vectors first, then scalar fields, which every format has. Each has names of
/// its own for vectors.
enum { SURFACE_VECTORS = 14, SURFACE_FIELDS = 12, SURFACE_COLUMNS = SURFACE_VECTORS + SURFACE_FIELDS };
extern const SurfaceField surface_columns[SURFACE_COLUMNS];
#define surface_fields (surface_columns + SURFACE_VECTORS)

/// How many of them there are.
static inline int surface_field_count(bool wet) { return wet ? SURFACE_FIELDS : SURFACE_FIELDS - 1; }

/// The values of a field: floats or int32_t.
static inline void *surface_field(const SingeSurface *surface, const SurfaceField *field) {
    void *array;
    memcpy(&array, (const char *)surface + field->array, sizeof array);
    return array;
}

/// Grows a box, its lowest and its highest corner, by a point; the first point is the whole box.
static inline void box_grow(float box[6], const float point[3], bool first) {
    for (int c = 0; c < 3; c++) {
        box[c] = !first && box[c] < point[c] ? box[c] : point[c];
        box[3 + c] = !first && box[3 + c] > point[c] ? box[3 + c] : point[c];
    }
}

// ---- a surface by sheet, for formats with a mesh for each

/// Vertices and triangles by sheet, each in the surface's order.
typedef struct SheetParts {
    const SingeSurface *surface;
    uint32_t sheet_count;
    uint32_t *vertex_first, *triangle_first; ///< [sheet_count + 1]
    uint32_t *vertices, *triangles;          ///< by sheet
    uint32_t *local;                         ///< [vertex_count] a vertex's number in its sheet
} SheetParts;

/// The part of one sheet.
typedef struct SheetPart {
    uint32_t sheet, count, triangle_count;
    const uint32_t *vertices, *triangles;
} SheetPart;

/// Sorts a surface whose sheets are 0 to sheet_count - 1. SINGE_ERROR_FORMAT if they are not, or if a triangle belongs
/// to two. Free it also after failure.
SINGE_NODISCARD SingeResult sheet_parts_make(SheetParts *parts, const SingeSurface *surface, uint32_t sheet_count,
                                             const char *path, SingeError *error);
void sheet_parts_free(SheetParts *parts);

static inline SheetPart sheet_part(const SheetParts *p, uint32_t sheet) {
    return (SheetPart){sheet, p->vertex_first[sheet + 1] - p->vertex_first[sheet],
                       p->triangle_first[sheet + 1] - p->triangle_first[sheet], p->vertices + p->vertex_first[sheet],
                       p->triangles + p->triangle_first[sheet]};
}
