// Air that sources move: jets, vortices, attraction and turbulence, on top of the wind.
#pragma once

#include "world/source.h"

/// The list if any of its sources moves air at this time, or NULL.
const SourceList *air_of(const SourceList *sources, double time);

/// The strength of a source at a time: linear between keys, held beyond the ends, 1 without keys.
float source_strength(const Source *source, double time);

/// What a lit source adds to the velocity of the air at a position, m/s; 0 if its kind moves none.
Float3 source_air(const Source *source, Float3 position, double time);

/// The sum of all; sources may be NULL.
Float3 air_velocity(const SourceList *sources, Float3 position, double time);
