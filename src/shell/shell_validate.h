// Invariants of a Shell and of a State on it: for assertions, and for tests. Each call checks everything.
#ifndef SHELL_SHELL_VALIDATE_H
#define SHELL_SHELL_VALIDATE_H

#include "shell/shell.h"

/// NULL, or the invariant of the Shell that is broken. The Shell may have torn.
const char *shell_validate(const Shell *shell);

/// NULL, or the invariant of a State between two steps that is broken, on a valid Shell.
const char *state_validate(const Shell *shell, const State *state);

#endif
