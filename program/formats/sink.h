// Collects the bytes of a file in memory. A sink that cannot grow remains unchanged and reports that at the end.
#pragma once

#include "formats/formats.h"
#include "common/store.h"

typedef struct Sink {
    uint8_t *bytes;
    size_t size, capacity;
    SingeAllocator allocator;
    bool failed; ///< there was no memory
} Sink;

void sink_free(Sink *sink);

/// Reserves so many bytes in total, so that it need not grow step by step. A failure is harmless.
void sink_reserve(Sink *sink, size_t size);

/// Appends `count` bytes for the caller to fill; NULL when out of memory.
uint8_t *sink_room(Sink *sink, size_t count);

void sink_bytes(Sink *sink, const void *bytes, size_t count);
void sink_zeros(Sink *sink, size_t count);
/// Pads with zeros to a multiple of `unit` bytes.
void sink_align(Sink *sink, size_t unit);

// little-endian
void sink_u16(Sink *sink, uint32_t value);
void sink_u32(Sink *sink, uint32_t value);
void sink_u64(Sink *sink, uint64_t value);
void sink_double(Sink *sink, double value);
/// Values of 4 bytes each.
void sink_words(Sink *sink, const void *values, size_t count);

/// Text without its zero, at most 4000 bytes. Numbers in it must be integers: printf's other numbers depend on the
/// locale.
void sink_text(Sink *sink, const char *format, ...) SINGE_PRINTF(2, 3);
/// A number that reads back exactly, in every locale.
void sink_number(Sink *sink, double value);
/// The shortest text of a float that reads back exactly.
void sink_float(Sink *sink, float value);

/// Writes the file, whole or not at all, and frees the sink.
SINGE_NODISCARD SingeResult sink_write(Sink *sink, const char *path, SingeError *error);
