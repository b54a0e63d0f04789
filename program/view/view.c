// singe view: shows a burn in a browser, from a run's folder or while a scene burns.
#include "view/view.h"

#include <stdlib.h>
#include <unistd.h>

#include "cli/args.h"
#include "cli/interrupt.h"
#include "cli/spawn.h"
#include "common/printable.h"

typedef struct ViewOptions {
    const char *what;
    SetList sets;
    int threads, frames, port;
    bool quiet;
} ViewOptions;

static const ArgOption view_options[] = {
    {ARGS_SET(ViewOptions)},
    {"frames", 0, "N", "frames of the scene", .read = args_int, offsetof(ViewOptions, frames), 1, JOB_FRAMES_MAX},
    {"threads", 0, "N", "threads of the burn [all]", .read = args_int, offsetof(ViewOptions, threads), 1,
     JOB_THREADS_MAX},
    {"port", 0, "N", "port on this machine [a free one]", .read = args_int, offsetof(ViewOptions, port), 1, 65535},
    {"quiet", 'q', NULL, "prints only the address, warnings and errors", .read = args_switch,
     offsetof(ViewOptions, quiet)},
};

const ArgCommand view_command = {
    "view",
    "SCENE|DIR",
    "Shows a burn in a browser: the cache in DIR, or SCENE as it burns, restarted each time its file is saved.",
    ARGS_OPTIONS(view_options),
    "The address works on this machine only; keep it secret. From another machine: ssh -L PORT:127.0.0.1:PORT and "
    "--port PORT.\nExit codes: 0 ended by Ctrl-C, 1 failed, 2 bad input.",
    "singe view letter.yaml\n"
    "singe view out",
    .operand_field = offsetof(ViewOptions, what)};

static ExitCode show(View *view, const ViewOptions *o) {
    SingeError error = {0};
    // 128 bits that nobody can guess
    uint8_t bytes[16];
    FILE *file = fopen("/dev/urandom", "rb");
    const bool random = file && fread(bytes, sizeof bytes, 1, file) == 1;

    if (file) fclose(file);
    for (size_t i = 0; i < sizeof bytes && random; i++) snprintf(view->token + 2 * i, 3, "%02x", bytes[i]);
    if (!random) {
        console_error(view->console, "/dev/urandom gives no random numbers");
        return EXIT_FAILED;
    }

    char *record = text_format("%s/run.json", o->what);
    const bool is_cache = access(record, F_OK) == 0;
    free(record);

    if (is_cache) {
        if (o->sets.count) {
            console_error(view->console, "%s is a cache: --set and --frames are for scenes", shown_path(o->what).text);
            return EXIT_INPUT;
        }
        const ExitCode code = shown_open(view, o->what);
        int first = 0, last = 0;
        if (code) return code;
        if (folder_span(&view->shown.folder, view->console, &first, &last)) return EXIT_INPUT;
    } else {
        // a scene that is wrong from the start is an error here; later ones are told on the page
        Job job;
        view->live.scene = job_scene_path(view->console, o->what);
        const ExitCode code =
            view->live.scene ? job_read(&job, view->console, view->live.scene, &o->sets, 1) : EXIT_INPUT;
        if (code) return code;

        job_close(&job);
        view->live.program = spawn_own_path();
        view->live.sets = &o->sets;
        view->live.threads = o->threads;
    }

    interrupt_watch(); // from here on there is something to clean up
    Server *server = NULL;
    view->port = o->port;
    SingeResult result = server_open(view, &server, &error);
    if (!result && view->live.scene) result = live_begin(view, &error);

    if (result) {
        console_result(view->console, &error);
        server_close(server);
        return EXIT_FAILED;
    }

    printf("http://127.0.0.1:%d/%s/\n", view->port, view->token);
    fflush(stdout);
    console_note(view->console, "open this address in a browser; Ctrl-C ends the view");

    while (!interrupt_asked()) {
        server_attend(server, 50);
        if (view->live.scene) live_attend(view);
    }

    server_close(server);
    return EXIT_GOOD;
}

int command_view(int argc, char **argv) {
    ViewOptions options = {.threads = job_threads()};
    ExitCode code;
    if (args_read(&view_command, argc, argv, &options, &code)) {
        if (options.frames) set_frames(&options.sets, options.frames);
        interrupt_shield();
        Console console = console_make(options.quiet);
        View view = {.console = &console};
        code = show(&view, &options);
        shown_close(&view.shown);
        live_end(&view);
    }

    set_free(&options.sets);
    return code;
}
