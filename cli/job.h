// A scene read and ready to be built: what run, check and render begin with.
#ifndef CLI_JOB_H
#define CLI_JOB_H

#include "cli/cli.h"
#include "cli/console.h"
#include "scene/scene.h"

/// Texts PATH=VALUE of --set, in their order. The array points into the command line or to `owned`.
typedef struct SetList {
    int count, capacity;
    const char **items;
    char *owned; ///< "frames=N" of --frames
} SetList;

void set_add(SetList *sets, const char *text);
/// Lays `frames=count` over everything else.
void set_frames(SetList *sets, int count);
void set_free(SetList *sets);

typedef struct Job {
    Scene *scene;
    SceneAssets assets;
    SingeSimDef hooks; ///< allocator, log and threads
} Job;

/// Reads the scene file alone. Messages have been printed unless the result is EXIT_GOOD, and the job is closed.
ExitCode job_read(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads);

/// Reads all that the scene names. Refuses one that needs more memory than the machine has, before and after its meshes
/// are read; `pictures` are the bytes that what is drawn of it takes.
ExitCode job_load(Job *job, Console *console, double pictures);

/// Both, for a scene that is not drawn.
ExitCode job_open(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads);

/// The same for a scene in memory, whose files are looked for in `folder`.
ExitCode job_parse(Job *job, Console *console, const char *name, const char *text, size_t size, const char *folder,
                   const SetList *sets, int threads);

/// The scene of a run's record, FOLDER/run.json.
ExitCode job_reopen(Job *job, Console *console, const char *folder, const SetList *sets, int threads);

/// Notes what meshes were read and what was done to them.
void job_note_meshes(const Job *job, Console *console);

/// Notes what comes next where the scene is so large that it takes a while.
void job_note_long(const Job *job, Console *console, const char *doing);

ExitCode job_build(Job *job, Console *console, SingeSim **sim);
void job_close(Job *job);

/// As many as the machine has, at most what the library takes.
int job_threads(void);
enum { JOB_THREADS_MAX = 64 };

/// The exit code of a library's result: memory and files of ours fail, all else is bad input.
ExitCode job_exit(SingeResult result);

#endif
