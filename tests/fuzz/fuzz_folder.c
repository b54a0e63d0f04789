// Any bytes as what a run leaves in its folder: run.json, which `render` and `verify` read, and stats.csv.
#include <unistd.h>

#include "cli/csv.h"
#include "cli/text.h"
#include "scene/scene.h"
#include "input.h"

static void demand_inside(JsonText whole, JsonText part) {
    demand(part.text >= whole.text && part.size <= whole.size && part.text + part.size <= whole.text + whole.size);
}

/// As job_reopen does, but for the files that the scene names.
static void read_record(JsonText record) {
    static const char *const names[] = {"scene_folder", "name", "result", "error", "nothing"};
    JsonText value;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        if (!text_json_member(record, names[k], &value)) continue;
        demand_inside(record, value);
        free(text_json_unquote(value));
        demand(text_json_count(record, names[k]) <= 1000000);
    }

    if (!text_json_member(record, "scene", &value)) return;
    demand_inside(record, value);

    Scene *scene = NULL;
    SceneMessages messages = {0};
    if (scene_parse("run.json", value.text, value.size, NULL, NULL, 0, &scene, &messages))
        demand(!scene && messages.count > 0);
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
    read_record((JsonText){text, size});
    free(text);
    if (size && data[0] != '{') read_table(data, size);
    return 0;
}
