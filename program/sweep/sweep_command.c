// singe sweep: the command.
#include <stdio.h>
#include <stdlib.h>

#include "cli/args.h"
#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/spawn.h"
#include "cli/text.h"
#include "common/printable.h"
#include "sweep/sweep.h"

static bool read_slurm(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    if (!text[strcspn(text, "\r\n")]) return args_set(command, option, text, field); // it becomes a line of a script
    return args_complain(command, "--slurm-option: expected one line, got '%s'", shown(text).text);
}

static const ArgOption sweep_options[] = {
    {"output", 'o', "DIR", "folder of the sweep [out/NAME]", .read = args_text, offsetof(SweepOptions, output)},
    {"jobs", 'j', "N", "rows at a time [cores of the machine / threads of a row]", .read = args_int,
     offsetof(SweepOptions, jobs), 1, 1024},
    {"threads", 0, "N", "threads of each row [1]", .read = args_int, offsetof(SweepOptions, threads), 1,
     JOB_THREADS_MAX},
    {"retry", 0, NULL, "runs failed rows again", .read = args_switch, offsetof(SweepOptions, retry)},
    {"no-preview", 0, NULL, "draws no pictures and makes no videos", .read = args_switch,
     offsetof(SweepOptions, no_preview)},
    {"print", 0, NULL, "prints a command for each unfinished row, and runs nothing", .read = args_switch,
     offsetof(SweepOptions, print)},
    {"openjd", 0, NULL, "prints an Open Job Description job, and runs nothing", .read = args_switch,
     offsetof(SweepOptions, openjd)},
    {"row", 0, "N", "runs only this row; jobs on a farm use this", .read = args_int, offsetof(SweepOptions, row), 1,
     PLAN_ROWS_MAX},
    {"report", 0, NULL, "writes the report of the rows that are complete, and runs nothing", .read = args_switch,
     offsetof(SweepOptions, report)},
    {"slurm", 0, NULL, "submits the rows, their pictures and the report to Slurm", .read = args_switch,
     offsetof(SweepOptions, submit)},
    {"max-running", 0, "N", "with --slurm: rows at a time [no limit]", .read = args_int,
     offsetof(SweepOptions, max_running), 1, PLAN_ROWS_MAX},
    {"slurm-option", 0, "TEXT", "with --slurm: an option of sbatch; may be repeated", .read = read_slurm,
     offsetof(SweepOptions, slurm)},
    {"render-frames", 0, "N", "with --slurm: frames that one job draws [24]", .read = args_int,
     offsetof(SweepOptions, frames), 1, JOB_FRAMES_MAX},
    {ARGS_QUIET(SweepOptions)},
};

static bool sweep_check(const ArgCommand *command, void *options) {
    SweepOptions *o = options;
    if (o->print + o->openjd + o->report + o->submit + (o->row > 0) > 1)
        return args_complain(command, "--print, --openjd, --report, --row and --slurm exclude each other");
    if (!o->jobs) o->jobs = job_threads() / o->threads > 1 ? job_threads() / o->threads : 1;
    return true;
}

const ArgCommand sweep_command = {
    "sweep",
    "PLAN",
    "Runs a scene many times with different parameters, and writes a report.",
    ARGS_OPTIONS(sweep_options),
    "docs/sweep.md describes plans. Repeat the command to continue a sweep that was stopped.\n"
    "Exit codes: 0 all rows are complete, 1 a row failed or the sweep was interrupted, 2 bad input.",
    "singe sweep sweep.yaml -o out --jobs 4\n"
    "singe sweep sweep.yaml -o out --print\n"
    "singe sweep sweep.yaml -o out --openjd > job.json\n"
    "singe sweep sweep.yaml -o out --slurm --max-running 20",
    .operand_field = offsetof(SweepOptions, plan),
    .check = sweep_check};

/// Absolute, so that jobs may start in any folder.
static char *absolute(const char *path) {
    char *whole = realpath(path, NULL);
    char *text = text_format("%s", whole ? whole : path);
    free(whole);
    return text;
}

static ExitCode sweep_make_room(Sweep *sweep) {
    if (!sweep->frames) sweep->frames = calloc(sweep->plan.row_count, sizeof *sweep->frames);
    if (sweep->frames) return EXIT_GOOD;
    console_error(sweep->console, "out of memory");
    return EXIT_FAILED;
}

ExitCode sweep_prepare(Sweep *sweep) {
    ExitCode code = sweep_make_room(sweep);
    if (code) return code;

    const SweepOptions *o = sweep->options;
    char *named = o->output ? text_format("%s", o->output) : text_format("out/%s", sweep->plan.name);
    SingeError error = {0};
    if (!named[0]) named[0] = '.';

    SingeResult result = folder_make(named, &error);
    if (!result) sweep->folder = absolute(named);
    free(named);

    // a sweep that runs or submits rows locks its folder; a row's job and a report do not
    if (!result && !o->row && !o->report && !o->print && !o->openjd) {
        char *path = text_format("%s/sweep.lock", sweep->folder);
        result = lock_take(&sweep->lock, path, "rows", false, sweep->console, &error);
        free(path);
    }

    if (!result) return sweep_note_plan(sweep);

    console_result(sweep->console, &error);
    return EXIT_FAILED;
}

Sweep sweep_make(Console *console, const SweepOptions *options) {
    return (Sweep){.console = console,
                   .options = options,
                   .program = spawn_own_path(), // valid on other nodes that see the same files
                   .plan_path = absolute(options->plan),
                   .lock = LOCK_NONE};
}

void sweep_close(Sweep *sweep) {
    lock_release(&sweep->lock);
    plan_free(&sweep->plan);
    free(sweep->folder);
    free(sweep->frames);
    free(sweep->name);
    free(sweep->program);
    free(sweep->plan_path);
}

/// Runs, submits, lists or reports the rows of a plan that has been read.
static ExitCode sweep_rows(Sweep *sweep) {
    const SweepOptions *o = sweep->options;
    const Plan *plan = &sweep->plan;
    if (o->row > 0 && (uint32_t)o->row > plan->row_count) {
        console_error(sweep->console, "--row %d: %s has %u rows", o->row, o->plan, plan->row_count);
        return EXIT_INPUT;
    }

    ExitCode code = sweep_make_room(sweep);
    if (!code) code = sweep_check_rows(sweep);
    if (!code) code = sweep_prepare(sweep);
    if (code) return code;

    // the commands of the rows that are due
    for (uint32_t row = 0; o->print && row < plan->row_count; row++) {
        if (!sweep_row_is_due(sweep, row)) continue;
        char *number = text_format("%u", row + 1), *line = sweep_row_line(sweep, number);
        puts(line);
        free(line);
        free(number);
    }

    if (o->print) return EXIT_GOOD;
    if (o->openjd) return sweep_print_openjd(sweep);
    if (o->submit) return sweep_submit(sweep);
    if (o->row) return sweep_run_rows(sweep);

    code = o->report ? EXIT_GOOD : sweep_run_rows(sweep);
    ExitCode report = sweep_report(sweep);
    if (!report && !o->quiet) printf("%s/index.html\n", sweep->folder);
    return code ? code : report;
}

int command_sweep(int argc, char **argv) {
    SweepOptions options = {.threads = 1, .frames = 24};
    ExitCode code;
    if (args_read(&sweep_command, argc, argv, &options, &code)) {
        interrupt_shield();
        Console console = console_make(options.quiet);
        Sweep sweep = sweep_make(&console, &options);
        code = plan_read(options.plan, false, &console, &sweep.plan);
        if (!code) code = sweep_rows(&sweep);
        sweep_close(&sweep);
    }

    set_free(&options.slurm);
    return code;
}
