// The words by which scenes, options and tables name the values of the library's enums.
#ifndef SCENE_WORDS_H
#define SCENE_WORDS_H

#include "singe/types.h"

// indexed by value; "" where scenes have no word for it, NULL after the last
extern const char *const words_SingeSourceKind[];
extern const char *const words_SingeColliderKind[];
extern const char *const words_SingeContactSides[];
extern const char *const words_SingeSolverMethod[];
extern const char *const words_SingeInstructions[];
extern const char *const words_SingeColour[];
extern const char *const words_SingeHeatOperator[];

#endif
