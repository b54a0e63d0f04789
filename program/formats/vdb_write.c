// A gas as an OpenVDB file (formats/vdb.h): one leaf for every block of cells that is not still air; all of its cells
// are active.
#include "common/store.h"
#include "formats/vdb.h"

#include <stdio.h>
#include <string.h>

enum { HEADER_MAX = 2048, GRID_MAX = 2048, NODE_SIDE = 1 << VDB_LOWER_LOG };

/// Blocks that are leaves, in the order of the tree; those of a node are contiguous.
typedef struct Leaf {
    uint16_t block[3];
    bool opens; ///< the first of its node
} Leaf;

typedef struct Writer {
    const Gas *gas;
    Leaf *leaves;
    size_t leaf_count, node_count, block_count;
    float coolest;
    bool half; ///< values are 16-bit floats
    uint8_t *begin, *at;
} Writer;

// ---- bytes

static void put_bytes(Writer *w, const void *bytes, size_t size) {
    memcpy(w->at, bytes, size);
    w->at += size;
}

static void put_zeros(Writer *w, size_t size) {
    memset(w->at, 0, size);
    w->at += size;
}

static void put_u32(Writer *w, uint32_t value) {
    store_u32_little(w->at, value);
    w->at += 4;
}

static void put_u64(Writer *w, uint64_t value) {
    put_u32(w, (uint32_t)value);
    put_u32(w, (uint32_t)(value >> 32));
}

static void put_float(Writer *w, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u32(w, bits);
}

/// Rounds to the nearest 16-bit float, ties to even.
static uint16_t to_half(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    bits &= 0x7fffffffu;
    if (bits >= 0x477ff000u) return sign | 0x7bff; // the largest finite number
    if (bits < 0x38800000u) {                      // below 2^-14 they are multiples of 2^-24
        float magnitude;
        memcpy(&magnitude, &bits, sizeof magnitude);
        return sign | (uint16_t)nearbyintf(magnitude * 0x1p24f);
    }
    bits += 0xfffu + (bits >> 13 & 1);
    return sign | (uint16_t)((bits - 0x38000000u) >> 13);
}

static float from_half(uint16_t half) {
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    const float magnitude = exponent ? ldexpf((float)(1024 + fraction), exponent - 25) : ldexpf((float)fraction, -24);
    return half & 0x8000 ? -magnitude : magnitude;
}

static void put_value(Writer *w, float value) {
    if (!w->half) {
        put_float(w, value);
        return;
    }
    const uint16_t half = to_half(value);
    const uint8_t bytes[2] = {(uint8_t)half, (uint8_t)(half >> 8)};
    put_bytes(w, bytes, 2);
}

static void put_double(Writer *w, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u64(w, bits);
}

static void put_string(Writer *w, const char *text) {
    put_u32(w, (uint32_t)strlen(text));
    put_bytes(w, text, strlen(text));
}

// ---- metadata

static void put_text(Writer *w, const char *name, const char *value) {
    put_string(w, name);
    put_string(w, "string");
    put_string(w, value);
}

static void put_triple(Writer *w, const char *name, const uint32_t value[3]) {
    put_string(w, name);
    put_string(w, "vec3i");
    put_u32(w, 12);
    for (int c = 0; c < 3; c++) put_u32(w, value[c]);
}

static void put_number(Writer *w, const char *name, double value) {
    put_string(w, name);
    put_string(w, "double");
    put_u32(w, 8);
    put_double(w, value);
}

static void put_header(Writer *w, double time) {
    put_u64(w, VDB_MAGIC);
    put_u32(w, VDB_VERSION);
    put_u32(w, VDB_LIBRARY_MAJOR);
    put_u32(w, VDB_LIBRARY_MINOR);
    put_bytes(w, "\1", 1);
    put_bytes(w, "00000000-0000-0000-0000-000000000000", VDB_ID); // the same gas gives the same bytes
    put_u32(w, w->half ? 4 : 5);
    put_text(w, "creator", "Singe " SINGE_VERSION);
    put_triple(w, "size", w->gas->view.size);
    put_number(w, "time", time);
    put_number(w, VDB_EXTINCTION, (double)GAS_EXTINCTION);
    if (!w->half) put_number(w, VDB_FLAME_UNIT, (double)GAS_FLAME_UNIT);
    put_u32(w, VDB_FIELDS + 1);
}

/// Lets a program identify a grid from its first kilobyte.
static void put_grid_metadata(Writer *w, const char *name, bool vector) {
    uint32_t low[3] = {UINT32_MAX, UINT32_MAX, UINT32_MAX}, high[3] = {0, 0, 0};
    uint64_t cells = 0;
    for (size_t i = 0; i < w->leaf_count; i++) {
        uint32_t block[3], from[3], to[3], volume = 1;
        for (int c = 0; c < 3; c++) block[c] = w->leaves[i].block[c];
        gas_block_box(&w->gas->view, block, from, to);
        for (int c = 0; c < 3; c++) {
            low[c] = from[c] < low[c] ? from[c] : low[c];
            high[c] = to[c] - 1 > high[c] ? to[c] - 1 : high[c];
            volume *= to[c] - from[c];
        }
        cells += volume;
    }
    put_u32(w, (w->leaf_count ? 6u : 4u) + w->half);
    if (w->half) {
        put_string(w, "is_saved_as_half_float");
        put_string(w, "bool");
        put_u32(w, 1);
        put_bytes(w, "\1", 1);
    }
    put_text(w, "name", name);
    if (vector) put_text(w, "vector_type", "contravariant relative");
    else put_text(w, "class", "fog volume");
    put_text(w, "file_compression", "active values");
    put_string(w, "file_voxel_count");
    put_string(w, "int64");
    put_u32(w, 8);
    put_u64(w, cells);
    if (!w->leaf_count) return;
    put_triple(w, "file_bbox_min", low);
    put_triple(w, "file_bbox_max", high);
}

/// Index to position: cell (0, 0, 0) has its centre half a cell from the origin.
static void put_map(Writer *w) {
    const SingeGas *gas = &w->gas->view;
    double cell = (double)gas->cell;
    put_string(w, VDB_MAP);
    for (int c = 0; c < 3; c++) put_double(w, (double)gas->origin[c] + 0.5 * cell);
    const double powers[5] = {cell, cell, 1 / cell, 1 / (cell * cell), 0.5 / cell};
    for (int k = 0; k < 5; k++)
        for (int c = 0; c < 3; c++) put_double(w, powers[k]);
}

// ---- the tree

static void set_bit(uint8_t *mask, uint32_t x, uint32_t y, uint32_t z, int log) {
    uint32_t n = (x << 2 * log) + (y << log) + z;
    mask[n >> 3] |= (uint8_t)(1 << (n & 7));
}

static bool vdb_write_bit(const uint8_t *mask, uint32_t n) { return mask[n >> 3] >> (n & 7) & 1; }

static void leaf_mask(const Writer *w, const Leaf *leaf, uint8_t mask[VDB_LEAF_MASK]) {
    uint32_t block[3] = {leaf->block[0], leaf->block[1], leaf->block[2]}, low[3], high[3];
    gas_block_box(&w->gas->view, block, low, high);
    memset(mask, 0, VDB_LEAF_MASK);
    for (uint32_t x = 0; x < high[0] - low[0]; x++)
        for (uint32_t y = 0; y < high[1] - low[1]; y++)
            for (uint32_t z = 0; z < high[2] - low[2]; z++) set_bit(mask, x, y, z, VDB_LEAF_LOG);
}

/// The masks of an inner node: children, then values, of which there are none.
static uint8_t *put_node(Writer *w, size_t mask_bytes) {
    uint8_t *children = w->at;
    put_zeros(w, 2 * mask_bytes + 1);
    return children;
}

static void put_topology(Writer *w, const VdbFieldInfo *field) {
    put_u32(w, 1);                                                             // buffers a leaf
    const float still = w->half ? from_half(to_half(w->coolest)) : w->coolest; // the background, a whole float anyway
    for (uint32_t k = 0; k < field->width; k++) put_float(w, field == &vdb_fields[VDB_TEMPERATURE] ? still : 0);
    put_u32(w, 0); // tiles
    put_u32(w, w->leaf_count > 0);
    if (!w->leaf_count) return;
    put_zeros(w, 12);
    uint8_t *upper = put_node(w, VDB_UPPER_MASK), *lower = NULL;
    for (size_t i = 0; i < w->leaf_count; i++) {
        const Leaf *leaf = &w->leaves[i];
        const uint16_t *b = leaf->block;
        if (leaf->opens) {
            set_bit(upper, b[0] / NODE_SIDE, b[1] / NODE_SIDE, b[2] / NODE_SIDE, VDB_UPPER_LOG);
            lower = put_node(w, VDB_LOWER_MASK);
        }
        set_bit(lower, b[0] % NODE_SIDE, b[1] % NODE_SIDE, b[2] % NODE_SIDE, VDB_LOWER_LOG);
        leaf_mask(w, leaf, w->at);
        w->at += VDB_LEAF_MASK;
    }
}

static void put_buffers(Writer *w, VdbField field) {
    const SingeGas *gas = &w->gas->view;
    const float *values = vdb_field(w->gas, field);
    uint32_t width = vdb_fields[field].width;
    for (size_t i = 0; i < w->leaf_count; i++) {
        uint8_t mask[VDB_LEAF_MASK];
        leaf_mask(w, &w->leaves[i], mask);
        put_bytes(w, mask, sizeof mask);
        put_zeros(w, 1);
        const uint16_t *b = w->leaves[i].block;
        for (uint32_t n = 0; n < GAS_BLOCK * GAS_BLOCK * GAS_BLOCK; n++) {
            if (!vdb_write_bit(mask, n)) continue;
            size_t cell = gas_index(gas, b[0] * GAS_BLOCK + (n >> 6), b[1] * GAS_BLOCK + (n >> 3 & 7),
                                    b[2] * GAS_BLOCK + (n & 7));
            for (uint32_t k = 0; k < width; k++) put_value(w, values[cell * width + k]);
        }
    }
}

/// A grid with its tree, or, if `parent` is given, one that shares the parent's.
static void put_grid(Writer *w, const char *name, VdbField field, const char *parent) {
    put_string(w, name);
    char type[64];
    snprintf(type, sizeof type, "%s%s", vdb_fields[field].type, w->half ? "_HalfFloat" : "");
    put_string(w, type);
    put_string(w, parent);
    uint8_t *locations = w->at;
    w->at += 24;
    uint64_t body = (uint64_t)(w->at - w->begin);
    put_u32(w, VDB_ACTIVE_VALUES);
    put_grid_metadata(w, name, vdb_fields[field].width == 3);
    put_map(w);
    if (!*parent) put_topology(w, &vdb_fields[field]);
    uint64_t buffers = (uint64_t)(w->at - w->begin);
    if (!*parent) put_buffers(w, field);
    uint8_t *end = w->at;
    w->at = locations;
    put_u64(w, body);
    put_u64(w, buffers);
    put_u64(w, (uint64_t)(end - w->begin));
    w->at = end;
}

// ---- the file

/// Collects the leaves of one node of 16 x 16 x 16 blocks.
static void find_leaves(Writer *w, const uint32_t node[3]) {
    const uint32_t *n = w->gas->view.size;
    bool opens = true;
    for (uint32_t i = 0; i < NODE_SIDE * NODE_SIDE * NODE_SIDE; i++) {
        uint32_t block[3] = {node[0] * NODE_SIDE + (i >> 8), node[1] * NODE_SIDE + (i >> 4 & 15),
                             node[2] * NODE_SIDE + (i & 15)};
        if (block[0] * GAS_BLOCK >= n[0] || block[1] * GAS_BLOCK >= n[1] || block[2] * GAS_BLOCK >= n[2]) continue;
        if (!gas_block_holds(&w->gas->view, block, w->coolest)) continue;
        w->leaves[w->leaf_count++] =
            (Leaf){{(uint16_t)block[0], (uint16_t)block[1], (uint16_t)block[2]}, .opens = opens};
        w->node_count += opens;
        opens = false;
    }
}

static void find_tree(Writer *w) {
    const uint32_t side = NODE_SIDE * GAS_BLOCK, *n = w->gas->view.size;
    uint32_t node[3];
    for (node[0] = 0; node[0] * side < n[0]; node[0]++)
        for (node[1] = 0; node[1] * side < n[1]; node[1]++)
            for (node[2] = 0; node[2] * side < n[2]; node[2]++) find_leaves(w, node);
}

/// Max bytes of the whole file.
static size_t size_max(const Writer *w) {
    size_t leaf = 2 * VDB_LEAF_MASK + 1, cells = GAS_BLOCK * GAS_BLOCK * GAS_BLOCK, all = HEADER_MAX + GRID_MAX;
    for (int f = 0; f < VDB_FIELDS; f++)
        all += GRID_MAX + 2 * VDB_UPPER_MASK + w->node_count * (2 * VDB_LOWER_MASK + 1) +
               w->leaf_count * (leaf + cells * vdb_fields[f].width * 4);
    return all;
}

static SingeResult write_file(Writer *w, const char *path, double time, SingeError *error) {
    size_t max = size_max(w);
    w->begin = w->at = store_new(w->gas->allocator, max, 1);
    if (!w->begin) return refuse_memory(error, "gas", path);
    put_header(w, time);
    for (int f = 0; f < VDB_FIELDS; f++) put_grid(w, vdb_fields[f].name, (VdbField)f, "");
    put_grid(w, "vel", VDB_VELOCITY, vdb_fields[VDB_VELOCITY].name);
    SingeResult result = file_write(path, w->begin, (size_t)(w->at - w->begin), error);
    store_free(w->gas->allocator, w->begin, max, 1);
    return result;
}

static SingeResult write_gas(const char *path, const Gas *gas, double time, bool half, SingeError *error) {
    if (!isfinite(time))
        return refuse(error, SINGE_ERROR_ARGUMENT, "gas", -1, "%s: the time is not finite", short_name(path));
    if (!gas_cells(&gas->view) || !gas_shape_is_good(&gas->view))
        return refuse(error, SINGE_ERROR_ARGUMENT, "gas", -1, "%s: no gas, or too much", short_name(path));
    Writer writer = {.gas = gas, .half = half, .coolest = gas_coolest(&gas->view), .block_count = 1};
    for (int c = 0; c < 3; c++) writer.block_count *= (gas->view.size[c] + GAS_BLOCK - 1) / GAS_BLOCK;
    writer.leaves = store_new(gas->allocator, writer.block_count, sizeof *writer.leaves);
    if (!writer.leaves) return refuse_memory(error, "gas", path);
    find_tree(&writer);
    SingeResult result = write_file(&writer, path, time, error);
    store_free(gas->allocator, writer.leaves, writer.block_count, sizeof *writer.leaves);
    return result;
}

SingeResult vdb_write_gas(const char *path, const Gas *gas, double time, SingeError *error) {
    return write_gas(path, gas, time, false, error);
}

SingeResult vdb_write_fine(const char *path, const Gas *gas, double time, SingeError *error) {
    return write_gas(path, gas, time, true, error);
}
