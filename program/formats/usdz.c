// A whole burn in one archive: the root, the frames that it refers to, and the sheets' pictures. No gas: the format
// allows no VDB.
#include "formats/usd.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the archive: uncompressed files, each aligned to 64 bytes, as USDZ requires

typedef struct Zip {
    Sink sink, directory;
    uint32_t count;
    bool too_large; ///< more than archives without extensions hold: 4 GiB, 65535 files
} Zip;

enum {
    ZIP_ALIGNMENT = 64,
    ZIP_VERSION = 20,
    ZIP_UTF8 = 1 << 11,
    ZIP_DAY = 1 << 5 | 1 /* 1980-01-01 */,
    ZIP_PADDING = 0x1986
};

/// Fields common to an entry and its line in the directory.
static void put_entry(Sink *sink, uint32_t sum, size_t size, size_t name, size_t extra) {
    sink_u16(sink, ZIP_VERSION), sink_u16(sink, ZIP_UTF8), sink_u16(sink, 0);
    sink_u16(sink, 0), sink_u16(sink, ZIP_DAY);
    sink_u32(sink, sum), sink_u32(sink, (uint32_t)size), sink_u32(sink, (uint32_t)size);
    sink_u16(sink, (uint32_t)name), sink_u16(sink, (uint32_t)extra);
}

/// Adds a file; the bytes are copied.
static void zip_add(Zip *zip, const char *name, const void *bytes, size_t size) {
    const size_t offset = zip->sink.size, length = strlen(name), head = offset + 30 + length;

    // an extra field without meaning is the padding: 4 bytes and its contents
    const size_t extra = (ZIP_ALIGNMENT - (head + 4) % ZIP_ALIGNMENT) % ZIP_ALIGNMENT + 4;

    // CRC-32 of ISO 3309
    uint32_t table[256], sum = UINT32_MAX;

    for (uint32_t i = 0; i < 256; i++) {
        table[i] = i;
        for (int k = 0; k < 8; k++) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0);
    }

    for (size_t i = 0; i < size; i++) sum = sum >> 8 ^ table[(sum ^ ((const uint8_t *)bytes)[i]) & 255];
    sum = ~sum;

    zip->too_large =
        zip->too_large || size > UINT32_MAX - 1024 || head + size > UINT32_MAX - 1024 || zip->count >= 65535;
    sink_bytes(&zip->sink, "PK\3\4", 4);
    put_entry(&zip->sink, sum, size, length, extra);
    sink_bytes(&zip->sink, name, length);
    sink_u16(&zip->sink, ZIP_PADDING), sink_u16(&zip->sink, (uint32_t)extra - 4);
    sink_zeros(&zip->sink, extra - 4);
    sink_bytes(&zip->sink, bytes, size);
    sink_bytes(&zip->directory, "PK\1\2", 4);
    sink_u16(&zip->directory, ZIP_VERSION);
    put_entry(&zip->directory, sum, size, length, 0);
    sink_zeros(&zip->directory, 10); // no comment, the first disk, no attributes
    sink_u32(&zip->directory, (uint32_t)offset);
    sink_bytes(&zip->directory, name, length);
    zip->count++;
}

// ---- its files

typedef char PictureName[32];

/// Adds the root, the frames and the pictures. `sheets` and `names` have room for each sheet.
static SingeResult add_files(Zip *zip, const char *path, const OutputScene *scene, const OutputCache *cache,
                             OutputSheet *sheets, PictureName *names, SingeError *error) {
    OutputScene packed = *scene;
    char root_name[1024];
    Sink root = {0};

    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const char *picture = scene->sheets[i].picture, *ending = picture ? strrchr(picture, '.') : NULL;
        sheets[i] = scene->sheets[i];
        if (!picture) continue;
        const bool png = ending && (strcmp(ending, ".png") == 0 || strcmp(ending, ".PNG") == 0);
        snprintf(names[i], sizeof names[i], "pictures/%u.%s", (unsigned)i, png ? "png" : "jpg");
        sheets[i].picture = names[i];
    }

    packed.sheets = sheets;
    packed.gas = false;
    usd_put_root(&root, &packed);
    snprintf(root_name, sizeof root_name, "%s.usda", scene->name);
    if (!root.failed) zip_add(zip, root_name, root.bytes, root.size);

    const bool failed = root.failed;
    sink_free(&root);
    SingeResult result = failed ? refuse_memory(error, "usdz", path) : SINGE_OK;

    for (int i = 1; i <= cache->frames && !result; i++) {
        OutputFrame frame;
        Sink bytes = {0};
        char name[1024];
        snprintf(name, sizeof name, "usd/%s.%04d.usdc", scene->name, i);
        result = cache->read(cache->context, i, &frame, error);
        if (!result) result = usd_frame_bytes(path, scene, &frame, &bytes, error);
        if (!result) zip_add(zip, name, bytes.bytes, bytes.size);
        sink_free(&bytes);
    }

    for (uint32_t i = 0; i < scene->sheet_count && !result; i++) {
        Bytes bytes = {0};
        if (!scene->sheets[i].picture) continue;

        result = output_picture_read(path, scene->sheets[i].picture, &bytes, error);
        if (!result) zip_add(zip, names[i], bytes.data, bytes.size);
        bytes_free(&bytes);
    }

    return result;
}

SingeResult usdz_write(const char *path, const OutputScene *scene, const OutputCache *cache, SingeError *error) {
    Zip zip = {0};
    OutputSheet *sheets = calloc(scene->sheet_count + 1, sizeof *sheets);
    PictureName *names = calloc(scene->sheet_count + 1, sizeof *names);
    SingeResult result = sheets && names ? SINGE_OK : refuse_memory(error, "usdz", path);

    if (!result) result = add_files(&zip, path, scene, cache, sheets, names, error);
    free(sheets), free(names);
    if (!result && zip.too_large)
        result = refuse(error, SINGE_ERROR_LIMIT, "zip", -1, "%s: more than 4 GiB, or 65535 files", short_name(path));

    if (result) {
        sink_free(&zip.sink);
        sink_free(&zip.directory);
        return result;
    }

    // the directory and its end; the archive is written whole or not at all
    Sink *sink = &zip.sink;
    const size_t offset = sink->size, size = zip.directory.size;
    sink_bytes(sink, zip.directory.bytes, size);
    sink_bytes(sink, "PK\5\6", 4);
    sink_zeros(sink, 4);

    sink_u16(sink, zip.count), sink_u16(sink, zip.count);
    sink_u32(sink, (uint32_t)size), sink_u32(sink, (uint32_t)offset);
    sink_u16(sink, 0);
    sink->failed = sink->failed || zip.directory.failed;
    sink_free(&zip.directory);
    return sink_write(sink, path, error);
}
