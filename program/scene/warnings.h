// Warnings about a scene that can be simulated.
#pragma once

#include "scene/scene.h"

/// Logs settings that certainly have no effect, or not the intended one, each with its location in the scene.
void scene_warn(const Scene *scene, const SceneAssets *assets, const SingeLog *log);

/// Why a source cannot heat anything, whatever moves; NULL: it may.
const char *source_heats_nothing(const Scene *scene, const SceneSource *source);

/// Logs sources that miss all sheets, with the nearest distance, and those that are too weak to light them; or that there
/// is no fire at all (fires.c).
void scene_warn_of_fires(const Scene *scene, const SceneAssets *assets, const SingeLog *log);

/// The lowest temperature at which a sheet of the scene begins to burn, K; INFINITY if none can.
double scene_ignition(const Scene *scene);

/// Whether a source heats what is near a point: only such a one can miss all sheets.
static inline bool source_is_round(const SingeSourceDef *def) {
    return def->kind == SINGE_SOURCE_BALL || def->kind == SINGE_SOURCE_SPOT;
}

/// Whether a source lights nothing: it wets, or moves air.
static inline bool source_wets_or_blows(const SingeSourceDef *def) {
    return def->kind >= SINGE_SOURCE_WATER && def->kind <= SINGE_SOURCE_TURBULENCE;
}
