// Flames at four positions at once, for every processor; and the choice of those that run.
#define FIRE_LOOK fire_look_plain
#include "preview/fire_kernel.h"

#include "common/cpu.h"

FireLook *fire_look(SingeInstructions set) {
    bool best = set == SINGE_INSTRUCTIONS_BEST;
#ifdef SINGE_X86_LEVELS
    if ((best || set == SINGE_INSTRUCTIONS_X86_V4) && cpu_has(SINGE_INSTRUCTIONS_X86_V4)) return fire_look_v4;
    if ((best || set == SINGE_INSTRUCTIONS_X86_V3) && cpu_has(SINGE_INSTRUCTIONS_X86_V3)) return fire_look_v3;
#endif
    return best || set == SINGE_INSTRUCTIONS_PLAIN ? fire_look_plain : NULL;
}
