// UTF-8 in file names and texts, which may contain any bytes.
#ifndef COMMON_UTF8_H
#define COMMON_UTF8_H

#include <stdbool.h>
#include <stdint.h>

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

#endif
