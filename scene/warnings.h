// Warnings about a scene that can be simulated.
#ifndef SCENE_WARNINGS_H
#define SCENE_WARNINGS_H

#include "scene/scene.h"

/// Tells the log what is certain to have no effect, or not the one that was meant, each with its location in the scene.
void scene_warn(const Scene *scene, const SceneAssets *assets, const SingeLog *log);

#endif
