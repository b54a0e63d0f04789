// Files in and out: meshes, pictures, the cache of PLY and VDB. Readers work on bytes in memory; file.c reads files,
// and writes them whole or not at all. Memory comes from a SingeAllocator (zeroed: libc).
#pragma once

#include "mesh/polygons.h"
#include "singe/sim.h"

// ---- bytes of a file

typedef struct Bytes {
    uint8_t *data; ///< followed by one zero byte that is not counted
    size_t size;
    SingeAllocator allocator;
} Bytes;

/// Reads a whole regular file. Errors: SINGE_ERROR_FILE with the path and the system's reason (missing,
/// directory, unreadable), SINGE_ERROR_LIMIT above 2 GiB.
SINGE_NODISCARD SingeResult file_read(const char *path, SingeAllocator allocator, Bytes *bytes, SingeError *error);
/// The same for a file of at most `max` bytes; a larger one is SINGE_ERROR_LIMIT, before it is read.
SINGE_NODISCARD SingeResult file_read_max(const char *path, size_t max, SingeAllocator allocator, Bytes *bytes,
                                          SingeError *error);
/// Reads at most `max` bytes from the start of a regular file; returns their number, 0 if it cannot be read.
size_t file_read_head(const char *path, uint8_t *bytes, size_t max);
void bytes_free(Bytes *bytes);

/// Whether it begins at the root, or at a drive of Windows.
bool path_is_absolute(const char *path);
/// Whether `path` is in the folder of the file `name` or below, contains no "..", and leads there through links, too.
/// False when out of memory.
bool path_is_inside(const char *name, const char *path);

/// Writes path whole or leaves it as it was: a temporary file next to it is written, flushed and renamed. A link is
/// replaced, not followed. Errors name the path and the system's reason (full disk, no permission) and remove the
/// temporary file.
SINGE_NODISCARD SingeResult file_write(const char *path, const void *data, size_t size, SingeError *error);

/// As file_write, but the previous file is renamed to `backup`, replacing an earlier one. One of the two exists at all
/// times.
SINGE_NODISCARD SingeResult file_write_backup(const char *path, const char *backup, const void *data, size_t size,
                                              SingeError *error);

/// Creates an empty file next to `path`, under a unique temporary name, to be written by other code or to replace
/// `path` later. *draft is its name, for file_publish or file_discard; NULL on failure. Errors as above.
SINGE_NODISCARD SingeResult file_draft(const char *path, char **draft, SingeError *error);

/// Replaces `path` by a draft. The draft is gone afterwards, also after a failure.
SINGE_NODISCARD SingeResult file_publish(char *draft, const char *path, SingeError *error);

/// Replaces the draft's name by that of `path` in the message of an error. A draft of NULL is none.
void file_name_target(SingeError *error, const char *draft, const char *path);

/// Removes a draft. NULL is none.
void file_discard(char *draft);

// ---- meshes

/// Reads a mesh, by the ending of `name` (registry.c), from bytes. `name` is used in messages. Errors have
/// the line (text formats) or byte offset in `element` and in the message: "letter.obj:17: ...". A face may name a
/// vertex twice; indices are in range.
SINGE_NODISCARD SingeResult polygons_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                          Polygons *polygons, SingeError *error);
SINGE_NODISCARD SingeResult obj_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                     Polygons *polygons, SingeError *error);
SINGE_NODISCARD SingeResult ply_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                     Polygons *polygons, SingeError *error);
SINGE_NODISCARD SingeResult stl_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                     Polygons *polygons, SingeError *error);
/// glTF 2 and GLB: triangles of the scene's nodes, with their transforms. Opens the regular files that it refers to, in
/// the folder of `name` and below. Version 1 is passed to assimp_read.
SINGE_NODISCARD SingeResult gltf_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                      Polygons *polygons, SingeError *error);
/// FBX, COLLADA, 3DS, X3D, OFF and glTF 1 by assimp, from a file in memory. Vertices are assimp's, faces as in the file; all
/// of a scene's meshes with their nodes' transforms. assimp runs in a child process with limits (isolate.h): a crash is
/// an error, and so is using more memory than 512 MiB plus 32 times the file's size, or more time than 10 s plus 1 s
/// for each 2 MB. Only regular files in the folder of `name` and below are opened. Call it while there is one thread.
/// It fails in a program built without assimp.
SINGE_NODISCARD SingeResult assimp_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                        Polygons *polygons, SingeError *error);

// ---- pictures

/// The most pixels along a side.
enum { IMAGE_SIDE_LIMIT = 16384 };

/// 8-bit RGB, rows from the top.
typedef struct Image {
    int width, height;
    uint8_t *rgb; ///< [height * width * 3]
    SingeAllocator allocator;
} Image;

/// Reads PNG or JPEG, distinguished by their first bytes; alpha is blended with white. At most 16384 × 16384.
SINGE_NODISCARD SingeResult image_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                       Image *image, SingeError *error);
/// Width and height that a PNG or JPEG file states in its first 64 KB; false if they are not there.
bool image_size(const char *path, int *width, int *height);
/// Writes an 8-bit RGB PNG file, whole or not at all.
SINGE_NODISCARD SingeResult png_write(const char *path, int width, int height, const uint8_t *rgb, SingeError *error);
void image_free(Image *image);

/// Type of a channel of an EXR: 16-bit or 32-bit floats, from floats, or 32-bit integers, from uint32_t.
typedef enum ExrKind { EXR_KIND_HALF, EXR_KIND_FLOAT, EXR_KIND_ID } ExrKind;

typedef struct ExrChannel {
    const char *name; ///< "R", "normal.X"
    ExrKind kind;
    const void *values; ///< of the first pixel, rows from the top
    int stride;         ///< values (of 4 bytes) from pixel to pixel
} ExrChannel;

/// False in a program built without OpenEXR, where exr_write fails.
bool exr_available(void);
/// A text in the file's header.
typedef struct ExrText {
    const char *name, *value;
} ExrText;

/// Writes an EXR file of one part, whole or not at all. Names of channels must differ. `texts` end with a NULL name; NULL:
/// none.
SINGE_NODISCARD SingeResult exr_write(const char *path, int width, int height, const ExrChannel *channels, int count,
                                      const ExrText *texts, SingeError *error);
/// Luminance (Rec. 709 weights of the encoded values, 0 to 1) as the SingeTexture of a parameter; values are allocated
/// with `allocator`, [width * height].
SINGE_NODISCARD SingeResult image_luminance(const Image *image, SingeAllocator allocator, SingeTexture *picture,
                                            SingeError *error);

// ---- the cache: one binary PLY per frame (docs/formats.md)

/// Makes a surface with all that a frame has, zeroed; free with singe_surface_free. False when out of memory.
SINGE_NODISCARD bool surface_new(SingeSurface *surface, uint32_t vertices, uint32_t triangles);

/// Bytes of its file, nearly.
uint64_t ply_surface_size(const SingeSurface *surface);
SINGE_NODISCARD SingeResult ply_write_surface(const char *path, const SingeSurface *surface, double time,
                                              SingeError *error);
/// Reads what ply_write_surface wrote; free with singe_surface_free. *time may be NULL.
SINGE_NODISCARD SingeResult ply_read_surface(const char *name, const uint8_t *bytes, size_t size,
                                             SingeAllocator allocator, SingeSurface *surface, double *time,
                                             SingeError *error);

// ---- the gas: one OpenVDB file per frame (docs/formats.md)

/// Instead of soot and heat release rate, files have quantities that renderers can use unchanged: extinction (1/m), and
/// flame in units of 10 MW/m3, which is 0 to 1 in flames and more in a few cells.
#define GAS_EXTINCTION 8700.0f ///< m2/kg of soot
#define GAS_FLAME_UNIT 1e7f    ///< W/m3

/// A gas that owns its arrays; `view` points at them. `smoke` and `flame` are computed from the file's values.
typedef struct Gas {
    SingeGas view; ///< size 0: none
    float *temperature, *smoke, *flame;
    float *extinction, *flame_share; ///< as in the file
    float (*velocity)[3];
    SingeAllocator allocator;
} Gas;

/// Max number of cells of a Gas.
enum { GAS_CELL_LIMIT = 1 << 23 };

/// Copies a gas as a file stores it: blocks of 8 x 8 x 8 cells without visible smoke, flame or heat become still air at
/// the coolest cell's temperature. SINGE_ERROR_ARGUMENT if a value is not finite, SINGE_ERROR_LIMIT above
/// GAS_CELL_LIMIT cells.
SINGE_NODISCARD SingeResult gas_copy(const SingeGas *gas, SingeAllocator allocator, Gas *copy, SingeError *error);
void gas_free(Gas *gas);

SINGE_NODISCARD SingeResult vdb_write_gas(const char *path, const Gas *gas, double time, SingeError *error);
/// The same in 16-bit floats, for other programs: flame_share is a share of the light, not scaled by metadata.
SINGE_NODISCARD SingeResult vdb_write_fine(const char *path, const Gas *gas, double time, SingeError *error);
/// Reads files of vdb_write_gas and no other VDB files; free with gas_free. *time may be NULL. The result of gas_copy
/// is read back bit for bit.
SINGE_NODISCARD SingeResult vdb_read_gas(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                                         Gas *gas, double *time, SingeError *error);
