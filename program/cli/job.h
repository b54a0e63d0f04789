// A scene that has been read and can be built: run, check and render begin with it.
#pragma once

#include "cli/cli.h"
#include "cli/console.h"
#include "cli/text.h"
#include "scene/scene.h"

/// The PATH=VALUE texts of --set, in order. The array points into the command line or to `owned`.
typedef struct SetList {
    int count, capacity;
    const char **items;
    char *owned; ///< "frames=N" of --frames
} SetList;

void set_add(SetList *sets, const char *text);
/// Adds `frames=count`, which overrides everything else.
void set_frames(SetList *sets, int count);
void set_free(SetList *sets);

typedef struct Job {
    Scene *scene;
    SceneAssets assets;
    SingeSimDef hooks; ///< allocator, log and threads
} Job;

/// The path of a scene that the command line names: a file, or a folder with one scene or with one of the folder's name.
/// NULL after an error. Free it.
char *job_scene_path(Console *console, const char *path);

/// Reads only the scene file. Messages have been printed unless the result is EXIT_GOOD, and the job is closed.
ExitCode job_read(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads);

/// Reads all files that the scene names. Refuses a scene that needs more memory than the machine has, before and after
/// its meshes are read; `pictures` is the memory for drawing it, bytes.
ExitCode job_load(Job *job, Console *console, double pictures);

/// Both, for a scene that is not drawn.
ExitCode job_open(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads);

/// The same for a scene in memory, whose files are looked for in `folder`.
ExitCode job_parse(Job *job, Console *console, const char *name, JsonText scene, const char *folder,
                   const SetList *sets, int threads);

/// The record of a run, which run writes (record.c).
typedef struct JobRecord {
    char *path; ///< FOLDER/run.json
    Bytes bytes;
    JsonText json; ///< all of them
} JobRecord;

/// Reads it. The error has been printed unless the result is EXIT_GOOD or the console is NULL. Close it in any case.
ExitCode job_record_open(JobRecord *record, Console *console, const char *folder);
void job_record_close(JobRecord *record);

/// Says that it is damaged or something else. Returns EXIT_INPUT.
ExitCode job_record_refuse(const JobRecord *record, Console *console);

/// The scene's path in the record of a run's folder, from malloc; NULL if the folder is none.
char *job_recorded_path(const char *folder);

/// Refuses a job that has been read, and closes it, if the machine has too little memory to draw it as well.
ExitCode job_fits(Job *job, Console *console, double pictures);

/// Reads the scene in a run's record, FOLDER/run.json, and its files, without the memory of pictures.
ExitCode job_reopen(Job *job, Console *console, const char *folder, const SetList *sets, int threads);

/// Prints which meshes were read and how they were repaired.
void job_note_meshes(const Job *job, Console *console);

/// Prints the next stage if the scene is so large that it takes a while.
void job_note_long(const Job *job, Console *console, const char *doing);

ExitCode job_build(Job *job, Console *console, SingeSim **sim);
void job_close(Job *job);

/// As many as the machine has, at most the library's limit.
int job_threads(void);
enum { JOB_THREADS_MAX = 64, JOB_FRAMES_MAX = 1000000 };

/// The exit code of a library result: out of memory and errors of our own files are failures, everything else is bad
/// input.
ExitCode job_exit(SingeResult result);
