// Bytes of a file in the making, in memory. A sink that could not grow stays as it is and says so at the end.
#ifndef FORMATS_SINK_H
#define FORMATS_SINK_H

#include "formats/formats.h"
#include "formats/store.h"

typedef struct Sink {
    uint8_t *bytes;
    size_t size, capacity;
    SingeAllocator allocator;
    bool failed; ///< there was no memory
} Sink;

void sink_free(Sink *sink);

/// Makes room for so many bytes in all, so that it need not grow by and by. It may fail without harm.
void sink_reserve(Sink *sink, size_t size);

/// Room for `count` bytes at the end, which they become; NULL where there is no memory.
uint8_t *sink_room(Sink *sink, size_t count);

void sink_bytes(Sink *sink, const void *bytes, size_t count);
void sink_zeros(Sink *sink, size_t count);
/// Zeros up to a whole number of `unit` bytes.
void sink_align(Sink *sink, size_t unit);

// little-endian
void sink_u32(Sink *sink, uint32_t value);
void sink_u64(Sink *sink, uint64_t value);
void sink_double(Sink *sink, double value);
/// Values of 4 bytes each.
void sink_words(Sink *sink, const void *values, size_t count);

/// Text without its zero, at most 4000 bytes. Numbers in it must be whole: others are a locale's to print.
void sink_text(Sink *sink, const char *format, ...) SINGE_PRINTF(2, 3);
/// A number that reads back exactly, in every locale.
void sink_number(Sink *sink, double value);
/// A float so that it reads back exactly, and no longer than that.
void sink_float(Sink *sink, float value);

/// Writes the file, whole or not at all, and frees the sink.
SINGE_NODISCARD SingeResult sink_write(Sink *sink, const char *path, SingeError *error);

#endif
