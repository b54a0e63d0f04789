// Damage to bytes of which most are good, and memory that has an end.
#pragma once

#include <math.h>
#include <string.h>

#include "input.h"
#include "singe/base.h"

/// Libc's memory, of which a simulation may hold so many bytes, so that a forged count is noticed.
typedef struct Limited {
    size_t max, held;
} Limited;

static inline void *limited_resize(void *context, void *block, size_t old_size, size_t new_size) {
    Limited *memory = context;
    if (new_size > old_size && new_size - old_size > memory->max - memory->held) return NULL;
    memory->held += new_size - old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, new_size);
}

static inline void put_word(Input *input, uint8_t *at) {
    static const float specials[] = {NAN,    INFINITY, -INFINITY, -1,    0,     -0.0f, 1,
                                     1e-45f, 1e-30f,   1e9f,      1e19f, 3e38f, -3e38f};
    static const uint32_t words[] = {0, 1, 2, 0xFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
    uint32_t word;
    float number;

    memcpy(&word, at, sizeof word);
    memcpy(&number, at, sizeof number);
    switch (input_pick(input, 6)) {
    case 0: number = specials[input_pick(input, sizeof specials / sizeof *specials)]; break;
    case 1: number *= 1 + input_share(input); break;
    case 2: number *= 1e6f * input_share(input); break;
    case 3: word = words[input_pick(input, 8)], memcpy(&number, &word, sizeof number); break;
    case 4: word += (uint32_t)((int)input_byte(input) - 128), memcpy(&number, &word, sizeof number); break;
    default: word = input_word(input), memcpy(&number, &word, sizeof number);
    }
    memcpy(at, &number, sizeof number);
}

static inline void put_double(Input *input, uint8_t *at) {
    static const double specials[] = {(double)NAN, (double)INFINITY, -1, 0, 1e-300, 1e9, 1e19, 1e300};
    double number = specials[input_pick(input, 8)];
    memcpy(at, &number, sizeof number);
}
