// Where a run's files are: DIR/ply/NAME.0001.ply, DIR/gas/NAME.0001.vdb, DIR/frames/NAME.0001.png,
// DIR/exr/NAME.0001.exr and those that exist once.
#ifndef CLI_FOLDER_H
#define CLI_FOLDER_H

#include "cli/cli.h"
#include "cli/console.h"
#include "singe/base.h"

typedef struct Folder {
    char *path;       ///< DIR, without a slash at its end
    char *name;       ///< NAME
    char *stats;      ///< DIR/stats.csv
    char *record;     ///< DIR/run.json
    char *checkpoint; ///< DIR/checkpoint.singe
    char *video;      ///< DIR/preview.mp4
    char *sheet;      ///< DIR/sheet.png
    char *gif;        ///< DIR/preview.gif
} Folder;

/// Names only; nothing is made. `path` NULL is out/NAME.
Folder folder_name(const char *path, const char *name);
void folder_free(Folder *folder);

/// Makes a folder and those above it. `path` is not empty.
SINGE_NODISCARD SingeResult folder_make(const char *path, SingeError *error);

/// What a run writes besides the surface: a folder of its own each.
typedef struct FolderParts { bool pictures, gas, exr; } FolderParts;

/// Makes the folder, those above it, ply/ and, as `parts` ask, frames/, gas/ and exr/ in it.
SINGE_NODISCARD SingeResult folder_create(const Folder *folder, FolderParts parts, SingeError *error);

/// Paths of a frame, from malloc.
char *folder_ply(const Folder *folder, int frame);
char *folder_png(const Folder *folder, int frame);
char *folder_vdb(const Folder *folder, int frame);
char *folder_exr(const Folder *folder, int frame);

/// Removes what an earlier run of the same name left (its frames, checkpoint, video, GIF), and nothing that is
/// not named as such files are. *removed is the number of files. What `parts` do not ask for goes too when it is
/// empty: frames/, gas/ and exr/.
SINGE_NODISCARD SingeResult folder_clean(const Folder *folder, FolderParts parts, int *removed, SingeError *error);

/// Removes what a killed run left half written under temporary names.
SINGE_NODISCARD SingeResult folder_sweep(const Folder *folder, SingeError *error);

/// Checks that there are PLYs of the frames asked for, from *first to *last, or sets both to all where *first is 0.
/// A message has been printed unless the result is EXIT_GOOD.
ExitCode folder_span(const Folder *folder, Console *console, int *first, int *last);

/// Fills *error with the path and the system's reason. Returns SINGE_ERROR_FILE.
SingeResult folder_fail(const char *path, const char *what, int reason, SingeError *error);

#endif
