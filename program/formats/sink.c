#include "formats/sink.h"

#include "formats/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void sink_free(Sink *sink) {
    store_free(sink->allocator, sink->bytes, sink->capacity, 1);
    *sink = (Sink){.allocator = sink->allocator};
}

void sink_reserve(Sink *sink, size_t size) {
    // a failure now is harmless: it is tried again when bytes come
    (void)store_grow(sink->allocator, &sink->bytes, &sink->capacity, size, 1);
}

uint8_t *sink_room(Sink *sink, size_t count) {
    if (sink->failed || count > SIZE_MAX / 4 ||
        !store_grow(sink->allocator, &sink->bytes, &sink->capacity, sink->size + count, 1)) {
        sink->failed = true;
        return NULL;
    }

    uint8_t *room = sink->bytes + sink->size;
    sink->size += count;
    return room;
}

void sink_bytes(Sink *sink, const void *bytes, size_t count) {
    uint8_t *room = sink_room(sink, count);
    if (room && count) memcpy(room, bytes, count);
}

void sink_zeros(Sink *sink, size_t count) {
    uint8_t *room = sink_room(sink, count);
    if (room && count) memset(room, 0, count);
}

void sink_align(Sink *sink, size_t unit) {
    size_t over = sink->size % unit;
    if (over) sink_zeros(sink, unit - over);
}

void sink_u16(Sink *sink, uint32_t value) {
    const uint8_t bytes[2] = {(uint8_t)value, (uint8_t)(value >> 8)};
    sink_bytes(sink, bytes, 2);
}

void sink_u32(Sink *sink, uint32_t value) {
    uint8_t *room = sink_room(sink, 4);
    if (room) store_u32_little(room, value);
}

void sink_u64(Sink *sink, uint64_t value) {
    sink_u32(sink, (uint32_t)value);
    sink_u32(sink, (uint32_t)(value >> 32));
}

void sink_double(Sink *sink, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    sink_u64(sink, bits);
}

void sink_words(Sink *sink, const void *values, size_t count) {
    uint8_t *room = sink_room(sink, 4 * count);
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (room && count) memcpy(room, values, 4 * count);
    return;
#endif
    const uint8_t *from = values;
    for (size_t i = 0; room && i < count; i++) {
        uint32_t bits;
        memcpy(&bits, from + 4 * i, sizeof bits);
        store_u32_little(room + 4 * i, bits);
    }
}

void sink_text(Sink *sink, const char *format, ...) {
    char text[4096];
    va_list list;
    va_start(list, format);
    int length = vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (length < 0 || (size_t)length >= sizeof text) sink->failed = true;
    else sink_bytes(sink, text, (size_t)length);
}

void sink_number(Sink *sink, double value) {
    char text[40];
    sink_bytes(sink, text, (size_t)number_print(value, text));
}

void sink_float(Sink *sink, float value) {
    // the shortest of 6 to 9 digits that is the same float
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        for (char *c = text; *c; c++)
            if (*c == ',') *c = '.';
        const uint8_t *at = (const uint8_t *)text;
        float again;
        if (number_float(&at, at + strlen(text), &again) == NUMBER_OK && again == value) break;
    }

    sink_bytes(sink, text, strlen(text));
}

SingeResult sink_write(Sink *sink, const char *path, SingeError *error) {
    SingeResult result =
        sink->failed ? refuse_memory(error, "cache", path) : file_write(path, sink->bytes, sink->size, error);
    sink_free(sink);
    return result;
}
