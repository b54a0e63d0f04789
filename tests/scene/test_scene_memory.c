// A scene that is read while one allocation after another fails, in libfyaml's process too: an error each time, no
// crash, and the same scene when none fails. This program's malloc takes the place of libc's for all of its
// libraries.
#include "parsing.h"

#include <errno.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HAVE_OWN_MALLOC 1
#endif

#ifdef HAVE_OWN_MALLOC
// glibc's own, by the names that it has for programs like this
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);

#define SEEN __attribute__((visibility("default"))) // by the libraries

static long calls, fail_at; // fail_at 0: never
static bool fail_once;

static bool refused(void) {
    calls++;
    bool now = fail_at && (fail_once ? calls == fail_at : calls >= fail_at);
    if (now) errno = ENOMEM;
    return now;
}

SEEN void *malloc(size_t size) { return refused() ? NULL : __libc_malloc(size); }
SEEN void *calloc(size_t count, size_t size) { return refused() ? NULL : __libc_calloc(count, size); }
SEEN void *realloc(void *block, size_t size) { return refused() ? NULL : __libc_realloc(block, size); }

static const char text[] = "frames: 3\n"
                           "sheets:\n"
                           "  - grid: {size: [20 cm, 0.3], cells: [2, 3]}\n"
                           "    name: 'it''s \u00e9'\n"
                           "    material: {base: newsprint, thickness: \"2 \\u006dm\"}\n"
                           "sources: # hot\n"
                           "  - {kind: spot, position: [0, 0, 0]}\n";
static const char broken[] = "frames: [1, 2\nsheets: '\n";

/// All of a scene as text, from malloc.
static char *whole(const Scene *scene) {
    char *dump = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&dump, &size);
    assert_non_null(file);
    scene_dump(scene, SCENE_JSON, 0, file);
    assert_int_equal(fclose(file), 0);
    assert_non_null(dump);
    return dump;
}

static char *undisturbed; // what the scene is where nothing fails

/// Reads with failures; returns whether all went well, which is when none was met.
static SingeResult attempt(const char *scene_text, long at, bool once, uint32_t *reported) {
    static const char *const sets[] = {"preview.camera.eye=[0, 1, 2]", "fps=30"};
    Scene *scene = NULL;
    OwnMessages messages = {0};
    calls = 0, fail_at = at, fail_once = once;

    SingeResult result = scene_parse("t.yaml", scene_text, strlen(scene_text), NULL, sets, 2, &scene, &messages);
    fail_at = 0;
    *reported = messages.count + messages.left_out;
    assert_int_equal(result == SINGE_OK, scene != NULL);

    if (scene) { // nothing of it was lost on the way
        char *dump = whole(scene);
        if (!undisturbed) undisturbed = dump;
        assert_string_equal(dump, undisturbed);
        if (dump != undisturbed) free(dump);
    }

    scene_free(scene);
    return result;
}

/// The n-th allocation, for every n that this process makes, and for the child's after them as long as it answers so.
static void sweep(const char *scene_text, bool once, SingeResult expected) {
    uint32_t reported;
    long good_in_a_row = 0, n = 1;
    for (; good_in_a_row < 150; n++) { // libfyaml may do without a block here and there
        SingeResult result = attempt(scene_text, n, once, &reported);
        if (result != expected && result != SINGE_ERROR_MEMORY)
            print_error("allocation %ld, %s: result %d\n", n, once ? "once" : "and all after", (int)result);
        assert_true(result == expected || result == SINGE_ERROR_MEMORY);
        assert_int_equal(reported == 0, result == SINGE_OK);
        good_in_a_row = result == expected ? good_in_a_row + 1 : 0;
    }

    assert_true(n > 180);
}

TEST(every_failed_allocation_is_reported) {
    uint32_t reported;
    assert_int_equal(attempt(text, 0, false, &reported), SINGE_OK);
    sweep(text, false, SINGE_OK);
    sweep(text, true, SINGE_OK);
    sweep(broken, false, SINGE_ERROR_FORMAT);
    sweep(broken, true, SINGE_ERROR_FORMAT);
    free(undisturbed);
}
#else
TEST(every_failed_allocation_is_reported) { skip(); }
#endif
