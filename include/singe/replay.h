/// Singe: repeats a recording (SingeSimDef.record, docs/replay.md) and compares.
#ifndef SINGE_REPLAY_H
#define SINGE_REPLAY_H

#include "singe/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What came of a replay.
typedef struct SingeReplay {
    size_t struct_size;
    char version[20]; ///< of the library that recorded
    uint64_t calls;   ///< made, besides the one that makes the simulation
    uint64_t steps;   ///< made, whose states were compared
    bool complete;    ///< the simulation was destroyed at the end; if not, the recording was cut short, as by a crash
    bool same;        ///< nothing differs: states and answers
    uint64_t step;    ///< the first step whose state differs, or the one during or after which an answer does
    char what[160];   ///< what differs first, a clause: "the state after step 12"; empty if nothing does
} SingeReplay;

/// Makes the simulation and the calls of a recording once more, and compares the state after every step with the
/// recorded one; it goes on to the end also where they differ. Hooks, threads and instructions come from `hooks`; its
/// `record` is not used. Fills `struct_size` bytes of *replay, the caller's sizeof. The work is bounded by the
/// recording's own steps, each of which it must have bytes for. SINGE_OK: the recording was read, whatever it shows.
/// SINGE_ERROR_FORMAT: `bytes` are no recording, or are damaged (*replay holds what was done until there);
/// SINGE_ERROR_VERSION: it is of a newer version; any error of making the simulation. *error may be NULL.
SINGE_API SINGE_NODISCARD SingeResult singe_replay_read(const SingeSimDef *hooks, const uint8_t *bytes, size_t size,
                                                        SingeReplay *replay, size_t struct_size, SingeError *error);

SINGE_NODISCARD static inline SingeResult singe_replay(const SingeSimDef *hooks, const uint8_t *bytes, size_t size,
                                                       SingeReplay *replay, SingeError *error) {
    return singe_replay_read(hooks, bytes, size, replay, sizeof *replay, error);
}

#ifdef __cplusplus
}
#endif
#endif
