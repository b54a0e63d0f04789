#include "sim/recorder.h"

#include "shell/shell.h"

#include <string.h>

struct Recorder {
    Memory memory; ///< its own, so that what a simulation holds is the same with and without it
    SingeLog log;
    bool warned;
    uint8_t kind; ///< of the record being written
    Tape tape;
};

// ---- records

Tape *recorder_begin(Recorder *recorder, int kind) {
    if (!recorder || recorder->tape.ended) return NULL;
    recorder->kind = (uint8_t)kind;
    recorder->tape.mode = STREAM_MEASURE;
    recorder->tape.offset = 0;
    return &recorder->tape;
}

Tape *recorder_again(Recorder *recorder) {
    Tape *tape = &recorder->tape;
    if (tape->mode == STREAM_WRITE) return NULL;
    uint64_t size = tape->offset;
    tape->mode = STREAM_WRITE;
    TAPE(tape, recorder->kind);
    TAPE(tape, size);
    return tape;
}

void recorder_flush(Recorder *recorder) {
    tape_flush(&recorder->tape);
    if (!recorder->tape.ended || recorder->warned) return;
    recorder->warned = true;
    if (recorder->log.write)
        recorder->log.write(recorder->log.context, SINGE_LOG_WARNING,
                            "the recording could not be written; it ends here");
}

void record_header(Tape *tape, RecordHeader *header) {
    tape_data(tape, header->magic, sizeof header->magic, 1);
    TAPE(tape, header->version);
    tape_data(tape, header->singe, sizeof header->singe, 1);
}

Recorder *recorder_open(const SingeSimDef *def, const uint8_t *bytes, size_t size) {
    Memory memory = memory_make(def->allocator);
    Recorder *recorder = memory_new(&memory, 1, sizeof *recorder);
    if (!recorder) return NULL;

    recorder->memory = memory;
    recorder->log = def->log;
    recorder->tape.record = def->record;
    recorder->tape.mode = STREAM_WRITE;
    RecordHeader header = {.magic = "SINGEREC", .version = RECORD_VERSION, .singe = SINGE_VERSION};
    record_header(&recorder->tape, &header);

    SingeSimDef copy = *def;
    RECORD(recorder, bytes ? RECORD_LOAD : RECORD_CREATE, tape) {
        TAPE(tape, copy.thread_count);
        tape_data(tape, &copy.instructions, 1, sizeof copy.instructions);
        if (bytes) tape_data(tape, (uint8_t *)(uintptr_t)bytes, size, 1);
        else tape_sim_def(tape, &copy);
    }

    recorder_flush(recorder);
    return recorder;
}

void recorder_close(Recorder *recorder) {
    if (!recorder) return;
    RECORD(recorder, RECORD_END, tape) {}
    recorder_flush(recorder);
    Memory memory = recorder->memory;
    FREE(&memory, recorder, 1);
}

SingeResult recorder_result(Recorder *recorder, SingeResult result, uint32_t first, uint32_t second) {
    uint32_t code = (uint32_t)result;
    RECORD(recorder, RECORD_RESULT, tape) {
        TAPE(tape, code);
        TAPE(tape, first);
        TAPE(tape, second);
    }
    return result;
}

// ---- states

enum { HASH_LANES = 4 };

/// Four sums side by side, each over every fourth word of 8 bytes.
typedef struct StateHash {
    uint64_t lane[HASH_LANES];
} StateHash;

static uint64_t hash_mix(uint64_t sum, uint64_t word) {
    sum ^= word;
    return (sum << 29 | sum >> 35) * 0x9e3779b97f4a7c15u;
}

/// A word of the tape's byte order from `size` bytes, at most 8, of numbers of `width` bytes.
static uint64_t hash_word(const uint8_t *bytes, size_t size, size_t width) {
    const uint16_t one = 1;
    uint64_t word = 0;
    if (*(const uint8_t *)&one == 1) {
        memcpy(&word, bytes, size);
        return word;
    }

    for (size_t i = 0; i < size; i++) {
        const size_t number = i / width * width;
        word |= (uint64_t)bytes[number + width - 1 - i % width] << 8 * i;
    }

    return word;
}

static void hash_array(StateHash *hash, const void *array, size_t count, size_t width) {
    const uint8_t *bytes = array;
    const size_t size = count * width;
    StateHash sum = *hash;
    size_t i = 0;
    for (; i + 8 * HASH_LANES <= size; i += 8 * HASH_LANES)
        for (size_t k = 0; k < HASH_LANES; k++)
            sum.lane[k] = hash_mix(sum.lane[k], hash_word(bytes + i + 8 * k, 8, width));
    for (; i < size; i += 8)
        sum.lane[i / 8 % HASH_LANES] =
            hash_mix(sum.lane[i / 8 % HASH_LANES], hash_word(bytes + i, size - i < 8 ? size - i : 8, width));
    *hash = sum;
}

// The hash is of all that the sheets' later steps depend on, but for target lengths, which follow from masses.
void recorder_state(Recorder *recorder, const Shell *shell, const State *state) {
    if (recorder->tape.ended) return;

    const size_t particles = shell->particle_count;
    StateHash hash = {
        {state->step, state->ablate.topology_version, state->tear.split_count, state->ablate.piece_count}};
    hash_array(&hash, state->dynamics.position, 4 * particles, sizeof(float));
    hash_array(&hash, state->dynamics.velocity, 4 * particles, sizeof(float));
    hash_array(&hash, state->heat.temperature, particles, sizeof(float));
    hash_array(&hash, state->burn.mass, particles, sizeof(float));
    hash_array(&hash, state->burn.fuel, particles, sizeof(float));
    hash_array(&hash, state->burn.time_ignited, particles, sizeof(float));
    hash_array(&hash, state->ablate.piece, particles, sizeof(int32_t));
    hash_array(&hash, state->ablate.particle_flags, particles, 1);
    hash_array(&hash, state->ablate.cell_flags, shell->cell_count, 1);
    hash_array(&hash, state->dynamics.pinned, particles, 1);
    if (shell->creases) hash_array(&hash, state->dynamics.crease, shell->springs[SINGE_GREEN].count, sizeof(float));

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        hash_array(&hash, state->ablate.spring_flags[colour], shell->springs[colour].count, 1);

    uint64_t sum = 0;
    for (int k = 0; k < HASH_LANES; k++) sum = hash_mix(sum, hash.lane[k] ^ hash.lane[k] >> 32);
    sum ^= sum >> 32;

    uint64_t step = state->step;
    RECORD(recorder, RECORD_STATE, tape) {
        TAPE(tape, step);
        TAPE(tape, sum);
    }
}

// ---- callback sources

void recorder_hear(void *context, const SingeView *view, float *flux, float *conductance,
                   float *conductance_temperature) {
    uint32_t count = view->particle_count;
    float *const arrays[3] = {flux, conductance, conductance_temperature};
    RECORD((Recorder *)context, RECORD_HEAT, tape) {
        TAPE(tape, count);
        for (uint32_t i = 0; i < count;) {
            // a run ends where all three are zero bits
            uint32_t end = i;
            for (bool zero = false; end < count && !zero; end += !zero) {
                uint32_t bits[3];
                for (int k = 0; k < 3; k++) memcpy(&bits[k], arrays[k] + end, sizeof bits[k]);
                zero = (bits[0] | bits[1] | bits[2]) == 0;
            }

            uint32_t length = end - i;
            if (length) {
                TAPE(tape, i);
                TAPE(tape, length);
                for (int k = 0; k < 3; k++) tape_data(tape, arrays[k] + i, length, sizeof(float));
            }
            i = end + 1;
        }
    }
}
