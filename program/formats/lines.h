// A cursor over lines of text that end in LF, CR LF or CR.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct Text {
    const uint8_t *at, *end;
    int64_t line; ///< from 1
} Text;

static inline bool text_is_blank(uint8_t c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
static inline bool text_is_end(uint8_t c) { return c == '\n' || c == '\r'; }

/// Bytes of the line end at p: 0, 1 or 2.
static inline size_t text_end_length(const uint8_t *p, const uint8_t *end) {
    if (p == end || !text_is_end(*p)) return 0;
    return *p == '\r' && p + 1 < end && p[1] == '\n' ? 2 : 1;
}

/// Moves past spaces and tabs.
static inline void text_skip_blanks(Text *text) {
    while (text->at < text->end && text_is_blank(*text->at)) text->at++;
}

static inline bool text_at_line_end(const Text *text) { return text->at == text->end || text_is_end(*text->at); }

/// Moves past the end of the line.
static inline void text_next_line(Text *text) {
    while (!text_at_line_end(text)) text->at++;
    size_t length = text_end_length(text->at, text->end);
    text->at += length;
    text->line += length > 0;
}

/// The end of the word at the cursor.
static inline const uint8_t *text_word_end(const Text *text) {
    const uint8_t *p = text->at;
    while (p < text->end && !text_is_blank(*p) && !text_is_end(*p)) p++;
    return p;
}

/// The cursor's column, from 1, in bytes. `begin` is the start of the file.
static inline int64_t text_column(const Text *text, const uint8_t *begin) {
    const uint8_t *p = text->at;
    while (p > begin && !text_is_end(p[-1])) p--;
    return text->at - p + 1;
}

static inline bool text_word_is(const uint8_t *begin, const uint8_t *end, const char *word) {
    size_t length = strlen(word);
    return (size_t)(end - begin) == length && memcmp(begin, word, length) == 0;
}
