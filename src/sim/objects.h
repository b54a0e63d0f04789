// Shared by the calls for sources, colliders and pins.
#pragma once

#include "common/store.h"
#include "sim/calls.h"

/// Reads the part of a caller's Def that it knows, over the defaults; fails if its struct_size is unknown.
#define OBJECT_DEF(sim, stage, local, given, defaults)                                                \
    do {                                                                                              \
        (local) = (defaults)();                                                                       \
        if (!sim_read_def(&(local), sizeof(local), (given), SIZE_MAX))                                \
            return sim_fail((sim), SINGE_ERROR_ARGUMENT, (stage), -1, STRUCT_SIZE_UNKNOWN(defaults)); \
    } while (0)

static inline SingeResult object_stale(SingeSim *sim, const char *stage, uint32_t index) {
    return error_set(&sim->error, SINGE_ERROR_HANDLE, stage, index, "the handle is stale or invalid");
}

/// Finds an object by its handle; NULL when stale.
#define OBJECT_FIND(list, id)                                                                                    \
    ((id).generation != 0 && (id).index < (list).count && (list).items[(id).index].generation == (id).generation \
         ? &(list).items[(id).index]                                                                             \
         : NULL)
