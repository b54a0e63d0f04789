// Starts other programs.
#pragma once

#include <sys/types.h>

/// Starts the program arguments[0] (by PATH) with an empty standard input. With a log, its messages and output are
/// appended to that file, and it has a process group of its own: Ctrl-C in a terminal does not reach it, so the caller
/// ends it. Without one (NULL) it shares ours. Returns 0, with the process in `child`, or an errno.
int spawn_program(char *const *arguments, const char *log, pid_t *child);

/// The path of this program, allocated; "singe" where it is unknown.
char *spawn_own_path(void);
