// OpenUSD's binary files ("crate", version 0.8.0), as far as frames need them, written without OpenUSD.
//
// A file is a header, values as they come, and sections that a table at the end points at:
//     TOKENS     the words that all names are numbers of
//     FIELDS     pairs of a token and a value
//     FIELDSETS  lists of fields, each ended by 0xffffffff
//     PATHS      the tree of prims and properties, depth first
//     SPECS      of each path its fields and its kind
// A value is 64 bits: flags (array, inlined, compressed) in bits 63 to 61, the type in 48 to 55, and in the lower 48
// the value or where it lies. Integers are packed as differences (crate_ints), these by LZ4; single floats may be
// numbers of a table of the values that occur (crate_floats). All is little-endian.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "formats/sink.h"

typedef uint64_t CrateValue;

typedef enum CrateType {
    CRATE_BOOL = 1,
    CRATE_INT = 3,
    CRATE_FLOAT = 8,
    CRATE_DOUBLE = 9,
    CRATE_TOKEN = 11,
    CRATE_VEC2F = 20,
    CRATE_VEC3F = 24,
    CRATE_TOKENS = 41,
    CRATE_SPECIFIER = 42,
    CRATE_VARIABILITY = 44,
    CRATE_SAMPLES = 46,
    CRATE_DOUBLES = 48,
} CrateType;

typedef enum CrateSpec { CRATE_ATTRIBUTE = 1, CRATE_PRIM = 6, CRATE_ROOT = 7 } CrateSpec;

typedef struct CrateField {
    const char *name;
    CrateValue value;
} CrateField;

typedef struct CratePath {
    uint32_t token, parent;
    bool property;
} CratePath;
typedef struct CrateSpecRow {
    uint32_t path, fields;
    CrateSpec kind;
} CrateSpecRow;

typedef struct Crate {
    Sink sink;
    Sink words;        ///< the tokens, each with its zero
    uint32_t *offsets; ///< of each in `words`
    size_t word_count, word_capacity;
    uint32_t *field_tokens;
    CrateValue *field_values;
    size_t field_count, field_capacity, value_capacity;
    uint32_t *sets;
    size_t set_count, set_capacity;
    CratePath *paths;
    size_t path_count, path_capacity;
    CrateSpecRow *specs;
    size_t spec_count, spec_capacity;
    Sink scratch, packed; ///< for packing
    uint32_t *table;
    size_t table_capacity;
} Crate;

enum { CRATE_NO_PARENT = UINT32_MAX };

void crate_begin(Crate *crate, SingeAllocator allocator);
void crate_free(Crate *crate);

// values
static inline CrateValue crate_inline(CrateType type, uint32_t value) {
    return (uint64_t)type << 48 | (uint64_t)1 << 62 | value;
}
CrateValue crate_token(Crate *crate, const char *text);
/// A number stored as a float.
CrateValue crate_double(float value);
CrateValue crate_token_list(Crate *crate, const char *const *texts, size_t count);
CrateValue crate_ints(Crate *crate, const int32_t *values, size_t count);
/// Arrays with one, two or three floats per entry.
CrateValue crate_floats(Crate *crate, int width, const float *values, size_t count);
/// Consecutive times from `first` on.
CrateValue crate_times(Crate *crate, double first, size_t count);
/// The values at those times.
CrateValue crate_series(Crate *crate, CrateValue times, const CrateValue *values, size_t count);

/// A path below `parent`. Paths come depth first: all of a path's children before its next sibling.
uint32_t crate_path(Crate *crate, const char *name, bool property, uint32_t parent);
void crate_spec(Crate *crate, uint32_t path, CrateSpec kind, const CrateField *fields, size_t count);

/// Ends the file and returns its bytes, to be freed. False when out of memory.
bool crate_take(Crate *crate, Sink *bytes);
/// Ends the file, writes it whole or not at all, and frees the crate.
SINGE_NODISCARD SingeResult crate_write(Crate *crate, const char *path, SingeError *error);

// LZ4's block format: OpenUSD compresses integers and names with it.

/// Max compressed size of `size` bytes.
static inline size_t lz4_size_max(size_t size) { return size + size / 255 + 16; }

/// Compresses a block and returns its length; `out` has room for lz4_size_max(size).
size_t lz4_pack(const uint8_t *in, size_t size, uint8_t *out);
