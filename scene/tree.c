#include "scene/tree.h"

#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>

#include "formats/printable.h"
#include "scene/scalar.h"

enum { DEPTH_MOST = 64 };

typedef struct Builder {
    SceneArena *arena;
    const SceneText *text;
    SceneMessages *messages;
    const char *bytes; // of the document
    size_t size;
    ScenePlace origin; // --set or file, without line and column
    Node *stack[DEPTH_MOST]; // open lists and maps
    char *keys[DEPTH_MOST];  // key that waits for its value, in each open map
    ScenePlace key_places[DEPTH_MOST];
    int depth;
    Node *root;
    int documents;
    bool bad;
} Builder;

static void builder_fail(Builder *builder, ScenePlace place, const char *what) {
    message_add(builder->messages, builder->text, place, "%s", what);
    builder->bad = true;
}

static ScenePlace event_place(const Builder *builder, struct fy_event *event) {
    ScenePlace place = builder->origin;
    const struct fy_mark *mark = fy_event_start_mark(event);
    if (mark && !place.set) {
        place.line = mark->line + 1;
        place.column = mark->column + 1;
        // libfyaml's mark of a quoted text lies behind the quote, that of an alias behind the star
        struct fy_token *value = event->type == FYET_SCALAR ? event->scalar.value : NULL;
        enum fy_scalar_style style = value ? fy_token_scalar_style(value) : FYSS_PLAIN;
        bool behind = style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED || event->type == FYET_ALIAS;
        if (behind && place.column > 1)
            place.column--;
    }
    return place;
}

static void builder_attach(Builder *builder, Node *node) {
    if (!builder->depth) {
        builder->root = node;
        return;
    }
    int top = builder->depth - 1;
    Node *parent = builder->stack[top];
    if (parent->kind == NODE_MAP) {
        node->key = builder->keys[top];
        node->key_place = builder->key_places[top];
        builder->keys[top] = NULL;
    }
    if (!node->place.line) // an empty value has no place of its own
        node->place = parent->kind == NODE_MAP ? node->key_place : parent->place;
    if (parent->last)
        parent->last->next = node;
    else
        parent->first = node;
    parent->last = node;
    parent->count++;
}

// True when the next node is a key of the innermost map.
static bool builder_wants_key(const Builder *builder) {
    int top = builder->depth - 1;
    return top >= 0 && builder->stack[top]->kind == NODE_MAP && !builder->keys[top];
}

static void builder_open(Builder *builder, NodeKind kind, ScenePlace place) {
    if (builder_wants_key(builder)) {
        builder_fail(builder, place, "a key must be a single word");
        return;
    }
    if (builder->depth == DEPTH_MOST) {
        builder_fail(builder, place, "lists and maps are nested more than 64 deep");
        return;
    }
    Node *node = arena_new(builder->arena, 1, sizeof *node);
    if (!node) {
        builder->bad = true;
        return;
    }
    node->kind = kind;
    node->place = place;
    builder_attach(builder, node);
    builder->stack[builder->depth] = node;
    builder->keys[builder->depth++] = NULL;
}

static void builder_value(Builder *builder, struct fy_event *event, ScenePlace place) {
    size_t length = 0;
    char *text = scalar_text(builder->arena, event->scalar.value, builder->bytes, builder->size, &length);
    if (!text) {
        builder->bad = true;
        return;
    }
    if (strlen(text) != length) {
        builder_fail(builder, place, "a text must not contain a zero character");
        return;
    }
    if (builder_wants_key(builder)) {
        builder->keys[builder->depth - 1] = text;
        builder->key_places[builder->depth - 1] = place;
        return;
    }
    Node *node = arena_new(builder->arena, 1, sizeof *node);
    if (!node) {
        builder->bad = true;
        return;
    }
    node->kind = NODE_VALUE;
    node->place = place;
    node->text = text;
    node->quoted = event->scalar.value && fy_token_scalar_style(event->scalar.value) != FYSS_PLAIN;
    builder_attach(builder, node);
}

static void builder_take(Builder *builder, struct fy_event *event) {
    ScenePlace place = event_place(builder, event);
    struct fy_token *tag = NULL, *anchor = NULL;
    if (event->type == FYET_SCALAR)
        tag = event->scalar.tag, anchor = event->scalar.anchor;
    else if (event->type == FYET_MAPPING_START)
        tag = event->mapping_start.tag, anchor = event->mapping_start.anchor;
    else if (event->type == FYET_SEQUENCE_START)
        tag = event->sequence_start.tag, anchor = event->sequence_start.anchor;
    if (anchor || event->type == FYET_ALIAS)
        builder_fail(builder, place, "anchors and aliases (&name, *name) are not supported; write the value out");
    else if (tag)
        builder_fail(builder, place, "tags (!name) are not supported; each key knows the type of its value");
    else if (event->type == FYET_SCALAR)
        builder_value(builder, event, place);
    else if (event->type == FYET_MAPPING_START)
        builder_open(builder, NODE_MAP, place);
    else if (event->type == FYET_SEQUENCE_START)
        builder_open(builder, NODE_LIST, place);
    else if (event->type == FYET_MAPPING_END || event->type == FYET_SEQUENCE_END)
        builder->depth--;
    else if (event->type == FYET_DOCUMENT_START && builder->documents++)
        builder_fail(builder, place, "a second document (---) begins here; a scene is one document");
}

// What libfyaml has found, or a plain sentence where it does not say.
static void builder_report(Builder *builder, struct fy_diag *diag) {
    void *iterator = NULL;
    struct fy_diag_error *found;
    bool any = false;
    while ((found = fy_diag_errors_iterate(diag, &iterator))) {
        ScenePlace place = builder->origin;
        place.line = found->line > 0 ? found->line : 0;
        place.column = found->column > 0 ? found->column : 1;
        if (place.file || !found->msg)
            message_add(builder->messages, builder->text, place, "not valid YAML");
        else
            message_add(builder->messages, builder->text, place, "not valid YAML: %s", shown(found->msg).text);
        any = true;
    }
    if (!any)
        message_add(builder->messages, builder->text, builder->origin, "not valid YAML");
    builder->bad = true;
}

// A line and column of a file; a --set has neither.
static ScenePlace place_at(const Builder *builder, int line, int column) {
    ScenePlace place = builder->origin;
    if (!place.set)
        place.line = line, place.column = column;
    return place;
}

// libfyaml takes any bytes; a scene is UTF-8 without control characters, so that messages can show it.
static bool bytes_are_text(Builder *builder, const char *bytes, size_t size) {
    int line = 1, column = 1;
    bool begins = true; // a line, as libfyaml counts them: behind a lone \r and behind a byte order mark too
    const unsigned char *c = (const unsigned char *)bytes, *end = c + size;
    while (c < end) {
        int more = *c < 0x80                 ? 0
                   : *c >= 0xc2 && *c < 0xe0 ? 1
                   : *c >= 0xe0 && *c < 0xf0 ? 2
                   : *c >= 0xf0 && *c < 0xf5 ? 3
                                             : -1;
        bool good = more >= 0 && end - c > more && (*c >= 0x20 || *c == '\n' || *c == '\r' || *c == '\t');
        for (int i = 1; good && i <= more; i++)
            good = (c[i] & 0xc0) == 0x80;
        if (!good) {
            builder_fail(builder, place_at(builder, line, column),
                         "this byte is not text; a scene is UTF-8 without control characters");
            return false;
        }
        if (begins && *c == '%') { // libfyaml 0.7 may not return from a cut-off directive
            builder_fail(builder, place_at(builder, line, column),
                         "a line must not begin with %; directives of YAML are not supported");
            return false;
        }
        bool mark = c == (const unsigned char *)bytes && more == 2 && memcmp(c, "\xef\xbb\xbf", 3) == 0;
        begins = *c == '\n' || *c == '\r' || mark;
        column++;
        if (*c == '\n')
            line++, column = 1;
        c += more + 1;
    }
    return true;
}

static void builder_run(Builder *builder, struct fy_diag *diag) {
    struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_JSON_NONE | FYPCF_DEFAULT_VERSION_AUTO, .diag = diag};
    struct fy_parser *parser = fy_parser_create(&config);
    if (!parser || fy_parser_set_string(parser, builder->bytes, builder->size)) {
        builder->bad = true;
        fy_parser_destroy(parser);
        return;
    }
    struct fy_event *event;
    bool ended = false;
    while (!builder->bad && !ended && (event = fy_parser_parse(parser))) {
        ended = event->type == FYET_STREAM_END;
        builder_take(builder, event);
        fy_parser_event_free(parser, event);
    }
    if (!builder->bad && (!ended || fy_parser_get_stream_error(parser)))
        builder_report(builder, diag);
    fy_parser_destroy(parser);
}

Node *tree_read(SceneArena *arena, const SceneText *text, const char *bytes, size_t size, ScenePlace origin,
                SceneMessages *messages) {
    Builder builder = {.arena = arena, .text = text, .messages = messages, .origin = origin};
    if (!bytes_are_text(&builder, bytes, size))
        return NULL;
    if (size == 0) { // libfyaml takes length 0 for "count yourself"
        bytes = "\n";
        size = 1;
    }
    struct fy_diag_cfg config;
    fy_diag_cfg_default(&config);
    config.fp = NULL;
    config.level = FYET_ERROR;
    struct fy_diag *diag = fy_diag_create(&config);
    if (!diag)
        return NULL;
    fy_diag_set_collect_errors(diag, true);
    builder.bytes = bytes;
    builder.size = size;
    builder_run(&builder, diag);
    fy_diag_destroy(diag);
    if (builder.bad)
        return NULL;
    if (!builder.root && origin.set) { // PATH= with nothing behind it
        builder.root = arena_new(arena, 1, sizeof *builder.root);
        if (builder.root) {
            builder.root->text = arena_text(arena, "", 0);
            builder.root->place = origin;
        }
    } else if (!builder.root && !arena_failed(arena)) {
        message_add(messages, text, place_at(&builder, 1, 1),
                    origin.file ? "the file is empty" : "the scene is empty; at least 'sheets' is needed");
    }
    return builder.root;
}

Node *node_find(const Node *map, const char *key) {
    Node *found = NULL;
    for (Node *child = map && map->kind == NODE_MAP ? map->first : NULL; child; child = child->next)
        if (strcmp(child->key, key) == 0)
            found = child;
    return found;
}

const char *node_describe(const Node *node, char *buffer, size_t size) {
    if (node->kind == NODE_MAP)
        return "a map";
    if (node->kind == NODE_LIST) {
        snprintf(buffer, size, "a list of %u", (unsigned)node->count);
        return buffer;
    }
    if (!node->quoted && (!node->text[0] || !strcmp(node->text, "~") || !strcmp(node->text, "null")))
        return "nothing";
    if (node->place.file) // what stands in other files than the scene is not told
        return "this value";
    snprintf(buffer, size, "'%s'", shown(node->text).text);
    return buffer;
}

const char *node_key(const Node *node, char *buffer, size_t size) {
    snprintf(buffer, size, node->key_place.file ? "" : " '%s'", shown(node->key).text);
    return buffer;
}
