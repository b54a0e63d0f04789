// Locates probes in the meshes of their sheets.
#ifndef SCENE_PROBES_H
#define SCENE_PROBES_H

#include "scene/messages.h"

/// Fills assets->probes, which is allocated. Reports probes by uv on a mesh without uv.
void probes_find(const Scene *scene, SceneAssets *assets, SceneMessages *messages);

#endif
