// Paths of a run's files: DIR/ply/NAME.0001.ply, DIR/gas/NAME.0001.vdb, DIR/frames/NAME.0001.png,
// DIR/exr/NAME.0001.exr, DIR/checkpoints/NAME.0001.singe, the formats of formats/output.h (DIR/vtp/NAME.0001.vtp, DIR/NAME.pvd), and files that are not
// per frame.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "cli/cli.h"
#include "cli/console.h"
#include "formats/output.h"
#include "singe/base.h"

typedef struct Folder {
    char *path;                       ///< DIR, without a slash at its end
    char *name;                       ///< NAME
    char *stats;                      ///< DIR/stats.csv
    char *events, *probes;            ///< DIR/events.csv, DIR/probes.csv
    char *record;                     ///< DIR/run.json
    char *checkpoint;                 ///< DIR/checkpoint.singe
    char *previous_checkpoint;        ///< DIR/checkpoint.previous.singe: the one before it
    char *video;                      ///< DIR/preview.mp4
    char *sheet;                      ///< DIR/sheet.png
    char *gif;                        ///< DIR/preview.gif
    char *cache_lock, *pictures_lock; ///< DIR/cache.lock, DIR/pictures.lock: while they are written
} Folder;

/// The kinds of files of frames, each in a folder of its own: those of formats first.
enum { FOLDER_FRAMES = OUTPUT_COUNT, FOLDER_GAS, FOLDER_GAS_DETAIL, FOLDER_EXR, FOLDER_CHECKPOINTS, FOLDER_COUNT };
/// The name of a kind's folder; NULL after the last.
const char *folder_kind(int kind);

/// Names only; nothing is created. `path` NULL is out/NAME.
Folder folder_name(const char *path, const char *name);
void folder_free(Folder *folder);

/// Creates a folder and those above it. `path` is not empty.
SINGE_NODISCARD SingeResult folder_make(const char *path, SingeError *error);

/// What a run writes besides the cache: folders, each for one kind of file, and tables.
typedef struct FolderParts {
    bool pictures, gas, gas_detail, exr, checkpoints, events, probes;
    bool elsewhere; ///< the cache is in another folder: no ply/
    OutputSet outputs;
} FolderParts;

/// Creates ply/ and, as `parts` ask, frames/, gas/, gas_detail/, exr/ and the folders of formats in the folder, which
/// must exist. A link in place of one of them is refused: its target is not ours.
SINGE_NODISCARD SingeResult folder_create(const Folder *folder, FolderParts parts, SingeError *error);

/// Paths of a frame, from malloc.
char *folder_ply(const Folder *folder, int frame);
char *folder_png(const Folder *folder, int frame);
char *folder_vdb(const Folder *folder, int frame);
char *folder_gas_detail(const Folder *folder, int frame);
char *folder_exr(const Folder *folder, int frame);
char *folder_kept(const Folder *folder, int frame); ///< a checkpoint that is kept
char *folder_output(const Folder *folder, int format, int frame);
/// Path of a file with all frames, from malloc: DIR/NAME.usdc, or DIR/vat/NAME, to which endings are added.
char *folder_single(const Folder *folder, int single);
/// Path of a format's root, from malloc.
char *folder_root(const Folder *folder, int format);

/// Removes the checkpoints of an earlier run: without its frames no run can resume from them. Adds to *removed.
SINGE_NODISCARD SingeResult folder_forget(const Folder *folder, int *removed, SingeError *error);

/// Removes the other files of an earlier run of the same name: frames, video, GIF, and tables that are not asked for.
/// Files with other names, or behind a link, remain. Adds to *removed. Empty folders that `parts` do not ask for are
/// removed, too.
SINGE_NODISCARD SingeResult folder_clean(const Folder *folder, FolderParts parts, int *removed, SingeError *error);

/// Removes half-written files that a killed run left under temporary names.
SINGE_NODISCARD SingeResult folder_sweep(const Folder *folder, SingeError *error);

/// Whether a file exists and is not empty.
bool folder_has(const char *path);

/// Gives a file a second name, in place of what has that name; where the file system cannot, copies it. Only a regular
/// file: no link is followed.
SINGE_NODISCARD SingeResult folder_link(const char *from, const char *to, SingeError *error);

/// Calls `visit` with each file of a kind, in no order, its size, and whether other folders have it too.
typedef void FolderVisit(void *context, int frame, uint64_t size, bool shared);
SINGE_NODISCARD SingeResult folder_each(const Folder *folder, int kind, FolderVisit *visit, void *context,
                                        SingeError *error);

/// Removes the files of all frames but 1, `last`, those beyond it, and every `every`-th one; checkpoints remain. Adds to
/// *removed.
SINGE_NODISCARD SingeResult folder_thin(const Folder *folder, int every, int last, int *removed, SingeError *error);

/// The range of the frames that have a PLY; 0 and 0 if there are none.
SINGE_NODISCARD SingeResult folder_find(const Folder *folder, int *first, int *last, SingeError *error);

/// Checks that the PLYs of frames *first to *last exist; sets both to the range of all frames if *first is 0. A message
/// has been printed unless the result is EXIT_GOOD.
ExitCode folder_span(const Folder *folder, Console *console, int *first, int *last);

/// Fills *error with the path and the system's error number, 0 for anything but a regular file. Returns
/// SINGE_ERROR_FILE.
SingeResult folder_fail(const char *path, const char *what, int reason, SingeError *error);
