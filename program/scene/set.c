// --set PATH=VALUE: paths are keys and numbers of list entries, "sheets.0.material.grammage" or "sources[1].start";
// maps that the file lacks are created.
#include "scene/tree.h"

#include <string.h>

enum { STEP_MAX = 64 };

typedef struct Setter {
    SceneArena *arena;
    const SceneText *text;
    SceneMessages *messages;
    SceneLocation location;
    const char *path, *rest, *stop; // the path, its unread rest, its end
} Setter;

// The next part of the path; false at its end or if the path is malformed (then *bad).
static bool setter_step(Setter *setter, char step[STEP_MAX], bool *bad) {
    const char *c = setter->rest;
    if (c == setter->stop) return false;
    bool bracket = *c == '[';
    if (bracket || (*c == '.' && c > setter->path)) c++;
    size_t length = 0;
    while (c < setter->stop && *c != '.' && *c != '[' && *c != ']' && length < STEP_MAX - 1) step[length++] = *c++;
    step[length] = 0;
    if (bracket) {
        if (c == setter->stop || *c != ']') *bad = true;
        else c++;
    }
    if (!length || (c < setter->stop && *c != '.' && *c != '[')) *bad = true;
    setter->rest = c;
    return !*bad;
}

static Node *child_at(const Node *list, const char *step) {
    uint32_t index = 0;
    for (const char *c = step; *c; c++) {
        if (*c < '0' || *c > '9' || index > 100000000) return NULL;
        index = index * 10 + (uint32_t)(*c - '0');
    }
    Node *child = list->first;
    while (child && index--) child = child->next;
    return child;
}

static Node *child_new(Setter *setter, Node *map, const char *step) {
    Node *child = arena_new(setter->arena, 1, sizeof *child);
    if (!child) return NULL;
    child->kind = NODE_MAP;
    child->location = child->key_location = setter->location;
    child->key = arena_text(setter->arena, step, strlen(step));
    if (!child->key) return NULL;
    if (map->last) map->last->next = child;
    else map->first = child;
    map->last = child;
    map->count++;
    return child;
}

// The node at the path, created if it is missing. NULL with a message, or when out of memory.
static Node *setter_walk(Setter *setter, Node *root) {
    char step[STEP_MAX], seen[NODE_WORDS];
    bool bad = false;
    Node *node = root;
    setter->rest = setter->path;
    while (setter_step(setter, step, &bad)) {
        Node *child = NULL;
        if (node->kind == NODE_LIST) {
            child = child_at(node, step);
            if (!child) {
                message_add(setter->messages, setter->text, setter->location,
                            "'%s' is not an entry of that list, which has %u (the first is 0)", step,
                            (unsigned)node->count);
                return NULL;
            }
        } else if (node->kind == NODE_MAP) {
            child = node_find(node, step);
            if (!child) child = child_new(setter, node, step);
        } else {
            message_add(setter->messages, setter->text, setter->location, "%s has no '%s' in it",
                        node_describe(node, seen, sizeof seen), step);
            return NULL;
        }
        if (!child) return NULL;
        node = child;
    }
    return node;
}

static bool setter_path_good(Setter *setter) {
    char step[STEP_MAX];
    bool bad = false, any = false;
    while (setter_step(setter, step, &bad)) any = true;
    return any && !bad;
}

static void set_one(SceneArena *arena, const SceneText *text, int index, Node *root, SceneMessages *messages) {
    const char *set = text->sets[index], *equals = strchr(set, '=');
    Setter setter = {arena, text, messages, {.set = index + 1}, set, set, equals ? equals : set};
    if (!setter_path_good(&setter)) {
        message_add(messages, text, setter.location, "expected PATH=VALUE, such as sheets.0.material.grammage=60 g/m2");
        return;
    }
    // the value first: a bad one must not leave partly created maps
    Node *value = tree_read(arena, text, equals + 1, strlen(equals + 1), setter.location, messages);
    Node *target = value ? setter_walk(&setter, root) : NULL;
    if (!target) return;
    // the value replaces the target among its siblings; its name is now the --set's
    value->key = target->key;
    value->key_location = setter.location;
    value->next = target->next;
    *target = *value;
}

bool tree_set(SceneArena *arena, const SceneText *text, Node *root, SceneMessages *messages) {
    for (int i = 0; i < text->set_count && !arena_failed(arena); i++) set_one(arena, text, i, root, messages);
    return !arena_failed(arena);
}
