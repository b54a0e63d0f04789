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
#include "formats/gas_grid.h"
#include "formats/sink.h"

#include <stdio.h>
#include <string.h>

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

static bool vdb_bit(const uint8_t *mask, uint32_t n) { return mask[n >> 3] >> (n & 7) & 1; }

// ---- writing: one leaf for every block of cells that is not still air; all of its cells are active

enum { NODE_SIDE = 1 << VDB_LOWER_LOG };

/// Blocks that are leaves, in the order of the tree; those of a node are contiguous.
typedef struct Leaf {
    uint16_t block[3];
    bool opens; ///< the first of its node
} Leaf;

typedef struct Writer {
    const Gas *gas;
    Leaf *leaves;
    size_t leaf_count, block_count;
    float coolest;
    bool half; ///< values are 16-bit floats
    Sink sink;
} Writer;

/// Rounds to the nearest 16-bit float, ties to even.
static uint16_t to_half(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    bits &= 0x7fffffffu;
    if (bits >= 0x477ff000u) return sign | 0x7bff; // the largest finite number

    if (bits < 0x38800000u) { // below 2^-14 they are multiples of 2^-24
        float magnitude;
        memcpy(&magnitude, &bits, sizeof magnitude);
        return sign | (uint16_t)nearbyintf(magnitude * 0x1p24f);
    }

    bits += 0xfffu + (bits >> 13 & 1);
    return sign | (uint16_t)((bits - 0x38000000u) >> 13);
}

static void put_string(Sink *sink, const char *text) {
    sink_u32(sink, (uint32_t)strlen(text));
    sink_bytes(sink, text, strlen(text));
}

/// The head of a value of `size` bytes, which follow.
static void put_metadata(Sink *sink, const char *name, const char *type, size_t size) {
    put_string(sink, name);
    put_string(sink, type);
    sink_u32(sink, (uint32_t)size);
}

static void put_text(Sink *sink, const char *name, const char *value) {
    put_metadata(sink, name, "string", strlen(value));
    sink_bytes(sink, value, strlen(value));
}

static void put_triple(Sink *sink, const char *name, const uint32_t value[3]) {
    put_metadata(sink, name, "vec3i", 12);
    sink_words(sink, value, 3);
}

static void put_number(Sink *sink, const char *name, double value) {
    put_metadata(sink, name, "double", 8);
    sink_double(sink, value);
}

// ---- the tree

static void set_bit(uint8_t *mask, uint32_t x, uint32_t y, uint32_t z, int log) {
    uint32_t n = (x << 2 * log) + (y << log) + z;
    mask[n >> 3] |= (uint8_t)(1 << (n & 7));
}

static void leaf_mask(const Writer *w, const Leaf *leaf, uint8_t mask[VDB_LEAF_MASK]) {
    uint32_t block[3] = {leaf->block[0], leaf->block[1], leaf->block[2]}, low[3], high[3];
    gas_block_box(&w->gas->view, block, low, high);
    memset(mask, 0, VDB_LEAF_MASK);
    for (uint32_t x = 0; x < high[0] - low[0]; x++)
        for (uint32_t y = 0; y < high[1] - low[1]; y++)
            for (uint32_t z = 0; z < high[2] - low[2]; z++) set_bit(mask, x, y, z, VDB_LEAF_LOG);
}

static void put_topology(Writer *w, const VdbFieldInfo *field) {
    Sink *sink = &w->sink;
    sink_u32(sink, 1);        // buffers a leaf
    float still = w->coolest; // the background, a whole float anyway
    if (w->half) {
        const uint16_t half = to_half(w->coolest);
        const int exponent = half >> 10 & 31, fraction = half & 1023;
        still = exponent ? ldexpf((float)(1024 + fraction), exponent - 25) : ldexpf((float)fraction, -24);
        if (half & 0x8000) still = -still;
    }

    if (field != &vdb_fields[VDB_TEMPERATURE]) still = 0;
    for (uint32_t k = 0; k < field->width; k++) sink_words(sink, &still, 1);
    sink_u32(sink, 0); // tiles
    sink_u32(sink, w->leaf_count > 0);
    if (!w->leaf_count) return;
    sink_zeros(sink, 12);

    // nodes: the mask of the children, and that of the values, of which there are none. The sink may move while it grows
    const size_t upper = sink->size;
    size_t lower = 0;
    sink_zeros(sink, 2 * VDB_UPPER_MASK + 1);
    for (size_t i = 0; i < w->leaf_count; i++) {
        const Leaf *leaf = &w->leaves[i];
        const uint16_t *b = leaf->block;
        if (leaf->opens) {
            lower = sink->size;
            sink_zeros(sink, 2 * VDB_LOWER_MASK + 1);
        }

        uint8_t *mask = sink_room(sink, VDB_LEAF_MASK);
        if (!mask) return;
        leaf_mask(w, leaf, mask);
        set_bit(sink->bytes + upper, b[0] / NODE_SIDE, b[1] / NODE_SIDE, b[2] / NODE_SIDE, VDB_UPPER_LOG);
        set_bit(sink->bytes + lower, b[0] % NODE_SIDE, b[1] % NODE_SIDE, b[2] % NODE_SIDE, VDB_LOWER_LOG);
    }
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

    Sink *sink = &w->sink;
    sink_u32(sink, (w->leaf_count ? 6u : 4u) + w->half);
    if (w->half) {
        put_metadata(sink, "is_saved_as_half_float", "bool", 1);
        sink_bytes(sink, "\1", 1);
    }

    put_text(sink, "name", name);
    if (vector) put_text(sink, "vector_type", "contravariant relative");
    else put_text(sink, "class", "fog volume");
    put_text(sink, "file_compression", "active values");
    put_metadata(sink, "file_voxel_count", "int64", 8);
    sink_u64(sink, cells);
    if (w->leaf_count) {
        put_triple(sink, "file_bbox_min", low);
        put_triple(sink, "file_bbox_max", high);
    }
}

/// A grid with its tree, or, if `parent` is given, one that shares the parent's.
static void put_grid(Writer *w, const char *name, VdbField field, const char *parent) {
    Sink *sink = &w->sink;
    char type[64];
    snprintf(type, sizeof type, "%s%s", vdb_fields[field].type, w->half ? "_HalfFloat" : "");
    put_string(sink, name);
    put_string(sink, type);
    put_string(sink, parent);

    const size_t locations = sink->size;
    sink_zeros(sink, 24);
    const size_t body = sink->size;
    sink_u32(sink, VDB_ACTIVE_VALUES);
    put_grid_metadata(w, name, vdb_fields[field].width == 3);

    // index to position: cell (0, 0, 0) has its centre half a cell from the origin
    const SingeGas *gas = &w->gas->view;
    double cell = (double)gas->cell;
    put_string(sink, VDB_MAP);
    for (int c = 0; c < 3; c++) sink_double(sink, (double)gas->origin[c] + 0.5 * cell);
    const double powers[5] = {cell, cell, 1 / cell, 1 / (cell * cell), 0.5 / cell};
    for (int k = 0; k < 5; k++)
        for (int c = 0; c < 3; c++) sink_double(sink, powers[k]);

    if (!*parent) put_topology(w, &vdb_fields[field]);
    const size_t buffers = sink->size;
    const uint32_t width = vdb_fields[field].width;
    for (size_t i = 0; i < w->leaf_count && !*parent; i++) {
        uint8_t mask[VDB_LEAF_MASK];
        leaf_mask(w, &w->leaves[i], mask);
        sink_bytes(sink, mask, sizeof mask);
        sink_zeros(sink, 1);
        const uint16_t *b = w->leaves[i].block;
        for (uint32_t n = 0; n < GAS_BLOCK * GAS_BLOCK * GAS_BLOCK; n++) {
            if (!vdb_bit(mask, n)) continue;
            const size_t at = gas_index(gas, b[0] * GAS_BLOCK + (n >> 6), b[1] * GAS_BLOCK + (n >> 3 & 7),
                                        b[2] * GAS_BLOCK + (n & 7));
            const float *values = vdb_field(w->gas, field) + at * width;
            if (!w->half) sink_words(sink, values, width);
            for (uint32_t k = 0; w->half && k < width; k++) sink_u16(sink, to_half(values[k]));
        }
    }

    // where they are; the sink may have failed
    const size_t end = sink->size;
    if (sink->failed) return;
    sink->size = locations;
    sink_u64(sink, body);
    sink_u64(sink, buffers);
    sink_u64(sink, end);
    sink->size = end;
}

// ---- the file

static SingeResult write_gas(const char *path, const Gas *gas, double time, bool half, SingeError *error) {
    if (!isfinite(time))
        return refuse(error, SINGE_ERROR_ARGUMENT, "gas", -1, "%s: the time is not finite", short_name(path));
    if (!gas_cells(&gas->view) || !gas_shape_is_good(&gas->view))
        return refuse(error, SINGE_ERROR_ARGUMENT, "gas", -1, "%s: the gas has no cells, or too many",
                      short_name(path));

    Writer writer = {.gas = gas, .half = half, .coolest = gas_coolest(&gas->view), .block_count = 1};
    for (int c = 0; c < 3; c++) writer.block_count *= (gas->view.size[c] + GAS_BLOCK - 1) / GAS_BLOCK;
    writer.leaves = store_new(gas->allocator, writer.block_count, sizeof *writer.leaves);
    if (!writer.leaves) return refuse_memory(error, "gas", path);

    // the leaves, node after node of 16 x 16 x 16 blocks
    const uint32_t side = NODE_SIDE * GAS_BLOCK, *n = gas->view.size;
    uint32_t node[3];
    for (node[0] = 0; node[0] * side < n[0]; node[0]++)
        for (node[1] = 0; node[1] * side < n[1]; node[1]++)
            for (node[2] = 0; node[2] * side < n[2]; node[2]++) {
                bool opens = true;
                for (uint32_t i = 0; i < NODE_SIDE * NODE_SIDE * NODE_SIDE; i++) {
                    uint32_t at[3] = {node[0] * NODE_SIDE + (i >> 8), node[1] * NODE_SIDE + (i >> 4 & 15),
                                      node[2] * NODE_SIDE + (i & 15)};
                    if (at[0] * GAS_BLOCK >= n[0] || at[1] * GAS_BLOCK >= n[1] || at[2] * GAS_BLOCK >= n[2]) continue;
                    if (!gas_block_holds(&writer.gas->view, at, writer.coolest)) continue;
                    writer.leaves[writer.leaf_count++] =
                        (Leaf){{(uint16_t)at[0], (uint16_t)at[1], (uint16_t)at[2]}, .opens = opens};
                    opens = false;
                }
            }

    // the file
    Sink *sink = &writer.sink;
    sink->allocator = gas->allocator;
    sink_u64(sink, VDB_MAGIC);
    sink_u32(sink, VDB_VERSION);
    sink_u32(sink, VDB_LIBRARY_MAJOR);
    sink_u32(sink, VDB_LIBRARY_MINOR);
    sink_bytes(sink, "\1", 1);
    sink_bytes(sink, "00000000-0000-0000-0000-000000000000", VDB_ID); // the same gas gives the same bytes
    sink_u32(sink, half ? 4 : 5);
    put_text(sink, "creator", "Singe " SINGE_VERSION);
    put_triple(sink, "size", gas->view.size);
    put_number(sink, "time", time);
    put_number(sink, VDB_EXTINCTION, (double)GAS_EXTINCTION);
    if (!half) put_number(sink, VDB_FLAME_UNIT, (double)GAS_FLAME_UNIT);
    sink_u32(sink, VDB_FIELDS + 1);

    for (int f = 0; f < VDB_FIELDS; f++) put_grid(&writer, vdb_fields[f].name, (VdbField)f, "");
    put_grid(&writer, "vel", VDB_VELOCITY, vdb_fields[VDB_VELOCITY].name);
    SingeResult result = sink_write(sink, path, error);
    store_free(gas->allocator, writer.leaves, writer.block_count, sizeof *writer.leaves);
    return result;
}

SingeResult vdb_write_gas(const char *path, const Gas *gas, double time, SingeError *error) {
    return write_gas(path, gas, time, false, error);
}

SingeResult vdb_write_fine(const char *path, const Gas *gas, double time, SingeError *error) {
    return write_gas(path, gas, time, true, error);
}

// ---- reading: files of vdb_write_gas and no others; everything is validated

typedef struct Reader {
    const char *name;
    const uint8_t *begin, *at, *end;
    Gas *gas;
    double time, extinction, flame_unit;
    SingeError *error;
} Reader;

static SingeResult vdb_read_bad(const Reader *r, const char *what) {
    return refuse(r->error, SINGE_ERROR_FORMAT, "gas", r->at - r->begin, "%s: at byte %lld: %s", short_name(r->name),
                  (long long)(r->at - r->begin), what);
}

// ---- bytes; reads past the end give 0 and leave `at` beyond it

static bool has(const Reader *r, uint64_t size) { return (uint64_t)(r->end - r->at) >= size; }

static const uint8_t *vdb_read_take(Reader *r, uint64_t size) {
    if (!has(r, size)) {
        r->at = r->end;
        return NULL;
    }
    const uint8_t *p = r->at;
    r->at += size;
    return p;
}

static uint32_t get_u32(Reader *r) {
    const uint8_t *p = vdb_read_take(r, 4);
    return p ? load_u32_little(p) : 0;
}

static uint64_t get_u64(Reader *r) {
    uint64_t low = get_u32(r);
    return low | (uint64_t)get_u32(r) << 32;
}

static float get_float(Reader *r) {
    uint32_t bits = get_u32(r);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static double get_double(Reader *r) {
    uint64_t bits = get_u64(r);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

typedef struct Text {
    const uint8_t *bytes; ///< NULL past the end
    uint32_t size;
} Text;

static Text get_string(Reader *r) {
    if (!has(r, 4)) return (Text){NULL, 0};
    uint32_t size = get_u32(r);
    return (Text){vdb_read_take(r, size), size};
}

static bool is(Text text, const char *word) {
    return text.bytes && text.size == strlen(word) && memcmp(text.bytes, word, text.size) == 0;
}

// ---- the file's head

/// Reads the metadata; keeps time and size from the file's metadata.
static SingeResult read_metadata(Reader *r, bool of_file) {
    uint32_t count = get_u32(r);
    for (uint32_t i = 0; i < count; i++) {
        Text name = get_string(r), type = get_string(r);
        uint32_t size = get_u32(r);
        if (!name.bytes || !type.bytes || !has(r, size)) return vdb_read_bad(r, "the metadata is truncated");
        Reader value = *r;
        r->at += size;
        if (of_file && is(name, "time") && is(type, "double") && size == 8) r->time = get_double(&value);
        if (of_file && is(name, VDB_EXTINCTION) && is(type, "double") && size == 8) r->extinction = get_double(&value);
        if (of_file && is(name, VDB_FLAME_UNIT) && is(type, "double") && size == 8) r->flame_unit = get_double(&value);
        if (of_file && is(name, "size") && is(type, "vec3i") && size == 12)
            for (int c = 0; c < 3; c++) r->gas->view.size[c] = get_u32(&value);
    }

    return SINGE_OK;
}

// ---- a grid

/// An inner node: returns the mask of its children. It must not have values.
static const uint8_t *take_node(Reader *r, size_t mask_bytes) {
    const uint8_t *node = vdb_read_take(r, 2 * mask_bytes + 1);
    if (!node || node[2 * mask_bytes]) return NULL;
    for (size_t i = 0; i < mask_bytes; i++)
        if (node[mask_bytes + i]) return NULL;
    return node;
}

static SingeResult read_node(Reader *r, Reader *buffers, const uint32_t low[3], VdbField field) {
    const uint8_t *children = take_node(r, VDB_LOWER_MASK);
    if (!children) return vdb_read_bad(r, "a node is truncated, or has values of its own");

    for (uint32_t n = 0; n < 8 * VDB_LOWER_MASK; n++) {
        const uint32_t at[3] = {low[0] + (n >> 8) * GAS_BLOCK, low[1] + (n >> 4 & 15) * GAS_BLOCK,
                                low[2] + (n & 15) * GAS_BLOCK};
        if (vdb_bit(children, n)) {
            // a leaf: its mask from the topology, its values from the buffers
            const SingeGas *gas = &r->gas->view;
            uint32_t width = vdb_fields[field].width;
            float *to = vdb_field(r->gas, field);
            const uint8_t *mask = vdb_read_take(r, VDB_LEAF_MASK), *again = vdb_read_take(buffers, VDB_LEAF_MASK + 1);
            if (!mask || !again || again[VDB_LEAF_MASK] || memcmp(mask, again, VDB_LEAF_MASK) != 0)
                return vdb_read_bad(buffers, "a leaf is truncated, or its masks differ");
            for (uint32_t cell = 0; cell < 8 * VDB_LEAF_MASK; cell++) {
                if (!vdb_bit(mask, cell)) continue;
                uint32_t x = at[0] + (cell >> 6), y = at[1] + (cell >> 3 & 7), z = at[2] + (cell & 7);
                if (x >= gas->size[0] || y >= gas->size[1] || z >= gas->size[2])
                    return vdb_read_bad(r, "a cell lies outside the gas");
                if (!has(buffers, 4 * (uint64_t)width)) return vdb_read_bad(buffers, "the values are truncated");
                for (uint32_t k = 0; k < width; k++) {
                    float value = get_float(buffers);
                    if (!isfinite(value)) return vdb_read_bad(buffers, "a value is not finite");
                    to[gas_index(gas, x, y, z) * width + k] = value;
                }
            }
        }
    }

    return SINGE_OK;
}

/// A pointer into the file; NULL if outside.
static const uint8_t *vdb_read_position(const Reader *r, uint64_t offset) {
    return offset <= (uint64_t)(r->end - r->begin) ? r->begin + offset : NULL;
}

static SingeResult read_grid(Reader *r, VdbField field) {
    if (!is(get_string(r), vdb_fields[field].name) || !is(get_string(r), vdb_fields[field].type) ||
        !is(get_string(r), ""))
        return vdb_read_bad(r, "unexpected grids");
    Reader body = *r, buffers = *r;
    body.at = vdb_read_position(r, get_u64(r));
    buffers.at = vdb_read_position(r, get_u64(r));

    const uint8_t *end = vdb_read_position(r, get_u64(r));
    if (!body.at || !buffers.at || !end || end < r->at) return vdb_read_bad(r, "a grid lies outside the file");
    r->at = end;
    if (get_u32(&body) != VDB_ACTIVE_VALUES) return vdb_read_bad(&body, "unsupported compression");
    TRY(read_metadata(&body, false));

    if (!is(get_string(&body), VDB_MAP)) return vdb_read_bad(&body, "unsupported map; expected " VDB_MAP);
    double position[3], scale[3];
    for (int c = 0; c < 3; c++) position[c] = get_double(&body);
    for (int c = 0; c < 3; c++) scale[c] = get_double(&body);
    if (!vdb_read_take(&body, 12 * 8)) return vdb_read_bad(&body, "the map is truncated");

    SingeGas map = body.gas->view;
    map.cell = (float)scale[0];
    for (int c = 0; c < 3; c++) map.origin[c] = (float)(position[c] - 0.5 * scale[0]);
    if (!gas_shape_is_good(&map) || scale[1] != scale[0] || scale[2] != scale[0])
        return vdb_read_bad(&body, "invalid map");
    if (field == 0) body.gas->view = map;
    else if (memcmp(map.origin, body.gas->view.origin, sizeof map.origin) != 0 || map.cell != body.gas->view.cell)
        return vdb_read_bad(&body, "the grids have different maps");

    bool good = get_u32(&body) == 1;
    float background = 0;

    for (uint32_t k = 0; k < vdb_fields[field].width; k++) {
        background = get_float(&body);
        good = good && isfinite(background) && (background == 0 || field == VDB_TEMPERATURE);
    }

    uint32_t tiles = get_u32(&body), children = get_u32(&body);
    if (!good || tiles || children > 1) return vdb_read_bad(&body, "unexpected root of the tree");
    if (field == VDB_TEMPERATURE) gas_fill(body.gas, background);
    if (!children) return SINGE_OK;
    static const uint8_t zero[12];

    const uint8_t *origin = vdb_read_take(&body, 12), *nodes = take_node(&body, VDB_UPPER_MASK);
    if (!origin || memcmp(origin, zero, 12) != 0 || !nodes)
        return vdb_read_bad(&body, "the tree is truncated or misplaced");

    for (uint32_t n = 0; n < 8 * VDB_UPPER_MASK; n++) {
        enum { SIDE = GAS_BLOCK << VDB_LOWER_LOG };
        const uint32_t low[3] = {(n >> 10) * SIDE, (n >> 5 & 31) * SIDE, (n & 31) * SIDE};
        if (vdb_bit(nodes, n)) TRY(read_node(&body, &buffers, low, field));
    }

    return SINGE_OK;
}

static SingeResult read_all(Reader *r) {
    if (get_u64(r) != VDB_MAGIC) return vdb_read_bad(r, "not a VDB file");
    if (get_u32(r) != VDB_VERSION) return vdb_read_bad(r, "unsupported version of VDB");
    vdb_read_take(r, 8); // of the library
    const uint8_t *offsets = vdb_read_take(r, 1);
    if (!offsets || *offsets != 1 || !vdb_read_take(r, VDB_ID))
        return vdb_read_bad(r, "the header is truncated, or has no offsets");
    r->time = (double)NAN;
    TRY(read_metadata(r, true));
    if (!isfinite(r->time) || !gas_cells(&r->gas->view))
        return vdb_read_bad(r, "not a gas of Singe: no time or no size");
    if (r->extinction != (double)GAS_EXTINCTION || r->flame_unit != (double)GAS_FLAME_UNIT)
        return vdb_read_bad(r, "density or flame has the units of another version of Singe");
    r->gas->view.cell = 1; // set by the grids
    if (!gas_shape_is_good(&r->gas->view)) return vdb_read_bad(r, "more cells than a gas can have");
    if (get_u32(r) != VDB_FIELDS + 1) return vdb_read_bad(r, "unexpected grids");

    TRY(gas_make(r->gas, r->name, 0, r->error));
    for (int f = 0; f < VDB_FIELDS; f++) TRY(read_grid(r, (VdbField)f));
    return gas_decode(r->gas) ? SINGE_OK : vdb_read_bad(r, "a value is not finite");
}

SingeResult vdb_read_gas(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Gas *gas,
                         double *time, SingeError *error) {
    *gas = (Gas){.allocator = allocator};
    Reader reader = {.name = name, .begin = bytes, .at = bytes, .end = bytes + size, .gas = gas, .error = error};
    SingeResult result = read_all(&reader);
    if (result) gas_free(gas);
    else if (time) *time = reader.time;
    return result;
}
