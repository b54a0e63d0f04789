// Smaller GLB: values are rounded, and then packed without loss by meshoptimizer (EXT_meshopt_compression, version 0 of
// its streams). The buffer that the accessors name is empty, as the extension has it: a reader fills it.
#include "formats/glb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifndef SINGE_MESHOPT

bool glb_pack_available(void) { return false; }

void glb_sort_triangles(GlbFile *f, uint32_t *corners, size_t count, uint32_t vertices) {
    (void)f, (void)corners, (void)count, (void)vertices;
}

uint32_t glb_put_packed(GlbFile *f, size_t begin, uint32_t count, int width, GlbRounding rounding, bool box) {
    (void)count, (void)width, (void)rounding, (void)box;
    f->data.size = begin;
    return f->view_count;
}

#else

#include <meshoptimizer.h>

bool glb_pack_available(void) { return true; }

/// Memory for meshoptimizer, allocated beforehand: it ends the program when an allocation fails.
static _Thread_local struct {
    uint8_t *next;
    size_t left;
} arena;

static void *arena_take(size_t size) {
    const size_t rounded = (size + 63) & ~(size_t)63;
    if (rounded > arena.left) abort(); // see `most`
    uint8_t *taken = arena.next;
    arena.next += rounded;
    arena.left -= rounded;
    return taken;
}

static void arena_give(void *taken) { (void)taken; }

void glb_sort_triangles(GlbFile *f, uint32_t *corners, size_t count, uint32_t vertices) {
    // its lists: corners twice and scores and flags of triangles, 10 bytes a corner; three of vertices. Twice that
    const size_t most = 20 * count + 24 * (size_t)vertices + 8192;
    f->scratch.size = 0;
    uint8_t *room = sink_room(&f->scratch, most + 64);
    if (!room) return;

    arena.next = room + (64 - (uintptr_t)room % 64);
    arena.left = most;
    meshopt_setAllocator(arena_take, arena_give);
    meshopt_optimizeVertexCacheStrip(corners, corners, count, vertices);
}

enum { GLB_BYTE = 5120, GLB_FLOAT32 = 5126, GLB_UINT32 = 5125, GRID_LARGEST = (1 << 23) - 1 };

/// Floats as the extension's exponential filter has them, all with one exponent: 24 bits of a multiple, 8 of the
/// exponent. Rounds `values` to what a reader will get.
static void round_to_grid(float *values, size_t count, int finest, uint8_t *stream) {
    float largest = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) values[i] = 0;
        largest = fmaxf(largest, fabsf(values[i]));
    }

    int exponent = finest;
    while (ldexpf(largest, -exponent) > GRID_LARGEST) exponent++;

    for (size_t i = 0; i < count; i++) {
        const int32_t multiple = (int32_t)lrintf(ldexpf(values[i], -exponent));
        const uint32_t bits = ((uint32_t)multiple & 0xffffff) | (uint32_t)exponent << 24;
        memcpy(stream + 4 * i, &bits, 4);
        values[i] = ldexpf((float)multiple, exponent);
    }
}

uint32_t glb_put_packed(GlbFile *f, size_t begin, uint32_t count, int width, GlbRounding rounding, bool box) {
    static const char *const types[] = {[1] = "SCALAR", [2] = "VEC2", [3] = "VEC3"};
    float *values = (float *)(void *)(f->data.bytes + begin);
    const size_t total = (size_t)count * (size_t)width;
    const bool corners = rounding.kind == GLB_TRIANGLES;
    if (f->data.failed) return f->view_count;

    // the bytes of an element; those of vertices must be multiples of four
    const uint32_t stride = rounding.kind == GLB_GRID ? 4 * (uint32_t)width : 4;

    // the stream before packing
    f->scratch.size = 0;
    sink_zeros(&f->scratch, (size_t)count * stride);
    if (f->scratch.failed) return f->view_count;

    uint8_t *stream = f->scratch.bytes;
    if (corners) memcpy(stream, values, 4 * total);
    else if (rounding.kind == GLB_GRID) round_to_grid(values, total, rounding.bits, stream);
    else
        for (uint32_t i = 0; i < count; i++) {
            const float direction[4] = {values[3 * i], values[3 * i + 1], values[3 * i + 2], 1};
            meshopt_encodeFilterOct(stream + 4 * (size_t)i, 1, 4, 8, direction);
        }

    float bounds[6] = {0}; // positions alone have a box
    for (uint32_t i = 0; i < count && box; i++) box_grow(bounds, values + 3 * (size_t)i, i == 0);

    // packed, in place of the floats; the versions are those that the extension allows
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
    f->data.size = begin;

    const size_t bound = corners ? meshopt_encodeIndexBufferBound(count, rounding.vertices)
                                 : meshopt_encodeVertexBufferBound(count, stride);
    uint8_t *room = sink_room(&f->data, bound);
    if (!room) return f->view_count;

    const size_t size = corners ? meshopt_encodeIndexBuffer(room, bound, (const unsigned *)(void *)stream, count)
                                : meshopt_encodeVertexBuffer(room, bound, stream, count, stride);
    f->data.size = begin + size;

    const char *comma = f->view_count ? "," : "";
    sink_text(&f->views, "%s{\"buffer\":1,\"byteOffset\":%zu,\"byteLength\":%zu", comma, f->unpacked,
              (size_t)count * stride);
    if (!corners) sink_text(&f->views, ",\"byteStride\":%u", (unsigned)stride);

    sink_text(&f->views, ",\"target\":%d,\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,",
              corners ? 34963 : 34962, begin);
    sink_text(&f->views, "\"byteLength\":%zu,\"byteStride\":%u,\"count\":%u,\"mode\":\"%s\"%s}}}", size,
              (unsigned)stride, (unsigned)count, corners ? "TRIANGLES" : "ATTRIBUTES",
              rounding.kind == GLB_GRID        ? ",\"filter\":\"EXPONENTIAL\""
              : rounding.kind == GLB_DIRECTION ? ",\"filter\":\"OCTAHEDRAL\""
                                               : "");
    f->unpacked += (size_t)count * stride;
    sink_align(&f->data, 4);

    const bool direction = rounding.kind == GLB_DIRECTION;
    sink_text(&f->accessors, "%s{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"%s", comma,
              f->view_count,
              corners     ? GLB_UINT32
              : direction ? GLB_BYTE
                          : GLB_FLOAT32,
              (unsigned)count, types[width], direction ? ",\"normalized\":true" : "");
    return glb_end_accessor(f, width, box ? bounds : NULL);
}

#endif
