// Locks of an output folder, so that two processes do not write the same files. The kernel holds them for the process
// (fcntl, advisory): they end with it, however it ends, and what a killed one leaves is an empty shell.
#ifndef CLI_LOCK_H
#define CLI_LOCK_H

#include <stdbool.h>

#include "singe/base.h"

typedef struct Lock {
    int fd; ///< -1: not taken
    bool shared;
    char *path; ///< of the file that is locked
} Lock;

#define LOCK_NONE ((Lock){.fd = -1})

/// Takes a lock by the file `path`, which is made: alone, or beside others that share it. `what` the folder has is
/// locked, for messages. Errors: SINGE_ERROR_STATE where another process holds it, which the message names;
/// SINGE_ERROR_FILE where the file cannot be made. On a file system without locks *kept is false, and nothing is held.
SINGE_NODISCARD SingeResult lock_take(Lock *lock, const char *path, const char *what, bool shared, bool *kept,
                                      SingeError *error);

/// Gives it back. The last one to do so removes the file.
void lock_release(Lock *lock);

#endif
