// A fuzzer's bytes, taken one by one as choices. What is missing at the end reads as zero.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct Input {
    const uint8_t *at, *end;
} Input;

static inline uint8_t input_byte(Input *input) { return input->at < input->end ? *input->at++ : 0; }

/// One of `count` numbers from 0, at most 256.
static inline unsigned input_pick(Input *input, unsigned count) { return input_byte(input) % count; }

/// True for about one in `count` bytes, and false after the last byte.
static inline bool input_rarely(Input *input, unsigned count) { return input_byte(input) % count == count - 1; }

static inline uint32_t input_word(Input *input) {
    uint32_t word = 0;
    for (int i = 0; i < 4; i++) word = word << 8 | input_byte(input);
    return word;
}

/// From -1 to 1.
static inline float input_share(Input *input) { return (float)((int)input_byte(input) - 128) / 128; }

/// Ends the fuzzer if a condition does not hold.
static inline void demand(bool holds) {
    if (!holds) abort();
}
