// A whole burn in one archive: the root, the frames that it refers to, and the sheets' pictures. No gas: the format
// allows no VDB.
#include "formats/usd.h"
#include "formats/zip.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef char PictureName[32];

/// The path of a picture, which may be relative to the archive's folder.
static SingeResult read_picture(const char *path, const char *picture, Bytes *bytes, SingeError *error) {
    char name[8192];
    const char *slash = strrchr(path, '/');
    const int folder = *picture == '/' || !slash ? 0 : (int)(slash - path) + 1;
    if ((size_t)snprintf(name, sizeof name, "%.*s%s", folder, path, picture) >= sizeof name)
        return refuse(error, SINGE_ERROR_LIMIT, "usdz", -1, "%s: the name is too long", short_name(picture));
    return file_read(name, (SingeAllocator){0}, bytes, error);
}

static SingeResult add_pictures(Zip *zip, const char *path, const OutputScene *scene, const PictureName *names,
                                SingeError *error) {
    SingeResult result = SINGE_OK;
    for (uint32_t i = 0; i < scene->sheet_count && !result; i++) {
        Bytes bytes = {0};
        if (!scene->sheets[i].picture) continue;
        result = read_picture(path, scene->sheets[i].picture, &bytes, error);
        if (!result) zip_add(zip, names[i], bytes.data, bytes.size);
        bytes_free(&bytes);
    }
    return result;
}

static SingeResult add_frames(Zip *zip, const char *path, const OutputScene *scene, const OutputCache *cache,
                              SingeError *error) {
    SingeResult result = SINGE_OK;
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
    return result;
}

/// The scene with its pictures in the archive.
static SingeResult add_root(Zip *zip, const OutputScene *scene, OutputSheet *sheets, PictureName *names,
                            const char *path, SingeError *error) {
    OutputScene packed = *scene;
    char name[1024];
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
    snprintf(name, sizeof name, "%s.usda", scene->name);
    if (!root.failed) zip_add(zip, name, root.bytes, root.size);
    const bool failed = root.failed;
    sink_free(&root);
    return failed ? refuse_memory(error, "usdz", path) : SINGE_OK;
}

SingeResult usdz_write(const char *path, const OutputScene *scene, const OutputCache *cache, SingeError *error) {
    Zip zip;
    OutputSheet *sheets = calloc(scene->sheet_count + 1, sizeof *sheets);
    PictureName *names = calloc(scene->sheet_count + 1, sizeof *names);
    SingeResult result = sheets && names ? SINGE_OK : refuse_memory(error, "usdz", path);
    zip_begin(&zip, (SingeAllocator){0});
    if (!result) result = add_root(&zip, scene, sheets, names, path, error);
    if (!result) result = add_frames(&zip, path, scene, cache, error);
    if (!result) result = add_pictures(&zip, path, scene, (const PictureName *)names, error);
    if (!result) result = zip_write(&zip, path, error);
    else zip_free(&zip);
    free(sheets), free(names);
    return result;
}
