// A frame of a cache as stored in its file, with its bad values: formats/ply_surface.c refuses those that verify
// counts.
#pragma once

#include "formats/output.h"

/// The properties that every cache has, and some of them.
enum { CACHE_COLUMNS = SURFACE_COLUMNS - 1, CACHE_X = 0, CACHE_REST = 11, CACHE_SHEET = 24 };

typedef struct CacheFrame {
    double time; ///< s, NaN if it is not in the header
    uint32_t vertex_count, triangle_count;
    bool there[CACHE_COLUMNS]; ///< whether there is a property of that name and type
    float (*position)[3];      ///< [vertex_count]
    float (*rest)[3];          ///< [vertex_count], 0 if there are none
    uint32_t (*triangles)[3];  ///< [triangle_count] as in the file: they may be out of range
    Bytes bytes;
    size_t row, offset[CACHE_COLUMNS]; ///< bytes per vertex, and the offset of a property in them
    const uint8_t *rows;
} CacheFrame;

/// A value of a vertex as stored; of an integer, its bits. 0 if the property is missing.
float cache_value(const CacheFrame *frame, int column, uint32_t vertex);

/// Reads a frame. Refuses files that are not a binary little-endian PLY of vertices with positions and faces of three
/// corners, or are not as long as their header says. Free it, after failure too.
SINGE_NODISCARD SingeResult cache_read(const char *path, CacheFrame *frame, SingeError *error);
void cache_free(CacheFrame *frame);
