// Helpers for tests that parse scenes from text.
#pragma once

#include "support/test.h"

#include "scene/scene.h"

static inline void parsed_end(Scene **scene) { scene_free(*scene); }
#define OwnScene OWNED(parsed_end) Scene
#define OwnMessages OWNED(scene_messages_free) SceneMessages

/// A complete scene with one sheet; `more` is appended.
#define SHEET "sheets:\n  - grid: {size: [0.2, 0.3], cells: [20, 30]}\n"

/// Parses text that must be good; prints what is wrong otherwise.
static inline Scene *good_scene(const char *text, const char *const *sets, int set_count) {
    Scene *scene = NULL;
    SceneMessages messages = {0};
    SingeResult result = scene_parse("test.yaml", text, strlen(text), NULL, sets, set_count, &scene, &messages);

    scene_messages_print(&messages, stderr);
    assert_int_equal(result, SINGE_OK);
    assert_int_equal(messages.count, 0);
    assert_non_null(scene);
    scene_messages_free(&messages);
    return scene;
}

/// The dump of a scene; free it.
static inline char *dump_text(const Scene *scene, SceneSyntax syntax) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    scene_dump(scene, syntax, 0, file);
    fclose(file);
    assert_non_null(text);
    return text;
}

/// A folder with files, in which scenes are read.
typedef struct Folder {
    char path[40];
} Folder;

static inline Folder folder_make(void) {
    Folder folder = {"/tmp/singe-test-XXXXXX"};
    assert_non_null(mkdtemp(folder.path));
    return folder;
}

static inline void folder_file(const Folder *folder, const char *name, const char *text) {
    char path[200];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static inline void folder_remove(Folder *folder) {
    char command[120];
    snprintf(command, sizeof command, "rm -r %s", folder->path);
    assert_int_equal(system(command), 0);
}
#define OwnFolder OWNED(folder_remove) Folder
