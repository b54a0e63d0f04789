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
