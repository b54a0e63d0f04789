// A frame of a cache as it lies in its file, bad values and all: formats/ply_surface.c refuses what is to be counted.
#ifndef ANALYSIS_CACHE_H
#define ANALYSIS_CACHE_H

#include "formats/formats.h"

/// The properties that docs/formats.md promises, in its order.
enum {
    CACHE_X,
    CACHE_NORMAL = 3,
    CACHE_UV = 6,
    CACHE_VELOCITY = 8,
    CACHE_REST = 11,
    CACHE_TEMPERATURE = 14,
    CACHE_PIECE = 22,
    CACHE_VERTEX,
    CACHE_SHEET,
    CACHE_COLUMNS
};

typedef struct CacheFrame {
    double time; ///< s, NaN where the header does not say
    uint32_t vertex_count, triangle_count;
    bool there[CACHE_COLUMNS]; ///< a property of that name and type
    float (*position)[3];      ///< [vertex_count]
    float (*rest)[3];          ///< [vertex_count], 0 where there are none
    uint32_t (*triangles)[3];  ///< [triangle_count] as in the file: they may be out of range
    Bytes bytes;
    size_t row, offset[CACHE_COLUMNS]; ///< bytes of a vertex, and where in it a property is
    const uint8_t *rows;
} CacheFrame;

const char *cache_column_name(int column);
bool cache_column_is_integer(int column);

/// A value of a vertex as the file has it; of an integer, its bits. 0 where the property is missing.
float cache_value(const CacheFrame *frame, int column, uint32_t vertex);

/// Reads a frame. Refuses what is no binary little-endian PLY of vertices with positions and faces of three corners, or
/// is not as long as its header says. Free it, after failure too.
SINGE_NODISCARD SingeResult cache_read(const char *path, CacheFrame *frame, SingeError *error);
void cache_free(CacheFrame *frame);

#endif
