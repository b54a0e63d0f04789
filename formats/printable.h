// Foreign text in messages: names of files, keys, what a scene says. What a terminal would act on or nobody would see
// is escaped, and long text is cut.
#ifndef FORMATS_PRINTABLE_H
#define FORMATS_PRINTABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum {
    SHOWN_MAX = 80,       ///< characters of a word that a message repeats
    SHOWN_PATH_MAX = 200, ///< of a path, its end
    PRINTABLE_PIECE = 12, ///< bytes that a character takes at most, with a zero
};

/// Writes the character at *at, of the bytes up to `end` (a zero follows there or behind), as it may be printed,
/// zero-terminated, and moves *at behind it. `\n`, `\x1b`: control characters and bytes that are no UTF-8; `\u202e`,
/// `\U000e0001`: what turns the direction of writing, has no width, breaks lines or is a control character beyond
/// ASCII. Returns the length written; *at must be before `end`.
size_t printable_character(const char **at, const char *end, char piece[PRINTABLE_PIECE]);

/// Whether all of a text prints as it is.
bool printable_is(const char *text);

/// Characters of a text: code points, and bytes that are no UTF-8.
size_t printable_count(const char *text);

/// Writes a text so, all on one line.
void printable_write(const char *text, FILE *file);

/// A piece of foreign text in a message.
typedef struct Shown {
    char text[1040];
} Shown;

/// At most SHOWN_MAX characters of a text, with "..." behind them where it is longer.
Shown shown(const char *text);
/// The last SHOWN_PATH_MAX characters of a path, with "..." before them where it is longer.
Shown shown_path(const char *path);

/// The end of a zero-terminated text whose last character was cut: that character goes.
void printable_trim(char *text);

#endif
