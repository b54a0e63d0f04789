// Errors in a scene, collected with their locations.
#pragma once

#include "scene/scene.h"

/// The text that a location refers to: the scene's name and bytes, and the --set texts; or those of a material file.
typedef struct SceneText {
    const char *name;
    const char *bytes;
    size_t size;
    const char *const *sets;
    int set_count;
    int number;              ///< of a material file, 0 for the scene
    struct SceneText *files; ///< of the scene: the material files read so far, the last one first
    struct SceneText *next;  ///< of a material file: the one before it
    struct YamlNode *root;   ///< its tree; of a material file NULL if it is invalid
    bool was_read;
} SceneText;

/// Adds an error at a location; an error in a material file that several sheets use is reported once. Never fails:
/// errors that do not fit into memory are counted in left_out.
void message_add(SceneMessages *messages, const SceneText *text, SceneLocation location, const char *format, ...)
    SINGE_PRINTF(4, 5);

/// Writes a warning with its location to the log. A zeroed log receives nothing.
void message_warn(const SingeLog *log, const SceneText *text, SceneLocation location, const char *format, ...)
    SINGE_PRINTF(4, 5);

/// Sorts the messages from `first` on by their location in the file; those of material files and of --set follow.
void messages_sort(SceneMessages *messages, uint32_t first);

/// The number of messages; a call that increases it has found an error.
static inline uint32_t message_total(const SceneMessages *messages) { return messages->count + messages->left_out; }
