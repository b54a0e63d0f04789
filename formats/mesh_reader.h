// What the mesh readers share.
#ifndef FORMATS_MESH_READER_H
#define FORMATS_MESH_READER_H

#include "formats/formats.h"

/// The largest number of vertices, faces or corners: they are numbered by int32_t.
enum { MESH_COUNT_LIMIT = 0x7fffffff };

/// A file that uses its meshes over and over may come to so many bytes of positions, corners and uv, and so many times
/// its size and that of the files that it refers to.
enum { MESH_ANSWER_BASE = 16 << 20, MESH_ANSWER_TIMES = 64 };

/// Whether a file's name has this ending (".obj"), in capitals or not.
bool mesh_name_ends(const char *name, const char *ending);

#endif
