// Properties of the particles, from the sheets' parameters.
#pragma once

#include "shell/shell.h"

/// Creates the fields and arrays of shell->matter, whose sheets are in place; areas, masses and capacities are zero
/// until measure_particles. False when out of memory.
bool matter_create(Memory *memory, Shell *shell, const SheetSource *sources);
void matter_free(Memory *memory, Shell *shell);

/// The value of a parameter at particle i of the sheet (its vertices, then its cells), or the quantity that is computed
/// from several; kept in the Field of the parameter.
float matter_value(const SheetSource *source, int param, uint32_t i);

/// Masses, capacities and their ratio, from areas, grammage and specific heat.
void matter_weigh(Shell *shell, const SheetSource *sources);

/// Gives a vertex without cells the material of another and `area` of its area, with the same share of mass and
/// capacity.
void matter_split(Shell *shell, uint32_t from, uint32_t to, float area);
