#include "scene/yaml.h"

#include <errno.h>
#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>

#include "formats/isolate.h"
#include "scene/arena.h"

/// More than any text of a megabyte needs (0.4 GB and some seconds, for brackets that never close).
static const IsolateLimits limits = {.memory = (size_t)1 << 30, .seconds = 10};

/// An event as sent from the child to the parent; its text and a zero follow.
typedef struct Record {
    uint32_t kind, flags, line, column, length;
} Record;

// ---- the text of a value

// fy_token_get_text of libfyaml 0.7 reads '''' (two quotes in quotes) as three quotes, finds that they do not fit,
// leaks and returns an empty text. So single quotes are removed here, and other styles are read chunk by chunk.

static bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Length of the line break at c: \n, \r or \r\n.
static int line_break(const char *c, const char *end) {
    if (c == end || (*c != '\n' && *c != '\r')) return 0;
    return *c == '\r' && end - c > 1 && c[1] == '\n' ? 2 : 1;
}

/// YAML 1.2, 7.3.2: '' is one quote. Lines are folded: blanks around a break vanish, one break is a space, and n breaks
/// are n - 1 newlines. `out` has room for as many bytes as the input.
static size_t scalar_unquote(const char *c, const char *end, char *out) {
    size_t length = 0, line = 0; // `line`: where trailing blanks of the current line may begin
    while (c < end) {
        int width = line_break(c, end);
        if (!width) {
            out[length++] = *c;
            c += *c == '\'' && end - c > 1 ? 2 : 1;
            continue;
        }

        while (length > line && is_blank(out[length - 1])) length--;
        int breaks = 0;
        for (; (width = line_break(c, end)) > 0; breaks++) {
            c += width;
            while (c < end && is_blank(*c)) c++;
        }

        if (breaks == 1) out[length++] = ' ';
        else {
            memset(out + length, '\n', (size_t)breaks - 1);
            length += (size_t)breaks - 1;
        }
        line = length;
    }

    return length;
}

/// Bytes of a token, copied to `out` if that is not NULL.
static size_t copy_chunks(struct fy_token_iter *iterator, char *out) {
    const struct fy_iter_chunk *chunk = NULL;
    size_t length = 0;
    int error = 0;
    while ((chunk = fy_token_iter_chunk_next(iterator, chunk, &error))) {
        if (out) memcpy(out + length, chunk->str, chunk->len);
        length += chunk->len;
    }
    return length;
}

/// The text of a scalar token (NULL is an empty one) of the input `bytes`, zero-terminated, in the arena; it may
/// contain zeros, so *length is its length. NULL when out of memory.
static char *scalar_text(SceneArena *arena, struct fy_token *token, const char *bytes, size_t size, size_t *length) {
    *length = 0;
    if (!token) return arena_text(arena, "", 0);

    // single quotes, if they are at the token's marks
    const struct fy_mark *first = fy_token_start_mark(token), *last = fy_token_end_mark(token);
    bool marked = fy_token_scalar_style(token) == FYSS_SINGLE_QUOTED && first && last && first->input_pos >= 1 &&
                  first->input_pos <= last->input_pos && last->input_pos < size;
    if (marked && bytes[first->input_pos - 1] == '\'' && bytes[last->input_pos] == '\'') {
        const char *begin = bytes + first->input_pos, *end = bytes + last->input_pos;
        char *text = arena_new(arena, (size_t)(end - begin) + 1, 1);
        if (text) {
            *length = scalar_unquote(begin, end, text);
            text[*length] = 0;
        }
        return text;
    }

    struct fy_token_iter *count = fy_token_iter_create(token), *copy = fy_token_iter_create(token);
    char *text = NULL;
    if (count && copy) {
        *length = copy_chunks(count, NULL);
        text = arena_new(arena, *length + 1, 1);
        if (text) copy_chunks(copy, text);
    }

    fy_token_iter_destroy(count);
    fy_token_iter_destroy(copy);
    return text;
}

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

    // an event without a location gets the end of the last one; libfyaml's mark of a quoted text is after the quote,
    // that of an alias after the star
    const struct fy_mark *mark = fy_event_start_mark((struct fy_event *)event);
    if (!mark && (tag || anchor)) mark = fy_token_start_mark(tag ? tag : anchor);
    sink_mark(sink, mark);

    enum fy_scalar_style style = value ? fy_token_scalar_style(value) : FYSS_PLAIN;
    bool behind = style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED || event->type == FYET_ALIAS;
    if (mark && behind && sink->column > 1) sink->column--;

    unsigned flags = (tag ? YAML_TAGGED : 0) | (anchor ? YAML_ANCHORED : 0);
    if (style != FYSS_PLAIN) flags |= YAML_QUOTED;

    // no mark shows it: libfyaml 0.8 has one for absent values, 0.7 has none
    if (kind == YAML_VALUE && !(flags & YAML_QUOTED) && length == 0) flags |= YAML_ABSENT;
    sink_event(sink, kind, flags, text, length);
    sink->depth += (kind == YAML_MAP || kind == YAML_LIST) - (kind == YAML_CLOSE);
    sink_mark(sink, fy_event_end_mark((struct fy_event *)event));

    return !tag && !anchor && kind != YAML_ALIAS && sink->depth <= YAML_DEPTH;
}

static SingeResult sink_work(void *context, IsolateAnswer *answer, SingeError *error) {
    Sink *sink = context;
    sink->answer = answer;
    sink->arena = arena_create();
    sink->line = sink->column = sink->line_count = 1;

    for (size_t i = 0; i < sink->size; i++)
        if (sink->bytes[i] == '\n') {
            sink->line_count++;
            sink->last_length = 0;
        } else {
            sink->last_length += ((unsigned char)sink->bytes[i] & 0xc0) != 0x80;
        }

    struct fy_diag_cfg diag_config;
    fy_diag_cfg_default(&diag_config);
    diag_config.fp = NULL;
    diag_config.level = FYET_ERROR;
    struct fy_diag *diag = fy_diag_create(&diag_config);
    struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_JSON_NONE | FYPCF_DEFAULT_VERSION_AUTO, .diag = diag};
    struct fy_parser *parser = NULL;

    errno = 0;
    if (diag) fy_diag_set_collect_errors(diag, true);
    if (diag && sink->arena) parser = fy_parser_create(&config);
    sink->no_memory = !parser || fy_parser_set_string(parser, sink->bytes, sink->size);

    struct fy_event *event;
    bool ended = false, more = !sink->no_memory;
    while (more && !ended && !sink->no_memory && (event = fy_parser_parse(parser))) {
        ended = event->type == FYET_STREAM_END;
        more = sink_take(sink, event);
        fy_parser_event_free(parser, event);
    }

    bool failed = more && (!ended || fy_parser_get_stream_error(parser));
    if (failed && errno == ENOMEM) // libfyaml reports it in no other way
        sink->no_memory = true;
    else if (failed) { // libfyaml's messages, or nothing if it has none
        void *iterator = NULL;
        const struct fy_diag_error *found;
        bool any = false;
        while ((found = fy_diag_errors_iterate(diag, &iterator))) {
            sink_move(sink, found->line - 1, found->column > 0 ? found->column - 1 : 0);
            sink_event(sink, YAML_FAULT, 0, found->msg, found->msg ? strlen(found->msg) : 0);
            any = true;
        }

        if (!any) sink_event(sink, YAML_FAULT, 0, NULL, 0);
    }

    if (parser) sink_event(sink, YAML_END, 0, NULL, 0);

    fy_parser_destroy(parser);
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

SingeResult yaml_read(const char *name, const char *bytes, size_t size, YamlEvents *events, SingeError *error) {
    Sink sink = {.bytes = bytes, .size = size};
    SingeResult result;
    *events = (YamlEvents){0};

    // commands that simulate before they read (`paper`, `validate`) read only their own scenes
    if (always_here || !isolate_possible()) {
        result = sink_work(&sink, NULL, error);
        events->bytes = (Bytes){.data = (uint8_t *)sink.out, .size = sink.used};
    } else {
        result = isolate_run(name, sink_work, &sink, limits, (SingeAllocator){0}, &events->bytes, error);
        if (result == SINGE_ERROR_LIMIT) // no text needs as much memory: so an allocation failed
            result = error->element < 0 ? SINGE_ERROR_FORMAT : SINGE_ERROR_MEMORY;
    }

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
