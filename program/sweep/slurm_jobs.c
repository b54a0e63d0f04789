// Jobs for Slurm: an array of rows, an array of renderings that waits for it, and the report that waits for both.
//
// A row's job may be preempted, requeued and started on another node at any time: SIGTERM comes ten seconds before the
// end, the row writes a checkpoint, and the requeued job resumes from it. Without a warning it resumes from the last
// one.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "sweep/sweep.h"

enum { ID_SIZE = 64 };

static void write_head(FILE *file, const Sweep *sweep, const char *what) {
    fprintf(file, "#!/bin/bash\n#SBATCH --job-name=%s-%s\n#SBATCH --open-mode=append\n", sweep->plan.name, what);
    const bool array = strcmp(what, "report") != 0;
    fprintf(file, "#SBATCH --output=%s/slurm/%s%s.log\n", sweep->folder, what, array ? "-%a" : "");
    for (int i = 0; i < sweep->options->slurm.count; i++) fprintf(file, "#SBATCH %s\n", sweep->options->slurm.items[i]);
}

/// "1-4,7": rows that are neither complete nor running, from 1. The result comes from malloc; "" for none.
static char *due_rows(const Sweep *sweep) {
    char *text = text_format("%s", "");
    for (uint32_t row = 0, end; row < sweep->plan.row_count; row = end + 1) {
        for (end = row; end < sweep->plan.row_count; end++) {
            const RowState state = sweep_row_state(sweep, end);
            if (state != ROW_ABSENT && !(state == ROW_FAILED && sweep->options->retry)) break;
        }
        if (end == row) continue;
        char *longer = end == row + 1 ? text_format("%s%s%u", text, *text ? "," : "", row + 1)
                                      : text_format("%s%s%u-%u", text, *text ? "," : "", row + 1, end);
        free(text);
        text = longer;
    }
    return text;
}

static void write_rows_job(FILE *file, const Sweep *sweep, const char *rows) {
    char *line = sweep_row_line(sweep, "\"$SLURM_ARRAY_TASK_ID\"");
    write_head(file, sweep, "run");
    fprintf(file, "#SBATCH --array=%s", rows);
    if (sweep->options->max_running) fprintf(file, "%%%d", sweep->options->max_running);
    fprintf(file,
            "\n#SBATCH --requeue\n#SBATCH --signal=B:TERM@10\n#SBATCH --cpus-per-task=%d\n"
            "# a shell takes a signal when what it waits for ends, or at once in `wait`\n"
            "trap 'kill -TERM \"$row\"' TERM\n%s &\nrow=$!\nwait \"$row\"\ncode=$?\n"
            "if [ \"$code\" -gt 128 ]; then wait \"$row\"; code=$?; fi\nexit \"$code\"\n",
            sweep->options->threads, line);
    free(line);
}

static uint32_t frames_max(const Sweep *sweep) {
    uint32_t max = 1;
    for (uint32_t row = 0; row < sweep->plan.row_count; row++)
        if (sweep->frames[row] > max) max = sweep->frames[row];
    return max;
}

/// An array over parts of rows: task t draws part t mod PARTS of row t / PARTS + 1.
static void write_render_job(FILE *file, const Sweep *sweep) {
    const uint32_t size = (uint32_t)sweep->options->frames, parts = (frames_max(sweep) + size - 1) / size;
    char *program = text_shell_quote(sweep->program), *folder = text_shell_quote(sweep->folder);
    write_head(file, sweep, "render");
    fprintf(file, "#SBATCH --array=0-%u\n#SBATCH --requeue\n#SBATCH --cpus-per-task=%d\n",
            sweep->plan.row_count * parts - 1, sweep->options->threads);
    fprintf(
        file,
        "row=$(printf %%04d $((SLURM_ARRAY_TASK_ID / %u + 1)))\nfirst=$((SLURM_ARRAY_TASK_ID %% %u * %u + 1))\n"
        "last=$((first + %u))\ndir=%s/rows/$row\n[ -d \"$dir\" ] || { echo \"row $row is not complete\"; exit 1; }\n"
        "frames=$(($(wc -l < \"$dir/stats.csv\") - 1))\n[ \"$last\" -le \"$frames\" ] || last=$frames\n"
        "[ \"$first\" -le \"$frames\" ] || exit 0\n"
        "exec %s render \"$dir\" --frames \"$first-$last\" --threads %d\n",
        parts, parts, size, size - 1, folder, program, sweep->options->threads);
    free(program), free(folder);
}

static void write_report_job(FILE *file, const Sweep *sweep) {
    char *program = text_shell_quote(sweep->program), *plan = text_shell_quote(sweep->plan_path);
    char *folder = text_shell_quote(sweep->folder);
    write_head(file, sweep, "report");
    fprintf(file, "exec %s sweep %s -o %s --report\n", program, plan, folder);
    free(program), free(plan), free(folder);
}

typedef enum JobKind { JOB_ROWS, JOB_RENDER, JOB_REPORT, JOB_KINDS } JobKind;
static const char *const job_names[JOB_KINDS] = {"run", "render", "report"};

static char *write_job(const Sweep *sweep, JobKind kind, const char *rows, SingeError *error) {
    char *path = text_format("%s/slurm/%s.sh", sweep->folder, job_names[kind]), *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file && kind == JOB_ROWS) write_rows_job(file, sweep, rows);
    else if (file && kind == JOB_RENDER) write_render_job(file, sweep);
    else if (file) write_report_job(file, sweep);
    SingeResult result = SINGE_ERROR_MEMORY;
    if (text_stream_end(file, &text)) result = file_write(path, text, size, error);
    else *error = (SingeError){.code = result, .stage = "slurm", .element = -1};
    free(text);
    if (!result) return path;
    free(path);
    return NULL;
}

/// Runs sbatch, which prints the job's number.
static bool submit_job(const Sweep *sweep, const char *path, const char *after, char id[ID_SIZE]) {
    char *script = text_shell_quote(path);
    char *line = text_format("sbatch --parsable %s%s %s", *after ? "--dependency=afterany:" : "", after, script);
    FILE *answer = popen(line, "r");
    id[0] = 0;
    if (answer && !fgets(id, ID_SIZE, answer)) id[0] = 0;
    const int status = answer ? pclose(answer) : -1;
    id[strcspn(id, ";\n")] = 0; // "123;cluster"
    const bool good = status == 0 && id[0] && !id[strspn(id, "0123456789")];
    if (!good) console_error(sweep->console, "sbatch did not take the job: %s", line);
    free(script), free(line);
    return good;
}

ExitCode sweep_submit(Sweep *sweep) {
    char *folder = text_format("%s/slurm", sweep->folder), *rows = due_rows(sweep), id[ID_SIZE] = "";
    SingeError error = {0};
    bool good = !folder_make(folder, &error);
    if (!good) console_result(sweep->console, &error);
    for (int kind = *rows ? JOB_ROWS : JOB_RENDER; kind < JOB_KINDS && good; kind++) {
        char after[ID_SIZE];
        memcpy(after, id, sizeof after);
        char *path = write_job(sweep, (JobKind)kind, rows, &error);
        if (path) good = submit_job(sweep, path, after, id);
        else console_result(sweep->console, &error), good = false;
        if (good) console_note(sweep->console, "%s: job %s", path, id);
        free(path);
    }
    free(rows), free(folder);
    return good ? EXIT_GOOD : EXIT_FAILED;
}
