// The tables of a run, which grow by whole lines with its frames: DIR/stats.csv with a line per frame, DIR/events.csv
// with a line per event, in order of time, and DIR/probes.csv with a line per probe and frame. A resumed run truncates
// them to its checkpoint.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "cli/folder.h"
#include "scene/scene.h"
#include "singe/base.h"
#include "singe/sim.h"

enum { TOTAL_SURFACE, TOTAL_PLY, TOTAL_PREVIEW, TOTAL_CHECKPOINT, TOTAL_OUTPUT_COUNT };

/// Fixed layout without padding: it is part of the checkpoint.
typedef struct Totals {
    double stage_seconds[SINGE_STAGE_COUNT];
    double output_seconds[TOTAL_OUTPUT_COUNT];
    double wall_seconds;
    uint64_t steps, heat_iterations, strands_projected, contacts;
    uint64_t ignited, holes_opened, pieces_freed;
    uint64_t crossed;       ///< pairs of triangles of the first frame
    uint64_t contact_halts; ///< steps
    double hottest;         ///< K, of all frames
} Totals;

/// A file that grows by whole lines.
typedef struct LineFile {
    int fd; ///< -1 when closed
    const char *path;
    int64_t size; ///< bytes of whole lines
} LineFile;

/// The times of a frame (ms) and its triangles.
typedef struct FrameCost {
    double stage[SINGE_STAGE_COUNT], contact; ///< contact is a part of the dynamics
    double surface, output;                   ///< output includes the surface
    uint64_t triangles, fine_triangles;
} FrameCost;

typedef struct HeldEvent {
    SingeEvent event;
    float uv[2]; ///< of the particle
} HeldEvent;

enum { TABLE_STATS, TABLE_PROBES, TABLE_EVENTS, TABLE_COUNT };

typedef struct Tables {
    const Scene *scene;
    const SceneAssets *assets;
    LineFile files[TABLE_COUNT]; ///< those that the scene does not ask for are closed
    HeldEvent *held;             ///< not written yet
    size_t held_count, held_capacity;
    size_t due;  ///< number of them that belong to the frame being written
    char *lines; ///< of that frame's probes, from malloc; NULL: none
} Tables;
#define TABLES_CLOSED                                   \
    {                                                   \
        .files = { {.fd = -1}, {.fd = -1}, {.fd = -1} } \
    }

/// Opens the tables that the scene asks for, and changes nothing in them. A link, a pipe or a device in the place of one
/// is refused. Scene, assets and folder must outlive it.
SINGE_NODISCARD SingeResult tables_open(Tables *tables, const Folder *folder, const Scene *scene,
                                        const SceneAssets *assets, SingeError *error);
/// Empties the files and writes their headers.
SINGE_NODISCARD SingeResult tables_begin(Tables *tables, SingeError *error);
/// Truncates the files to the state of a checkpoint with so many whole frames and these totals. All lines up to there
/// must exist.
SINGE_NODISCARD SingeResult tables_cut(Tables *tables, int frames, const Totals *totals, SingeError *error);

/// Copies the tables that the scene asks for from another folder, as they were at that state; `to` NULL only checks that
/// all lines exist.
SINGE_NODISCARD SingeResult tables_copy(const Folder *from, const Folder *to, const Scene *scene, int frames,
                                        const Totals *totals, SingeError *error);

/// Holds the events of the simulation's last step.
SINGE_NODISCARD SingeResult tables_take_step(Tables *tables, const SingeSim *sim, SingeError *error);
/// Holds the probes' values at a frame; the events so far belong to that frame.
SINGE_NODISCARD SingeResult tables_take_frame(Tables *tables, const SingeSim *sim, int frame, SingeError *error);
/// Writes the lines held for a frame, and its line of statistics. A line that does not fit on the disk leaves nothing.
SINGE_NODISCARD SingeResult tables_write_frame(Tables *tables, int frame, const SingeStats *stats, const Totals *totals,
                                               const FrameCost *cost, SingeError *error);
/// Writes the events of the steps since the last frame, before `frame`.
SINGE_NODISCARD SingeResult tables_write_steps(Tables *tables, int frame, SingeError *error);
/// Asks the system to put the lines on the disk, as a checkpoint relies on them.
SINGE_NODISCARD SingeResult tables_sync(Tables *tables, SingeError *error);
/// The unit of a column of stats.csv; "" if it has none.
const char *tables_unit(const char *column);
void tables_close(Tables *tables);
