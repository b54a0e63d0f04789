// The PLY header, and values of its body, for the readers of meshes and of the cache.
#pragma once

#include "formats/formats.h"
#include "formats/lines.h"

typedef enum PlyFormat { PLY_ASCII = 0, PLY_LITTLE, PLY_BIG } PlyFormat;

typedef enum PlyType {
    PLY_INT8 = 0,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64,
    PLY_TYPE_COUNT
} PlyType;

typedef struct PlyProperty {
    const uint8_t *name, *name_end;
    bool is_list;
    PlyType type;       ///< of the value, or of a list's items
    PlyType count_type; ///< of a list's length
} PlyProperty;

typedef struct PlyElement {
    const uint8_t *name, *name_end;
    uint32_t count;
    size_t first_property, property_count;
} PlyElement;

typedef struct PlyHeader {
    PlyFormat format;
    PlyElement *elements;
    PlyProperty *properties;
    size_t element_count, element_capacity, property_count, property_capacity;
    const uint8_t *note, *note_end; ///< the first comment that begins with "singe", or NULL
} PlyHeader;

/// A position in a PLY file, with the context of error messages.
typedef struct Ply {
    const char *name;
    const uint8_t *begin;
    Text text;
    PlyHeader header;
    SingeAllocator allocator;
    SingeError *error;
} Ply;

/// Reads the header of ply->text and leaves the cursor at the body. The element counts fit into the bytes that follow.
/// Free with ply_header_free, also after failure.
SINGE_NODISCARD SingeResult ply_read_header(Ply *ply);
void ply_header_free(Ply *ply);

/// The element of that name, or NULL.
const PlyElement *ply_element(const Ply *ply, const char *name);
size_t ply_type_size(PlyType type);

/// Fails at the cursor: by line in text, by byte in binary.
SingeResult ply_refuse(const Ply *ply, SingeResult code, const char *format, ...) SINGE_PRINTF(3, 4);
