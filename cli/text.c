#include "cli/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"

/// A block that is there, or the end.
static char *need(char *block) {
    if (block) return block;
    fputs("singe: error: out of memory\n", stderr);
    exit(EXIT_FAILED);
}

char *text_format(const char *format, ...) {
    va_list list, again;
    va_start(list, format);
    va_copy(again, list);
    int length = vsnprintf(NULL, 0, format, list);
    char *text = need(length < 0 ? NULL : malloc((size_t)length + 1));
    vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(list);
    return text;
}

bool text_stream_end(FILE *stream, char **text) {
    bool good = stream && !ferror(stream);
    if (stream && fclose(stream) != 0) good = false;
    return good && *text; // without memory for the last change of its size there is no text, and no error
}

void text_json_string(FILE *file, const char *text) {
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\') fprintf(file, "\\%c", *c);
        else if (*c < 0x20) fprintf(file, "\\u%04x", *c);
        else fputc(*c, file);
    }
    fputc('"', file);
}

void text_json_number(FILE *file, double number) {
    if (isfinite(number)) fprintf(file, "%.17g", number);
    else fputs("null", file);
}

static const char *skip_space(const char *p, const char *end) {
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\n' || *p == '\r')) p++;
    return p;
}

/// The end of the string that begins at p, behind its closing quote, or NULL.
static const char *skip_string(const char *p, const char *end) {
    if (p >= end || *p != '"') return NULL;
    for (p++; p < end; p++) {
        if (*p == '\\') p++;
        else if (*p == '"') return p + 1;
    }
    return NULL;
}

/// The end of the value that begins at p, or NULL.
static const char *skip_value(const char *p, const char *end) {
    if (p >= end) return NULL;
    if (*p == '"') return skip_string(p, end);
    int depth = 0;
    while (p < end) {
        if (*p == '"') {
            if (!(p = skip_string(p, end))) return NULL;
            continue;
        }
        if (*p == '{' || *p == '[') depth++;
        else if (*p == '}' || *p == ']') {
            if (depth == 0) return p;
            if (--depth == 0) return p + 1;
        } else if (*p == ',' && depth == 0) return p;
        p++;
    }
    return NULL;
}

bool text_json_member(const char *json, size_t size, const char *name, const char **value, size_t *value_size) {
    const char *end = json + size, *p = skip_space(json, end);
    size_t length = strlen(name);
    if (p >= end || *p != '{') return false;
    p = skip_space(p + 1, end);
    while (p < end && *p == '"') {
        const char *key = p + 1, *after = skip_string(p, end);
        if (!after) return false;
        bool found = (size_t)(after - 1 - key) == length && memcmp(key, name, length) == 0;
        p = skip_space(after, end);
        if (p >= end || *p != ':') return false;
        const char *begin = skip_space(p + 1, end);
        if (!(p = skip_value(begin, end))) return false;
        if (found) {
            *value = begin, *value_size = (size_t)(p - begin);
            return true;
        }
        p = skip_space(p, end);
        if (p >= end || *p != ',') return false;
        p = skip_space(p + 1, end);
    }
    return false;
}

char *text_json_unquote(const char *value, size_t size) {
    while (size && (value[size - 1] == ' ' || value[size - 1] == '\n')) size--;
    if (size < 2 || value[0] != '"' || value[size - 1] != '"') return NULL;
    char *text = need(malloc(size)), *out = text;
    for (size_t i = 1; i < size - 1; i++) {
        if (value[i] != '\\' || i + 1 >= size - 1) {
            *out++ = value[i];
            continue;
        }
        char kind = value[++i];
        if (kind == 'u' && i + 4 < size - 1) {
            char digits[5] = {value[i + 1], value[i + 2], value[i + 3], value[i + 4], 0};
            *out++ = (char)strtol(digits, NULL, 16); // only control characters are written so
            i += 4;
        } else {
            *out++ = kind == 'n' ? '\n' : kind == 't' ? '\t' : kind == 'r' ? '\r' : kind;
        }
    }
    *out = 0;
    return text;
}
