#include "scene/messages.h"

#include "common/printable.h"

#include <stdarg.h>
#include <stdlib.h>

enum { MESSAGES_MAX = 200, LINE_WIDTH = 110 };

/// A printable copy (formats/printable.h); tabs become blanks.
static char *text_printable(const char *text, size_t length) {
    const char *end = text + length;
    char *copy = malloc(PRINTABLE_PIECE * length + 1);
    size_t used = 0;
    if (!copy) return NULL;

    while (text < end)
        if (*text == '\t') {
            copy[used++] = ' ';
            text++;
        } else {
            used += printable_character(&text, end, copy + used);
        }

    copy[used] = 0;
    char *fit = realloc(copy, used + 1);

    return fit ? fit : copy;
}

static char *text_format(const char *format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (!text) return NULL;

    vsnprintf(text, (size_t)length + 1, format, arguments);
    char *printable = text_printable(text, strlen(text));
    free(text);
    return printable;
}

static bool starts_character(char byte) { return ((unsigned char)byte & 0xc0) != 0x80; }

static const char *next_character(const char *c, const char *end) {
    do c++;
    while (c < end && !starts_character(*c));
    return c;
}

/// The line, or the part of a long line around the column; *caret counts characters of that part.
static char *source_line(const SceneText *text, int line, int column, int *caret) {
    const char *start = text->bytes, *stop = text->bytes + text->size;
    for (int i = 1; i < line; i++) {
        const char *end = start < stop ? memchr(start, '\n', (size_t)(stop - start)) : NULL;
        if (!end) return NULL;
        start = end + 1;
    }

    const char *end = start < stop ? memchr(start, '\n', (size_t)(stop - start)) : NULL;
    if (!end) end = stop;
    if (end > start && end[-1] == '\r') end--;

    for (; column > LINE_WIDTH - 20 && start < end; column--) start = next_character(start, end);
    if (end - start > LINE_WIDTH) {
        end = start + LINE_WIDTH;
        while (end > start && !starts_character(*end)) end--;
    }

    // the caret counts characters as they are shown
    const char *at = start;
    for (int i = 1; i < column && at < end; i++) at = next_character(at, end);
    char *before = text_printable(start, (size_t)(at - start));
    *caret = before ? (int)printable_count(before) + 1 : 0;
    free(before);

    return *caret ? text_printable(start, (size_t)(end - start)) : NULL;
}

/// The file that a location is in.
static const SceneText *text_of(const SceneText *text, SceneLocation location) {
    const SceneText *file = text && location.file ? text->files : text;
    while (file && file->number != location.file) file = file->next;
    return file;
}

static char *text_origin(const SceneText *text, SceneLocation location) {
    const SceneText *file = text_of(text, location);
    const char *name = file && file->name ? file->name : "scene";
    char origin[sizeof(Shown) + 40];
    if (location.set > 0 && text && location.set <= text->set_count)
        snprintf(origin, sizeof origin, "--set %s", shown(text->sets[location.set - 1]).text);
    else if (location.line > 0)
        snprintf(origin, sizeof origin, "%s:%d:%d", shown_path(name).text, location.line, location.column);
    else snprintf(origin, sizeof origin, "%s", shown_path(name).text);

    return text_printable(origin, strlen(origin));
}

void message_add(SceneMessages *messages, const SceneText *text, SceneLocation location, const char *format, ...) {
    SceneMessage *items =
        messages->count < MESSAGES_MAX ? realloc(messages->items, (messages->count + 1) * sizeof *items) : NULL;
    if (!items) {
        messages->left_out++;
        return;
    }

    messages->items = items;

    SceneMessage message = {.location = location, .origin = text_origin(text, location)};
    va_list arguments;
    va_start(arguments, format);
    message.text = text_format(format, arguments);
    va_end(arguments);

    // an error in a material file that several sheets use is reported once
    bool complete = message.text && message.origin, known = false;
    for (uint32_t i = 0; i < messages->count && complete && location.file && !known; i++)
        known = !strcmp(items[i].origin, message.origin) && !strcmp(items[i].text, message.text);

    if (!complete || known) {
        free(message.text);
        free(message.origin);
        messages->left_out += !complete;
        return;
    }

    // only lines of the scene are shown: whoever sees the message may not be allowed to read other files
    const SceneText *file = text_of(text, location);
    if (file && location.line > 0 && location.set == 0 && location.file == 0)
        message.source = source_line(file, location.line, location.column, &message.caret);
    items[messages->count++] = message;
}

void message_warn(const SingeLog *log, const SceneText *text, SceneLocation location, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *what = text_format(format, arguments), *origin = text_origin(text, location);
    va_end(arguments);

    const size_t size = what && origin ? strlen(what) + strlen(origin) + 3 : 0;
    char *line = size ? malloc(size) : NULL;
    if (line) snprintf(line, size, "%s: %s", origin, what);
    if (log->write) // when out of memory, without the location
        log->write(log->context, SINGE_LOG_WARNING, line ? line : format);
    free(line);
    free(what);
    free(origin);
}

void messages_sort(SceneMessages *messages, uint32_t first) {
    for (uint32_t i = first + 1; i < messages->count; i++) {
        const SceneMessage moved = messages->items[i];
        const SceneLocation a = moved.location;
        uint32_t j = i;
        for (; j > first; j--) {
            const SceneLocation b = messages->items[j - 1].location;
            const int by_text = a.set != b.set ? a.set - b.set : a.file - b.file;
            const int by_place = a.line != b.line ? a.line - b.line : a.column - b.column;
            if ((by_text ? by_text : by_place) >= 0) break;
            messages->items[j] = messages->items[j - 1];
        }

        messages->items[j] = moved;
    }
}

void scene_messages_print(const SceneMessages *messages, FILE *file) {
    for (uint32_t i = 0; i < messages->count; i++) {
        const SceneMessage *message = &messages->items[i];
        fprintf(file, "%s: error: %s\n", message->origin, message->text);
        if (message->source) fprintf(file, "    %s\n    %*s\n", message->source, message->caret, "^");
    }

    if (messages->left_out) fprintf(file, "... and %u more\n", (unsigned)messages->left_out);
}

void scene_messages_free(SceneMessages *messages) {
    for (uint32_t i = 0; i < messages->count; i++) {
        free(messages->items[i].origin);
        free(messages->items[i].text);
        free(messages->items[i].source);
    }

    free(messages->items);
    *messages = (SceneMessages){0};
}
