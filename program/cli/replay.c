// singe replay: makes the calls of a recording once more and compares.
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/args.h"
#include "cli/job.h"
#include "common/allocator.h"
#include "common/printable.h"
#include "singe/replay.h"

typedef struct ReplayOptions {
    const char *path;
    int threads;
} ReplayOptions;

static const ArgOption replay_options[] = {
    {ARGS_THREADS(ReplayOptions)},
};

const ArgCommand replay_command = {
    "replay",
    "FILE",
    "Repeats the calls of a recording (singe run --record) and compares the state after every step.",
    ARGS_OPTIONS(replay_options),
    "Exit codes: 0 identical (a truncated recording is compared up to its end), 1 different, or out of memory,\n"
    "2 not a recording, or a damaged one.",
    "singe run letter.yaml --record letter.replay\n"
    "singe replay letter.replay --threads 1",
    .operand_field = offsetof(ReplayOptions, path)};

int command_replay(int argc, char **argv) {
    ReplayOptions options = {.threads = job_threads()};
    ExitCode code;
    if (!args_read(&replay_command, argc, argv, &options, &code)) return code;

    Console console = console_make(false);
    SingeSimDef hooks = singe_default_sim();
    hooks.allocator = allocator_or_libc((SingeAllocator){0});
    hooks.log = console_log(&console);
    hooks.thread_count = options.threads;

    Bytes bytes = {0};
    SingeReplay replay;
    SingeError error = {0};
    SingeResult result = file_read(options.path, hooks.allocator, &bytes, &error);
    if (!result) result = singe_replay(&hooks, bytes.data, bytes.size, &replay, &error);

    if (result == SINGE_ERROR_FORMAT || result == SINGE_ERROR_VERSION) {
        console_error(&console, "%s: %s", shown(options.path).text, error.message);
        code = EXIT_INPUT;
    } else if (result) {
        console_result(&console, &error);
        code = result == SINGE_ERROR_FILE ? EXIT_INPUT : job_exit(result);
    } else {
        if (strcmp(replay.version, singe_version()) != 0)
            console_note(&console, "recorded by singe %s; this is %s", shown(replay.version).text, singe_version());
        if (!replay.complete) console_note(&console, "the recording is truncated, perhaps by a crash");
        if (replay.same) printf("the same: %" PRIu64 " steps, %" PRIu64 " calls\n", replay.steps, replay.calls);
        else printf("differs first: %s\n", replay.what);
        code = replay.same ? EXIT_GOOD : EXIT_FAILED;
    }

    bytes_free(&bytes);
    return code;
}
