// Properties of every scene that is read, whatever its bytes.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"

/// A refusal says why, and where by a line or a --set.
static inline void expect_reported(const SceneMessages *messages, const Scene *scene) {
    if (!messages->count || scene) abort();
    for (uint32_t i = 0; i < messages->count; i++) {
        const SceneLocation *place = &messages->items[i].location;
        if (!place->set && (place->line < 1 || place->column < 1)) abort();
    }
}

/// An accepted scene reads back from its own dump.
static inline void expect_back(const Scene *scene, SceneSyntax syntax) {
    Scene *again = NULL;
    SceneMessages messages = {0};
    char *text = NULL;
    size_t length = 0;
    FILE *file = open_memstream(&text, &length);
    if (!file) abort();
    scene_dump(scene, syntax, 0, file);
    fclose(file);

    // a dump says more than its scene did, and so may exceed the limit that scenes have
    if (length <= 1 << 20 && scene_parse("dump", text, length, NULL, NULL, 0, &again, &messages)) {
        scene_messages_print(&messages, stderr);
        abort();
    }
    free(text);
    scene_free(again);
    scene_messages_free(&messages);
}
