#include "scene/yaml.h"

#include <errno.h>
#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>

#include "formats/isolate.h"
#include "scene/scalar.h"

/// More than any text of a megabyte needs (0.4 GB and some seconds, for brackets that never close).
static const IsolateLimits limits = {.memory = (size_t)1 << 30, .seconds = 10};

/// An event as sent from the child to the parent; its text and a zero follow.
typedef struct Record {
    uint32_t kind, flags, line, column, length;
} Record;

// ---- in the child

enum { SINK_BYTES = 1 << 16 };

typedef struct Sink {
    const char *bytes; ///< the text
    size_t size;
    SceneArena *arena;     ///< of the texts of values
    IsolateAnswer *answer; ///< NULL: `out` grows instead
    char *out;
    size_t used, capacity;
    uint32_t line, column;            ///< where the last event was
    uint32_t line_count, last_length; ///< of the text: lines, and characters of the last
    int depth;
    bool no_memory;
} Sink;

static void sink_flush(Sink *sink) {
    isolate_put(sink->answer, sink->out, sink->used);
    sink->used = 0;
}

static void sink_put(Sink *sink, const void *bytes, size_t size) {
    if (sink->answer && sink->used + size > sink->capacity) sink_flush(sink);
    if (sink->used + size > sink->capacity) {
        size_t capacity = 2 * (sink->used + size) + SINK_BYTES;
        char *out = realloc(sink->out, capacity);
        if (!out) {
            sink->no_memory = true;
            return;
        }
        sink->out = out;
        sink->capacity = capacity;
    }
    memcpy(sink->out + sink->used, bytes, size);
    sink->used += size;
}

static void sink_event(Sink *sink, YamlKind kind, unsigned flags, const char *text, size_t length) {
    Record record = {kind, flags, sink->line, sink->column, (uint32_t)length};
    sink_put(sink, &record, sizeof record);
    sink_put(sink, length ? text : "", length);
    sink_put(sink, "", 1);
}

/// libfyaml adds a line end to a text without one: what it finds there is after that line.
static void sink_move(Sink *sink, int line, int column) {
    if (line < 0 || column < 0) return;
    sink->line = (uint32_t)line + 1;
    sink->column = (uint32_t)column + 1;
    if (sink->line > sink->line_count) {
        sink->line = sink->line_count;
        sink->column = sink->last_length + 1;
    }
}

static void sink_mark(Sink *sink, const struct fy_mark *mark) {
    if (mark) sink_move(sink, mark->line, mark->column);
}

static void sink_measure(Sink *sink) {
    sink->line_count = 1;
    for (size_t i = 0; i < sink->size; i++)
        if (sink->bytes[i] == '\n') sink->line_count++, sink->last_length = 0;
        else sink->last_length += ((unsigned char)sink->bytes[i] & 0xc0) != 0x80;
}

/// An event without a location gets the end of the last one.
static void sink_location(Sink *sink, const struct fy_event *event, struct fy_token *tag, struct fy_token *anchor) {
    struct fy_token *value = event->type == FYET_SCALAR ? event->scalar.value : NULL;
    const struct fy_mark *mark = fy_event_start_mark((struct fy_event *)event);
    if (!mark && (tag || anchor)) mark = fy_token_start_mark(tag ? tag : anchor);
    sink_mark(sink, mark);
    // libfyaml's mark of a quoted text is after the quote, that of an alias after the star
    enum fy_scalar_style style = value ? fy_token_scalar_style(value) : FYSS_PLAIN;
    bool behind = style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED || event->type == FYET_ALIAS;
    if (mark && behind && sink->column > 1) sink->column--;
}

/// Returns whether there are more events: one that no scene may have is the last.
static bool sink_take(Sink *sink, const struct fy_event *event) {
    struct fy_token *tag = NULL, *anchor = NULL, *value = NULL;
    YamlKind kind = YAML_CLOSE;
    size_t length = 0;
    char *text = NULL;
    switch (event->type) {
    case FYET_SCALAR:
        kind = YAML_VALUE;
        value = event->scalar.value;
        tag = event->scalar.tag;
        anchor = event->scalar.anchor;
        text = scalar_text(sink->arena, value, sink->bytes, sink->size, &length);
        sink->no_memory = sink->no_memory || !text;
        break;
    case FYET_MAPPING_START:
        kind = YAML_MAP;
        tag = event->mapping_start.tag;
        anchor = event->mapping_start.anchor;
        break;
    case FYET_SEQUENCE_START:
        kind = YAML_LIST;
        tag = event->sequence_start.tag;
        anchor = event->sequence_start.anchor;
        break;
    case FYET_MAPPING_END:
    case FYET_SEQUENCE_END: break;
    case FYET_DOCUMENT_START: kind = YAML_DOCUMENT; break;
    case FYET_ALIAS: kind = YAML_ALIAS; break;
    default: return true;
    }
    sink_location(sink, event, tag, anchor);
    unsigned flags = (tag ? YAML_TAGGED : 0) | (anchor ? YAML_ANCHORED : 0);
    if (value && fy_token_scalar_style(value) != FYSS_PLAIN) flags |= YAML_QUOTED;
    // no mark shows it: libfyaml 0.8 has one for absent values, 0.7 has none
    if (kind == YAML_VALUE && !(flags & YAML_QUOTED) && length == 0) flags |= YAML_ABSENT;
    sink_event(sink, kind, flags, text, length);
    sink->depth += (kind == YAML_MAP || kind == YAML_LIST) - (kind == YAML_CLOSE);
    sink_mark(sink, fy_event_end_mark((struct fy_event *)event));
    return !tag && !anchor && kind != YAML_ALIAS && sink->depth <= YAML_DEPTH;
}

/// libfyaml's message, or nothing if it has none.
static void sink_faults(Sink *sink, struct fy_diag *diag) {
    void *iterator = NULL;
    struct fy_diag_error *found;
    bool any = false;
    while ((found = fy_diag_errors_iterate(diag, &iterator))) {
        sink_move(sink, found->line - 1, found->column > 0 ? found->column - 1 : 0);
        sink_event(sink, YAML_FAULT, 0, found->msg, found->msg ? strlen(found->msg) : 0);
        any = true;
    }
    if (!any) sink_event(sink, YAML_FAULT, 0, NULL, 0);
}

static void sink_run(Sink *sink, struct fy_diag *diag) {
    struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_JSON_NONE | FYPCF_DEFAULT_VERSION_AUTO, .diag = diag};
    struct fy_parser *parser = fy_parser_create(&config);
    if (!parser || fy_parser_set_string(parser, sink->bytes, sink->size)) {
        sink->no_memory = true;
        fy_parser_destroy(parser);
        return;
    }
    struct fy_event *event;
    bool ended = false, more = true;
    while (more && !ended && !sink->no_memory && (event = fy_parser_parse(parser))) {
        ended = event->type == FYET_STREAM_END;
        more = sink_take(sink, event);
        fy_parser_event_free(parser, event);
    }
    if (more && (!ended || fy_parser_get_stream_error(parser))) {
        if (errno == ENOMEM) // libfyaml reports it in no other way
            sink->no_memory = true;
        else sink_faults(sink, diag);
    }
    sink_event(sink, YAML_END, 0, NULL, 0);
    fy_parser_destroy(parser);
}

static SingeResult sink_work(void *context, IsolateAnswer *answer, SingeError *error) {
    Sink *sink = context;
    struct fy_diag_cfg config;
    fy_diag_cfg_default(&config);
    config.fp = NULL;
    config.level = FYET_ERROR;
    struct fy_diag *diag = fy_diag_create(&config);
    sink->answer = answer;
    sink->arena = arena_create();
    sink->line = sink->column = 1;
    sink_measure(sink);
    errno = 0;
    if (diag && sink->arena) {
        fy_diag_set_collect_errors(diag, true);
        sink_run(sink, diag);
    } else {
        sink->no_memory = true;
    }
    fy_diag_destroy(diag);
    arena_destroy(sink->arena);
    if (answer) sink_flush(sink);
    *error = (SingeError){.code = sink->no_memory ? SINGE_ERROR_MEMORY : SINGE_OK, .element = -1};
    return error->code;
}

// ---- in the parent

#ifdef SCENE_YAML_HERE
static const bool always_here = true; // fuzzers instrument libfyaml, and start no process per text
#else
static const bool always_here = false;
#endif

static SingeResult yaml_run(const char *name, Sink *sink, YamlEvents *events, SingeError *error) {
    // commands that simulate before they read (`paper`, `validate`) read only their own scenes
    if (always_here || !isolate_possible()) {
        SingeResult result = sink_work(sink, NULL, error);
        events->bytes = (Bytes){.data = (uint8_t *)sink->out, .size = sink->used};
        return result;
    }
    SingeResult result = isolate_run(name, sink_work, sink, limits, (SingeAllocator){0}, &events->bytes, error);
    if (result == SINGE_ERROR_LIMIT) // no text needs as much memory: so an allocation failed
        result = error->element < 0 ? SINGE_ERROR_FORMAT : SINGE_ERROR_MEMORY;
    return result;
}

SingeResult yaml_read(const char *name, const char *bytes, size_t size, YamlEvents *events, SingeError *error) {
    Sink sink = {.bytes = bytes, .size = size};
    *events = (YamlEvents){0};
    SingeResult result = yaml_run(name, &sink, events, error);
    if (result) yaml_free(events);
    return result;
}

bool yaml_next(YamlEvents *events, YamlEvent *event) {
    Record record;
    size_t left = events->bytes.size - events->at;
    if (left < sizeof record) return false;
    memcpy(&record, events->bytes.data + events->at, sizeof record);
    left -= sizeof record;
    bool good = record.kind < YAML_KINDS && record.flags <= YAML_FLAGS && record.length < left;
    good = good && record.line > 0 && record.line < INT32_MAX && record.column > 0 && record.column < INT32_MAX;
    if (!good) return false;
    const char *text = (const char *)events->bytes.data + events->at + sizeof record;
    *event = (YamlEvent){record.kind, record.flags, record.line, record.column, record.length, text};
    events->at += sizeof record + record.length + 1;
    return text[record.length] == 0;
}

void yaml_free(YamlEvents *events) {
    bytes_free(&events->bytes);
    *events = (YamlEvents){0};
}
