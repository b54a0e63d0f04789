#include "cli/job.h"

#include <stdlib.h>
#include <unistd.h>

#include "cli/text.h"

void set_add(SetList *sets, const char *text) {
    if (sets->count == sets->capacity) {
        sets->capacity = sets->capacity ? 2 * sets->capacity : 8;
        const char **items = realloc(sets->items, (size_t)sets->capacity * sizeof *items);
        if (!items) {
            fputs("singe: error: out of memory\n", stderr);
            exit(EXIT_FAILED);
        }
        sets->items = items;
    }
    sets->items[sets->count++] = text;
}

void set_frames(SetList *sets, int count) {
    free(sets->owned);
    sets->owned = text_format("frames=%d", count);
    set_add(sets, sets->owned);
}

void set_free(SetList *sets) {
    free(sets->items);
    free(sets->owned);
    *sets = (SetList){0};
}

int job_threads(void) {
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > JOB_THREADS_MAX ? JOB_THREADS_MAX : (int)count;
}

ExitCode job_exit(SingeResult result) {
    if (!result) return EXIT_GOOD;
    return result == SINGE_ERROR_MEMORY ? EXIT_FAILED : EXIT_INPUT;
}

static void *libc_resize(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context, (void)old_size;
    if (new_size) return realloc(block, new_size);
    free(block);
    return NULL;
}

static ExitCode finish_open(Job *job, Console *console, SingeResult result, SceneMessages *messages, int threads) {
    if (!result) result = scene_load(job->scene, &job->assets, messages);
    if (result) {
        console_clear(console);
        scene_messages_print(messages, stderr);
        if (messages->count == 0) console_error(console, "%s", singe_result_name(result));
        scene_free(job->scene);
        *job = (Job){0};
    } else {
        scene_frame(job->scene, &job->assets);
        job->hooks = singe_default_sim();
        job->hooks.allocator = (SingeAllocator){libc_resize, NULL};
        job->hooks.log = console_log(console);
        job->hooks.thread_count = threads;
    }
    scene_messages_free(messages);
    return job_exit(result);
}

ExitCode job_open(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads) {
    SceneMessages messages = {0};
    *job = (Job){0};
    SingeResult result = scene_read(scene_path, sets->items, sets->count, &job->scene, &messages);
    return finish_open(job, console, result, &messages, threads);
}

ExitCode job_parse(Job *job, Console *console, const char *name, const char *text, size_t size, const char *folder,
                   const SetList *sets, int threads) {
    SceneMessages messages = {0};
    *job = (Job){0};
    SingeResult result = scene_parse(name, text, size, folder, sets->items, sets->count, &job->scene, &messages);
    return finish_open(job, console, result, &messages, threads);
}

ExitCode job_reopen(Job *job, Console *console, const char *folder, const SetList *sets, int threads) {
    SingeError error = {0};
    Bytes bytes = {0};
    char *record = text_format("%s/run.json", folder);
    const SingeResult result = file_read(record, (SingeAllocator){0}, &bytes, &error);
    if (result) {
        console_result(console, &error);
        free(record);
        return job_exit(result);
    }
    const char *scene, *scene_folder, *json = (const char *)bytes.data;
    size_t scene_size, folder_size;
    ExitCode code = EXIT_INPUT;
    if (text_json_member(json, bytes.size, "scene", &scene, &scene_size) &&
        text_json_member(json, bytes.size, "scene_folder", &scene_folder, &folder_size)) {
        char *base = text_json_unquote(scene_folder, folder_size);
        if (base) code = job_parse(job, console, record, scene, scene_size, base, sets, threads);
        else console_error(console, "%s: bad \"scene_folder\"", record);
        free(base);
    } else {
        console_error(console, "%s is not a record of a run: no \"scene\" and \"scene_folder\"", record);
    }
    bytes_free(&bytes);
    free(record);
    return code;
}

void job_note_meshes(const Job *job, Console *console) {
    for (uint32_t i = 0; i < job->assets.sheet_count; i++) {
        char text[200];
        for (int line = 0; mesh_report_line(&job->assets.reports[i], line, text, sizeof text); line++)
            console_note(console, "%s: %s", job->scene->sheets[i].mesh.name, text);
    }
}

ExitCode job_build(Job *job, Console *console, SingeSim **sim) {
    SceneMessages messages = {0};
    SingeResult result = scene_build(job->scene, &job->assets, &job->hooks, sim, &messages);
    if (result) {
        console_clear(console);
        scene_messages_print(&messages, stderr);
        if (messages.count == 0) console_error(console, "%s", singe_result_name(result));
    }
    scene_messages_free(&messages);
    return job_exit(result);
}

void job_close(Job *job) {
    scene_assets_free(&job->assets);
    scene_free(job->scene);
    *job = (Job){0};
}
