// Flames at several positions at once, compiled for each instruction set.
#pragma once

#include "preview/fire.h"
#include "singe/types.h"

FireLook fire_look_plain, fire_look_v3, fire_look_v4;

/// That of an instruction set; NULL if it, or the set, is not there. SINGE_INSTRUCTIONS_BEST: of the machine's best.
FireLook *fire_look(SingeInstructions set);
