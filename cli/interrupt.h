// Signals. Ctrl-C and SIGTERM: the first asks the run to end after its step, the second ends the program at once.
// SIGABRT while a library of C++ is at work: that of one which ran out of memory and cannot say so.
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

/// A broken pipe and a file over its size limit become errors of the write instead of the program's end.
void interrupt_shield(void);

/// From now on Ctrl-C and SIGTERM are noted.
void interrupt_watch(void);

/// Whether the run was asked to end.
bool interrupt_asked(void);

/// A draft (file_draft) that goes if the program ends in the middle, by an abort within the guard or by exit where
/// memory lacks; from then on until it is disowned, which comes before it is freed. Nothing is done for NULL, nor
/// beyond 8 of them.
void interrupt_own(const char *draft);
void interrupt_disown(const char *draft);

/// Between the two an abort ends the program with a message and EXIT_FAILED, as running out of memory does elsewhere.
/// Embree throws where the system gives no memory for its errors, and what it throws cannot be caught in C. All files
/// are whole at that time, or drafts, which go.
void interrupt_guard_begin(void);
void interrupt_guard_end(void);

#endif
