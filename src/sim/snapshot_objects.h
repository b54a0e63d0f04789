// Sheets and objects in a snapshot. Each function returns false when out of memory, or where the stream has failed.
#pragma once

#include "common/stream.h"
#include "sim/sim_internal.h"

/// Fails the stream if a check refuses data read back. Returns whether the stream is still good.
bool snapshot_held(Stream *stream, bool good);

bool snapshot_motion(Stream *stream, Memory *memory, uint32_t count, Motion *motion);

/// The sheets as they were added.
bool snapshot_sheets(Stream *stream, SingeSim *sim);

/// Sources, colliders and pins, with their generations; the shell has been built.
bool snapshot_objects(Stream *stream, SingeSim *sim);
