// The part of the OpenVDB file format that Singe writes and reads.
//
// File, all little-endian; a string is its length (u32) and its bytes:
//     magic (i64), file version 224 (u32), library version (2 u32), 1: grids have offsets (u8), id (36 bytes),
//     metadata, number of grids (u32), then for each grid its name, type and the grid whose tree it shares (strings),
//     the offsets in the file of its body, of its buffers and of its end (3 i64), and there
//     body: compression (u32), metadata, map (a string and 15 doubles), number of buffers (u32, 1), topology
// Metadata: their number (u32), each a name, a type (strings), a size (u32) and the bytes. Topology, depth first: the
// root has its background value, no tiles and at most one child at (0, 0, 0) (2 u32, 3 i32): a node of 32^3 children,
// each a node of 16^3 leaves of 8^3 cells. A node is the mask of its children, the mask of its values and, as the
// compression is by active values alone and there are none, one zero byte; a leaf is the mask of its cells. The buffers
// hold, for each leaf, the mask again, a zero byte and the values of its cells. A node's entries, and a mask's bits
// from the lowest, are numbered with z fastest.
#ifndef FORMATS_VDB_H
#define FORMATS_VDB_H

#include "formats/gas_grid.h"

#define VDB_MAGIC 0x56444220u
enum {
    VDB_VERSION = 224,
    VDB_LIBRARY_MAJOR = 10,
    VDB_LIBRARY_MINOR = 0,
    VDB_ACTIVE_VALUES = 2, ///< compression: values of inactive cells are omitted
    VDB_ID = 36,
    VDB_UPPER_LOG = 5,
    VDB_LOWER_LOG = 4,
    VDB_LEAF_LOG = 3,
    VDB_UPPER_MASK = 1 << (3 * VDB_UPPER_LOG - 3), ///< bytes
    VDB_LOWER_MASK = 1 << (3 * VDB_LOWER_LOG - 3),
    VDB_LEAF_MASK = 1 << (3 * VDB_LEAF_LOG - 3),
};

#define VDB_MAP "UniformScaleTranslateMap"
// metadata for computing smoke and flame from the file's grids
#define VDB_EXTINCTION "extinction_of_soot" ///< m2/kg
#define VDB_FLAME_UNIT "flame_unit"         ///< W/m3

/// The grids of a file, in its order. `vel` is `velocity` under Houdini's name: it shares the tree.
typedef enum VdbField { VDB_DENSITY, VDB_FLAME, VDB_TEMPERATURE, VDB_VELOCITY, VDB_FIELDS } VdbField;

typedef struct VdbFieldInfo {
    const char *name, *type;
    uint32_t width; ///< floats a cell
} VdbFieldInfo;

static const VdbFieldInfo vdb_fields[VDB_FIELDS] = {
    [VDB_DENSITY] = {"density", "Tree_float_5_4_3", 1},
    [VDB_FLAME] = {"flame", "Tree_float_5_4_3", 1},
    [VDB_TEMPERATURE] = {"temperature", "Tree_float_5_4_3", 1},
    [VDB_VELOCITY] = {"velocity", "Tree_vec3s_5_4_3", 3},
};

static inline float *vdb_field(const Gas *gas, VdbField field) {
    float *const arrays[VDB_FIELDS] = {gas->extinction, gas->flame_share, gas->temperature, (float *)gas->velocity};
    return arrays[field];
}

#endif
