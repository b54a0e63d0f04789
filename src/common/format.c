#include "common/format.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum {
    TEXT_SPEC = 24,    // bytes of a conversion with its closing zero
    TEXT_NUMBER = 512, // of a number: %f of the largest double has 309 digits before its point
};

/// The text so far; length < size, and a zero terminates it.
typedef struct Text {
    char *out;
    size_t size, length;
} Text;

static void text_add(Text *text, const char *bytes, size_t count) {
    size_t room = text->size - 1 - text->length;
    if (count > room) count = room;
    memcpy(text->out + text->length, bytes, count);
    text->length += count;
    text->out[text->length] = 0;
}

static bool text_in_number(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '+' || c == '-' ||
           c == ' ';
}

/// Adds the conversion `spec` of the next argument; false if it is unknown.
static bool text_convert(Text *text, const char *spec, va_list *arguments) {
    char number[TEXT_NUMBER];
    size_t room = text->size - text->length;
    const char *l = strchr(spec, 'l');
    int bytes;
    switch (spec[strlen(spec) - 1]) {
    case '%': text_add(text, "%", 1); return true;
    case 's':
        bytes = snprintf(text->out + text->length, room, spec, va_arg(*arguments, const char *));
        if (bytes > 0) text->length += (size_t)bytes < room ? (size_t)bytes : room - 1;
        return true;
    case 'd':
    case 'u':
    case 'x':
        if (l && l[1] == 'l') snprintf(number, sizeof number, spec, va_arg(*arguments, long long));
        else if (l) snprintf(number, sizeof number, spec, va_arg(*arguments, long));
        else if (strchr(spec, 'z')) snprintf(number, sizeof number, spec, va_arg(*arguments, size_t));
        else snprintf(number, sizeof number, spec, va_arg(*arguments, int));
        text_add(text, number, strlen(number));
        return true;
    case 'e':
    case 'f':
    case 'g':
        snprintf(number, sizeof number, spec, va_arg(*arguments, double));
        // printf's decimal point may be several bytes long
        for (const char *c = number; *c; c++) {
            if (text_in_number(*c)) text_add(text, c, 1);
            else if (text_in_number(c[1])) text_add(text, ".", 1);
        }
        return true;
    default: return false;
    }
}

void text_print(char *out, size_t size, const char *format, va_list arguments) {
    Text text = {.out = out, .size = size};
    va_list list;
    va_copy(list, arguments); // an array in some ABIs: only a copy's address can be passed on
    out[0] = 0;

    for (bool known = true; known && *format;) {
        size_t plain = strcspn(format, "%");
        text_add(&text, format, plain);
        format += plain;
        if (!*format) break;

        char spec[TEXT_SPEC];
        size_t length = 1 + strspn(format + 1, "-+ #0123456789.lz") + 1;
        if (length >= sizeof spec || !format[length - 1]) break;

        memcpy(spec, format, length);
        spec[length] = 0;
        known = text_convert(&text, spec, &list);
        format += length;
    }
    va_end(list);
}
