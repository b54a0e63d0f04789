// Internals of singe view. view.c is the command, serve.c speaks HTTP and decides who may ask, answers.c makes the answers,
// live.c burns a scene and watches its file.
//
// All of it is one thread: files are read in child processes, which are made while there is one (formats/isolate.h).
#pragma once

#include <sys/types.h>
#include <time.h>

#include "cli/console.h"
#include "cli/folder.h"
#include "cli/job.h"
#include "preview/preview.h"

/// A run's folder that is shown.
typedef struct Exhibit {
    Folder folder;
    Job job;
    Preview *preview;
    PreviewShape *shapes;
    uint32_t shape_max;
    int number; ///< which one: the page loads everything again when it changes; 0: none yet
} Exhibit;

/// A scene that burns, again each time its file is saved.
typedef struct Live {
    char *program, *scene, *room; ///< `room`: our own folder for the runs, removed at the end
    int lock;                     ///< open file in `room`: the folder is in use; -1: none
    const SetList *sets;
    int threads;
    int number;              ///< of the current run, from 1
    pid_t process;           ///< 0: it has ended
    int exit_code;           ///< of the last one that has ended, -1: it was stopped
    bool stopping;           ///< the file was saved: it is about to begin again
    struct timespec changed; ///< the scene file's, when it was read
    off_t size;
    char *folder, *log; ///< of the current run
} Live;

typedef struct View {
    Console *console;
    Exhibit shown;
    Live live; ///< scene NULL: a finished cache
    char token[33];
    int port;
} View;

// live.c
SINGE_NODISCARD SingeResult live_begin(View *view, SingeError *error);
/// Starts again if the file was saved, and shows the run that has its first frame.
void live_attend(View *view);
void live_end(View *view);

// answers.c
/// Opens a run's folder, in place of the one before, which remains if this fails; a message has been printed.
ExitCode shown_open(View *view, const char *path);
void shown_close(Exhibit *shown);

typedef struct Answer {
    unsigned status; ///< of HTTP
    const char *type;
    char *bytes; ///< from malloc, unless `fixed`
    size_t size;
    bool fixed;
    bool large; ///< of a frame: few at a time
} Answer;

/// The answer to a path behind the token, "frame/12". Never NULL bytes.
Answer answer_to(View *view, const char *path);
Answer answer_text(unsigned status, const char *text);

// serve.c
typedef struct Server Server;
/// Listens on the loopback; port 0 is a free one. Sets view->port.
SINGE_NODISCARD SingeResult server_open(View *view, Server **server, SingeError *error);
/// Attends to requests for at most some ms.
void server_attend(Server *server, int ms);
void server_close(Server *server);
