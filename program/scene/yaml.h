// YAML as a list of events, by libfyaml in a process of its own (formats/isolate.h): libfyaml crashes when out of
// memory, and a scene may come from anywhere. The events are validated.
#pragma once

#include "formats/formats.h"

typedef enum YamlKind {
    YAML_VALUE, ///< its text follows
    YAML_MAP,   ///< keys and values in turn, up to its YAML_CLOSE
    YAML_LIST,
    YAML_CLOSE,
    YAML_DOCUMENT, ///< one begins
    YAML_ALIAS,    ///< an alias, a tag or an anchor: the last event
    YAML_FAULT,    ///< not YAML; its text, if any, says why
    YAML_END,      ///< of the text
    YAML_KINDS
} YamlKind;

enum {
    YAML_QUOTED = 1, ///< or a block scalar
    YAML_TAGGED = 2,
    YAML_ANCHORED = 4,
    YAML_ABSENT = 8, ///< an empty value; its location is the end of the event before it
    YAML_FLAGS = 15,
};

enum { YAML_DEPTH = 64 }; ///< max depth of maps and lists; the first deeper one is the last event

typedef struct YamlEvent {
    uint32_t kind, flags;
    uint32_t line, column; ///< from 1
    uint32_t length;       ///< of the text, without its zero
    const char *text;      ///< zero-terminated, and may contain zeros; NULL if there is none
} YamlEvent;

/// The events of a text, read one by one. Zero it before the first use.
typedef struct YamlEvents {
    Bytes bytes;
    size_t at;
} YamlEvents;

/// Reads a text of at least one byte. `name` is for messages. Errors in the text are events. Errors:
/// SINGE_ERROR_MEMORY; SINGE_ERROR_FORMAT if libfyaml crashed or did not end; SINGE_ERROR_STATE if it was interrupted.
/// A process that has threads reads the text itself, not in a child.
SINGE_NODISCARD SingeResult yaml_read(const char *name, const char *bytes, size_t size, YamlEvents *events,
                                      SingeError *error);

/// The next event; false if there is none or it is invalid. Its text lives as long as the events.
bool yaml_next(YamlEvents *events, YamlEvent *event);

void yaml_free(YamlEvents *events);
