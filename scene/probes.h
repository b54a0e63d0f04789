// Where probes are in the meshes of their sheets.
#ifndef SCENE_PROBES_H
#define SCENE_PROBES_H

#include "scene/messages.h"

/// Fills assets->probes, which has room for them. Messages: a probe by uv on a mesh that has none.
void probes_find(const Scene *scene, SceneAssets *assets, SceneMessages *messages);

#endif
