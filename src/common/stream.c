#include "common/stream.h"

#include <string.h>

void stream_data(Stream *stream, void *data, size_t size) {
    if (stream->mode != STREAM_MEASURE) {
        if (size > stream->size - stream->offset || stream->failed) {
            stream->failed = true;
            if (stream->mode == STREAM_READ && size) memset(data, 0, size);
            return;
        }
        if (size && stream->mode == STREAM_WRITE) memcpy(stream->bytes + stream->offset, data, size);
        if (size && stream->mode == STREAM_READ) memcpy(data, stream->bytes + stream->offset, size);
    }
    stream->offset += size;
}

uint64_t stream_checksum(const uint8_t *bytes, size_t size) {
    uint64_t hash = 0xcbf29ce484222325u, word;
    size_t i = 0;
    for (; i + 8 <= size; i += 8) {
        memcpy(&word, bytes + i, 8);
        hash = (hash ^ word) * 0x100000001b3u;
        hash ^= hash >> 29;
    }

    for (; i < size; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash ^ hash >> 32;
}
