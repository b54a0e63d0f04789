// The text of a scene as a tree of lists, maps and single values, each with its location. Knows YAML, not scenes.
#ifndef SCENE_TREE_H
#define SCENE_TREE_H

#include "scene/arena.h"
#include "scene/messages.h"

typedef enum NodeKind { NODE_VALUE, NODE_LIST, NODE_MAP } NodeKind;

typedef struct Node {
    NodeKind kind;
    SceneLocation location;
    bool quoted; ///< value: it was written in quotes or as a block
    char *text;  ///< value: zero-terminated, has no zero inside
    char *key;   ///< its name when it is in a map
    SceneLocation key_location;
    uint32_t count; ///< of children
    struct Node *first, *last, *next;
} Node;

/// Reads one YAML document. NULL after an error or when out of memory. `origin` has the numbers of the --set or the
/// file for locations.
Node *tree_read(SceneArena *arena, const SceneText *text, const char *bytes, size_t size, SceneLocation origin,
                SceneMessages *messages);

/// Lays --set texts over a tree; their values' locations name them. Returns false when out of memory.
bool tree_set(SceneArena *arena, const SceneText *text, Node *root, SceneMessages *messages);

/// The last child with this key, or NULL.
Node *node_find(const Node *map, const char *key);

enum { NODE_WORDS = 1100 }; ///< bytes that a description may take

/// "a map", "a list of 3", "nothing" or the value itself in quotes, cut and printable, for messages. Of a value in
/// another file than the scene: "this value".
const char *node_describe(const Node *node, char *buffer, size_t size);

/// " 'key'", cut and printable; "" of a key in another file than the scene.
const char *node_key(const Node *node, char *buffer, size_t size);

#endif
