// The bytes of a recording, written and read by the same code. Numbers are little-endian on every machine, and nothing
// depends on the size of a pointer.
#pragma once

#include "common/def_table.h"
#include "common/memory.h"
#include "common/stream.h"

enum { TAPE_BUFFER = 4096 };

/// What a replay has read of a call; freed when the call has returned.
typedef struct TapeBlock TapeBlock;

typedef struct Tape {
    StreamMode mode;
    uint64_t offset; ///< bytes measured, written or read
    bool failed;     ///< reading: the bytes ended too soon, or are none that a recorder writes; all after it is zero
    bool no_memory;  ///< the same, as there was no memory for them

    // reading
    const uint8_t *bytes;
    uint64_t size;
    Memory *memory;
    TapeBlock *blocks;
    SingeFluxFn *callback; ///< what the callback of a source becomes
    void *callback_context;

    // writing
    SingeRecord record;
    bool ended; ///< `record` has refused bytes: nothing is written any more
    size_t used;
    uint8_t buffer[TAPE_BUFFER];
} Tape;

/// Passes `count` numbers of `width` bytes through the tape, in its direction.
void tape_data(Tape *tape, void *data, uint64_t count, size_t width);

#define TAPE(tape, number) tape_data((tape), &(number), 1, sizeof(number))

void tape_bool(Tape *tape, bool *value);

/// An array of `count` numbers, or NULL. When reading, the tape owns it.
void tape_array(Tape *tape, void *array_pointer, uint64_t count, size_t width);

/// A string, or NULL. When reading, the tape owns it.
void tape_text(Tape *tape, const char **text);

/// Memory that lives until tape_release; NULL and `no_memory` when there is none.
void *tape_new(Tape *tape, uint64_t size);
void tape_release(Tape *tape);

/// Hands what is in the buffer to the writer.
void tape_flush(Tape *tape);

// ---- Defs (tape_defs.c)

// When writing, `given` is the caller's Def, of any version, and *def any memory. When reading, `given` is not used; *def
// becomes the Def, with the defaults of what an older recording lacks, and its arrays belong to the tape. A Def that the
// call refuses for its struct_size has the struct_size 0.
void tape_sim_def(Tape *tape, SingeSimDef *def); // without hooks; it is whole already
void tape_sheet_def(Tape *tape, const SingeSheetDef *given, SingeSheetDef *def);
void tape_source_def(Tape *tape, const SingeSourceDef *given, SingeSourceDef *def);
void tape_collider_def(Tape *tape, const SingeColliderDef *given, SingeColliderDef *def);
void tape_pin_def(Tape *tape, const SingePinDef *given, SingePinDef *def);
void tape_wind_def(Tape *tape, const SingeWindDef *given, SingeWindDef *def);
void tape_material_def(Tape *tape, const SingeMaterialDef *given, SingeMaterialDef *def);

/// An array of keys, or NULL.
void tape_path(Tape *tape, uint32_t *count, const SingePoseKey **path);
