#include "sim/tape.h"

#include <string.h>

struct TapeBlock {
    TapeBlock *next;
    size_t size;
    double data[]; // aligned for all that a tape holds
};

static bool tape_swaps(void) {
    const uint16_t one = 1;
    return *(const uint8_t *)&one == 0;
}

/// Turns numbers of `width` bytes around.
static void tape_turn(uint8_t *data, size_t count, size_t width) {
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < width / 2; k++) {
            uint8_t *low = &data[i * width + k], *high = &data[(i + 1) * width - 1 - k];
            const uint8_t byte = *low;
            *low = *high;
            *high = byte;
        }
}

static void tape_hand_over(Tape *tape, const void *bytes, size_t size) {
    if (!tape->ended && size) tape->ended = !tape->record.write(tape->record.context, bytes, size);
}

void tape_flush(Tape *tape) {
    tape_hand_over(tape, tape->buffer, tape->used);
    tape->used = 0;
}

/// Writes bytes that are in the tape's order already.
static void tape_put(Tape *tape, const void *bytes, size_t size) {
    if (size > TAPE_BUFFER - tape->used) tape_flush(tape);
    if (size > TAPE_BUFFER) {
        tape_hand_over(tape, bytes, size);
        return;
    }
    memcpy(tape->buffer + tape->used, bytes, size);
    tape->used += size;
}

void tape_data(Tape *tape, void *data, uint64_t count, size_t width) {
    const uint64_t size = count * width; // no array is larger than memory
    if (tape->mode == STREAM_READ && (tape->failed || size > tape->size - tape->offset)) {
        tape->failed = true;
        if (size <= TAPE_BUFFER) memset(data, 0, (size_t)size); // arrays are bounded before they come here
        return;
    }

    if (tape->mode == STREAM_READ && size) {
        memcpy(data, tape->bytes + tape->offset, (size_t)size);
        if (tape_swaps()) tape_turn(data, (size_t)count, width);
    }

    if (tape->mode == STREAM_WRITE && size && !tape_swaps()) tape_put(tape, data, (size_t)size);
    if (tape->mode == STREAM_WRITE && tape_swaps())
        for (uint64_t i = 0; i < count; i++) {
            uint8_t number[8];
            memcpy(number, (const uint8_t *)data + i * width, width);
            tape_turn(number, 1, width);
            tape_put(tape, number, width);
        }
    tape->offset += size;
}

void tape_bool(Tape *tape, bool *value) {
    uint8_t byte = tape->mode != STREAM_READ && *value;
    TAPE(tape, byte);
    if (tape->mode == STREAM_READ) *value = byte != 0;
}

void *tape_new(Tape *tape, uint64_t size) {
    TapeBlock *block = NULL;
    if (size < SIZE_MAX - sizeof *block) block = memory_new(tape->memory, sizeof *block + (size_t)size, 1);
    if (!block) {
        tape->failed = tape->no_memory = true;
        return NULL;
    }

    block->next = tape->blocks;
    block->size = (size_t)size;
    tape->blocks = block;
    return block->data;
}

void tape_release(Tape *tape) {
    while (tape->blocks) {
        TapeBlock *block = tape->blocks;
        tape->blocks = block->next;
        memory_free(tape->memory, (void *)&block, sizeof *block + block->size, 1);
    }
}

void tape_array(Tape *tape, void *array_pointer, uint64_t count, size_t width) {
    void *array;
    memcpy(&array, array_pointer, sizeof array);

    bool there = tape->mode != STREAM_READ && array;
    tape_bool(tape, &there);
    if (tape->mode == STREAM_READ) {
        array = NULL;
        tape->failed |= there && count > (tape->size - tape->offset) / width;
        if (there && !tape->failed) array = tape_new(tape, count * width);
        memcpy(array_pointer, &array, sizeof array);
    }
    if (array) tape_data(tape, array, count, width);
}

void tape_text(Tape *tape, const char **text) {
    bool there = tape->mode != STREAM_READ && *text;
    uint32_t length = there ? (uint32_t)strlen(*text) : 0;
    tape_bool(tape, &there);
    if (there) TAPE(tape, length);

    char *copy = (char *)(uintptr_t)*text;
    if (tape->mode == STREAM_READ) {
        *text = NULL;
        tape->failed |= length > tape->size - tape->offset;
        if (!there || tape->failed || !(copy = tape_new(tape, (uint64_t)length + 1))) return;
        *text = copy;
    }
    if (there) tape_data(tape, copy, length, 1);
}
