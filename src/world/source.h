// Sources of heat: their slots. src/heat/source.c makes them and heats sheets; src/gas burns their flames.
#pragma once

#include <math.h>

#include "singe/sim.h"
#include "singe/source.def"
#include "world/path.h"

/// A heat source of the simulation. Textures are evaluated once, at every particle.
typedef struct Source {
    uint32_t generation; ///< 0: the slot is free
    SingeSourceDef def;  ///< its pointers (path, texture, strength) are not used
    Path path;
    uint32_t strength_count;
    SingeValueKey *strength;
    float *texture;       ///< [particle_count] or NULL; of an arrival map also the two values below
    SingeTexture waiting; ///< own copy of a texture that was added before the commit, until then
} Source;

/// A particle that an arrival map never ignites, and one of a sheet that it does not cover.
#define SOURCE_NEVER 2.0f
#define SOURCE_UNMAPPED (-1.0f)

typedef struct SourceList {
    uint32_t count, capacity;
    Source *items;
} SourceList;

/// Whether its kind has a picture over uv.
static inline bool source_is_drawn(const SingeSourceDef *def) {
    return def->kind == SINGE_SOURCE_TEXTURE || def->kind == SINGE_SOURCE_ARRIVAL || def->kind == SINGE_SOURCE_WATER;
}

/// Whether its kind moves air (world/air.h).
static inline bool source_blows(const SingeSourceDef *def) {
    return (unsigned)def->kind < 32 && SINGE_SOURCES_OF_AIR >> def->kind & 1;
}

/// Whether a slot holds a source that is lit at this time.
static inline bool source_is_lit(const Source *source, double time) {
    return source->generation && time >= source->def.start && time < source->def.end;
}

/// When an arrival map ignites a particle that it covers, s; INFINITY: never.
static inline double source_arrival(const Source *source, uint32_t particle) {
    const double from = (double)source->def.arrival_from, to = (double)source->def.arrival_to;
    const float map = source->texture[particle];
    return map == SOURCE_NEVER ? (double)INFINITY : from + (to - from) * (double)map;
}
