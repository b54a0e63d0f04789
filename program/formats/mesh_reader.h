// Shared by the mesh readers.
#ifndef FORMATS_MESH_READER_H
#define FORMATS_MESH_READER_H

#include "formats/formats.h"

/// Limits for files that instance their meshes: bytes of positions, corners and uv, absolute and as a multiple of the
/// size of the file and of the files that it refers to.
enum { MESH_ANSWER_BASE = 16 << 20, MESH_ANSWER_TIMES = 64 };

/// Whether a file's name has this ending (".obj"), in any case.
bool mesh_name_ends(const char *name, const char *ending);

#endif
