// Any bytes as what a run leaves in its folder: run.json, which `render` and `verify` read, and stats.csv.
#include <string.h>
#include <unistd.h>

#include "cli/csv.h"
#include "cli/text.h"
#include "scene/scene.h"
#include "input.h"

static void demand_inside(const uint8_t *data, size_t size, const char *value, size_t value_size) {
    const char *begin = (const char *)data;
    demand(value >= begin && value_size <= size && value + value_size <= begin + size);
}

/// As job_reopen does, but for the files that the scene names.
static void read_record(const char *json, size_t size) {
    static const char *const names[] = {"scene_folder", "name", "result", "error", "nothing"};
    const char *value;
    size_t length;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        if (!text_json_member(json, size, names[k], &value, &length)) continue;
        demand_inside((const uint8_t *)json, size, value, length);
        free(text_json_unquote(value, length));
    }

    if (!text_json_member(json, size, "scene", &value, &length)) return;
    demand_inside((const uint8_t *)json, size, value, length);

    Scene *scene = NULL;
    SceneMessages messages = {0};
    if (scene_parse("run.json", value, length, NULL, NULL, 0, &scene, &messages)) demand(!scene && messages.count > 0);
    scene_free(scene);
    scene_messages_free(&messages);
}

static void read_table(const uint8_t *data, size_t size) {
    char path[] = "/tmp/singe-fuzz-XXXXXX";
    int file = mkstemp(path);
    demand(file >= 0 && write(file, data, size) == (ssize_t)size && close(file) == 0);

    Console console = console_make(true);
    StatsTable table = {0};
    ExitCode code = stats_table_read(&table, path, &console);
    demand(code == EXIT_GOOD || code == EXIT_INPUT);
    for (int i = 0; code == EXIT_GOOD && i < table.count; i++) demand(table.rows[i].triangles >= 0);
    (void)stats_table_row(&table, 1);
    stats_table_free(&table);
    demand(unlink(path) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1); // files are read with a zero after them
    demand(text);
    if (size) memcpy(text, data, size);
    text[size] = 0;
    read_record(text, size);
    free(text);
    if (size && data[0] != '{') read_table(data, size);
    return 0;
}
