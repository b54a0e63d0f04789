// Runs rows on this machine: several at a time, each as a process of its own: singe run, then singe measure. A row that
// succeeds moves to rows/. Ctrl-C and SIGTERM are passed on, so that each row leaves a checkpoint.
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/spawn.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "sweep/sweep.h"

typedef enum Stage { STAGE_IDLE, STAGE_RUN, STAGE_MEASURE } Stage;

/// A running row.
typedef struct Slot {
    Stage stage;
    uint32_t row;
    pid_t process;
} Slot;

typedef struct Pool {
    Sweep *sweep;
    Slot *slots;
    int slot_count;
    uint32_t *queue; ///< rows to start, in order
    uint32_t queued, next;
    uint32_t complete, failed, due; ///< rows; due: to be run by this sweep
    double started;
    uint64_t frames_before; ///< frames that existed at its start
    bool stopping;
} Pool;

// ---- processes

static void fail_row(Pool *pool, Slot *slot, const char *why) {
    SingeError error = {0};
    char *folder = sweep_row_folder(pool->sweep, slot->row, false);
    char *path = text_format("%s/failed.txt", folder), *text = text_format("%s\n", why);
    if (file_write(path, text, strlen(text), &error)) console_result(pool->sweep->console, &error);
    console_error(pool->sweep->console, "row %u: %s; its messages are in %s/log.txt", slot->row + 1, why, folder);

    pool->failed++;
    slot->stage = STAGE_IDLE;
    free(path);
    free(text);
    free(folder);
}

/// Starts a row's run or its measurement. Its messages are appended to the row's log.
static void start_stage(Pool *pool, Slot *slot, Stage stage) {
    char *program = pool->sweep->program, *folder = sweep_row_folder(pool->sweep, slot->row, false);
    char *log = text_format("%s/log.txt", folder), *csv = text_format("--csv=%s/measure.csv", folder);
    char *measure[] = {program, "measure", csv, "--", folder, NULL};
    char *measure_undrawn[] = {program, "measure", csv, "--no-preview", "--", folder, NULL};
    char **run = stage == STAGE_RUN ? sweep_run_command(pool->sweep, slot->row) : NULL;
    char **command = run ? run : pool->sweep->options->no_preview ? measure_undrawn : measure;
    const int reason = stage != STAGE_RUN || run ? spawn_program(command, log, &slot->process) : ENOMEM;

    slot->stage = stage;
    if (reason) {
        char *why = text_format("cannot run %s: %s", program, strerror(reason));
        fail_row(pool, slot, why);
        free(why);
    }

    sweep_free_command(run);
    free(csv);
    free(log);
    free(folder);
}

/// The next stage of a row whose process has ended.
static void next_stage(Pool *pool, Slot *slot, int status) {
    const bool stopped = WIFSIGNALED(status) && (WTERMSIG(status) == SIGTERM || WTERMSIG(status) == SIGINT);
    const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (good && (slot->stage == STAGE_MEASURE || pool->sweep->plan.target.given)) { // a fit measures by itself
        char *from = sweep_row_folder(pool->sweep, slot->row, false),
             *to = sweep_row_folder(pool->sweep, slot->row, true);
        if (rename(from, to) != 0) {
            fail_row(pool, slot, strerror(errno));
        } else {
            pool->complete++;
            slot->stage = STAGE_IDLE;
        }
        free(from);
        free(to);
    } else if (pool->stopping || stopped || interrupt_asked()) {
        slot->stage = STAGE_IDLE; // it resumes another time
    } else if (good) {
        start_stage(pool, slot, STAGE_MEASURE);
    } else {
        const char *doing = slot->stage == STAGE_RUN ? "run" : "measure";
        char *why = WIFEXITED(status) ? text_format("singe %s ended with exit code %d", doing, WEXITSTATUS(status))
                                      : text_format("singe %s was stopped by signal %d", doing, WTERMSIG(status));
        fail_row(pool, slot, why);
        free(why);
    }
}

/// Frames that are done and frames in all, of the rows that this sweep runs.
static void frame_totals(const Pool *pool, uint64_t *done, uint64_t *all) {
    const Sweep *sweep = pool->sweep;
    *done = *all = 0;

    for (uint32_t row = 0; row < sweep->plan.row_count; row++) {
        if (sweep->options->row && row + 1 != (uint32_t)sweep->options->row) continue;
        *all += sweep->frames[row];
        if (sweep_row_state(sweep, row) == ROW_COMPLETE) {
            *done += sweep->frames[row];
            continue;
        }

        // a line of stats.csv for each complete frame, after the header
        char *folder = sweep_row_folder(sweep, row, false), *path = text_format("%s/stats.csv", folder), block[4096];
        FILE *file = fopen(path, "rb");
        uint64_t lines = 0;
        for (size_t size; file && (size = fread(block, 1, sizeof block, file)) > 0;)
            for (size_t i = 0; i < size; i++) lines += block[i] == '\n';

        if (file) fclose(file);
        free(path);
        free(folder);
        *done += lines ? lines - 1 : 0;
    }
}

// ---- all rows

/// Gives each idle slot the next row. Rows that another process is running go to the end of the queue.
static void fill_slots(Pool *pool) {
    for (int i = 0; i < pool->slot_count && !pool->stopping; i++) {
        Slot *slot = &pool->slots[i];
        if (slot->stage != STAGE_IDLE) continue;

        RowState state = ROW_ELSEWHERE;
        uint32_t row = 0;
        for (uint32_t left = pool->queued - pool->next; left > 0 && state == ROW_ELSEWHERE; left--) {
            uint32_t *first = &pool->queue[pool->next];
            row = *first;
            state = sweep_row_state(pool->sweep, row);
            if (state != ROW_ELSEWHERE) {
                pool->next++;
            } else {
                memmove(first, first + 1, (pool->queued - pool->next - 1) * sizeof *first);
                pool->queue[pool->queued - 1] = row;
            }
        }

        if (state == ROW_ELSEWHERE) continue;
        if (state == ROW_COMPLETE) { // by another process
            pool->complete++;
            continue;
        }

        // create the folder before the log, and clear an earlier failure
        SingeError error = {0};
        char *folder = sweep_row_folder(pool->sweep, row, false), *failed = text_format("%s/failed.txt", folder);
        *slot = (Slot){.row = row};
        unlink(failed);
        if (folder_make(folder, &error)) fail_row(pool, slot, error.message);
        else start_stage(pool, slot, STAGE_RUN);
        free(failed);
        free(folder);
    }
}

static void run_queue(Pool *pool) {
    const struct timespec pause = {.tv_nsec = 50000000};
    interrupt_watch();

    for (int turn = 0;; turn++) {
        const bool stop = interrupt_asked() && !pool->stopping;
        pool->stopping = pool->stopping || stop;
        for (int i = 0; i < pool->slot_count; i++) {
            Slot *slot = &pool->slots[i];
            int status = 0;
            if (slot->stage == STAGE_IDLE) continue;
            if (stop) kill(slot->process, SIGTERM);
            if (waitpid(slot->process, &status, WNOHANG) == slot->process) next_stage(pool, slot, status);
        }

        fill_slots(pool);

        uint32_t running = 0;
        for (int i = 0; i < pool->slot_count; i++) running += pool->slots[i].stage != STAGE_IDLE;

        const bool over = running == 0 && (pool->stopping || pool->next == pool->queued);
        if (over || turn % 10 == 0) {
            uint64_t done, all;
            frame_totals(pool, &done, &all);

            const double now = console_clock() - pool->started;
            const double each = done > pool->frames_before ? now / (double)(done - pool->frames_before) : 0;
            console_sweep(pool->sweep->console, &(ConsoleSweep){.complete = pool->complete,
                                                                .running = running,
                                                                .failed = pool->failed,
                                                                .rows = pool->due,
                                                                .frames = done,
                                                                .frames_all = all,
                                                                .seconds_left = each * (double)(all - done)});
        }

        if (over) break;
        nanosleep(&pause, NULL);
    }

    console_clear(pool->sweep->console);
}

ExitCode sweep_run_rows(Sweep *sweep) {
    const SweepOptions *options = sweep->options;
    const int jobs = options->row ? 1 : options->jobs;
    Pool pool = {.sweep = sweep,
                 .slots = calloc((size_t)jobs, sizeof *pool.slots),
                 .slot_count = jobs,
                 .queue = calloc(sweep->plan.row_count, sizeof *pool.queue),
                 .started = console_clock()};
    if (!pool.slots || !pool.queue) {
        console_error(sweep->console, "out of memory");
        free(pool.slots);
        free(pool.queue);
        return EXIT_FAILED;
    }

    // queue the rows to run: with --retry also failed ones; only the named row if there is one
    for (uint32_t row = 0; row < sweep->plan.row_count; row++) {
        if (options->row && row + 1 != (uint32_t)options->row) continue;
        const RowState state = sweep_row_state(sweep, row);
        pool.due++;
        if (state == ROW_COMPLETE) pool.complete++;
        else if (state == ROW_FAILED && !options->retry && !options->row) pool.failed++;
        else pool.queue[pool.queued++] = row;
    }

    uint64_t all;
    frame_totals(&pool, &pool.frames_before, &all);
    run_queue(&pool);
    console_note(sweep->console, "%u of %u rows are complete, %u failed%s", pool.complete, pool.due, pool.failed,
                 pool.stopping ? "; the same command continues the sweep"
                 : pool.failed ? "; --retry runs those again"
                               : "");
    free(pool.slots);
    free(pool.queue);

    return pool.complete == pool.due ? EXIT_GOOD : EXIT_FAILED;
}
