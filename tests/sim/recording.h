// A recording in memory, and its records.
#pragma once

#include <stdlib.h>
#include <string.h>

#include "singe/sim.h"

typedef struct Tape {
    uint8_t *bytes;
    size_t size, room;
    size_t refuse_at; ///< no more than so many bytes; 0: any
} Tape;

static inline void tape_free(Tape *tape) { free(tape->bytes); }
#define OwnTape OWNED(tape_free) Tape

static inline bool tape_write(void *context, const void *bytes, size_t size) {
    Tape *tape = context;
    if (tape->refuse_at && tape->size + size > tape->refuse_at) return false;

    if (tape->size + size > tape->room) {
        tape->room = 2 * (tape->size + size);
        tape->bytes = realloc(tape->bytes, tape->room);
        if (!tape->bytes) abort();
    }

    memcpy(tape->bytes + tape->size, bytes, size);
    tape->size += size;
    return true;
}

static inline SingeSimDef recorded(SingeSimDef def, Tape *tape) {
    def.record = (SingeRecord){tape_write, tape};
    return def;
}

enum { HEADER = 32, HEAD = 9, RESULT = 4, STATE = 5, HEAT = 6, STEP = 36 };

static inline uint64_t tape_number(const uint8_t *bytes, int size) {
    uint64_t number = 0;
    for (int i = 0; i < size; i++) number |= (uint64_t)bytes[i] << 8 * i;
    return number;
}

/// The offset of the n-th record of a kind, from 0; the size of the recording if there is none.
static inline size_t tape_find(const Tape *tape, int kind, int n) {
    size_t at = HEADER;
    while (at + HEAD <= tape->size) {
        if (tape->bytes[at] == kind && n-- == 0) return at;
        at += HEAD + (size_t)tape_number(tape->bytes + at + 1, 8);
    }
    return tape->size;
}
