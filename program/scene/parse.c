// scene_read and scene_parse: bytes → tree → --set → scene.
#include "scene/values.h"

#include "common/printable.h"

#include <string.h>

// The scene keeps the text, so that later messages can show its lines.
static SceneText *keep_text(SceneArena *arena, const SceneText *text) {
    SceneText *kept = arena_new(arena, 1, sizeof *kept);
    char *name = arena_text(arena, text->name, strlen(text->name));
    char *bytes = arena_text(arena, text->bytes, text->size);
    const char **sets = arena_new(arena, (size_t)text->set_count + 1, sizeof *sets);
    if (!kept || !name || !bytes || !sets) return NULL;
    for (int i = 0; i < text->set_count; i++)
        if (!(sets[i] = arena_text(arena, text->sets[i], strlen(text->sets[i])))) return NULL;
    *kept = (SceneText){.name = name, .bytes = bytes, .size = text->size, .sets = sets, .set_count = text->set_count};
    return kept;
}

// "dir/letter.yaml" → "letter". Bytes that are not UTF-8 become '_', as the name goes into run.json.
static char *stem(SceneArena *arena, const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    char *copy = length ? arena_text(arena, name, length) : arena_text(arena, "scene", 5);
    for (char *c = copy; c && *c;) {
        int width = utf8_length(c);
        if (!width) *c = '_';
        c += width ? width : 1;
    }
    return copy;
}

// The default name of a scene. A file name is not always a valid name of outputs.
static void take_name(Reader *reader, const Node *root) {
    SchemaRow row = {.key = "name", .type = ROW_NAME};
    char expected[240];
    row_expected(&row, expected, sizeof expected);
    reader->scene->name = stem(reader->arena, reader->text->name);
    if (reader->scene->name && !node_find(root, "name") && !value_names_files(reader->scene->name))
        message_add(reader->messages, reader->text, (SceneLocation){.line = 1, .column = 1},
                    "the outputs cannot be called '%s' as the file is; give the scene a name: %s",
                    shown(reader->scene->name).text, expected);
}

static void scene_fill(Reader *reader, const Node *root) {
    Scene *scene = reader->scene;
    if (root->kind != NODE_MAP) {
        char seen[NODE_WORDS];
        message_add(reader->messages, reader->text, root->location, "a scene must be a map (key: value), not %s",
                    node_describe(root, seen, sizeof seen));
        return;
    }
    default_scene(reader->arena, scene);
    schema_read(reader, &schema_scene, root, scene);
    if (!scene->name) take_name(reader, root);
    scene->sim.time_step = (float)(1 / ((double)scene->fps * scene->steps));
}

static SingeResult parse_into(SceneArena *arena, const SceneText *given, const char *base_dir, Scene **result,
                              SceneMessages *messages) {
    SceneText *text = keep_text(arena, given);
    Scene *scene = arena_new(arena, 1, sizeof *scene);
    char *folder = base_dir ? arena_text(arena, base_dir, strlen(base_dir)) : NULL;
    if (!text || !scene || (base_dir && !folder)) return SINGE_ERROR_MEMORY;
    uint32_t before = message_total(messages), first = messages->count;
    Node *root = tree_read(arena, text, text->bytes, text->size, (SceneLocation){0}, messages);
    if (root) schema_spell_out(arena, &schema_scene, root);
    if (root && !tree_set(arena, text, root, messages)) return SINGE_ERROR_MEMORY;
    Reader reader = {
        .arena = arena, .text = text, .messages = messages, .base_dir = folder, .prefix = "", .scene = scene};
    if (root) scene_fill(&reader, root);
    if (arena_failed(arena)) return SINGE_ERROR_MEMORY;
    messages_sort(messages, first);
    if (message_total(messages) != before) return SINGE_ERROR_FORMAT;
    if (!root) return SINGE_ERROR_MEMORY;
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
