// Foreign text in messages: file names, keys and values of a scene, which may contain any bytes. Characters that are
// invisible or that a terminal would act on are escaped, and long text is shortened.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum {
    SHOWN_MAX = 80,       ///< characters of a word that a message repeats
    SHOWN_PATH_MAX = 200, ///< of a path, its end
    PRINTABLE_PIECE = 12, ///< max bytes of a character, with a zero
};

/// Bytes of the character at `text`, which is zero-terminated; 0 if the bytes are not UTF-8.
static inline int utf8_length(const char *text) {
    static const uint32_t min[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *c = (const unsigned char *)text;
    int length = *c < 0x80 ? 1 : *c < 0xc0 ? 0 : *c < 0xe0 ? 2 : *c < 0xf0 ? 3 : *c < 0xf8 ? 4 : 0;
    if (length <= 1) return length;

    uint32_t code = *c & (0x7fu >> length);
    for (int i = 1; i < length; i++) {
        if ((c[i] & 0xc0) != 0x80) return 0; // the end of the text, too
        code = code << 6 | (c[i] & 0x3fu);
    }

    bool surrogate = code >= 0xd800 && code < 0xe000;
    return code < min[length] || code > 0x10ffff || surrogate ? 0 : length;
}

/// Writes the character at *at, of the bytes up to `end` (a zero follows there or later), in printable form,
/// zero-terminated, and moves *at past it. `\n`, `\x1b`: control characters and bytes that are not UTF-8; `\u202e`,
/// `\U000e0001`: characters that change the direction of writing, have no width, break lines or are control characters
/// beyond ASCII. Returns the length written; *at must be before `end`.
size_t printable_character(const char **at, const char *end, char piece[PRINTABLE_PIECE]);

/// Whether a text needs no escapes.
bool printable_is(const char *text);

/// Characters of a text: code points, and bytes that are not UTF-8.
size_t printable_count(const char *text);

/// Writes a text in this form, on one line.
void printable_write(const char *text, FILE *file);

/// Foreign text in a message.
typedef struct Shown {
    char text[1040];
} Shown;

/// At most SHOWN_MAX characters of a text, followed by "..." if it is longer.
Shown shown(const char *text);
/// The last SHOWN_PATH_MAX characters of a path, after "..." if it is longer.
Shown shown_path(const char *path);

/// Removes an incomplete last character of a zero-terminated text.
void printable_trim(char *text);
