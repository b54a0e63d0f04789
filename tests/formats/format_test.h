// Helpers for the tests of formats: a temporary folder, and checks of messages.
#pragma once

#include <unistd.h>

#include "formats/formats.h"
#include "support/support.h"

/// Gives a test a folder of its own, `folder`, which it leaves empty, and the name of a file there, `path`.
#define TEST_IN_FOLDER(file)                                      \
    static char folder[] = "/tmp/singe-formats-XXXXXX", path[64]; \
    static void open_folder(int argc, char **argv) {              \
        (void)argc, (void)argv;                                   \
        assert_non_null(mkdtemp(folder));                         \
        snprintf(path, sizeof path, "%s/%s", folder, file);       \
    }                                                             \
    static int close_folder(void) { return rmdir(folder) != 0; }  \
    TEST_AROUND(open_folder, close_folder)

/// Reads a file whole, and removes it.
static inline Bytes take_file(const char *path) {
    SingeError error;
    Bytes bytes;
    if (file_read(path, (SingeAllocator){0}, &bytes, &error)) fail_msg("%s", error.message);
    unlink(path);
    return bytes;
}

/// Reads a mesh from a copy with nothing behind it, so that a sanitizer sees a read behind its end.
static inline SingeResult read_mesh(const char *name, const void *data, size_t size, Polygons *mesh,
                                    SingeError *error) {
    if (error) *error = (SingeError){0};
    uint8_t *bytes = calloc(size ? size : 1, 1);
    memcpy(bytes, data, size);
    SingeResult result = polygons_read(name, bytes, size, (SingeAllocator){0}, mesh, error);
    free(bytes);
    return result;
}

static inline void assert_message(const SingeError *error, const char *part) {
    if (!strstr(error->message, part)) fail_msg("\"%s\" is not in \"%s\"", part, error->message);
}

/// A mesh is refused with this code, line or byte (-1: any), and part of the message, and nothing is left of it.
static inline void assert_mesh_refused(const char *name, const void *data, size_t size, SingeResult code,
                                       int64_t element, const char *part) {
    Polygons mesh;
    SingeError error;
    SingeResult result = read_mesh(name, data, size, &mesh, &error);
    if (result != code || error.code != code)
        fail_msg("result %d, not %d, for %.*s (%s)", result, code, (int)size, (const char *)data, error.message);
    assert_string_equal(error.stage, strrchr(name, '.') + 1);

    if (element >= 0 && error.element != element)
        fail_msg("%d, not %d: %s", (int)error.element, (int)element, error.message);
    assert_message(&error, part);
    assert_message(&error, name);
    assert_null(mesh.positions);
    assert_null(mesh.corners);
    assert_null(mesh.attributes);
}
