// DIR/checkpoint.singe, and the one before it in DIR/checkpoint.previous.singe: a snapshot of the simulation, then a
// trailer with the frame that it comes after, the steps since, the hash of the scene and a checksum. Written whole or
// not at all, after everything of its frame.
#ifndef CLI_CHECKPOINT_H
#define CLI_CHECKPOINT_H

#include "cli/console.h"
#include "cli/folder.h"
#include "cli/totals.h"
#include "scene/scene.h"

/// What a checkpoint belongs to.
typedef struct SceneHash {
    uint64_t result; ///< of all that the simulation's result and its sheets' looks depend on
    uint64_t looks;  ///< of the preview, which may differ when a run goes on
} SceneHash;

/// The result's: the resolved scene without its number of frames and its preview, and the contents of every file that
/// it names for anything but the preview: meshes and pictures of sheets, sources and colliders, as they are used.
/// Moving meshes are held against a checkpoint frame by frame, up to where it is.
SINGE_NODISCARD SingeResult checkpoint_scene_hash(const Scene *scene, const SceneAssets *assets, SceneHash *hash,
                                                  SingeError *error);

/// Where a run is: behind a frame whose files are written, by so many steps of the next.
typedef struct Progress {
    int frame, step;
} Progress;

/// A snapshot that has been taken and not been written yet.
typedef struct CheckpointBytes {
    uint8_t *bytes; ///< NULL: none
    size_t size;
} CheckpointBytes;

SINGE_NODISCARD SingeResult checkpoint_take(SingeSim *sim, CheckpointBytes *taken, SingeError *error);

/// Writes what was taken, with where the run was then. What was taken is gone afterwards, also when this fails.
SINGE_NODISCARD SingeResult checkpoint_write(const Folder *folder, SingeSim *sim, SingeAllocator allocator,
                                             CheckpointBytes *taken, Progress progress, SceneHash hash,
                                             const SceneAssets *assets, const Totals *totals, SingeError *error);

void checkpoint_drop(SingeSim *sim, CheckpointBytes *taken);

typedef struct Checkpoint {
    Progress progress; ///< frame 0: there is no checkpoint
    Totals totals;
    bool other_looks;   ///< the preview was another
    bool previous;      ///< it is the one before the last, which is missing or was refused
    SingeError refused; ///< why; all zero where it is missing
    SingeSim *sim;
} Checkpoint;

/// Reads the last checkpoint that can be used, of two, and makes its simulation. Errors, where neither can be used, are
/// those of the last: SINGE_ERROR_FORMAT and others for one that is damaged or of another version, SINGE_ERROR_STATE
/// for one of another scene (which is not passed over). No file: success with frame 0.
SINGE_NODISCARD SingeResult checkpoint_read(const Folder *folder, const SingeSimDef *hooks, SceneHash hash,
                                            const SceneAssets *assets, Checkpoint *checkpoint, SingeError *error);

/// Puts the checkpoint before the last instead of the last, which cannot be used: so the next one written does not
/// replace the only good one.
SINGE_NODISCARD SingeResult checkpoint_promote(const Folder *folder, SingeError *error);

#endif
