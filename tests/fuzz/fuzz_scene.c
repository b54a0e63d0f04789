// Any bytes as a scene: no crash, every refusal has its location, and what is accepted reads back from its own dump.
#include "fuzz_scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Scene *scene = NULL;
    SceneMessages messages = {0};
    if (scene_parse("fuzz", (const char *)data, size, NULL, NULL, 0, &scene, &messages))
        expect_reported(&messages, scene);
    else expect_back(scene, size % 2 ? SCENE_JSON : SCENE_YAML);
    scene_free(scene);
    scene_messages_free(&messages);
    return 0;
}
