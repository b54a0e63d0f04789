// Ctrl-C and SIGTERM: the first asks the run to end after its frame, the second ends the program at once.
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

/// A broken pipe and a file over its size limit become errors of the write instead of the program's end.
void interrupt_shield(void);

/// From now on Ctrl-C and SIGTERM are noted.
void interrupt_watch(void);

/// Whether the run was asked to end.
bool interrupt_asked(void);

#endif
