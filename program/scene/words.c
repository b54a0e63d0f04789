// The words of the library's enums, from its tables.
#include "scene/words.h"

#define SINGE_ROWS_STAY
#define SINGE_WORD(Enum, NAME, value, word, text) .Enum[NAME] = word,
const EnumWords enum_words = {
#include "singe/source.def"
#include "singe/collider.def"
#include "singe/solver.def"
#include "singe/sim.def"
#include "singe/mesh.def"
#include "singe/material.def"
};
