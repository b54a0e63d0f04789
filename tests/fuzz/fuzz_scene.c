// Any bytes as a scene: no crash, and what is accepted reads back from its own dump.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Scene *scene = NULL, *again = NULL;
    SceneMessages messages = {0};
    SingeResult result = scene_parse("fuzz", (const char *)data, size, NULL, NULL, 0, &scene, &messages);
    if (!result) {
        char *text = NULL;
        size_t length = 0;
        FILE *file = open_memstream(&text, &length);
        if (!file)
            abort();
        scene_dump(scene, size % 2 ? SCENE_JSON : SCENE_YAML, 0, file);
        fclose(file);
        // a dump says more than its scene did, and so may exceed the limit that scenes have
        if (length <= 1 << 20 && scene_parse("dump", text, length, NULL, NULL, 0, &again, &messages)) {
            scene_messages_print(&messages, stderr);
            abort();
        }
        free(text);
    } else if (!messages.count || scene) {
        abort(); // a refusal must say why
    }
    scene_free(scene);
    scene_free(again);
    scene_messages_free(&messages);
    return 0;
}
