#include "formats/zip.h"

#include <string.h>

enum {
    ZIP_ALIGNMENT = 64,
    ZIP_VERSION = 20,
    ZIP_UTF8 = 1 << 11,
    ZIP_DAY = 1 << 5 | 1 /* 1980-01-01 */,
    ZIP_PADDING = 0x1986
};

void zip_begin(Zip *zip, SingeAllocator allocator) {
    *zip = (Zip){.sink = {.allocator = allocator}, .directory = {.allocator = allocator}};
}

void zip_free(Zip *zip) { sink_free(&zip->sink), sink_free(&zip->directory); }

/// CRC-32 of ISO 3309.
static uint32_t zip_sum(const uint8_t *bytes, size_t size) {
    uint32_t table[256], sum = UINT32_MAX;
    for (uint32_t i = 0; i < 256; i++) {
        table[i] = i;
        for (int k = 0; k < 8; k++) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0);
    }
    for (size_t i = 0; i < size; i++) sum = sum >> 8 ^ table[(sum ^ bytes[i]) & 255];
    return ~sum;
}

static void put_u16(Sink *sink, uint32_t value) {
    const uint8_t bytes[2] = {(uint8_t)value, (uint8_t)(value >> 8)};
    sink_bytes(sink, bytes, 2);
}

/// Fields common to an entry and its line in the directory.
static void put_entry(Sink *sink, uint32_t sum, size_t size, size_t name, size_t extra) {
    put_u16(sink, ZIP_VERSION), put_u16(sink, ZIP_UTF8), put_u16(sink, 0);
    put_u16(sink, 0), put_u16(sink, ZIP_DAY);
    sink_u32(sink, sum), sink_u32(sink, (uint32_t)size), sink_u32(sink, (uint32_t)size);
    put_u16(sink, (uint32_t)name), put_u16(sink, (uint32_t)extra);
}

void zip_add(Zip *zip, const char *name, const void *bytes, size_t size) {
    const size_t offset = zip->sink.size, length = strlen(name), head = offset + 30 + length;
    // an extra field without meaning is the padding: 4 bytes and its contents
    const size_t extra = (ZIP_ALIGNMENT - (head + 4) % ZIP_ALIGNMENT) % ZIP_ALIGNMENT + 4;
    const uint32_t sum = zip_sum(bytes, size);
    zip->too_large =
        zip->too_large || size > UINT32_MAX - 1024 || head + size > UINT32_MAX - 1024 || zip->count >= 65535;
    sink_bytes(&zip->sink, "PK\3\4", 4);
    put_entry(&zip->sink, sum, size, length, extra);
    sink_bytes(&zip->sink, name, length);
    put_u16(&zip->sink, ZIP_PADDING), put_u16(&zip->sink, (uint32_t)extra - 4);
    sink_zeros(&zip->sink, extra - 4);
    sink_bytes(&zip->sink, bytes, size);
    sink_bytes(&zip->directory, "PK\1\2", 4);
    put_u16(&zip->directory, ZIP_VERSION);
    put_entry(&zip->directory, sum, size, length, 0);
    sink_zeros(&zip->directory, 10); // no comment, the first disk, no attributes
    sink_u32(&zip->directory, (uint32_t)offset);
    sink_bytes(&zip->directory, name, length);
    zip->count++;
}

SingeResult zip_write(Zip *zip, const char *path, SingeError *error) {
    Sink *sink = &zip->sink;
    const size_t offset = sink->size, size = zip->directory.size;
    if (zip->too_large) {
        zip_free(zip);
        return refuse(error, SINGE_ERROR_LIMIT, "zip", -1, "%s: more than 4 GiB, or 65535 files", short_name(path));
    }
    sink_bytes(sink, zip->directory.bytes, size);
    sink_bytes(sink, "PK\5\6", 4);
    sink_zeros(sink, 4);
    put_u16(sink, zip->count), put_u16(sink, zip->count);
    sink_u32(sink, (uint32_t)size), sink_u32(sink, (uint32_t)offset);
    put_u16(sink, 0);
    sink->failed = sink->failed || zip->directory.failed;
    sink_free(&zip->directory);
    return sink_write(sink, path, error);
}
