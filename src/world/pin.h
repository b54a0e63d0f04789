// Particles held on a path.
#ifndef WORLD_PIN_H
#define WORLD_PIN_H

#include "shell/shell.h"
#include "world/path.h"

typedef struct Pin {
    uint32_t generation;   ///< 0: the slot is free
    uint32_t count;
    uint32_t *particles;   ///< held particles, increasing
    float (*anchors)[3];   ///< m, in the frame of the path's pose
    Path path;
    void *user_data;
    SingePinDef waiting;   ///< of a pin that was added before the commit, until then: its points and vertices are its own
} Pin;

typedef struct PinList {
    uint32_t count, capacity;
    Pin *items;
} PinList;

#endif
