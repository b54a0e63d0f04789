// Any lines as --set texts over a good scene, which the first byte picks.
#include "fuzz_scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SETS_MAX = 16 };

static const char *const scenes[] = {
    "sheets:\n  - grid: {size: [0.2, 0.3], cells: [20, 30]}\n",
    "sheets:\n  - {grid: {size: [0.2, 0.3], cells: [2, 3]}, name: a, material: newsprint}\n"
    "  - {grid: {size: [0.2, 0.3], cells: [2, 3]}, name: b, material: {mass_rate: {from: 1, to: 2, noise: {}}}}\n"
    "sources: [{kind: spot, position: [0, 0, 0]}, {kind: ball, path: [{time: 0}, {time: 1}]}]\n"
    "colliders: [{kind: plane}, {kind: sphere}, {kind: box}, {kind: capsule}]\n"
    "pins: [{points: [[0, 0, 0]]}, {sheet: b, vertices: [0, 1]}]\n"
    "solver: paper\ngas: no\ncontact: no\n",
    "{\"sheets\": [{\"mesh\": \"a.obj\"}], \"solver\": {\"substeps\": 3}, \"preview\": {\"camera\": {\"fov\": 20}}}\n",
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    const char *sets[SETS_MAX];
    int count = 0;

    if (!text) abort();
    for (size_t i = 1; i < size; i++) text[i] = data[i] == '\n' ? 0 : (char)data[i];
    text[size] = 0;
    for (size_t i = 1; i < size && count < SETS_MAX; i += strlen(text + i) + 1) sets[count++] = text + i;

    const char *base = scenes[size ? data[0] % (sizeof scenes / sizeof *scenes) : 0];
    Scene *scene = NULL;
    SceneMessages messages = {0};
    if (scene_parse("fuzz", base, strlen(base), NULL, sets, count, &scene, &messages))
        expect_reported(&messages, scene);
    else expect_back(scene, size % 2 ? SCENE_JSON : SCENE_YAML);
    scene_free(scene);
    scene_messages_free(&messages);
    free(text);

    return 0;
}
