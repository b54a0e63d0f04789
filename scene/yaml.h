// YAML as a list of events, by libfyaml in a process of its own (formats/isolate.h): it crashes where memory is
// refused, and a scene may come from anywhere. What comes back is checked before it is believed.
#ifndef SCENE_YAML_H
#define SCENE_YAML_H

#include "formats/formats.h"

typedef enum YamlKind {
    YAML_VALUE, ///< its text follows
    YAML_MAP,   ///< keys and values in turn, up to its YAML_CLOSE
    YAML_LIST,
    YAML_CLOSE,
    YAML_DOCUMENT, ///< one begins
    YAML_ALIAS,    ///< the last event, as is one with a tag or an anchor
    YAML_FAULT,    ///< not YAML; its text says why, or nothing
    YAML_END,      ///< of the text
    YAML_KINDS
} YamlKind;

enum {
    YAML_QUOTED = 1, ///< or a block
    YAML_TAGGED = 2,
    YAML_ANCHORED = 4,
    YAML_ABSENT = 8, ///< a value of which nothing is written; its location is where the event before it ended
    YAML_FLAGS = 15,
};

enum { YAML_DEPTH = 64 }; ///< that maps and lists are reported to; the first that is deeper is the last event

typedef struct YamlEvent {
    uint32_t kind, flags;
    uint32_t line, column; ///< from 1
    uint32_t length;       ///< of the text, without its zero
    const char *text;      ///< zero-terminated, and may have zeros inside; NULL where there is none
} YamlEvent;

/// The events of a text, to be read one after another. Zero it before the first use.
typedef struct YamlEvents {
    Bytes bytes;
    size_t at;
} YamlEvents;

/// Reads a text of at least one byte. `name` is for messages. Errors in the text are events. Errors:
/// SINGE_ERROR_MEMORY; SINGE_ERROR_FORMAT where libfyaml crashed or did not come to an end; SINGE_ERROR_STATE where
/// it was interrupted. In a process that has threads it is read here, not in a child.
SINGE_NODISCARD SingeResult yaml_read(const char *name, const char *bytes, size_t size, YamlEvents *events,
                                      SingeError *error);

/// The next event; false where there is none or it is not as it should be. Its text lives as long as the events.
bool yaml_next(YamlEvents *events, YamlEvent *event);

void yaml_free(YamlEvents *events);

#endif
