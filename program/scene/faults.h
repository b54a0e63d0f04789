// From an error of the library to the scene's objects: their file, line and words.
#pragma once

#include "scene/messages.h"

/// The object of a scene at which its construction failed, and the library's error.
typedef struct SceneFault {
    enum { FAULT_SIM, FAULT_SHEET, FAULT_COMMIT, FAULT_SOURCE, FAULT_COLLIDER, FAULT_PIN, FAULT_RENDER_MESH } object;
    uint32_t index; ///< of the sheet, source, collider or pin
    SingeError error;
} SceneFault;

/// Reports a fault at its object; for a refused sheet, the faults of all sheets.
void fault_report(const Scene *scene, const SceneAssets *assets, const SceneFault *fault, SceneMessages *messages);

/// The Def of a sheet. It points into the scene and the assets.
void scene_sheet_def(const Scene *scene, const SceneAssets *assets, uint32_t index, SingeSheetDef *def);

typedef enum FaultScope {
    FAULTS_OF_MESHES, ///< only of meshes that were read; pictures and attributes may be missing
    FAULTS_OF_SHEETS, ///< everything
} FaultScope;

/// Reports the first fault of each sheet; faults of a mesh at the name of its file. Returns whether there was one.
bool sheet_faults(const Scene *scene, const SceneAssets *assets, FaultScope scope, SceneMessages *messages);
