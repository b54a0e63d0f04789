// singe sweep: the command.
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cli/args.h"
#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/text.h"
#include "common/printable.h"
#include "sweep/sweep.h"

enum {
    OPT_OUTPUT,
    OPT_JOBS,
    OPT_THREADS,
    OPT_RETRY,
    OPT_NO_PREVIEW,
    OPT_PRINT,
    OPT_OPENJD,
    OPT_ROW,
    OPT_REPORT,
    OPT_SLURM,
    OPT_MAX_RUNNING,
    OPT_SLURM_OPTION,
    OPT_RENDER_FRAMES,
    OPT_QUIET,
    OPT_COUNT
};

static const ArgOption sweep_options[OPT_COUNT] = {
    [OPT_OUTPUT] = {"output", 'o', "DIR", "folder of the sweep [out/NAME]"},
    [OPT_JOBS] = {"jobs", 'j', "N", "rows at a time [cores of the machine / threads of a row]"},
    [OPT_THREADS] = {"threads", 0, "N", "threads of each row [1]"},
    [OPT_RETRY] = {"retry", 0, NULL, "runs failed rows again"},
    [OPT_NO_PREVIEW] = {"no-preview", 0, NULL, "draws no pictures and makes no videos"},
    [OPT_PRINT] = {"print", 0, NULL, "prints a command for each unfinished row, and runs nothing"},
    [OPT_OPENJD] = {"openjd", 0, NULL, "prints a job of Open Job Description, and runs nothing"},
    [OPT_ROW] = {"row", 0, "N", "runs only this row, as a job of a farm does"},
    [OPT_REPORT] = {"report", 0, NULL, "writes the report of the rows that are complete, and runs nothing"},
    [OPT_SLURM] = {"slurm", 0, NULL, "submits the rows, their pictures and the report to Slurm"},
    [OPT_MAX_RUNNING] = {"max-running", 0, "N", "with --slurm: rows at a time [no limit]"},
    [OPT_SLURM_OPTION] = {"slurm-option", 0, "TEXT", "with --slurm: an option of sbatch; may be repeated"},
    [OPT_RENDER_FRAMES] = {"render-frames", 0, "N", "with --slurm: frames that one job draws [24]"},
    [OPT_QUIET] = {"quiet", 'q', NULL, "prints only warnings and errors"},
};

const ArgCommand sweep_command = {
    "sweep",
    "PLAN",
    "Runs a scene many times with other parameters, and writes a report.",
    sweep_options,
    OPT_COUNT,
    "docs/sweep.md describes plans. The same command continues a sweep that was stopped.\n"
    "Exit codes: 0 all rows are complete, 1 a row failed or the sweep was interrupted, 2 bad input.",
    "singe sweep sweep.yaml -o out --jobs 4\n"
    "singe sweep sweep.yaml -o out --print\n"
    "singe sweep sweep.yaml -o out --openjd > job.json\n"
    "singe sweep sweep.yaml -o out --slurm --max-running 20"};

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
    // the path of this program, valid on other nodes that see the same files
    char path[4096];
    const ssize_t size = readlink("/proc/self/exe", path, sizeof path - 1);
    if (size > 0) path[size] = 0;
    return (Sweep){.console = console,
                   .options = options,
                   .program = text_format("%s", size > 0 ? path : "singe"),
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
    ArgReader reader = args_begin(&sweep_command, argc, argv);
    SweepOptions options = {.threads = 1, .frames = 24};
    ExitCode code = EXIT_GOOD;
    const char *value;
    bool done = false;

    for (int option; !code && !done && (option = args_next(&reader, &value)) != ARG_END;) {
        bool good = true;
        switch (option) {
        case OPT_OUTPUT: options.output = value; break;
        case OPT_JOBS: good = args_int(&reader, option, value, 1, 1024, &options.jobs); break;
        case OPT_THREADS: good = args_int(&reader, option, value, 1, JOB_THREADS_MAX, &options.threads); break;
        case OPT_RETRY: options.retry = true; break;
        case OPT_NO_PREVIEW: options.no_preview = true; break;
        case OPT_PRINT: options.print = true; break;
        case OPT_OPENJD: options.openjd = true; break;
        case OPT_ROW: good = args_int(&reader, option, value, 1, PLAN_ROWS_MAX, &options.row); break;
        case OPT_REPORT: options.report = true; break;
        case OPT_SLURM: options.submit = true; break;
        case OPT_MAX_RUNNING: good = args_int(&reader, option, value, 1, PLAN_ROWS_MAX, &options.max_running); break;
        case OPT_SLURM_OPTION:
            set_add(&options.slurm, value);
            good = !value[strcspn(value, "\r\n")]; // it becomes a line of a script
            if (!good) args_complain(&reader, "--slurm-option: expected one line, got '%s'", shown(value).text);
            break;
        case OPT_RENDER_FRAMES: good = args_int(&reader, option, value, 1, 1000000, &options.frames); break;
        case OPT_QUIET: options.quiet = true; break;
        case ARG_OPERAND: options.plan = value; break;
        case ARG_HELP: done = true; break;
        default: good = false;
        }
        if (!good) code = EXIT_INPUT;
    }

    if (!code && !done && options.print + options.openjd + options.report + options.submit + (options.row > 0) > 1) {
        args_complain(&reader, "--print, --openjd, --report, --row and --slurm exclude each other");
        code = EXIT_INPUT;
    }

    if (!code && !options.jobs)
        options.jobs = job_threads() / options.threads > 1 ? job_threads() / options.threads : 1;

    if (!code && !done) {
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
