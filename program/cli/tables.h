// Tables of events and probes: DIR/events.csv with a line per event, in order of time, and DIR/probes.csv with a line
// per probe and frame. They grow with the frames; a resumed run truncates them to its checkpoint.
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
    LineFile events, probes; ///< closed if the scene asks for none
    HeldEvent *held;         ///< not written yet
    size_t held_count, held_capacity;
    size_t due;  ///< number of them that belong to the frame being written
    char *lines; ///< of that frame's probes, from malloc; NULL: none
} Tables;
#define TABLES_CLOSED \
    { .events = LINE_FILE_CLOSED, .probes = LINE_FILE_CLOSED }

/// Opens the tables that the scene asks for, and changes nothing in them. Scene, assets and folder must outlive it.
SINGE_NODISCARD SingeResult tables_open(Tables *tables, const Folder *folder, const Scene *scene,
                                        const SceneAssets *assets, SingeError *error);
/// Empties the files and writes their headers.
SINGE_NODISCARD SingeResult tables_begin(Tables *tables, SingeError *error);
/// Truncates the files to the state of a checkpoint with so many whole frames and these totals.
SINGE_NODISCARD SingeResult tables_cut(Tables *tables, int frames, const Totals *totals, SingeError *error);

/// Holds the events of the simulation's last step.
SINGE_NODISCARD SingeResult tables_take_step(Tables *tables, const SingeSim *sim, SingeError *error);
/// Holds the probes' values at a frame; the events so far belong to that frame.
SINGE_NODISCARD SingeResult tables_take_frame(Tables *tables, const SingeSim *sim, int frame, SingeError *error);
/// Writes the lines held for a frame.
SINGE_NODISCARD SingeResult tables_write_frame(Tables *tables, int frame, SingeError *error);
/// Writes the events of the steps since the last frame, before `frame`.
SINGE_NODISCARD SingeResult tables_write_steps(Tables *tables, int frame, SingeError *error);
/// Asks the system to put the lines on the disk.
SINGE_NODISCARD SingeResult tables_sync(Tables *tables, SingeError *error);
void tables_close(Tables *tables);

#endif
