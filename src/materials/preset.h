// The table of materials that have names: src/materials/presets.c, made from src/materials/*.yaml.
#pragma once

#include "singe/material.h"

typedef struct MaterialPreset {
    const char *name;
    void (*apply)(SingeMaterialDef *def); ///< to the defaults
} MaterialPreset;

/// In the order of their names; a row of zeros behind the last.
extern const MaterialPreset material_presets[];
