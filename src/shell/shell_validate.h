// Invariants of a Shell and of a State on it: for assertions, and for tests. Each call checks everything.
#pragma once

#include "shell/shell.h"

/// What is wrong, in words: "cell 12 names corner 40 twice".
typedef struct ShellFault {
    char text[128];
} ShellFault;

/// Whether the Shell, which may have torn, holds together; if not, *fault is the first thing that is wrong.
bool shell_validate(const Shell *shell, ShellFault *fault);

/// The same for a State between two steps, on a valid Shell.
bool state_validate(const Shell *shell, const State *state, ShellFault *fault);

/// Asserts both; the assertion prints the fault.
void shell_assert(const Shell *shell, const State *state);
