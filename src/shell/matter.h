// What the particles are made of, from the sheets' parameters.
#ifndef SHELL_MATTER_H
#define SHELL_MATTER_H

#include "shell/shell.h"

/// Makes the fields and arrays of shell->matter, whose sheets are in place; areas, masses and capacities are zero
/// until measure_particles. False when out of memory.
bool matter_create(Memory *memory, Shell *shell, const SheetSource *sources);
void matter_free(Memory *memory, Shell *shell);

/// Masses, capacities and their ratio, from areas, grammage and specific heat.
void matter_weigh(Shell *shell, const SheetSource *sources);

#endif
