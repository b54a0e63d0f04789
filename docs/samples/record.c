// A recording of a burn, with what the host did in between, is repeated and compared step by step.
//
// Prints:
//   72 steps with 1 thread: the same
//   72 steps with 2 threads: the same
#include "sample.h"
#include <singe/replay.h>

typedef struct Tape {
    uint8_t *bytes;
    size_t size;
} Tape;

static bool write_tape(void *context, const void *bytes, size_t size) {
    Tape *tape = context;
    uint8_t *grown = realloc(tape->bytes, tape->size + size);
    if (!grown) return false; // the recording ends; the simulation goes on
    memcpy(grown + tape->size, bytes, size);
    tape->bytes = grown, tape->size += size;
    return true;
}

int main(void) {
    Tape tape = {0};
    SingeSimDef def = singe_default_sim();
    def.record = (SingeRecord){write_tape, &tape};
    SingeSim *sim = sample_sim(def);
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.15f, 16, 0);
    const SingePinId held = sample_pin(sim, sheet, 0, 0.075f, 0, 0.02f);
    sample_match(sim, 0, -0.075f, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.1, 0, NULL));
    TRY(sim, singe_sim_remove_pin(sim, held)); // as a player would
    TRY(sim, singe_sim_advance(sim, 0.05, 0, NULL));
    singe_sim_destroy(sim);

    for (int threads = 1; threads <= 2; threads++) {
        SingeSimDef hooks = singe_default_sim();
        hooks.thread_count = threads;
        SingeReplay replay;
        SingeError error;
        must(singe_replay(&hooks, tape.bytes, tape.size, &replay, &error), &error);
        printf("%u steps with %d thread%s: %s\n", (unsigned)replay.steps, threads, threads > 1 ? "s" : "",
               replay.same ? "the same" : replay.what);
    }
    free(tape.bytes);
}
