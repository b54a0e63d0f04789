// DIR/checkpoint.singe, and the previous one in DIR/checkpoint.previous.singe: a snapshot of the simulation, then a
// trailer with its frame, the steps since, the hash of the scene and a checksum. A checkpoint is written whole or not
// at all, after all files of its frame.
#pragma once

#include "cli/console.h"
#include "cli/folder.h"
#include "cli/tables.h"
#include "scene/scene.h"

/// Identifies the scene of a checkpoint.
typedef struct SceneHash {
    uint64_t result; ///< of everything that the result and the sheets' appearance depend on
    uint64_t looks;  ///< of the preview, which may change when a run resumes
} SceneHash;

/// The hash of the result covers the resolved scene without its number of frames and its preview, and the contents of
/// every file that it names except for the preview: meshes and pictures of sheets, sources and colliders, as they are
/// used. Moving meshes are compared with a checkpoint frame by frame, up to its frame.
SINGE_NODISCARD SingeResult checkpoint_scene_hash(const Scene *scene, const SceneAssets *assets, SceneHash *hash,
                                                  SingeError *error);

/// Progress of a run: the last frame whose files are written, and the steps made since.
typedef struct Progress {
    int frame, step;
} Progress;

/// A snapshot that has been taken but not yet written.
typedef struct CheckpointBytes {
    uint8_t *bytes; ///< NULL: none
    size_t size;
} CheckpointBytes;

SINGE_NODISCARD SingeResult checkpoint_take(SingeSim *sim, CheckpointBytes *taken, SingeError *error);

/// Writes the snapshot with the run's progress at that time, and frees it, also on failure.
SINGE_NODISCARD SingeResult checkpoint_write(const Folder *folder, SingeSim *sim, SingeAllocator allocator,
                                             CheckpointBytes *taken, Progress progress, SceneHash hash,
                                             const SceneAssets *assets, const Totals *totals, SingeError *error);

void checkpoint_drop(SingeSim *sim, CheckpointBytes *taken);

typedef struct Checkpoint {
    Progress progress; ///< frame 0: there is no checkpoint
    Totals totals;
    bool other_looks;   ///< the preview has changed since
    bool previous;      ///< this is the previous one; the last is missing or was refused
    SingeError refused; ///< why; all zero if it is missing
    SingeSim *sim;
} Checkpoint;

/// Reads the last usable of the two checkpoints and creates its simulation. If neither is usable, the error is that of
/// the last: SINGE_ERROR_FORMAT and others if it is damaged or of another version, SINGE_ERROR_STATE if it is of
/// another scene (the previous one is then not tried). No file: success with frame 0.
SINGE_NODISCARD SingeResult checkpoint_read(const Folder *folder, const SingeSimDef *hooks, SceneHash hash,
                                            const SceneAssets *assets, Checkpoint *checkpoint, SingeError *error);

/// The progress of a file's checkpoint, without reading the rest; false if it has none of this version.
bool checkpoint_peek(const char *path, Progress *progress);

/// Reads the checkpoint in a file. Errors as above.
SINGE_NODISCARD SingeResult checkpoint_read_file(const char *path, const SingeSimDef *hooks, SceneHash hash,
                                                 const SceneAssets *assets, Checkpoint *checkpoint, SingeError *error);

/// Replaces the last checkpoint, which is unusable, by the previous one: the next one written then does not replace the
/// only good one.
SINGE_NODISCARD SingeResult checkpoint_promote(const Folder *folder, SingeError *error);
