// A block is a row of sequences: a byte with two lengths (of literals in its upper half, of a match less 4 in its lower
// one; 15 continues in bytes up to one below 255), the literals, and the match's distance back (u16). The last sequence
// has only literals, at least 5, and no match begins in the last 12 bytes. Matches are found by a table with the last
// position of each hash of 4 bytes; the stride grows while nothing matches.
#include "formats/lz4.h"

#include <string.h>

enum { HASH_BITS = 13, MATCH_MIN = 4, TAIL = 5, MATCH_MARGIN = 12, DISTANCE_MAX = 65535 };

static uint32_t read_word(const uint8_t *p) {
    uint32_t word;
    memcpy(&word, p, sizeof word);
    return word;
}

static uint8_t *put_length(uint8_t *out, size_t rest) {
    for (; rest >= 255; rest -= 255) *out++ = 255;
    *out++ = (uint8_t)rest;
    return out;
}

/// A sequence; `match` 0: the last.
static uint8_t *put_sequence(uint8_t *out, const uint8_t *literals, size_t count, size_t match, size_t distance) {
    uint8_t *token = out++;
    *token = (uint8_t)((count < 15 ? count : 15) << 4);
    if (count >= 15) out = put_length(out, count - 15);
    memcpy(out, literals, count);
    out += count;
    if (!match) return out;
    *out++ = (uint8_t)distance;
    *out++ = (uint8_t)(distance >> 8);
    size_t rest = match - MATCH_MIN;
    *token |= (uint8_t)(rest < 15 ? rest : 15);
    return rest >= 15 ? put_length(out, rest - 15) : out;
}

size_t lz4_pack(const uint8_t *in, size_t size, uint8_t *out) {
    uint32_t last[1 << HASH_BITS] = {0}; // one more than the offset; 0: none
    uint8_t *begin = out;
    size_t at = 0, literals = 0, misses = 0;

    while (size > MATCH_MARGIN && at < size - MATCH_MARGIN && at < UINT32_MAX) {
        const uint32_t hash = (read_word(in + at) * 2654435761u >> (32 - HASH_BITS)), before = last[hash];
        last[hash] = (uint32_t)at + 1;
        const size_t distance = at + 1 - before;
        if (!before || distance > DISTANCE_MAX || read_word(in + before - 1) != read_word(in + at)) {
            at += 1 + (misses++ >> 6);
            continue;
        }
        size_t length = 0;
        while (at + length < size - TAIL && in[before - 1 + length] == in[at + length]) length++;
        out = put_sequence(out, in + literals, at - literals, length, distance);
        at += length;
        literals = at;
        misses = 0;
    }

    out = put_sequence(out, in + literals, size - literals, 0, 0);
    return (size_t)(out - begin);
}
