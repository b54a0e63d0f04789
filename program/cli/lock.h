// Locks of an output folder, so that two processes do not write the same files. The kernel holds them for the process
// (fcntl, advisory): they end with it, however it ends. A killed process leaves a file that locks nothing.
#pragma once

#include <stdbool.h>

#include "cli/console.h"
#include "singe/base.h"

typedef struct Lock {
    int fd; ///< -1: not taken
    bool shared;
    char *path; ///< of the locked file
} Lock;

#define LOCK_NONE ((Lock){.fd = -1})

/// Takes a lock, exclusive or shared, by creating the file `path`. `what` names the locked part of the folder in
/// messages. Errors: SINGE_ERROR_STATE if another process holds it, which the message names; SINGE_ERROR_FILE if the
/// file cannot be created. On a file system without locks nothing is held, and a warning says so.
SINGE_NODISCARD SingeResult lock_take(Lock *lock, const char *path, const char *what, bool shared, Console *console,
                                      SingeError *error);

/// Releases the lock. The last holder removes the file.
void lock_release(Lock *lock);
