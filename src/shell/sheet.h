// A sheet's checked Def and material.
#pragma once

#include "shell/shell.h"

/// Checks the parameters that have one value for the sheet.
SingeResult material_check_scalars(const SingeMaterialDef *material, const char *sheet, SingeError *error);

/// Evaluates every parameter at every particle into the source and checks its range; the source's
/// mesh, uv and sheet are in place.
SingeResult material_evaluate(Memory *memory, const SingeSheetDef *def, SheetSource *source, SingeError *error);

/// Checks values that material_evaluate wrote, or that were read back.
SingeResult material_check_values(const SheetSource *source, SingeError *error);
