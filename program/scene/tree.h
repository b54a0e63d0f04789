// The text of a scene as a tree of lists, maps and single values, each with its location. It depends on YAML, not on
// scenes.
#pragma once

#include "scene/arena.h"
#include "scene/messages.h"

typedef enum NodeKind { NODE_VALUE, NODE_LIST, NODE_MAP } NodeKind;

typedef struct YamlNode {
    NodeKind kind;
    SceneLocation location;
    bool quoted; ///< value: it was written in quotes or as a block
    char *text;  ///< value: zero-terminated, without zeros inside
    char *key;   ///< its name if it is in a map
    SceneLocation key_location;
    uint32_t count; ///< of children
    struct YamlNode *first, *last, *next;
} YamlNode;

/// Reads one YAML document. NULL after an error or when out of memory. `origin` has the number of the --set or the file
/// for locations.
YamlNode *tree_read(SceneArena *arena, const SceneText *text, const char *bytes, size_t size, SceneLocation origin,
                    SceneMessages *messages);

/// Applies --set texts to a tree; the locations of their values name them. Returns false when out of memory.
bool tree_set(SceneArena *arena, const SceneText *text, YamlNode *root, SceneMessages *messages);

/// The last child with this key, or NULL.
YamlNode *node_find(const YamlNode *map, const char *key);

enum { NODE_WORDS = 1100 }; ///< max bytes of a description

/// "a map", "a list of 3", "nothing" or the value itself in quotes, shortened and printable, for messages. For a value
/// in a file other than the scene: "this value".
const char *node_describe(const YamlNode *node, char *buffer, size_t size);

/// " 'key'", shortened and printable; "" for a key in a file other than the scene.
const char *node_key(const YamlNode *node, char *buffer, size_t size);
