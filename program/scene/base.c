// The base of a material: a built-in material or a file. Either is a map with the keys of `material` in a scene, and
// may have a base of its own.
#include "common/printable.h"
#include "scene/builtin.h"
#include "scene/values.h"

#include <string.h>
#include <sys/stat.h>

enum { BASES_MAX = 16 }; ///< depth of bases

/// A file being read, and the file that names it.
typedef struct BaseChain {
    const struct BaseChain *outer;
    const SceneText *text;
    struct stat status; ///< of a file: two paths may lead to the same one
    int depth;
} BaseChain;

const char *scene_material_name(int index) {
    int count = 0;
    while (scene_builtins[count].name && count < index) count++;
    return count == index ? scene_builtins[count].name : NULL;
}

const char *base_names(char *buffer, size_t size) {
    buffer[0] = 0;
    for (const SceneBuiltin *builtin = scene_builtins; builtin->name; builtin++) {
        size_t used = strlen(buffer);
        snprintf(buffer + used, size - used, "%s%s", used ? ", " : "", builtin->name);
    }
    return buffer;
}

static bool ends_in(const char *text, const char *ending) {
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

/// The text of that name, already read or new; NULL when out of memory.
static SceneText *base_text(Reader *reader, const char *name, const char *bytes, size_t size) {
    SceneText *text = arena_new(reader->arena, 1, sizeof *text);
    char *copy = arena_text(reader->arena, bytes, size);
    if (!text || !copy) return NULL;

    text->name = name;
    text->bytes = copy;
    text->size = size;
    text->next = reader->text->files;
    text->number = text->next ? text->next->number + 1 : 1;

    return reader->text->files = text;
}

static SceneText *base_known(const Reader *reader, const char *name) {
    SceneText *text = reader->text->files;
    while (text && strcmp(text->name, name) != 0) text = text->next;
    return text;
}

static SceneText *base_builtin(Reader *reader, const YamlNode *node) {
    Nearest nearest = {.word = node->text};
    const SceneBuiltin *builtin = scene_builtins;
    for (; builtin->name && strcmp(builtin->name, node->text) != 0; builtin++) nearest_offer(&nearest, builtin->name);

    if (builtin->name) {
        SceneText *known = base_known(reader, builtin->name);
        return known ? known : base_text(reader, builtin->name, builtin->bytes, builtin->size);
    }

    char seen[NODE_WORDS], hint[80], names[160];
    complain(reader, node->location,
             "there is no material %s; the built-in ones are %s; a file of your own needs its extension "
             "(mine.yaml)%s",
             node_describe(node, seen, sizeof seen), base_names(names, sizeof names),
             nearest_hint(&nearest, hint, sizeof hint));

    return NULL;
}

/// The text of a file; *file says where it is.
static SceneText *base_file(Reader *reader, const SchemaRow *row, const YamlNode *node, SceneFile *file) {
    uint32_t before = message_total(reader->messages);
    Bytes bytes = {0};
    SingeError error;
    SceneText *text = NULL;

    value_file(reader, row, node, file); // reports a missing file
    if (message_total(reader->messages) != before || !file->path) return NULL;
    if ((text = base_known(reader, file->path))) return text;

    if (file_read_max(file->path, SCENE_BYTES_MAX, (SingeAllocator){0}, &bytes, &error))
        complain(reader, node->location, "a material cannot be read: %s", error.message);
    else text = base_text(reader, file->path, (const char *)bytes.data, bytes.size);
    bytes_free(&bytes);

    return text;
}

/// Whether the file may be read: not if it is being read already.
static bool chain_open(Reader *reader, const YamlNode *node, const SceneFile *file, BaseChain *link) {
    if (file->path && stat(file->path, &link->status)) link->status = (struct stat){0};
    for (const BaseChain *outer = link->outer; outer; outer = outer->outer)
        if (outer->text == link->text || (file->path && outer->status.st_ino == link->status.st_ino &&
                                          outer->status.st_dev == link->status.st_dev)) {
            complain(reader, node->location, "%s is based on itself, through %s", shown_path(link->text->name).text,
                     shown_path(reader->chain->text->name).text);
            return false;
        }
    if (link->depth <= BASES_MAX) return true;

    complain(reader, node->location, "more than %d materials are based on one another", BASES_MAX);
    return false;
}

void read_base(Reader *reader, const SchemaRow *row, const YamlNode *node, SceneMaterial *material) {
    if (!value_is_text(node)) {
        value_wrong(reader, node, row);
        return;
    }

    // names of files have an ending or a slash; names of built-in materials have neither
    const char *word = node->text;
    bool from_file = strchr(word, '/') || ends_in(word, ".yaml") || ends_in(word, ".yml") || ends_in(word, ".json");
    if (from_file && !reader->base_dir) // files are not read
        return;

    SceneFile file = {0};
    SceneText *text = from_file ? base_file(reader, row, node, &file) : base_builtin(reader, node);
    BaseChain link = {.outer = reader->chain, .text = text, .depth = reader->chain ? reader->chain->depth + 1 : 1};
    if (!text || !chain_open(reader, node, &file, &link)) return;

    if (!text->was_read)
        text->root = tree_read(reader->arena, reader->text, text->bytes, text->size,
                               (SceneLocation){.file = text->number}, reader->messages);
    text->was_read = true;
    YamlNode *root = text->root;
    if (!root) return;

    char seen[NODE_WORDS];
    if (root->kind != NODE_MAP) {
        complain(reader, root->location, "a material must be a map (key: value), not %s",
                 node_describe(root, seen, sizeof seen));
        return;
    }

    // files that this one names are relative to its folder, "materials/" of "materials/mine.yaml"
    Reader inner = *reader;
    const char *slash = file.name ? strrchr(file.name, '/') : NULL;
    inner.chain = &link;
    inner.prefix = slash ? arena_text(reader->arena, file.name, (size_t)(slash + 1 - file.name)) : "";
    if (!inner.prefix) return;

    schema_spell_out(reader->arena, &schema_material, root);
    schema_read(&inner, &schema_material, root, material);

    // "dir/mine.yaml" is called mine
    if (!node_find(root, "name")) {
        const char *last = strrchr(text->name, '/'), *name = last ? last + 1 : text->name, *dot = strrchr(name, '.');
        material->name = arena_text(reader->arena, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
    }
}
