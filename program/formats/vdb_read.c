// Reads the OpenVDB files of vdb_write.c, and no others. Everything is validated; tree entries outside the gas are
// refused.
#include "common/store.h"
#include "formats/vdb.h"

#include <string.h>

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
        if (!name.bytes || !type.bytes || !has(r, size)) return vdb_read_bad(r, "metadata are cut off");
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

static SingeResult read_head(Reader *r) {
    if (get_u64(r) != VDB_MAGIC) return vdb_read_bad(r, "not a VDB file");
    if (get_u32(r) != VDB_VERSION) return vdb_read_bad(r, "a VDB file of another version");
    vdb_read_take(r, 8); // of the library
    const uint8_t *offsets = vdb_read_take(r, 1);
    if (!offsets || *offsets != 1 || !vdb_read_take(r, VDB_ID))
        return vdb_read_bad(r, "the head is cut off or has no offsets");
    r->time = (double)NAN;
    TRY(read_metadata(r, true));
    if (!isfinite(r->time) || !gas_cells(&r->gas->view))
        return vdb_read_bad(r, "not a gas of Singe: no time or no size");
    if (r->extinction != (double)GAS_EXTINCTION || r->flame_unit != (double)GAS_FLAME_UNIT)
        return vdb_read_bad(r, "its density or its flame is in other units than those of this version");
    r->gas->view.cell = 1; // set by the grids
    if (!gas_shape_is_good(&r->gas->view)) return vdb_read_bad(r, "more cells than a gas can have");
    if (get_u32(r) != VDB_FIELDS + 1) return vdb_read_bad(r, "other grids than those of Singe");
    return SINGE_OK;
}

// ---- a grid

static SingeResult read_map(Reader *r, bool first) {
    if (!is(get_string(r), VDB_MAP)) return vdb_read_bad(r, "another map than " VDB_MAP);
    double position[3], scale[3];
    for (int c = 0; c < 3; c++) position[c] = get_double(r);
    for (int c = 0; c < 3; c++) scale[c] = get_double(r);
    if (!vdb_read_take(r, 12 * 8)) return vdb_read_bad(r, "the map is cut off");
    SingeGas map = r->gas->view;
    map.cell = (float)scale[0];
    for (int c = 0; c < 3; c++) map.origin[c] = (float)(position[c] - 0.5 * scale[0]);
    if (!gas_shape_is_good(&map) || scale[1] != scale[0] || scale[2] != scale[0]) return vdb_read_bad(r, "a bad map");
    if (first) r->gas->view = map;
    else if (memcmp(map.origin, r->gas->view.origin, sizeof map.origin) != 0 || map.cell != r->gas->view.cell)
        return vdb_read_bad(r, "grids of different maps");
    return SINGE_OK;
}

static bool vdb_read_bit(const uint8_t *mask, uint32_t n) { return mask[n >> 3] >> (n & 7) & 1; }

/// An inner node: returns the mask of its children. It must not have values.
static const uint8_t *take_node(Reader *r, size_t mask_bytes) {
    const uint8_t *node = vdb_read_take(r, 2 * mask_bytes + 1);
    if (!node || node[2 * mask_bytes]) return NULL;
    for (size_t i = 0; i < mask_bytes; i++)
        if (node[mask_bytes + i]) return NULL;
    return node;
}

/// A leaf: its mask from the topology, its values from the buffers.
static SingeResult read_leaf(Reader *r, Reader *buffers, const uint32_t low[3], VdbField field) {
    const SingeGas *gas = &r->gas->view;
    uint32_t width = vdb_fields[field].width;
    float *values = vdb_field(r->gas, field);
    const uint8_t *mask = vdb_read_take(r, VDB_LEAF_MASK), *again = vdb_read_take(buffers, VDB_LEAF_MASK + 1);
    if (!mask || !again || again[VDB_LEAF_MASK] || memcmp(mask, again, VDB_LEAF_MASK) != 0)
        return vdb_read_bad(buffers, "a leaf is cut off, or its masks differ");
    for (uint32_t n = 0; n < 8 * VDB_LEAF_MASK; n++) {
        if (!vdb_read_bit(mask, n)) continue;
        uint32_t x = low[0] + (n >> 6), y = low[1] + (n >> 3 & 7), z = low[2] + (n & 7);
        if (x >= gas->size[0] || y >= gas->size[1] || z >= gas->size[2])
            return vdb_read_bad(r, "a cell outside of the gas");
        if (!has(buffers, 4 * (uint64_t)width)) return vdb_read_bad(buffers, "the values are cut off");
        for (uint32_t k = 0; k < width; k++) {
            float value = get_float(buffers);
            if (!isfinite(value)) return vdb_read_bad(buffers, "a value is not finite");
            values[gas_index(gas, x, y, z) * width + k] = value;
        }
    }
    return SINGE_OK;
}

static SingeResult read_node(Reader *r, Reader *buffers, const uint32_t low[3], VdbField field) {
    const uint8_t *children = take_node(r, VDB_LOWER_MASK);
    if (!children) return vdb_read_bad(r, "a node is cut off or has values of its own");
    for (uint32_t n = 0; n < 8 * VDB_LOWER_MASK; n++) {
        const uint32_t at[3] = {low[0] + (n >> 8) * GAS_BLOCK, low[1] + (n >> 4 & 15) * GAS_BLOCK,
                                low[2] + (n & 15) * GAS_BLOCK};
        if (vdb_read_bit(children, n)) TRY(read_leaf(r, buffers, at, field));
    }
    return SINGE_OK;
}

static SingeResult read_tree(Reader *r, Reader *buffers, VdbField field) {
    bool good = get_u32(r) == 1;
    float background = 0;
    for (uint32_t k = 0; k < vdb_fields[field].width; k++) {
        background = get_float(r);
        good = good && isfinite(background) && (background == 0 || field == VDB_TEMPERATURE);
    }
    uint32_t tiles = get_u32(r), children = get_u32(r);
    if (!good || tiles || children > 1) return vdb_read_bad(r, "the tree's root is not as Singe writes it");
    if (field == VDB_TEMPERATURE) gas_fill(r->gas, background);
    if (!children) return SINGE_OK;
    static const uint8_t zero[12];
    const uint8_t *origin = vdb_read_take(r, 12), *nodes = take_node(r, VDB_UPPER_MASK);
    if (!origin || memcmp(origin, zero, 12) != 0 || !nodes)
        return vdb_read_bad(r, "the tree is cut off or lies elsewhere");
    for (uint32_t n = 0; n < 8 * VDB_UPPER_MASK; n++) {
        enum { SIDE = GAS_BLOCK << VDB_LOWER_LOG };
        const uint32_t low[3] = {(n >> 10) * SIDE, (n >> 5 & 31) * SIDE, (n & 31) * SIDE};
        if (vdb_read_bit(nodes, n)) TRY(read_node(r, buffers, low, field));
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
        return vdb_read_bad(r, "other grids than those of Singe");
    Reader body = *r, buffers = *r;
    body.at = vdb_read_position(r, get_u64(r));
    buffers.at = vdb_read_position(r, get_u64(r));
    const uint8_t *end = vdb_read_position(r, get_u64(r));
    if (!body.at || !buffers.at || !end || end < r->at) return vdb_read_bad(r, "a grid lies outside of the file");
    r->at = end;
    if (get_u32(&body) != VDB_ACTIVE_VALUES) return vdb_read_bad(&body, "another compression than by active values");
    TRY(read_metadata(&body, false));
    TRY(read_map(&body, field == 0));
    return read_tree(&body, &buffers, field);
}

static SingeResult read_all(Reader *r) {
    TRY(read_head(r));
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
