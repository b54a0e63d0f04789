// The words by which scenes, options and tables name the values of the library's enums.
#pragma once

#include "singe/mesh.h"

/// The words of each enum, indexed by value: "" where scenes have no word for it, NULL after the last.
typedef struct EnumWords {
    const char *SingeSourceKind[12];
    const char *SingeColliderKind[8];
    const char *SingeContactSides[8];
    const char *SingeSolverMethod[8];
    const char *SingeInstructions[8];
    const char *SingeColour[8];
    const char *SingeHeatOperator[8];
    const char *SingeMeshQuads[8];
} EnumWords;

extern const EnumWords enum_words;
