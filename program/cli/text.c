#include "cli/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "common/printable.h"

/// The block; without memory the program ends.
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
    return good && *text; // if memory ran out when it last grew there is no text, and no error
}

FILE *text_open(char **text) {
    static _Thread_local size_t size; // texts end with a zero
    *text = NULL;
    FILE *stream = open_memstream(text, &size);
    if (!stream) need(NULL);
    return stream;
}

void text_close(FILE *stream, char **text) {
    if (!text_stream_end(stream, text)) need(NULL);
}

void text_json_string(FILE *file, const char *text) {
    fputc('"', file);
    for (const char *c = text; *c;) {
        int length = utf8_length(c);
        unsigned byte = (unsigned char)*c;
        if (length == 0) fprintf(file, "\\udc%02x", byte);
        else if (*c == '"' || *c == '\\') fprintf(file, "\\%c", *c);
        else if (byte < 0x20 || byte == 0x7f) fprintf(file, "\\u%04x", byte);
        else fwrite(c, 1, (size_t)length, file);
        c += length ? length : 1;
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

/// The end of the string that begins at p, after its closing quote, or NULL.
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

bool text_json_member(JsonText object, const char *name, JsonText *value) {
    const char *end = object.text + object.size, *p = skip_space(object.text, end);
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
            *value = (JsonText){begin, (size_t)(p - begin)};
            return true;
        }

        p = skip_space(p, end);
        if (p >= end || *p != ',') return false;
        p = skip_space(p + 1, end);
    }

    return false;
}

/// Four hexadecimal digits, or -1.
static int32_t read_hex(const char *text, const char *end) {
    int32_t value = 0;
    for (int i = 0; i < 4; i++) {
        static const char digits[] = "0123456789abcdef0123456789ABCDEF";
        const char *digit = text + i < end && text[i] ? strchr(digits, text[i]) : NULL;
        if (!digit) return -1;
        value = 16 * value + (int32_t)((digit - digits) % 16);
    }

    return value;
}

/// Reads the escape after a backslash and appends its character; \udc80 to \udcff stand for single bytes. Returns the
/// position after it, or NULL if it is no escape.
static const char *put_escape(const char *p, const char *end, char **out) {
    static const char kinds[] = "\"\\/bfnrt", meanings[] = "\"\\/\b\f\n\r\t";
    const char *kind = p < end && *p ? strchr(kinds, *p) : NULL;
    if (kind) {
        *(*out)++ = meanings[kind - kinds];
        return p + 1;
    }
    if (p >= end || *p != 'u') return NULL;

    int32_t code = read_hex(p + 1, end), low = -1;
    if (code <= 0) return NULL; // a text ends at 0
    p += 5;

    const bool high = code >= 0xd800 && code < 0xdc00;
    if (high && end - p >= 6 && p[0] == '\\' && p[1] == 'u') low = read_hex(p + 2, end);
    if (low >= 0xdc00 && low < 0xe000) {
        code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        p += 6;
    }

    if (code >= 0xdc80 && code <= 0xdcff) {
        *(*out)++ = (char)(code - 0xdc00);
        return p;
    }

    static const unsigned char heads[] = {0, 0xc0, 0xe0, 0xf0};
    int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    *(*out)++ = (char)(heads[more] | (unsigned)code >> 6 * more);
    while (more--) *(*out)++ = (char)(0x80 | ((unsigned)code >> 6 * more & 0x3f));
    return p;
}

char *text_json_unquote(JsonText value) {
    const char *p = value.text + 1, *end = value.text + value.size;
    while (end > p && (end[-1] == ' ' || end[-1] == '\n')) end--;
    if (end < p + 1 || p[-1] != '"' || *--end != '"') return NULL;

    char *text = need(malloc(value.size)), *out = text; // no escape is shorter than its character
    while (p && p < end) {
        if (*p == '\\') p = put_escape(p + 1, end, &out);
        else *out++ = *p++;
    }

    if (!p) {
        free(text);
        return NULL;
    }

    *out = 0;
    return text;
}

char *text_json_words(JsonText object, const char *name) {
    JsonText value;
    return text_json_member(object, name, &value) ? text_json_unquote(value) : NULL;
}

int text_json_count(JsonText object, const char *name) {
    JsonText value;
    char text[16];
    if (!text_json_member(object, name, &value) || value.size >= sizeof text) return 0;
    snprintf(text, sizeof text, "%.*s", (int)value.size, value.text);
    const long number = strtol(text, NULL, 10);
    return number >= 1 && number <= 1000000 ? (int)number : 0;
}

char *text_shell_quote(const char *text) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,";
    if (*text && text[strspn(text, plain)] == 0) return text_format("%s", text);

    char *quoted = text_format("''");
    for (const char *c = text; *c; c++) {
        size_t length = strlen(quoted) - 1;
        char *longer = text_format(*c == '\'' ? "%.*s'\\%c''" : "%.*s%c'", (int)length, quoted, *c);
        free(quoted);
        quoted = longer;
    }

    return quoted;
}

void text_csv_cell(FILE *file, const char *text) {
    if (!text[strcspn(text, ",\"\n")]) {
        fputs(text, file);
        return;
    }

    fputc('"', file);
    for (; *text; text++) fprintf(file, *text == '"' ? "\"\"" : "%c", *text);
    fputc('"', file);
}
