#include "scene/messages.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGES_MOST = 200, LINE_WIDTH = 110 };

static char *text_copy(const char *text, size_t length) {
    char *copy = malloc(length + 1);
    if (copy) {
        memcpy(copy, text, length);
        copy[length] = 0;
    }
    return copy;
}

static char *text_format(const char *format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, arguments);
    return text;
}

// The length of a UTF-8 character at the start of a text; 0 where its bytes are not one.
static int character_length(const unsigned char *c) {
    int length = *c < 0x80                 ? 1
                 : *c >= 0xc2 && *c < 0xe0 ? 2
                 : *c >= 0xe0 && *c < 0xf0 ? 3
                 : *c >= 0xf0 && *c < 0xf5 ? 4
                                           : 0;
    for (int i = 1; i < length; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    return length;
}

// Bytes that would move the cursor become blanks, and what is not UTF-8 question marks.
static void text_tame(char *text) {
    for (unsigned char *c = (unsigned char *)text; *c;) {
        int length = character_length(c);
        if (!length)
            *c = '?';
        else if (*c < 0x20 || *c == 0x7f)
            *c = ' ';
        c += length ? length : 1;
    }
}

static bool starts_character(char byte) { return ((unsigned char)byte & 0xc0) != 0x80; }

// The line and, where it is long, only the part around the column; *caret counts characters of that part.
static char *source_line(const SceneText *text, int line, int column, int *caret) {
    const char *start = text->bytes, *stop = text->bytes + text->size;
    for (int i = 1; i < line; i++) {
        const char *end = start < stop ? memchr(start, '\n', (size_t)(stop - start)) : NULL;
        if (!end)
            return NULL;
        start = end + 1;
    }
    const char *end = start < stop ? memchr(start, '\n', (size_t)(stop - start)) : NULL;
    if (!end)
        end = stop;
    if (end > start && end[-1] == '\r')
        end--;
    for (; column > LINE_WIDTH - 20 && start < end; column--)
        do
            start++;
        while (start < end && !starts_character(*start));
    if (end - start > LINE_WIDTH) {
        end = start + LINE_WIDTH;
        while (end > start && !starts_character(*end))
            end--;
    }
    *caret = column;
    char *copy = text_copy(start, (size_t)(end - start));
    if (copy)
        text_tame(copy);
    return copy;
}

// The file that a place is in.
static const SceneText *text_of(const SceneText *text, ScenePlace place) {
    const SceneText *file = text && place.file ? text->files : text;
    while (file && file->number != place.file)
        file = file->next;
    return file;
}

static char *text_origin(const SceneText *text, ScenePlace place) {
    const SceneText *file = text_of(text, place);
    const char *name = file && file->name ? file->name : "scene";
    size_t size = 64;
    if (place.set > 0 && text && place.set <= text->set_count) {
        const char *set = text->sets[place.set - 1];
        size += strlen(set);
        char *origin = malloc(size);
        if (origin)
            snprintf(origin, size, "--set %s", set);
        return origin;
    }
    size += strlen(name);
    char *origin = malloc(size);
    if (!origin)
        return NULL;
    if (place.line > 0)
        snprintf(origin, size, "%s:%d:%d", name, place.line, place.column);
    else
        snprintf(origin, size, "%s", name);
    return origin;
}

static bool told_already(const SceneMessages *messages, const SceneMessage *message) {
    for (uint32_t i = 0; i < messages->count; i++)
        if (!strcmp(messages->items[i].origin, message->origin) && !strcmp(messages->items[i].text, message->text))
            return true;
    return false;
}

void message_add(SceneMessages *messages, const SceneText *text, ScenePlace place, const char *format, ...) {
    if (messages->count >= MESSAGES_MOST) {
        messages->left_out++;
        return;
    }
    SceneMessage *items = realloc(messages->items, (messages->count + 1) * sizeof *items);
    if (!items) {
        messages->left_out++;
        return;
    }
    messages->items = items;
    SceneMessage message = {.place = place};
    va_list arguments;
    va_start(arguments, format);
    message.text = text_format(format, arguments);
    va_end(arguments);
    message.origin = text_origin(text, place);
    if (!message.text || !message.origin) {
        free(message.text);
        free(message.origin);
        messages->left_out++;
        return;
    }
    text_tame(message.text);
    text_tame(message.origin);
    if (place.file && told_already(messages, &message)) {
        free(message.text);
        free(message.origin);
        return;
    }
    const SceneText *file = text_of(text, place);
    if (file && place.line > 0 && place.set == 0)
        message.source = source_line(file, place.line, place.column, &message.caret);
    items[messages->count++] = message;
}

static bool place_before(ScenePlace a, ScenePlace b) {
    if (a.set != b.set)
        return a.set < b.set;
    if (a.file != b.file)
        return a.file < b.file;
    return a.line != b.line ? a.line < b.line : a.column < b.column;
}

void messages_sort(SceneMessages *messages, uint32_t first) {
    for (uint32_t i = first + 1; i < messages->count; i++) {
        SceneMessage moved = messages->items[i];
        uint32_t j = i;
        for (; j > first && place_before(moved.place, messages->items[j - 1].place); j--)
            messages->items[j] = messages->items[j - 1];
        messages->items[j] = moved;
    }
}

void scene_messages_print(const SceneMessages *messages, FILE *file) {
    for (uint32_t i = 0; i < messages->count; i++) {
        const SceneMessage *message = &messages->items[i];
        fprintf(file, "%s: error: %s\n", message->origin, message->text);
        if (message->source)
            fprintf(file, "    %s\n    %*s\n", message->source, message->caret, "^");
    }
    if (messages->left_out)
        fprintf(file, "... and %u more\n", (unsigned)messages->left_out);
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
