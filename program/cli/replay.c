// singe replay: makes the calls of a recording once more and compares.
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/args.h"
#include "cli/job.h"
#include "common/allocator.h"
#include "common/printable.h"
#include "singe/replay.h"

enum { OPT_THREADS, OPT_COUNT };

static const ArgOption replay_options[OPT_COUNT] = {
    [OPT_THREADS] = {"threads", 0, "N", "threads [all]; the result does not depend on them"},
};

const ArgCommand replay_command = {
    "replay",
    "FILE",
    "Repeats the calls of a recording (singe run --record) and compares the state after every step.",
    replay_options,
    OPT_COUNT,
    "Exit codes: 0 identical (a truncated recording is compared up to its end), 1 different, or out of memory,\n"
    "2 not a recording, or a damaged one.",
    "singe run letter.yaml --record letter.replay\n"
    "singe replay letter.replay --threads 1"};

/// Prints what a replay has shown, and returns the exit code.
static ExitCode replay_report(const SingeReplay *replay, Console *console) {
    if (strcmp(replay->version, singe_version()) != 0)
        console_note(console, "recorded by singe %s; this is %s", shown(replay->version).text, singe_version());
    if (!replay->complete) console_note(console, "the recording is truncated, perhaps by a crash");
    if (!replay->same) {
        printf("differs first: %s\n", replay->what);
        return EXIT_FAILED;
    }
    printf("the same: %" PRIu64 " steps, %" PRIu64 " calls\n", replay->steps, replay->calls);
    return EXIT_GOOD;
}

int command_replay(int argc, char **argv) {
    ArgReader reader = args_begin(&replay_command, argc, argv);
    const char *value, *path = NULL;
    int threads = job_threads();
    for (int option; (option = args_next(&reader, &value)) != ARG_END;) {
        if (option == ARG_HELP) return EXIT_GOOD;
        if (option == ARG_OPERAND) path = value;
        else if (option != OPT_THREADS || !args_int(&reader, option, value, 1, JOB_THREADS_MAX, &threads))
            return EXIT_INPUT;
    }

    Console console = console_make(false);
    SingeSimDef hooks = singe_default_sim();
    hooks.allocator = allocator_or_libc((SingeAllocator){0});
    hooks.log = console_log(&console);
    hooks.thread_count = threads;

    Bytes bytes = {0};
    SingeReplay replay;
    SingeError error = {0};
    SingeResult result = file_read(path, hooks.allocator, &bytes, &error);
    if (!result) result = singe_replay(&hooks, bytes.data, bytes.size, &replay, &error);
    ExitCode code = EXIT_GOOD;
    if (result == SINGE_ERROR_FORMAT || result == SINGE_ERROR_VERSION) {
        console_error(&console, "%s: %s", shown(path).text, error.message);
        code = EXIT_INPUT;
    } else if (result) {
        console_result(&console, &error);
        code = result == SINGE_ERROR_FILE ? EXIT_INPUT : job_exit(result);
    } else {
        code = replay_report(&replay, &console);
    }
    bytes_free(&bytes);
    return code;
}
