// What a run notes of events and of probes: DIR/events.csv, a line an event in the order in which they happen, and
// DIR/probes.csv, a line a probe and frame. They grow with the frames; a resumption cuts them back to its checkpoint.
#ifndef CLI_TABLES_H
#define CLI_TABLES_H

#include "cli/checkpoint.h"
#include "cli/folder.h"
#include "cli/line_file.h"
#include "cli/totals.h"
#include "scene/scene.h"

typedef struct HeldEvent {
    SingeEvent event;
    float uv[2]; ///< of the particle
} HeldEvent;

typedef struct Tables {
    const Scene *scene;
    const SceneAssets *assets;
    LineFile events, probes; ///< closed where the scene asks for none
    HeldEvent *held;         ///< that are not written yet
    size_t held_count, held_capacity;
    size_t due;  ///< of them, those of the frame in writing
    char *lines; ///< of its probes, from malloc; NULL: none
} Tables;
#define TABLES_CLOSED \
    { .events = LINE_FILE_CLOSED, .probes = LINE_FILE_CLOSED }

/// Opens what the scene asks for, and changes nothing in it. Scene, assets and folder must outlive it.
SINGE_NODISCARD SingeResult tables_open(Tables *tables, const Folder *folder, const Scene *scene,
                                        const SceneAssets *assets, SingeError *error);
/// Empties the files and writes their headers.
SINGE_NODISCARD SingeResult tables_begin(Tables *tables, SingeError *error);
/// Cuts the files behind what a checkpoint of so many whole frames and with those totals stands for.
SINGE_NODISCARD SingeResult tables_cut(Tables *tables, int frames, const Totals *totals, SingeError *error);

/// Keeps the events of the step that the simulation has just done.
SINGE_NODISCARD SingeResult tables_take_step(Tables *tables, const SingeSim *sim, SingeError *error);
/// Keeps what the probes show at a frame; the events so far are that frame's.
SINGE_NODISCARD SingeResult tables_take_frame(Tables *tables, const SingeSim *sim, int frame, SingeError *error);
/// Writes what was taken of a frame.
SINGE_NODISCARD SingeResult tables_write_frame(Tables *tables, int frame, SingeError *error);
/// Writes the events of steps behind the last frame, on the way to `frame`.
SINGE_NODISCARD SingeResult tables_write_steps(Tables *tables, int frame, SingeError *error);
/// Asks the system to put the lines on the disk.
SINGE_NODISCARD SingeResult tables_sync(Tables *tables, SingeError *error);
void tables_close(Tables *tables);

#endif
