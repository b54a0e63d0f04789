// Writes a recording: how a simulation was made, and every call that changes it.
//
// A recording is its header (RecordHeader), then records: a kind (1 byte), the bytes that follow (8 bytes), and these. A
// call's record comes before the call does anything. Behind it come what callback sources returned (RECORD_HEAT) and the
// state (RECORD_STATE) of each step, then the call's answer (RECORD_RESULT). A recording without RECORD_END was cut
// short.
#pragma once

#include "sim/tape.h"
#include "singe/sim.h"

struct Shell;
struct State;

enum RecordKind {
    RECORD_CREATE = 1, ///< threads, instructions, the Def
    RECORD_LOAD = 2,   ///< threads, instructions, saved bytes
    RECORD_END = 3,    ///< destroyed
    RECORD_RESULT = 4, ///< SingeResult (4 bytes), and two numbers of 4 bytes: a new handle, or steps
    RECORD_STATE = 5,  ///< step and hash, 8 bytes each
    RECORD_HEAT = 6,   ///< particles, then runs: first, count, and the three arrays' values of each
    RECORD_CALL = 16,  ///< and above: numbers of calls.def
};

enum { RECORD_VERSION = 2, RECORD_HEAD = 1 + 8 };

typedef struct RecordHeader {
    char magic[8];    ///< "SINGEREC"
    uint32_t version; ///< RECORD_VERSION
    char singe[20];   ///< version of the library, zero-terminated
} RecordHeader;

void record_header(Tape *tape, RecordHeader *header);

typedef struct Recorder Recorder;

/// Begins a recording of a simulation made from its Def, or loaded from `bytes`. NULL when out of memory.
Recorder *recorder_open(const SingeSimDef *def, const uint8_t *bytes, size_t size);
/// Ends it; NULL is allowed.
void recorder_close(Recorder *recorder);

/// A record is written twice: to measure it, and to write it. RECORD(recorder, kind, tape) { ... } does so; not at all
/// if the recording has ended.
#define RECORD(recorder, kind, tape) \
    for (Tape *tape = recorder_begin((recorder), (kind)); tape; tape = recorder_again((recorder)))
Tape *recorder_begin(Recorder *recorder, int kind);
Tape *recorder_again(Recorder *recorder);

/// Hands over all that is written so far, so that it survives a crash.
void recorder_flush(Recorder *recorder);

/// The answer to a call; returns it.
SingeResult recorder_result(Recorder *recorder, SingeResult result, uint32_t first, uint32_t second);

/// The state after a step.
void recorder_state(Recorder *recorder, const struct Shell *shell, const struct State *state);

/// What a callback source has left in the arrays: a SingeFluxFn whose context is the recorder.
void recorder_hear(void *context, const SingeView *view, float *flux, float *conductance,
                   float *conductance_temperature);
