// A sweep on disk: the plan of its rows, and the state of each row.
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/checkpoint.h"
#include "cli/folder.h"
#include "cli/text.h"
#include "common/printable.h"
#include "formats/formats.h"
#include "sweep/sweep.h"

char *sweep_row_folder(const Sweep *sweep, uint32_t row, bool complete) {
    return text_format("%s/%s/%04u", sweep->folder, complete ? "rows" : "unfinished", row + 1);
}

static bool row_has(const Sweep *sweep, uint32_t row, bool complete, const char *name) {
    char *folder = sweep_row_folder(sweep, row, complete);
    char *path = text_format("%s/%s", folder, name);
    const bool has = access(path, F_OK) == 0;
    free(path);
    free(folder);
    return has;
}

RowState sweep_row_state(const Sweep *sweep, uint32_t row) {
    if (row_has(sweep, row, true, "run.json")) return ROW_COMPLETE;

    // has another process locked the row's folder?
    char *folder = sweep_row_folder(sweep, row, false);
    char *path = text_format("%s/cache.lock", folder);
    const int fd = open(path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    struct flock wanted = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    const bool locked = fd >= 0 && fcntl(fd, F_GETLK, &wanted) == 0 && wanted.l_type != F_UNLCK;

    if (fd >= 0) close(fd);
    free(path);
    free(folder);
    if (locked) return ROW_ELSEWHERE;

    return row_has(sweep, row, false, "failed.txt") ? ROW_FAILED : ROW_ABSENT;
}

// ---- scenes

ExitCode sweep_check_row(Sweep *sweep, uint32_t row) {
    const Plan *plan = &sweep->plan;
    char *owned[PLAN_PARAMETERS_MAX];
    SetList sets = {0};

    for (uint32_t i = 0; i < plan->set_count; i++) set_add(&sets, plan->sets[i]);

    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        owned[p] = text_format("%s=%s", plan->parameters[p].key, plan_value(plan, row, p));
        set_add(&sets, owned[p]);
    }

    Job job;

    // A plan may come from a stranger and name any file of the user's: errors
    // are shown with the lines that they quote only if the file is a scene, alone or with the row's values
    bool foreign = true;
    for (int with = 0; with < 2 && foreign; with++) {
        SceneMessages messages = {0};
        Scene *scene;
        const SingeResult result = scene_read(plan->scene.path, sets.items, with ? sets.count : 0, &scene, &messages);
        scene_messages_free(&messages);
        if (!result) scene_free(scene);
        foreign = result == SINGE_ERROR_FORMAT;
    }

    ExitCode code = foreign ? EXIT_INPUT : job_read(&job, sweep->console, plan->scene.path, &sets, 1);
    if (foreign) {
        console_error(sweep->console, "%s, which %s names, is not a valid scene; `singe check` says why",
                      shown_path(plan->scene.path).text, sweep->options->plan);
    } else if (code) {
        console_error(sweep->console, "row %u of %s is not a valid scene", row + 1, sweep->options->plan);
    } else {
        sweep->frames[row] = (uint32_t)job.scene->frames;
        if (!sweep->name) sweep->name = text_format("%s", job.scene->name);
        job_close(&job);
    }

    for (uint32_t p = 0; p < plan->parameter_count; p++) free(owned[p]);
    set_free(&sets);
    return code;
}

ExitCode sweep_check_rows(Sweep *sweep) {
    const uint32_t only = (uint32_t)sweep->options->row;
    ExitCode code = EXIT_GOOD;
    for (uint32_t row = 0; row < sweep->plan.row_count && !code; row++)
        if (!only || row + 1 == only) code = sweep_check_row(sweep, row);
    return code;
}

// ---- the plan

static void put_cell(FILE *file, const char *text) {
    fputc(',', file);
    text_csv_cell(file, text);
}

/// plan.csv: the values of each row; for a fit its ranges and its target, as the values follow from them.
static char *plan_table(const Sweep *sweep) {
    const Plan *plan = &sweep->plan;
    const PlanTarget *target = &plan->target;
    char *text;
    FILE *file = text_open(&text);
    fputs("row", file);
    for (uint32_t p = 0; p < plan->parameter_count; p++) put_cell(file, plan->parameters[p].key);

    for (uint32_t p = 0; p < plan->parameter_count && target->given; p++) {
        const PlanParameter *parameter = &plan->parameters[p];
        fprintf(file, "\nrange,%.9g,%.9g,%s,%d,%d", parameter->from, parameter->to, parameter->unit,
                parameter->logarithmic, parameter->whole);
    }

    if (target->given) {
        fprintf(file, "\ntarget,%d,%.9g", (int)plan->search, target->front_speed);
        put_cell(file, target->curve.path ? target->curve.path : "");
        put_cell(file, target->probe ? target->probe : "");
        put_cell(file, target->masks.path ? target->masks.path : "");
    }

    for (uint32_t row = 0; row < plan->row_count && !target->given; row++) {
        fprintf(file, "\n%u", row + 1);
        for (uint32_t p = 0; p < plan->parameter_count; p++) put_cell(file, plan_value(plan, row, p));
    }

    fputc('\n', file);
    text_close(file, &text);
    return text;
}

/// Compares a text with that of a file; if there is no file yet, writes it.
static ExitCode note_or_compare(Sweep *sweep, const char *name, const char *text, bool table) {
    char *path = text_format("%s/%s", sweep->folder, name);
    Bytes bytes = {0};
    SingeError error = {0};
    SingeResult result;
    ExitCode code = EXIT_GOOD;

    if (access(path, F_OK) != 0) result = file_write(path, text, strlen(text), &error);
    else result = file_read(path, (SingeAllocator){0}, &bytes, &error);

    const char *there = (const char *)bytes.data;
    if (result) {
        console_result(sweep->console, &error);
        code = EXIT_FAILED;
    } else if (there && strcmp(there, text) != 0) {
        int line = 1;
        for (const char *a = there, *b = text; *a && *a == *b; a++, b++) line += *a == '\n';

        if (table)
            console_error(sweep->console, "%s belongs to another plan: line %d differs; use another folder (-o)", path,
                          line);
        else
            console_error(sweep->console,
                          "%s: the scene, its `set` or a file that it names has changed; use another folder (-o)",
                          path);
        code = EXIT_INPUT;
    }

    bytes_free(&bytes);
    free(path);
    return code;
}

ExitCode sweep_note_plan(Sweep *sweep) {
    // the scene without the rows' parameters, with the contents of its files
    SetList sets = {0};
    Job job;
    for (uint32_t i = 0; i < sweep->plan.set_count; i++) set_add(&sets, sweep->plan.sets[i]);

    ExitCode code = job_open(&job, sweep->console, sweep->plan.scene.path, &sets, 1);
    set_free(&sets);
    if (code) return code;

    SceneHash hash = {0};
    SingeError error = {0};
    const int frames = job.scene->frames;
    SingeResult result = checkpoint_scene_hash(job.scene, &job.assets, &hash, &error);
    job_close(&job);

    static const char *const parts[] = {"rows", "unfinished"};

    for (int i = 0; i < 2 && !result; i++) {
        char *path = text_format("%s/%s", sweep->folder, parts[i]);
        result = folder_make(path, &error);
        free(path);
    }

    if (result) {
        console_result(sweep->console, &error);
        code = EXIT_FAILED;
    }

    char *table = plan_table(sweep), *note;
    FILE *file = text_open(&note);
    fprintf(file, "{\"frames\": %d, \"scene\": \"%016llx\", \"preview\": \"%016llx\"", frames,
            (unsigned long long)hash.result, (unsigned long long)hash.looks);
    if (sweep->plan.from.path) {
        fputs(", \"from\": ", file);
        text_json_string(file, sweep->plan.from.path);
    }

    fputs("}\n", file);
    text_close(file, &note);
    if (!code) code = note_or_compare(sweep, "plan.csv", table, true);
    if (!code) code = note_or_compare(sweep, "sweep.json", note, false);
    free(note);
    free(table);
    return code;
}

// ---- commands

enum { COMMAND_MAX = 16 + 2 * PLAN_PARAMETERS_MAX };

char **sweep_run_command(const Sweep *sweep, uint32_t row) {
    const Plan *plan = &sweep->plan;
    char **command = calloc(COMMAND_MAX + 2 * (size_t)plan->set_count, sizeof *command);
    int n = 0;
    if (!command) return NULL;

    command[n++] = text_format("%s", sweep->program);
    command[n++] = text_format("run");
    command[n++] = text_format("--output=%s/unfinished/%04u", sweep->folder, row + 1);
    command[n++] = text_format("--threads=%d", sweep->options->threads);
    command[n++] = text_format("--resume");
    if (plan->from.path) command[n++] = text_format("--from=%s", plan->from.path);
    if (sweep->options->no_preview) command[n++] = text_format("--no-preview");

    for (uint32_t i = 0; i < plan->set_count; i++) command[n++] = text_format("--set=%s", plan->sets[i]);
    for (uint32_t p = 0; p < plan->parameter_count; p++)
        command[n++] = text_format("--set=%s=%s", plan->parameters[p].key, plan_value(plan, row, p));
    command[n++] = text_format("--");
    command[n++] = text_format("%s", plan->scene.path);
    return command;
}

void sweep_free_command(char **command) {
    for (char **argument = command; argument && *argument; argument++) free(*argument);
    free(command);
}

bool sweep_row_is_due(const Sweep *sweep, uint32_t row) {
    const RowState state = sweep_row_state(sweep, row);
    return state == ROW_ABSENT || (state == ROW_FAILED && sweep->options->retry);
}

char *sweep_due_rows(const Sweep *sweep) {
    char *rows = text_format("%s", "");
    for (uint32_t row = 0, end; row < sweep->plan.row_count; row = end + 1) {
        for (end = row; end < sweep->plan.row_count && sweep_row_is_due(sweep, end);) end++;
        if (end == row) continue;
        char *longer = end == row + 1 ? text_format("%s%s%u", rows, *rows ? "," : "", row + 1)
                                      : text_format("%s%s%u-%u", rows, *rows ? "," : "", row + 1, end);
        free(rows);
        rows = longer;
    }

    return rows;
}

char *sweep_row_line(const Sweep *sweep, const char *number) {
    char *program = text_shell_quote(sweep->program), *plan = text_shell_quote(sweep->plan_path);
    char *folder = text_shell_quote(sweep->folder);
    char *line = text_format("%s sweep %s -o %s --row %s --threads %d%s", program, plan, folder, number,
                             sweep->options->threads, sweep->options->no_preview ? " --no-preview" : "");

    free(program);
    free(plan);
    free(folder);
    return line;
}
