// Which instructions this machine can run.
#pragma once

#include "singe/types.h"

/// Whether the processor has all instructions of the set, and the operating system saves their registers. False for
/// SINGE_INSTRUCTIONS_BEST, which is no set.
bool cpu_has(SingeInstructions set);
