// DIR/checkpoint.singe: a snapshot of the simulation, then a trailer with the frame it belongs to, the hash of the
// scene and a checksum. Written whole or not at all, after everything of its frame.
#ifndef CLI_CHECKPOINT_H
#define CLI_CHECKPOINT_H

#include "cli/console.h"
#include "cli/folder.h"
#include "cli/totals.h"
#include "scene/scene.h"

/// A hash of all that the simulation's result depends on: the resolved scene without its number of frames and its
/// preview, and the contents of its meshes and pictures.
SINGE_NODISCARD SingeResult checkpoint_scene_hash(const Scene *scene, const SceneAssets *assets, uint64_t *hash,
                                                  SingeError *error);

SINGE_NODISCARD SingeResult checkpoint_write(const Folder *folder, SingeSim *sim, SingeAllocator allocator, int frame,
                                             uint64_t scene_hash, const Totals *totals, SingeError *error);

typedef struct Checkpoint {
    int frame; ///< 0: there is no checkpoint
    Totals totals;
    SingeSim *sim;
} Checkpoint;

/// Reads a checkpoint and makes its simulation. Errors: SINGE_ERROR_FORMAT and others for one that is damaged or of
/// another version, SINGE_ERROR_STATE for one of another scene. No file: success with frame 0.
SINGE_NODISCARD SingeResult checkpoint_read(const Folder *folder, const SingeSimDef *hooks, uint64_t scene_hash,
                                            Checkpoint *checkpoint, SingeError *error);

#endif
