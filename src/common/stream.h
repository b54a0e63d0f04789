// A stream of bytes in memory, read and written by the same code, so that the two cannot disagree.
#pragma once

#include "common/memory.h"

typedef enum StreamMode { STREAM_MEASURE, STREAM_WRITE, STREAM_READ } StreamMode;

typedef struct Stream {
    StreamMode mode;
    uint8_t *bytes; ///< written to or read from; not used when measuring
    size_t size;    ///< of `bytes`
    size_t offset;
    bool failed; ///< the bytes ended too soon; everything read after it is zero
} Stream;

/// Passes `size` bytes of *data through the stream, in its direction.
void stream_data(Stream *stream, void *data, size_t size);

#define STREAM(stream, value) stream_data((stream), &(value), sizeof(value))

/// 64-bit FNV-1a over 8-byte words and the remaining bytes: detects damage, not malice.
uint64_t stream_checksum(const uint8_t *bytes, size_t size);
