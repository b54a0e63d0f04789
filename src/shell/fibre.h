// Directions of the springs relative to the fibres.
#ifndef SHELL_FIBRE_H
#define SHELL_FIBRE_H

#include "shell/shell.h"

/// Fills the springs' `grain` where a sheet shrinks more in one direction; rest positions and lengths are in place.
/// False when out of memory.
bool fibre_measure(Memory *memory, Shell *shell);

#endif
