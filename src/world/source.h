// Sources of heat: their slots. src/heat/source.c makes them and heats sheets; src/gas burns their flames.
#ifndef WORLD_SOURCE_H
#define WORLD_SOURCE_H

#include "singe/sim.h"
#include "world/path.h"

/// A heat source of the simulation. Textures are evaluated once, at every particle.
typedef struct Source {
    uint32_t generation; ///< 0: the slot is free
    SingeSourceDef def;  ///< its pointers (path, texture, strength) are not used
    Path path;
    uint32_t strength_count;
    SingeValueKey *strength;
    float *texture;       ///< [particle_count] or NULL
    SingeTexture waiting; ///< own copy of a texture that was added before the commit, until then
} Source;

typedef struct SourceList {
    uint32_t count, capacity;
    Source *items;
} SourceList;

/// Whether a slot holds a source that is lit at this time.
static inline bool source_is_lit(const Source *source, double time) {
    return source->generation && time >= source->def.start && time < source->def.end;
}

#endif
