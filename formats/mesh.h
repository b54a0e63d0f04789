// What the mesh readers share.
#ifndef FORMATS_MESH_H
#define FORMATS_MESH_H

#include "formats.h"

/// The largest number of vertices or cells: they are numbered by int32_t.
enum { MESH_COUNT_LIMIT = 0x7fffffff };

/// A corner of a cell that names a vertex twice, or -1.
static inline int mesh_cell_repeats(const uint32_t c[4]) {
    if (c[1] == c[0]) return 1;
    if (c[2] == c[0] || c[2] == c[1]) return 2;
    return c[3] == c[0] || c[3] == c[1] || c[3] == c[2] ? 3 : -1;
}

#endif
