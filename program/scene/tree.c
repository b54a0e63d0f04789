#include "scene/tree.h"

#include "common/printable.h"
#include "scene/yaml.h"

enum { DEPTH_MAX = YAML_DEPTH };

typedef struct Builder {
    SceneArena *arena;
    const SceneText *text;
    SceneMessages *messages;
    SceneLocation origin;       // --set or file, without line and column
    YamlNode *stack[DEPTH_MAX]; // open lists and maps
    char *keys[DEPTH_MAX];      // pending key of each open map
    SceneLocation key_locations[DEPTH_MAX];
    int depth;
    YamlNode *root;
    int documents;
    bool bad;
} Builder;

static void builder_fail(Builder *builder, SceneLocation location, const char *what) {
    message_add(builder->messages, builder->text, location, "%s", what);
    builder->bad = true;
}

/// A line and column of a file; a --set has neither.
static SceneLocation location_at(const Builder *builder, int line, int column) {
    SceneLocation location = builder->origin;
    if (!location.set) {
        location.line = line;
        location.column = column;
    }
    return location;
}

static const char not_read[] = "not valid YAML, or it could not be read";

static void builder_attach(Builder *builder, YamlNode *node) {
    if (!builder->depth) {
        builder->root = node;
        return;
    }

    int top = builder->depth - 1;
    YamlNode *parent = builder->stack[top];
    if (parent->kind == NODE_MAP) {
        node->key = builder->keys[top];
        node->key_location = builder->key_locations[top];
        builder->keys[top] = NULL;
    }

    if (parent->last) parent->last->next = node;
    else parent->first = node;
    parent->last = node;
    parent->count++;
}

/// True when the next node is a key of the innermost map.
static bool builder_wants_key(const Builder *builder) {
    int top = builder->depth - 1;
    return top >= 0 && builder->stack[top]->kind == NODE_MAP && !builder->keys[top];
}

static void builder_open(Builder *builder, NodeKind kind, SceneLocation location) {
    if (builder_wants_key(builder)) {
        builder_fail(builder, location, "a key must be a single word");
        return;
    }

    if (builder->depth == DEPTH_MAX) {
        builder_fail(builder, location, "lists and maps are nested more than 64 deep");
        return;
    }

    YamlNode *node = arena_new(builder->arena, 1, sizeof *node);
    if (!node) {
        builder->bad = true;
        return;
    }

    node->kind = kind;
    node->location = location;
    builder_attach(builder, node);
    builder->stack[builder->depth] = node;
    builder->keys[builder->depth++] = NULL;
}

static void builder_value(Builder *builder, const YamlEvent *event, SceneLocation location) {
    char *text = arena_text(builder->arena, event->text, event->length);
    if (!text) {
        builder->bad = true;
        return;
    }

    if (strlen(text) != event->length) {
        builder_fail(builder, location, "a text must not contain a zero character");
        return;
    }

    if (builder_wants_key(builder)) {
        builder->keys[builder->depth - 1] = text;
        builder->key_locations[builder->depth - 1] = location;
        return;
    }

    YamlNode *node = arena_new(builder->arena, 1, sizeof *node);
    if (!node) {
        builder->bad = true;
        return;
    }

    int top = builder->depth - 1;
    if ((event->flags & YAML_ABSENT) && top >= 0) // reported at its key
        location = builder->stack[top]->kind == NODE_MAP ? builder->key_locations[top] : builder->stack[top]->location;
    node->kind = NODE_VALUE;
    node->location = location;
    node->text = text;
    node->quoted = event->flags & YAML_QUOTED;
    builder_attach(builder, node);
}

static void builder_take(Builder *builder, const YamlEvent *event) {
    SceneLocation location = location_at(builder, (int)event->line, (int)event->column);
    bool node = event->kind == YAML_VALUE || event->kind == YAML_MAP || event->kind == YAML_LIST;
    if ((event->flags & YAML_ANCHORED) || event->kind == YAML_ALIAS) {
        builder_fail(builder, location, "anchors and aliases (&name, *name) are not supported; write the value out");
    } else if (event->flags & YAML_TAGGED) {
        builder_fail(builder, location, "tags (!name) are not supported; each key knows the type of its value");
    } else if (node && builder->root && !builder->depth) {
        builder_fail(builder, location, not_read);
    } else if (event->kind == YAML_VALUE) {
        builder_value(builder, event, location);
    } else if (node) {
        builder_open(builder, event->kind == YAML_MAP ? NODE_MAP : NODE_LIST, location);
    } else if (event->kind == YAML_CLOSE) {
        // the events come from a process that may have failed: an impossible order is refused
        int top = builder->depth - 1;
        if (top < 0 || (builder->stack[top]->kind == NODE_MAP && builder->keys[top]))
            builder_fail(builder, location, not_read);
        else builder->depth--;
    } else if (event->kind == YAML_DOCUMENT && builder->documents++) {
        builder_fail(builder, location, "a second document (---) begins here; a scene is one document");
    } else if (event->kind == YAML_FAULT && (location.file || !event->length)) {
        builder_fail(builder, location, "not valid YAML");
    } else if (event->kind == YAML_FAULT) {
        message_add(builder->messages, builder->text, location, "not valid YAML: %s", shown(event->text).text);
        builder->bad = true;
    }
}

/// libfyaml takes any bytes; a scene is UTF-8 without control characters, so that messages can show it.
static bool bytes_are_text(Builder *builder, const char *bytes, size_t size) {
    int line = 1, column = 1;
    bool begins = true; // of a line as libfyaml counts them: also after a lone \r and after a byte order mark
    const unsigned char *c = (const unsigned char *)bytes, *end = c + size;

    while (c < end) {
        const int length = utf8_length((const char *)c); // a zero follows all texts
        const bool good = length && end - c >= length && (*c >= 0x20 || *c == '\n' || *c == '\r' || *c == '\t');
        if (!good) {
            builder_fail(builder, location_at(builder, line, column),
                         "this byte is not text; a scene is UTF-8 without control characters");
            return false;
        }

        if (begins && *c == '%') { // libfyaml 0.7 may not return from a cut-off directive
            builder_fail(builder, location_at(builder, line, column),
                         "a line must not begin with %; directives of YAML are not supported");
            return false;
        }

        bool mark = c == (const unsigned char *)bytes && length == 3 && memcmp(c, "\xef\xbb\xbf", 3) == 0;
        begins = *c == '\n' || *c == '\r' || mark;
        column++;

        if (*c == '\n') {
            line++;
            column = 1;
        }
        c += length;
    }

    return true;
}

static YamlNode *plain_node(SceneArena *arena, const char *bytes, size_t size, SceneLocation location) {
    YamlNode *node = arena_new(arena, 1, sizeof *node);
    char *text = arena_text(arena, bytes, size);
    if (!node || !text) return NULL;
    node->location = location;
    node->text = text;
    return node;
}

YamlNode *tree_read(SceneArena *arena, const SceneText *text, const char *bytes, size_t size, SceneLocation origin,
                    SceneMessages *messages) {
    Builder builder = {.arena = arena, .text = text, .messages = messages, .origin = origin};
    if (!bytes_are_text(&builder, bytes, size)) return NULL;

    // a --set value that is a word or a number, perhaps with a unit, needs no YAML; PATH= alone is a value, too
    static const char inside[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789./%+-_() ";
    bool plain = !size || (strspn(bytes, inside) == size && bytes[size - 1] != ' ');
    if (origin.set && plain && size) {
        const char *first = bytes + (*bytes == '-' || *bytes == '+');
        plain = strspn(first, inside) > 0 && !strchr("-%() +_/", *first) && strncmp(first, "..", 2) != 0;
    }
    if (origin.set && plain) return plain_node(arena, bytes, size, origin);

    if (size == 0) { // libfyaml takes length 0 for "count yourself"
        bytes = "\n";
        size = 1;
    }

    YamlEvents events;
    SingeError error = {0};
    SingeResult result = yaml_read(text->name, bytes, size, &events, &error);
    if (result == SINGE_ERROR_MEMORY) {
        arena_fail(arena);
        return NULL;
    }

    if (result) {
        message_add(messages, text, location_at(&builder, 1, 1), "%s%s",
                    result == SINGE_ERROR_FILE ? "" : "not valid YAML, or it cannot be read: ", error.message);
        return NULL;
    }

    // an error ends the tree, but all syntax errors are reported
    YamlEvent event = {0};
    while (event.kind != YAML_END && (!builder.bad || event.kind == YAML_FAULT)) {
        if (!yaml_next(&events, &event)) {
            builder_fail(&builder, location_at(&builder, 1, 1), not_read);
            break;
        }
        if (!builder.bad || event.kind == YAML_FAULT) builder_take(&builder, &event);
    }

    if (!builder.bad && builder.depth)
        builder_fail(&builder, location_at(&builder, (int)event.line, (int)event.column), not_read);
    yaml_free(&events);
    if (builder.bad) return NULL;

    if (!builder.root && origin.set && !arena_failed(arena)) // only a comment
        return plain_node(arena, "", 0, origin);
    if (!builder.root && !arena_failed(arena))
        message_add(messages, text, location_at(&builder, 1, 1),
                    origin.file ? "the file is empty" : "the scene is empty; at least 'sheets' is needed");

    return builder.root;
}

YamlNode *node_find(const YamlNode *map, const char *key) {
    YamlNode *found = NULL;
    for (YamlNode *child = map && map->kind == NODE_MAP ? map->first : NULL; child; child = child->next)
        if (strcmp(child->key, key) == 0) found = child;
    return found;
}

const char *node_describe(const YamlNode *node, char *buffer, size_t size) {
    if (node->kind == NODE_MAP) return "a map";
    if (node->kind == NODE_LIST) {
        snprintf(buffer, size, "a list of %u", (unsigned)node->count);
        return buffer;
    }

    if (!node->quoted && (!node->text[0] || !strcmp(node->text, "~") || !strcmp(node->text, "null"))) return "nothing";
    if (node->location.file) // the contents of files other than the scene are not shown
        return "this value";
    snprintf(buffer, size, "'%s'", shown(node->text).text);
    return buffer;
}

const char *node_key(const YamlNode *node, char *buffer, size_t size) {
    snprintf(buffer, size, node->key_location.file ? "" : " '%s'", shown(node->key).text);
    return buffer;
}
