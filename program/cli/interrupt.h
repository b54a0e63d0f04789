// Signals. Ctrl-C and SIGTERM: the first asks the run to end after its step, the second ends the program at once.
#pragma once

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

/// Registers a draft (file_draft) to be removed if the program exits early, when out of memory. It must be disowned before it is freed. Ignores NULL and more than 8 drafts.
void interrupt_own(const char *draft);
void interrupt_disown(const char *draft);
