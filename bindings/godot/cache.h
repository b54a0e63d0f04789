// Frames of a run's cache, as docs/formats.md describes them.
#ifndef SINGE_GODOT_CACHE_H
#define SINGE_GODOT_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// What is drawn of a vertex; y is up.
typedef struct SheetVertex {
    float position[3], normal[3], uv[2]; // m
    float temperature, peak;             // K
    float burn;                          // 0 fresh to 1 ash
} SheetVertex;

typedef struct CacheFrame {
    int64_t vertex_count, triangle_count;
    SheetVertex *vertices;
    uint32_t (*triangles)[3];
    uint8_t *bytes; // of the file
    size_t vertex_room, triangle_room, byte_room;
} CacheFrame;

/// Reads a frame of `out/letter/ply/letter.####.ply`; #### is its number. False, with the reason in `why`, and an empty
/// frame, if it cannot. Memory of an earlier frame is used again. Free with cache_free.
bool cache_read(const char *pattern, int64_t number, CacheFrame *frame, char *why, size_t why_size);
void cache_free(CacheFrame *frame);

/// Copies vertex i of a frame, for a caller that draws meshes of several kinds.
void cache_vertex(const void *frame, int64_t i, SheetVertex *vertex);

#endif
