// Jobs for Slurm: an array of rows, an array of renderings that waits for it, and the report that waits for both.
//
// A row's job may be preempted, requeued and started on another node at any time: SIGTERM comes ten seconds before the
// end, the row writes a checkpoint, and the requeued job resumes from it. Without a warning it resumes from the last
// one.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "common/printable.h"
#include "formats/formats.h"
#include "sweep/sweep.h"

enum { ID_SIZE = 64 };

typedef enum JobKind { JOB_ROWS, JOB_RENDER, JOB_REPORT, JOB_KINDS } JobKind;
static const char *const job_names[JOB_KINDS] = {"run", "render", "report"};

/// A text as a part of an #SBATCH line: in double quotes, within which a backslash takes away the meaning of quotes and
/// backslashes. With `pattern` of a file's name, in which %a stands for the task. A line cannot contain a line break: a
/// blank is written.
static char *sbatch_quote(const char *text, bool pattern) {
    char *quoted = malloc(2 * strlen(text) + 3), *to = quoted;
    if (!quoted) return text_format("%s", "sweep");

    *to++ = '"';
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') *to++ = '\\';
        if (*text == '%' && pattern) *to++ = '%';
        *to++ = *text == '\n' || *text == '\r' ? ' ' : *text;
    }

    memcpy(to, "\"", 2);
    return quoted;
}

/// Writes the script of a job. Returns its path, NULL after an error.
static char *write_job(const Sweep *sweep, JobKind kind, const char *rows, SingeError *error) {
    const SweepOptions *o = sweep->options;
    const char *what = job_names[kind];
    char *path = text_format("%s/slurm/%s.sh", sweep->folder, what), *text = NULL;
    char *program = text_shell_quote(sweep->program), *plan = text_shell_quote(sweep->plan_path);
    char *folder = text_shell_quote(sweep->folder), *line = sweep_row_line(sweep, "\"$SLURM_ARRAY_TASK_ID\"");
    char *name = sbatch_quote(sweep->plan.name, false), *log = sbatch_quote(sweep->folder, true);
    FILE *file = text_open(&text);
    fprintf(file,
            "#!/bin/bash\n#SBATCH --job-name=%s-%s\n#SBATCH --open-mode=append\n"
            "#SBATCH --output=%s/slurm/%s%s.log\n",
            name, what, log, what, kind == JOB_REPORT ? "" : "-%a");
    for (int i = 0; i < o->slurm.count; i++) fprintf(file, "#SBATCH %s\n", o->slurm.items[i]);

    if (kind == JOB_ROWS) {
        fprintf(file, "#SBATCH --array=%s", rows);
        if (o->max_running) fprintf(file, "%%%d", o->max_running);
        fprintf(file,
                "\n#SBATCH --requeue\n#SBATCH --signal=B:TERM@10\n#SBATCH --cpus-per-task=%d\n"
                "# a shell handles a signal when its command ends; during `wait` it does so at once\n"
                "trap 'kill -TERM \"$row\"' TERM\n%s &\nrow=$!\nwait \"$row\"\ncode=$?\n"
                "if [ \"$code\" -gt 128 ]; then wait \"$row\"; code=$?; fi\nexit \"$code\"\n",
                o->threads, line);
    } else if (kind == JOB_RENDER) {
        // an array over parts of rows: task t draws part t mod PARTS of row t / PARTS + 1
        uint32_t frames = 1;
        for (uint32_t row = 0; row < sweep->plan.row_count; row++)
            if (sweep->frames[row] > frames) frames = sweep->frames[row];

        const uint32_t part = (uint32_t)o->frames, parts = (frames + part - 1) / part;
        fprintf(file, "#SBATCH --array=0-%u\n#SBATCH --requeue\n#SBATCH --cpus-per-task=%d\n",
                sweep->plan.row_count * parts - 1, o->threads);
        fprintf(file,
                "row=$(printf %%04d $((SLURM_ARRAY_TASK_ID / %u + 1)))\n"
                "first=$((SLURM_ARRAY_TASK_ID %% %u * %u + 1))\nlast=$((first + %u))\ndir=%s/rows/$row\n"
                "[ -d \"$dir\" ] || { echo \"row $row is not complete\"; exit 1; }\n"
                "frames=$(($(wc -l < \"$dir/stats.csv\") - 1))\n[ \"$last\" -le \"$frames\" ] || last=$frames\n"
                "[ \"$first\" -le \"$frames\" ] || exit 0\n"
                "exec %s render \"$dir\" --frames \"$first-$last\" --threads %d\n",
                parts, parts, part, part - 1, folder, program, o->threads);
    } else {
        fprintf(file, "exec %s sweep %s -o %s --report\n", program, plan, folder);
    }

    text_close(file, &text);
    SingeResult result = file_write(path, text, strlen(text), error);
    char *const texts[] = {text, program, plan, folder, line, name, log, result ? path : NULL};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) free(texts[i]);
    return result ? NULL : path;
}

ExitCode sweep_submit(Sweep *sweep) {
    // in the name of a log Slurm takes a backslash for an order to replace nothing, and then finds no such file: its jobs
    // would fail without a word
    if (strpbrk(sweep->folder, "\\\r\n")) {
        console_error(sweep->console, "--slurm: expected a folder without backslashes and line breaks, got '%s'",
                      shown_path(sweep->folder).text);
        return EXIT_INPUT;
    }

    char *rows = sweep_due_rows(sweep);
    SingeError error = {0};
    char *folder = text_format("%s/slurm", sweep->folder), id[ID_SIZE] = "";
    bool good = !folder_make(folder, &error);
    if (!good) console_result(sweep->console, &error);

    for (int kind = *rows ? JOB_ROWS : JOB_RENDER; kind < JOB_KINDS && good; kind++) {
        char *path = write_job(sweep, (JobKind)kind, rows, &error);
        if (!path) {
            console_result(sweep->console, &error);
            good = false;
            continue;
        }

        // sbatch prints the job's number, "123" or "123;cluster"; each job waits for the one before it
        char *script = text_shell_quote(path);
        char *line = text_format("sbatch --parsable %s%s %s", *id ? "--dependency=afterany:" : "", id, script);
        FILE *answer = popen(line, "r");
        id[0] = 0;
        if (answer && !fgets(id, ID_SIZE, answer)) id[0] = 0;

        const int status = answer ? pclose(answer) : -1;
        id[strcspn(id, ";\n")] = 0;
        good = status == 0 && id[0] && !id[strspn(id, "0123456789")];
        if (good) console_note(sweep->console, "%s: job %s", path, id);
        else console_error(sweep->console, "sbatch refused the job: %s", line);
        free(script);
        free(line);
        free(path);
    }

    free(rows);
    free(folder);
    return good ? EXIT_GOOD : EXIT_FAILED;
}
