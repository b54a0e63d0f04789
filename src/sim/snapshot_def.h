// Defs in a snapshot: each field that matters, without padding, pointers and hooks.
#pragma once

#include "common/stream.h"
#include "sim/sim_internal.h"

/// All but hooks and thread count, which do not change when reading.
void snapshot_sim_def(Stream *stream, SingeSimDef *def);

/// Name, counts, material and the rest of a sheet as it was added.
void snapshot_sheet_def(Stream *stream, Sheet *sheet);

/// Without path, texture, strength and callback.
void snapshot_source_def(Stream *stream, SingeSourceDef *def);

/// Without path.
void snapshot_collider_def(Stream *stream, SingeColliderDef *def);
