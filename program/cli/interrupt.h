// Signals. Ctrl-C and SIGTERM: the first asks the run to end after its step, the second ends the program at once.
// SIGABRT while a C++ library runs: it ran out of memory and cannot report it.
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

/// A broken pipe becomes a write error instead of ending the program.
void interrupt_shield(void);

/// From now on Ctrl-C and SIGTERM are recorded.
void interrupt_watch(void);

/// Whether the run was asked to end.
bool interrupt_asked(void);

/// Whether it was asked a second or two ago: work that takes long is given up then. From any thread.
bool interrupt_overdue(void);

/// Whether interrupt_overdue has ever been true: what failed since was given up.
bool interrupt_left_work(void);

/// Registers a draft (file_draft) to be removed if the program ends early: by an abort within the guard, or by exit
/// when out of memory. It must be disowned before it is freed. Ignores NULL and more than 8 drafts.
void interrupt_own(const char *draft);
void interrupt_disown(const char *draft);

/// Between these two calls an abort ends the program with a message and EXIT_FAILED, as running out of memory does
/// elsewhere. Embree throws when out of memory, and C cannot catch the exception. All files are whole at that time, or
/// drafts, which are removed.
void interrupt_guard_begin(void);
void interrupt_guard_end(void);

#endif
