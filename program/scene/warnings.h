// Warnings about a scene that can be simulated.
#ifndef SCENE_WARNINGS_H
#define SCENE_WARNINGS_H

#include "scene/scene.h"

/// Logs settings that certainly have no effect, or not the intended one, each with its location in the scene.
void scene_warn(const Scene *scene, const SceneAssets *assets, const SingeLog *log);

#endif
