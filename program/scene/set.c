// --set PATH=VALUE: paths are keys and numbers of list entries, "sheets.0.material.grammage" or "sources[1].start";
// maps that the file lacks are created.
#include "scene/tree.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { STEP_MAX = 64 };

typedef struct Setter {
    SceneArena *arena;
    const SceneText *text;
    SceneMessages *messages;
    SceneLocation location;
    const char *path, *rest, *stop; // the path, its unread rest, its end
} Setter;

/// The next part of the path; false at its end or if the path is malformed (then *bad).
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

/// The node at the path, created if it is missing. NULL with a message, or when out of memory.
static YamlNode *setter_walk(Setter *setter, YamlNode *root) {
    char step[STEP_MAX], seen[NODE_WORDS];
    bool bad = false;
    YamlNode *node = root;
    setter->rest = setter->path;

    while (setter_step(setter, step, &bad)) {
        YamlNode *child = NULL;
        if (node->kind == NODE_LIST) {
            const size_t digits = strspn(step, "0123456789");
            unsigned long index = digits < 10 && !step[digits] ? strtoul(step, NULL, 10) : ULONG_MAX;
            for (child = node->first; child && index; child = child->next) index--;

            if (!child) {
                char last[40];
                snprintf(last, sizeof last, node->count == 1 ? "only entry 0" : "entries 0 to %u",
                         (unsigned)node->count - 1);
                message_add(setter->messages, setter->text, setter->location, "no entry '%s': the list %s%s", step,
                            node->count ? "has " : "is empty", node->count ? last : "");
                return NULL;
            }
        } else if (node->kind == NODE_MAP) {
            child = node_find(node, step);
        } else {
            message_add(setter->messages, setter->text, setter->location, "%s has no '%s' in it",
                        node_describe(node, seen, sizeof seen), step);
            return NULL;
        }

        if (!child) { // a new key of a map
            child = arena_new(setter->arena, 1, sizeof *child);
            char *key = arena_text(setter->arena, step, strlen(step));
            if (!child || !key) return NULL;
            *child = (YamlNode){
                .kind = NODE_MAP, .location = setter->location, .key = key, .key_location = setter->location};
            if (node->last) node->last->next = child;
            else node->first = child;
            node->last = child;
            node->count++;
        }

        node = child;
    }

    return node;
}

bool tree_set(SceneArena *arena, const SceneText *text, YamlNode *root, SceneMessages *messages) {
    for (int i = 0; i < text->set_count && !arena_failed(arena); i++) {
        const char *set = text->sets[i], *equals = strchr(set, '=');
        Setter setter = {arena, text, messages, {.set = i + 1}, set, set, equals ? equals : set};
        char step[STEP_MAX];
        bool bad = false, any = false;
        while (setter_step(&setter, step, &bad)) any = true;

        if (!any || bad) {
            message_add(messages, text, setter.location,
                        "expected PATH=VALUE, such as sheets.0.material.grammage=60 g/m2");
            continue;
        }

        // the value first: a bad one must not leave partly created maps
        YamlNode *value = tree_read(arena, text, equals + 1, strlen(equals + 1), setter.location, messages);
        YamlNode *target = value ? setter_walk(&setter, root) : NULL;
        if (!target) continue;

        // the value replaces the target among its siblings; its name is now the --set's
        value->key = target->key;
        value->key_location = setter.location;
        value->next = target->next;
        *target = *value;
    }

    return !arena_failed(arena);
}
