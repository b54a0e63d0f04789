// Finds the sheets of a scene that the library refuses.
#ifndef SCENE_FAULTS_H
#define SCENE_FAULTS_H

#include "scene/messages.h"

/// The Def of a sheet. It points into the scene and the assets.
void scene_sheet_def(const Scene *scene, const SceneAssets *assets, uint32_t index, SingeSheetDef *def);

typedef enum FaultScope {
    FAULTS_OF_MESHES, ///< only of meshes that were read; pictures and attributes may be missing
    FAULTS_OF_SHEETS, ///< everything
} FaultScope;

/// Reports the first fault of each sheet; faults of a mesh at the name of its file. Returns whether there was one.
bool sheet_faults(const Scene *scene, const SceneAssets *assets, FaultScope scope, SceneMessages *messages);

#endif
