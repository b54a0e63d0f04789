// Invariants of a Shell and of a State on it: for assertions, and for tests. Each call goes over everything.
#ifndef SHELL_VALIDATE_H
#define SHELL_VALIDATE_H

#include "shell/shell.h"

/// NULL, or which invariant of the Shell is broken. The Shell may have torn.
const char *shell_validate(const Shell *shell);

/// NULL, or which invariant of a State between two steps is broken, on a valid Shell.
const char *state_validate(const Shell *shell, const State *state);

#endif
