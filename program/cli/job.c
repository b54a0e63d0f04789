#if defined(__APPLE__)
#define _DARWIN_C_SOURCE
#elif defined(__linux__)
#define _DEFAULT_SOURCE
#endif

#include "cli/job.h"

#include <dirent.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "common/allocator.h"
#include "common/printable.h"
#include "scene/messages.h"

#if defined(__APPLE__)
#include <sys/sysctl.h>
#endif

// ---- the machine

/// A number in a file of Linux' control groups; 0 where there is none, or "max".
static double group_limit(const char *path) {
    FILE *file = fopen(path, "r");
    double bytes = 0;
    if (file && fscanf(file, "%lf", &bytes) != 1) bytes = 0;
    if (file) fclose(file);
    return bytes;
}

static double machine_lesser(double room, double limit) {
    return limit > 0 && (room <= 0 || limit < room) ? limit : room;
}

/// Bytes of memory that this process may use: the machine's, or its limit (ulimit, a container) if that is less; 0 if
/// unknown.
static double machine_memory(void) {
    double room = 0;
#if defined(_SC_PHYS_PAGES)
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    if (pages > 0 && page > 0) room = (double)pages * (double)page;
#elif defined(__APPLE__)
    uint64_t bytes = 0;
    size_t size = sizeof bytes;
    if (sysctlbyname("hw.memsize", &bytes, &size, NULL, 0) == 0) room = (double)bytes;
#endif
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        room = machine_lesser(room, (double)limit.rlim_cur);
    if (getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        room = machine_lesser(room, (double)limit.rlim_cur);
    room = machine_lesser(room, group_limit("/sys/fs/cgroup/memory.max"));
    return machine_lesser(room, group_limit("/sys/fs/cgroup/memory/memory.limit_in_bytes"));
}

// ---- jobs

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

/// Prints what is wrong and closes the job, if the result says so.
static ExitCode job_tell(Job *job, Console *console, SingeResult result, SceneMessages *messages) {
    if (result) {
        console_clear(console);
        scene_messages_print(messages, stderr);
        if (messages->count == 0) console_error(console, "%s", singe_result_name(result));
        job_close(job);
    }

    scene_messages_free(messages);
    return job_exit(result);
}

static bool is_overdue(void *context) {
    (void)context;
    return interrupt_overdue();
}

static void set_hooks(Job *job, Console *console, int threads) {
    job->hooks = singe_default_sim();
    job->hooks.allocator = allocator_or_libc((SingeAllocator){0});
    job->hooks.log = console_log(console);
    job->hooks.cancel = (SingeCancel){.asked = is_overdue};
    job->hooks.thread_count = threads;
}

char *job_scene_path(Console *console, const char *path) {
    DIR *folder = opendir(path);
    if (!folder) return text_format("%s", path); // a file, or nothing: job_read says so

    // the folder's own name, also of "." and "letter/"
    char *whole = realpath(path, NULL), *found = NULL, *names = text_format("%s", "");
    const char *slash = whole ? strrchr(whole, '/') : NULL;
    char *own = text_format("%s.yaml", slash ? slash + 1 : path);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        const char *dot = strrchr(entry->d_name, '.');
        if (!dot || dot == entry->d_name || (strcmp(dot, ".yaml") != 0 && strcmp(dot, ".yml") != 0)) continue;

        const bool named = strcmp(entry->d_name, own) == 0;
        if (named || count == 0) {
            free(found);
            found = text_format(path[strlen(path) - 1] == '/' ? "%s%s" : "%s/%s", path, entry->d_name);
        }

        if (named) {
            count = 1;
            break;
        }

        if (count++ < 5) {
            char *longer = text_format("%s%s%s", names, *names ? ", " : "", shown(entry->d_name).text);
            free(names);
            names = longer;
        }
    }

    closedir(folder);
    free(whole);
    free(own);

    if (count != 1) {
        if (count)
            console_error(console, "%s is a folder of several scenes: name one of %s", shown_path(path).text, names);
        else console_error(console, "%s is a folder without a scene (.yaml)", shown_path(path).text);
        free(found);
        found = NULL;
    }
    free(names);
    return found;
}

ExitCode job_read(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads) {
    SceneMessages messages = {0};
    *job = (Job){0};
    set_hooks(job, console, threads);
    SingeResult result = scene_read(scene_path, sets->items, sets->count, &job->scene, &messages);
    return job_tell(job, console, result, &messages);
}

ExitCode job_load(Job *job, Console *console, double pictures) {
    SceneMessages messages = {0};
    SingeResult result = SINGE_OK;

    // twice, as the cells of mesh files are known only when they have been read
    for (int loaded = 0; loaded < 2 && !result; loaded++) {
        const SceneAssets *assets = loaded ? &job->assets : NULL;
        double wanted = scene_size(job->scene, assets).memory + pictures;
        if (!scene_fits(job->scene, assets, wanted, machine_memory(), &messages)) result = SINGE_ERROR_LIMIT;
        else if (!loaded) result = scene_load(job->scene, &job->assets, &messages);
    }

    if (!result) scene_frame(job->scene, &job->assets);
    return job_tell(job, console, result, &messages);
}

ExitCode job_fits(Job *job, Console *console, double pictures) {
    SceneMessages messages = {0};
    const double wanted = scene_size(job->scene, &job->assets).memory + pictures;
    const bool fits = scene_fits(job->scene, &job->assets, wanted, machine_memory(), &messages);
    return job_tell(job, console, fits ? SINGE_OK : SINGE_ERROR_LIMIT, &messages);
}

ExitCode job_open(Job *job, Console *console, const char *scene_path, const SetList *sets, int threads) {
    ExitCode code = job_read(job, console, scene_path, sets, threads);
    return code ? code : job_load(job, console, 0);
}

ExitCode job_parse(Job *job, Console *console, const char *name, JsonText scene, const char *folder,
                   const SetList *sets, int threads) {
    SceneMessages messages = {0};
    *job = (Job){0};
    set_hooks(job, console, threads);
    SingeResult result =
        scene_parse(name, scene.text, scene.size, folder, sets->items, sets->count, &job->scene, &messages);
    const ExitCode code = job_tell(job, console, result, &messages);
    return code ? code : job_load(job, console, 0);
}

ExitCode job_record_open(JobRecord *record, Console *console, const char *folder) {
    SingeError error = {0};
    *record = (JobRecord){.path = text_format("%s/run.json", folder)};
    const SingeResult result = file_read(record->path, (SingeAllocator){0}, &record->bytes, &error);
    if (result && console) console_result(console, &error);
    record->json = (JsonText){(const char *)record->bytes.data, record->bytes.size};
    return job_exit(result);
}

void job_record_close(JobRecord *record) {
    bytes_free(&record->bytes);
    free(record->path);
}

ExitCode job_record_refuse(const JobRecord *record, Console *console) {
    console_error(console, "%s is not the record of a run, or it is damaged", shown_path(record->path).text);
    return EXIT_INPUT;
}

char *job_recorded_path(const char *folder) {
    char *path = NULL;
    JobRecord record;
    if (!job_record_open(&record, NULL, folder)) {
        char *base = text_json_words(record.json, "scene_folder"), *file = text_json_words(record.json, "scene_file");
        const char *slash = file ? strrchr(file, '/') : NULL;
        if (base && file) path = text_format("%s/%s", base, slash ? slash + 1 : file);
        free(base);
        free(file);
    }
    job_record_close(&record);
    return path;
}

ExitCode job_reopen(Job *job, Console *console, const char *folder, const SetList *sets, int threads) {
    JobRecord record;
    ExitCode code = job_record_open(&record, console, folder);
    if (!code) {
        JsonText scene;
        char *base = text_json_words(record.json, "scene_folder");
        if (base && text_json_member(record.json, "scene", &scene))
            code = job_parse(job, console, record.path, scene, base, sets, threads);
        else code = job_record_refuse(&record, console);
        free(base);
    }
    job_record_close(&record);
    return code;
}

void job_note_meshes(const Job *job, Console *console) {
    for (uint32_t i = 0; i < job->assets.sheet_count; i++) {
        char text[200];
        for (int line = 0; mesh_report_line(&job->assets.reports[i], line, text, sizeof text); line++)
            console_note(console, "%s: %s", job->scene->sheets[i].mesh.name, text);
    }
}

void job_note_long(const Job *job, Console *console, const char *doing) {
    const SingeSolverDef *solver = &job->scene->sim.solver;
    const double substeps = solver->substeps > 10 ? solver->substeps : 10; // 0: a few
    const double cells = (double)scene_size(job->scene, &job->assets).cells;
    if (cells * 0.1 * substeps * solver->projections < 200e3) return; // from so many on a stage takes seconds
    fflush(stdout);                                                   // so that earlier output comes first
    console_note(console, "%s", doing);
}

ExitCode job_build(Job *job, Console *console, SingeSim **sim) {
    SceneMessages messages = {0};
    job_note_long(job, console, "building");
    SingeResult result = scene_build(job->scene, &job->assets, &job->hooks, sim, &messages);

    // what a run would find when it writes its first frame
    if (!result && job->scene->gas_detail > 1) {
        const SingeGas coarse = singe_sim_gas(*sim);
        SingeGas fine;
        SingeError error = {0};
        result = gas_detail_shape(&coarse, job->scene->gas_detail, &fine, &error);
        if (result) {
            message_add(&messages, job->scene->text, job->scene->gas_detail_location, "%s", error.message);
            singe_sim_destroy(*sim);
            *sim = NULL;
        }
    }

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
