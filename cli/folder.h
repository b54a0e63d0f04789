// Where a run's files are: DIR/ply/NAME.0001.ply, DIR/gas/NAME.0001.vdb, DIR/frames/NAME.0001.png,
// DIR/exr/NAME.0001.exr, those of the formats of formats/output.h (DIR/vtp/NAME.0001.vtp, DIR/NAME.pvd) and those that
// exist once.
#ifndef CLI_FOLDER_H
#define CLI_FOLDER_H

#include <stdbool.h>

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

/// Names only; nothing is made. `path` NULL is out/NAME.
Folder folder_name(const char *path, const char *name);
void folder_free(Folder *folder);

/// Makes a folder and those above it. `path` is not empty.
SINGE_NODISCARD SingeResult folder_make(const char *path, SingeError *error);

/// What a run writes besides the cache: a folder of its own each, or a table.
typedef struct FolderParts {
    bool pictures, gas, gas_detail, exr, events, probes;
    OutputSet outputs;
} FolderParts;

/// Makes ply/ and, as `parts` ask, frames/, gas/, gas_detail/, exr/ and those of formats in the folder, which must be
/// there. A link instead of one of them is refused: what it points at is not ours.
SINGE_NODISCARD SingeResult folder_create(const Folder *folder, FolderParts parts, SingeError *error);

/// Paths of a frame, from malloc.
char *folder_ply(const Folder *folder, int frame);
char *folder_png(const Folder *folder, int frame);
char *folder_vdb(const Folder *folder, int frame);
char *folder_gas_detail(const Folder *folder, int frame);
char *folder_exr(const Folder *folder, int frame);
char *folder_output(const Folder *folder, int format, int frame);
/// Path of what has all frames, from malloc: DIR/NAME.usdc, or DIR/vat/NAME, to which endings are added.
char *folder_single(const Folder *folder, int single);
/// Path of a format's root, from malloc.
char *folder_root(const Folder *folder, int format);

/// Removes the checkpoints of an earlier run: without its frames no run may resume from them. Adds to *removed.
SINGE_NODISCARD SingeResult folder_forget(const Folder *folder, int *removed, SingeError *error);

/// Removes what else an earlier run of the same name left (its frames, video, GIF, and tables that are not asked for),
/// and nothing that is not named as such files are or lies behind a link. Adds to *removed. The folders that `parts` do
/// not ask for go too when they are empty.
SINGE_NODISCARD SingeResult folder_clean(const Folder *folder, FolderParts parts, int *removed, SingeError *error);

/// Removes what a killed run left half written under temporary names.
SINGE_NODISCARD SingeResult folder_sweep(const Folder *folder, SingeError *error);

/// Whether a file is there and holds something.
bool folder_has(const char *path);

/// Checks that there are PLYs of the frames asked for, from *first to *last, or sets both to all where *first is 0.
/// A message has been printed unless the result is EXIT_GOOD.
ExitCode folder_span(const Folder *folder, Console *console, int *first, int *last);

/// Fills *error with the path and the system's reason, 0 for what is no regular file. Returns SINGE_ERROR_FILE.
SingeResult folder_fail(const char *path, const char *what, int reason, SingeError *error);

#endif
