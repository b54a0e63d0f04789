// A run that continues from a frame of an earlier one: `singe run SCENE --from DIR:FRAME`.
//
// The earlier run is found as its record describes it, and its simulation at that frame: from the nearest checkpoint
// before, or from the start, with the scene that it had. Its drawn surface must be that of the frame in the cache. Only
// then does the simulation take over what the new scene has changed. The frames up to there get a second name in the new
// folder, which is a whole cache.
//
// A record keeps its ancestors' scenes in the member "from", so that a branch can be branched again before its first
// frame, and after its ancestors are gone.
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/run.h"
#include "cli/text.h"
#include "common/printable.h"
#include "common/store.h"
#include "scene/values.h"
#include "scene/warnings.h"

// ---- records

enum { ANCESTORS_MAX = 1000 };

char *branch_lineage(const Folder *folder) {
    JobRecord record;
    JsonText from;
    char *text = NULL;
    if (!job_record_open(&record, NULL, folder->path) && text_json_member(record.json, "from", &from) &&
        text_json_count(from, "frame"))
        text = text_format("%.*s", (int)(from.size < INT_MAX ? from.size : 0), from.text);
    job_record_close(&record);
    return text;
}

/// The scene that a run had at a frame: its own, or an ancestor's. *first is the frame from which it holds, 1 or that of
/// a branch. False if the record is damaged.
static bool scene_at(JsonText record, int frame, JsonText *scene, int *first) {
    *scene = record;
    for (int depth = 0; depth < ANCESTORS_MAX; depth++) {
        JsonText from;
        *first = 1;
        if (!text_json_member(*scene, "from", &from)) return true;
        *first = text_json_count(from, "frame");
        if (*first == 0) return false;
        if (frame >= *first) return true;
        *scene = from;
    }

    return false;
}

/// Writes the member "from" of the new record.
static char *lineage_text(const char *folder, int frame, JsonText scene) {
    static const char *const copied[] = {"scene_folder", "scene", "from"};
    char *text, *whole = realpath(folder, NULL);
    FILE *file = text_open(&text);
    fputs("{\"folder\": ", file);
    text_json_string(file, whole ? whole : folder);
    fprintf(file, ", \"frame\": %d", frame);
    for (size_t i = 0; i < sizeof copied / sizeof *copied; i++) {
        JsonText value;
        if (!text_json_member(scene, copied[i], &value)) continue;
        fprintf(file, ", \"%s\": ", copied[i]);
        fwrite(value.text, 1, value.size, file);
    }

    fputc('}', file);
    free(whole);
    text_close(file, &text);
    return text;
}

/// Reads the earlier run's record: names of its files, its scene at the frame, and the new record's lineage.
static ExitCode read_record(Run *run, const char *folder) {
    Branch *branch = &run->branch;
    JobRecord record;
    ExitCode code = job_record_open(&record, run->console, folder);
    char *name = NULL, *base = NULL;
    if (!code) {
        JsonText scene, at;
        name = text_json_words(record.json, "name");
        if (name && value_names_files(name) && scene_at(record.json, branch->frame, &at, &branch->first) &&
            text_json_member(at, "scene", &scene) && (base = text_json_words(at, "scene_folder"))) {
            branch->folder = folder_name(folder, name);
            code = job_parse(&branch->job, run->console, record.path, scene, base, &(SetList){0},
                             run->job.hooks.thread_count);
            run->record.from = lineage_text(folder, branch->frame, at);
        } else code = job_record_refuse(&record, run->console);
    }

    job_record_close(&record);
    free(base);
    free(name);
    return code;
}

// ---- the simulation at the frame

typedef struct Candidate {
    Progress progress;
    char *path;
} Candidate;

typedef struct Candidates {
    const Branch *branch;
    Candidate *items;
    size_t count, capacity;
} Candidates;

/// Takes a checkpoint if the frame can be reached from it with one scene; of none with the path NULL.
static void offer_checkpoint(Candidates *candidates, char *path) {
    const Branch *branch = candidates->branch;
    Progress progress;
    if (checkpoint_peek(path, &progress) && progress.frame >= branch->first &&
        progress.frame + (progress.step > 0) <= branch->frame &&
        store_grow((SingeAllocator){0}, &candidates->items, &candidates->capacity, candidates->count + 1,
                   sizeof *candidates->items))
        candidates->items[candidates->count++] = (Candidate){progress, path};
    else free(path);
}

static void offer_kept(void *context, int frame, uint64_t size, bool shared) {
    Candidates *candidates = context;
    (void)size, (void)shared;
    offer_checkpoint(candidates, folder_kept(&candidates->branch->folder, frame));
}

static int latest_first(const void *a, const void *b) {
    const Progress one = ((const Candidate *)a)->progress, other = ((const Candidate *)b)->progress;
    return one.frame != other.frame ? (one.frame < other.frame) - (one.frame > other.frame)
                                    : (one.step < other.step) - (one.step > other.step);
}

/// Loads the nearest checkpoint that can be used. run->sim remains NULL if there is none.
static ExitCode load_checkpoint(Run *run, Progress *progress) {
    Branch *branch = &run->branch;
    SceneHash hash;
    SingeError error = {0};
    Candidates candidates = {.branch = branch};
    SingeResult result = checkpoint_scene_hash(branch->job.scene, &branch->job.assets, &hash, &error);
    if (!result) result = folder_each(&branch->folder, FOLDER_CHECKPOINTS, offer_kept, &candidates, &error);
    offer_checkpoint(&candidates, text_format("%s", branch->folder.checkpoint));
    offer_checkpoint(&candidates, text_format("%s", branch->folder.previous_checkpoint));
    if (candidates.count) qsort(candidates.items, candidates.count, sizeof *candidates.items, latest_first);

    for (size_t i = 0; i < candidates.count && !result && !run->sim; i++) {
        Checkpoint checkpoint = {0};
        SingeResult refused = checkpoint_read_file(candidates.items[i].path, &run->job.hooks, hash, &branch->job.assets,
                                                   &checkpoint, &error);
        run->sim = checkpoint.sim;
        *progress = checkpoint.progress;
        *run->totals = checkpoint.totals;

        // of another scene, an earlier checkpoint would not help
        if (refused == SINGE_ERROR_STATE)
            snprintf(
                error.message, sizeof error.message,
                "%.200s: a mesh or picture that its scene names has changed since; leave its files as they are, and "
                "give changed ones other names",
                candidates.items[i].path);
        if (refused == SINGE_ERROR_STATE || refused == SINGE_ERROR_MEMORY) result = refused;
        else if (refused) console_warn(run->console, "%s; an earlier checkpoint is used", error.message);
    }

    for (size_t i = 0; i < candidates.count; i++) free(candidates.items[i].path);
    store_free((SingeAllocator){0}, candidates.items, candidates.capacity, sizeof *candidates.items);
    if (!result) return EXIT_GOOD;
    console_result(run->console, &error);
    return job_exit(result);
}

/// Steps with the earlier scene to the end of the frame.
static SingeResult step_to_frame(Run *run, Progress at, SingeError *error) {
    const Job now = run->job;
    SingeResult result = SINGE_OK;

    run->job = run->branch.job;
    run->timers = singe_sim_timers(run->sim);
    if (at.frame == 0) {
        result = run_pass_frame(run, 1, error);
        at.frame = 1;
    }

    run->step = at.step;
    for (int frame = at.frame + 1; frame <= run->branch.frame && !result; frame++) {
        result = run_advance(run, frame, error);
        if (!result) result = run_pass_frame(run, frame, error);
    }

    run->branch.job = run->job;
    run->job = now;
    run->step = 0;
    return result;
}

/// Whether the simulation is that of which the frame in the cache was drawn.
static ExitCode compare_frame(Run *run) {
    Branch *branch = &run->branch;
    SingeError error = {0};
    Frame cached = {0};
    SingeResult result = frame_take_surface(run->sim, &run->frame, &error);
    if (!result) result = frame_read_surface(&branch->folder, branch->frame, &cached, &error);

    const SingeSurface *a = &run->frame.surface, *b = &cached.surface;
    const size_t vertices = a->vertex_count;
    const bool same = !result && a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
                      memcmp(a->position, b->position, vertices * sizeof *a->position) == 0 &&
                      memcmp(a->temperature, b->temperature, vertices * sizeof *a->temperature) == 0 &&
                      memcmp(a->mass, b->mass, vertices * sizeof *a->mass) == 0;

    frame_free(&cached);
    if (same) return EXIT_GOOD;

    if (result) console_result(run->console, &error);
    else
        console_error(run->console,
                      "frame %d simulated again differs from that in %s: it was made by another version of singe, on "
                      "another kind of machine, or from files that have changed",
                      branch->frame, shown_path(branch->folder.path).text);
    return job_exit(result ? result : SINGE_ERROR_STATE);
}

// ---- before anything is written

/// Whether all that the frames up to the branch need is there.
static ExitCode check_branch(Run *run) {
    Branch *branch = &run->branch;
    SceneMessages messages = {0};
    const SceneWhole now = {run->job.scene, &run->job.assets}, before = {branch->job.scene, &branch->job.assets};
    const SingeResult result = scene_may_branch(now, before, &messages);
    if (result) scene_messages_print(&messages, stderr);
    scene_messages_free(&messages);
    if (result) return job_exit(result);

    int first = branch->frame, last = branch->frame;
    ExitCode code = folder_span(&branch->folder, run->console, &first, &last);
    if (!code && branch->frame > now.scene->frames) {
        console_error(run->console, "the branch begins at frame %d, but only %d frames are requested", branch->frame,
                      now.scene->frames);
        code = EXIT_INPUT;
    }

    for (int frame = 1; frame <= branch->frame && !code; frame++) {
        char *ply = folder_ply(&branch->folder, frame), *vdb = folder_vdb(&branch->folder, frame);
        const char *missing = !folder_has(ply) ? ply : now.scene->sim.gas.enabled && !folder_has(vdb) ? vdb : NULL;
        if (missing) {
            console_error(run->console, "%s is missing or empty: a branch needs all frames up to it", missing);
            code = EXIT_INPUT;
        }
        free(ply);
        free(vdb);
    }

    return code;
}

/// Reads the record of the run and the frame that `--from` names, DIR:FRAME.
static ExitCode open_branch(Run *run, const char *from) {
    struct stat here, there;
    const char *colon = strrchr(from, ':');
    char *end = NULL;

    errno = 0;
    const long frame = colon && colon[1] >= '0' && colon[1] <= '9' ? strtol(colon + 1, &end, 10) : 0;
    if (frame < 1 || frame > 1000000 || *end || errno || colon == from) {
        console_error(run->console, "--from: expected DIR:FRAME, such as out/letter:80, not '%s'", shown(from).text);
        return EXIT_INPUT;
    }
    run->branch.frame = (int)frame;

    char *folder = text_format("%.*s", (int)(colon - from), from);
    ExitCode code = EXIT_GOOD;
    if (stat(folder, &here) == 0 && stat(run->folder.path, &there) == 0 && here.st_dev == there.st_dev &&
        here.st_ino == there.st_ino) {
        console_error(run->console, "--from: %s is also the folder of this run; -o names another one",
                      shown_path(folder).text);
        code = EXIT_INPUT;
    }

    if (!code) code = read_record(run, folder);
    free(folder);
    return code;
}

ExitCode branch_prepare(Run *run, const char *from) {
    Branch *branch = &run->branch;
    ExitCode code = open_branch(run, from);
    if (!code) code = check_branch(run);

    // the simulation, as it was
    Progress at = {0, 0};
    if (!code) code = load_checkpoint(run, &at);
    if (!code && !run->sim && branch->first > 1) {
        console_error(run->console, "%s is a branch itself, and has no usable checkpoint from frame %d to %d",
                      shown_path(branch->folder.path).text, branch->first, branch->frame);
        code = EXIT_INPUT;
    }

    branch->job.hooks = run->job.hooks;
    if (!code && !run->sim) code = job_build(&branch->job, run->console, &run->sim);
    if (code) return code;
    if (branch->frame > (at.frame > 0 ? at.frame : 1))
        console_note(run->console, "simulating frames %d to %d again (the scene's `checkpoints` can save this)",
                     at.frame + 1, branch->frame);

    SingeError error = {0};
    const SingeResult result = step_to_frame(run, at, &error);
    if (result) {
        console_result(run->console, &error);
        return EXIT_FAILED;
    }
    code = compare_frame(run);

    // as it goes on
    SingeResult lines = SINGE_OK;
    if (!code) lines = tables_copy(&branch->folder, NULL, run->job.scene, branch->frame, run->totals, &error);
    if (lines) {
        console_result(run->console, &error);
        code = EXIT_INPUT;
    }

    const SceneWhole now = {run->job.scene, &run->job.assets}, before = {branch->job.scene, &branch->job.assets};
    SceneMessages messages = {0};
    if (!code) code = job_exit(scene_branch(now, before, branch->frame, run->sim, &messages));
    scene_messages_print(&messages, stderr);
    scene_messages_free(&messages);
    if (!code) scene_warn(now.scene, now.assets, &run->job.hooks.log);
    branch->alike = scene_looks_alike(now, before);
    return code;
}

// ---- the folder

/// Links a file of the earlier run that may be missing. Frees both paths.
static SingeResult link_optional(char *from, char *to, SingeError *error) {
    const SingeResult result = folder_has(from) ? folder_link(from, to, error) : SINGE_OK;
    free(from);
    free(to);
    return result;
}

typedef struct KeptLinks {
    const Branch *branch;
    const Folder *to;
    SingeResult result;
    SingeError *error;
} KeptLinks;

static void link_kept(void *context, int frame, uint64_t size, bool shared) {
    KeptLinks *links = context;
    (void)size, (void)shared;
    if (links->result || frame >= links->branch->frame) return;
    links->result =
        link_optional(folder_kept(&links->branch->folder, frame), folder_kept(links->to, frame), links->error);
}

SingeResult branch_fill(Run *run, SingeError *error) {
    const Branch *branch = &run->branch;
    const Folder *from = &branch->folder, *to = &run->folder;
    const FolderParts parts = run_parts(run);
    const bool detail = parts.gas_detail && run->job.scene->gas_detail == branch->job.scene->gas_detail;
    SingeResult result = SINGE_OK;

    for (int i = 1; i <= branch->frame && !result; i++) {
        result = link_optional(folder_ply(from, i), folder_ply(to, i), error);
        if (!result && parts.gas) result = link_optional(folder_vdb(from, i), folder_vdb(to, i), error);
        if (!result && detail) result = link_optional(folder_gas_detail(from, i), folder_gas_detail(to, i), error);
        if (!result && parts.pictures && branch->alike)
            result = link_optional(folder_png(from, i), folder_png(to, i), error);
        if (!result && parts.exr && branch->alike)
            result = link_optional(folder_exr(from, i), folder_exr(to, i), error);
    }

    KeptLinks links = {branch, to, SINGE_OK, error};
    if (!result) result = folder_each(from, FOLDER_CHECKPOINTS, link_kept, &links, error);
    if (!result) result = links.result;
    if (!result) result = tables_copy(from, to, run->job.scene, branch->frame, run->totals, error);
    if (!result) result = tables_open(&run->tables, to, run->job.scene, &run->job.assets, error);
    if (!result) result = tables_cut(&run->tables, branch->frame, run->totals, error);
    if (result) return result;

    run->halts = run->totals->contact_halts;
    run->wall_before = run->totals->wall_seconds;
    run->record.resumed_from = run->record.frames_done = branch->frame;
    run->first = branch->frame + 1;
    console_note(run->console, "continuing from frame %d of %s", branch->frame, from->path);

    // the checkpoint at the branch is kept, as no other has its scene and its frame
    TRY(run_write_checkpoint(run, (Progress){branch->frame, 0}, error));
    char *kept = folder_kept(to, branch->frame);
    result = folder_link(to->checkpoint, kept, error);
    free(kept);
    return result;
}

void branch_close(Branch *branch) {
    job_close(&branch->job);
    folder_free(&branch->folder);
    *branch = (Branch){0};
}

// ---- checkpoints that are kept

typedef struct KeptSizes {
    int every, branch; ///< those of other frames go
    double bytes;
    const Folder *folder; ///< NULL: only counts
} KeptSizes;

static bool kept_stays(const KeptSizes *sizes, int frame) {
    return frame % sizes->every == 0 || frame == sizes->branch;
}

static void visit_kept(void *context, int frame, uint64_t size, bool shared) {
    KeptSizes *sizes = context;
    (void)shared;
    if (kept_stays(sizes, frame)) sizes->bytes += (double)size;
    if (kept_stays(sizes, frame) || !sizes->folder) return;
    char *path = folder_kept(sizes->folder, frame);
    remove(path);
    free(path);
}

SingeResult run_keep_checkpoint(Run *run, int frame, SingeError *error) {
    char *path = folder_kept(&run->folder, frame);
    SingeResult result = folder_link(run->folder.checkpoint, path, error);
    free(path);
    const double most = 1e6 * (double)run->job.scene->checkpoints.megabytes;
    if (result || most <= 0) return result;

    // every second one is deleted until the rest fit
    const char *from = run->record.from;
    const int branch = from ? text_json_count((JsonText){from, strlen(from)}, "frame") : 0;
    KeptSizes sizes = {run->keep_every, branch, 0, NULL};
    result = folder_each(&run->folder, FOLDER_CHECKPOINTS, visit_kept, &sizes, error);
    while (!result && sizes.bytes > most && sizes.every < 1 << 20) {
        sizes = (KeptSizes){2 * sizes.every, branch, 0, NULL};
        result = folder_each(&run->folder, FOLDER_CHECKPOINTS, visit_kept, &sizes, error);
    }

    run->keep_every = sizes.every;
    sizes.folder = &run->folder;
    return result ? result : folder_each(&run->folder, FOLDER_CHECKPOINTS, visit_kept, &sizes, error);
}
