// scene_read and scene_parse: bytes → tree → --set → scene.
#include "scene/values.h"

#include "common/printable.h"
#include "formats/mesh_reader.h"

#include <string.h>

/// The default name of a scene: "letter" of "dir/letter.yaml". A file name is not always a valid name of outputs.
static void take_name(Reader *reader, const YamlNode *root) {
    const char *path = reader->text->name, *slash = strrchr(path, '/'), *file = slash ? slash + 1 : path;
    const char *dot = strrchr(file, '.');
    const size_t length = dot && dot > file ? (size_t)(dot - file) : strlen(file);
    char *name = length ? arena_text(reader->arena, file, length) : arena_text(reader->arena, "scene", 5);

    // bytes that are not UTF-8 become '_', as the name goes into run.json
    for (char *c = name; c && *c;) {
        int width = utf8_length(c);
        if (!width) *c = '_';
        c += width ? width : 1;
    }

    SchemaRow row = {.key = "name", .type = ROW_NAME};
    char expected[240];
    row_expected(&row, expected, sizeof expected);
    reader->scene->name = name;
    if (name && !node_find(root, "name") && !value_names_files(name))
        complain(reader, (SceneLocation){.line = 1, .column = 1},
                 "the outputs cannot have the file's name, '%s'; give the scene a name: %s", shown(name).text,
                 expected);
}

static SingeResult parse_into(SceneArena *arena, const SceneText *given, const char *base_dir, Scene **result,
                              SceneMessages *messages) {
    // the scene keeps the text, so that later messages can show its lines
    SceneText *text = arena_new(arena, 1, sizeof *text);
    Scene *scene = arena_new(arena, 1, sizeof *scene);
    char *name = arena_text(arena, given->name, strlen(given->name));
    char *bytes = arena_text(arena, given->bytes, given->size);
    char *folder = base_dir ? arena_text(arena, base_dir, strlen(base_dir)) : NULL;
    const char **sets = arena_new(arena, (size_t)given->set_count + 1, sizeof *sets);
    for (int i = 0; sets && i < given->set_count; i++)
        sets[i] = arena_text(arena, given->sets[i], strlen(given->sets[i]));

    if (arena_failed(arena)) return SINGE_ERROR_MEMORY;
    *text = (SceneText){.name = name, .bytes = bytes, .size = given->size, .sets = sets, .set_count = given->set_count};

    uint32_t before = message_total(messages), first = messages->count;
    YamlNode *root = tree_read(arena, text, text->bytes, text->size, (SceneLocation){0}, messages);
    if (root) schema_spell_out(arena, &schema_scene, root);
    if (root && !tree_set(arena, text, root, messages)) return SINGE_ERROR_MEMORY;

    Reader reader = {
        .arena = arena, .text = text, .messages = messages, .base_dir = folder, .prefix = "", .scene = scene};
    if (root && root->kind == NODE_MAP) {
        default_scene(arena, scene);
        schema_read(&reader, &schema_scene, root, scene);
        if (!scene->name) take_name(&reader, root);
        scene->sim.velocity_steps = scene->steps;
        scene->sim.time_step = (float)(1 / ((double)scene->fps * scene->steps));
    } else if (root) {
        char seen[NODE_WORDS];
        message_add(messages, text, root->location, "a scene must be a map (key: value), not %s",
                    node_describe(root, seen, sizeof seen));
    }

    if (arena_failed(arena)) return SINGE_ERROR_MEMORY;
    messages_sort(messages, first);
    if (message_total(messages) != before) return SINGE_ERROR_FORMAT;
    if (!root) return SINGE_ERROR_MEMORY;

    text->root = root;
    scene->text = text;
    scene->arena = arena;
    *result = scene;
    return SINGE_OK;
}

SingeResult scene_parse(const char *name, const char *bytes, size_t size, const char *base_dir, const char *const *sets,
                        int set_count, Scene **scene, SceneMessages *messages) {
    SceneText text = {.name = name ? name : "scene",
                      .bytes = bytes,
                      .size = size,
                      .sets = sets,
                      .set_count = set_count > 0 ? set_count : 0};
    *scene = NULL;

    if (size > SCENE_BYTES_MAX) {
        message_add(messages, &text, (SceneLocation){.line = 1, .column = 1},
                    "a scene has at most 1 MiB, this one has %zu bytes", size);
        return SINGE_ERROR_LIMIT;
    }

    SceneArena *arena = arena_create();
    SingeResult result = arena ? parse_into(arena, &text, base_dir, scene, messages) : SINGE_ERROR_MEMORY;
    if (result == SINGE_ERROR_MEMORY) message_add(messages, &text, (SceneLocation){0}, "out of memory");
    if (result) arena_destroy(arena);
    return result;
}

SingeResult scene_read(const char *path, const char *const *sets, int set_count, Scene **scene,
                       SceneMessages *messages) {
    SceneText text = {.name = path};
    Bytes bytes = {0};
    SingeError error;
    *scene = NULL;

    if (mesh_name_is_stage(path)) {
        message_add(messages, &text, (SceneLocation){0}, MESH_STAGE_HELP);
        return SINGE_ERROR_FORMAT;
    }

    SingeResult result = file_read_max(path, SCENE_BYTES_MAX, (SingeAllocator){0}, &bytes, &error);
    if (result) {
        message_add(messages, &text, (SceneLocation){0}, "%s", error.message);
        return result;
    }

    const char *slash = strrchr(path, '/');
    char folder[4096] = ".";
    size_t length = slash ? (size_t)(slash - path) : 1;
    if (length >= sizeof folder) {
        message_add(messages, &text, (SceneLocation){0}, "the path is too long");
        result = SINGE_ERROR_LIMIT;
    } else {
        if (slash) snprintf(folder, sizeof folder, "%.*s", (int)length, slash == path ? "/." : path);
        result = scene_parse(path, (const char *)bytes.data, bytes.size, slash == path ? "/." : folder, sets, set_count,
                             scene, messages);
    }

    bytes_free(&bytes);
    return result;
}

void scene_free(Scene *scene) {
    if (scene) arena_destroy(scene->arena);
}
