// The words of the library's enums, from its tables.
#include "scene/words.h"

#define OTHERS(name, word)

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeSourceKind(NAME, word) [NAME] = word,
const char *const words_SingeSourceKind[] = {
#include "singe/source.def"
    NULL};
#undef WORD_SingeSourceKind

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeColliderKind(NAME, word) [NAME] = word,
#define WORD_SingeContactSides OTHERS
const char *const words_SingeColliderKind[] = {
#include "singe/collider.def"
    NULL};
#undef WORD_SingeColliderKind
#undef WORD_SingeContactSides

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeContactSides(NAME, word) [NAME] = word,
#define WORD_SingeColliderKind OTHERS
const char *const words_SingeContactSides[] = {
#include "singe/collider.def"
    NULL};
#undef WORD_SingeContactSides
#undef WORD_SingeColliderKind

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeSolverMethod(NAME, word) [NAME] = word,
#define WORD_SingeColour OTHERS
const char *const words_SingeSolverMethod[] = {
#include "singe/solver.def"
    NULL};
#undef WORD_SingeSolverMethod
#undef WORD_SingeColour

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeInstructions(NAME, word) [NAME] = word,
const char *const words_SingeInstructions[] = {
#include "singe/sim.def"
    NULL};
#undef WORD_SingeInstructions

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeColour(NAME, word) [NAME] = word,
#define WORD_SingeSolverMethod OTHERS
const char *const words_SingeColour[] = {
#include "singe/solver.def"
    NULL};
#undef WORD_SingeColour
#undef WORD_SingeSolverMethod

#define SINGE_WORD(Enum, NAME, value, word, text) WORD_##Enum(NAME, word)
#define WORD_SingeHeatOperator(NAME, word) [NAME] = word,
const char *const words_SingeHeatOperator[] = {
#include "singe/material.def"
    NULL};
#undef WORD_SingeHeatOperator
