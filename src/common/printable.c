#include "common/printable.h"

#include <string.h>

/// Unicode characters that are controls, have no width or change the direction of writing.
static const struct Range {
    uint32_t first, last;
} unseen[] = {
    {0x80, 0x9f},     {0xad, 0xad},     {0x34f, 0x34f},   {0x61c, 0x61c},     {0x115f, 0x1160},   {0x17b4, 0x17b5},
    {0x180b, 0x180f}, {0x200b, 0x200f}, {0x2028, 0x202e}, {0x2060, 0x206f},   {0x3164, 0x3164},   {0xfdd0, 0xfdef},
    {0xfeff, 0xfeff}, {0xffa0, 0xffa0}, {0xfff0, 0xfffb}, {0x1d173, 0x1d17a}, {0xe0000, 0xe0fff},
};

/// Length of the UTF-8 character at `c`, and its code; 0 if the bytes are invalid.
static int character_at(const char *c, const char *end, uint32_t *code) {
    const int length = utf8_length(c);
    if (length == 0 || end - c < length) return 0;
    *code = length == 1 ? (unsigned char)*c : (unsigned char)*c & (0x7fu >> length);
    for (int i = 1; i < length; i++) *code = *code << 6 | ((unsigned char)c[i] & 0x3fu);
    return length;
}

static bool is_unseen(uint32_t code) {
    if (code < 0x20 || code == 0x7f || (code & 0xfffe) == 0xfffe) return true;
    for (size_t i = 0; i < sizeof unseen / sizeof *unseen; i++)
        if (code >= unseen[i].first && code <= unseen[i].last) return true;
    return false;
}

size_t printable_character(const char **at, const char *end, char piece[PRINTABLE_PIECE]) {
    const char *c = *at;
    uint32_t code = (unsigned char)*c;
    int length = character_at(c, end, &code);
    *at += length ? length : 1;

    if (length && !is_unseen(code)) {
        memcpy(piece, c, (size_t)length);
        piece[length] = 0;
        return (size_t)length;
    }

    const char *names = "\nn\tt\rr", *name = code < 0x20 && code ? strchr(names, (int)code) : NULL;
    if (name && length) return (size_t)snprintf(piece, PRINTABLE_PIECE, "\\%c", name[1]);
    if (length <= 1) return (size_t)snprintf(piece, PRINTABLE_PIECE, "\\x%02x", (unsigned)(unsigned char)*c);
    return (size_t)snprintf(piece, PRINTABLE_PIECE, code > 0xffff ? "\\U%08x" : "\\u%04x", (unsigned)code);
}

bool printable_is(const char *text) {
    const char *end = text + strlen(text);
    char piece[PRINTABLE_PIECE];
    while (text < end) {
        const char *before = text;
        size_t length = printable_character(&text, end, piece);
        if (length != (size_t)(text - before) || memcmp(before, piece, length) != 0) return false;
    }
    return true;
}

size_t printable_count(const char *text) {
    const char *end = text + strlen(text);
    char piece[PRINTABLE_PIECE];
    size_t count = 0;
    for (; text < end; count++) printable_character(&text, end, piece);
    return count;
}

void printable_write(const char *text, FILE *file) {
    const char *end = text + strlen(text);
    char piece[PRINTABLE_PIECE];
    while (text < end) {
        size_t length = printable_character(&text, end, piece);
        fwrite(piece, 1, length, file);
    }
}

Shown shown(const char *text) {
    Shown result;
    const char *end = text + strlen(text);
    size_t used = 0;
    for (int i = 0; i < SHOWN_MAX && text < end; i++) used += printable_character(&text, end, result.text + used);
    strcpy(result.text + used, text < end ? "..." : "");
    return result;
}

Shown shown_path(const char *path) {
    Shown result;
    const char *end = path + strlen(path);
    size_t left = printable_count(path), used = 0;
    char piece[PRINTABLE_PIECE];

    if (left > SHOWN_PATH_MAX) used = strlen(strcpy(result.text, "..."));
    for (; left > SHOWN_PATH_MAX; left--) printable_character(&path, end, piece);
    while (path < end && used < sizeof result.text - PRINTABLE_PIECE)
        used += printable_character(&path, end, result.text + used);
    result.text[used] = 0;
    return result;
}

void printable_trim(char *text) {
    size_t length = strlen(text), back = length ? 1 : 0;
    while (back && back < 4 && back < length && ((unsigned char)text[length - back] & 0xc0) == 0x80) back++;
    char *last = text + length - back;
    if (back && (unsigned char)*last >= 0xc0 && !utf8_length(last)) *last = 0;
}
