// Locates probes in the meshes of their sheets.
#pragma once

#include "scene/messages.h"

/// Fills assets->probes, which is allocated. Reports probes by uv on a mesh without uv.
void probes_find(const Scene *scene, SceneAssets *assets, SceneMessages *messages);
