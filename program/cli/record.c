#include "cli/run.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/text.h"

Record record_make(const char *scene_path) {
    Record record = {.scene_path = scene_path, .result = "running"};
    time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc)) strftime(record.started, sizeof record.started, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return record;
}

static void member(FILE *file, const char *name, const char *text) {
    fprintf(file, "  \"%s\": ", name);
    text_json_string(file, text);
    fputs(",\n", file);
}

/// Seconds, totals, triangles and counts.
static void write_numbers(FILE *file, const Record *record) {
    static const char *const names[] = {"heat",    "burn", "ablate",  "dynamics",  "gas",
                                        "surface", "ply",  "preview", "checkpoint"};
    const Totals *t = &record->totals;
    fputs("  \"seconds\": {\"wall\": ", file);
    text_json_number(file, t->wall_seconds);

    for (int i = 0; i < SINGE_STAGE_COUNT + TOTAL_OUTPUT_COUNT; i++) {
        fprintf(file, ", \"%s\": ", names[i]);
        text_json_number(file, i < SINGE_STAGE_COUNT ? t->stage_seconds[i] : t->output_seconds[i - SINGE_STAGE_COUNT]);
    }

    fprintf(file,
            "},\n  \"totals\": {\"steps\": %" PRIu64 ", \"heat_iterations\": %" PRIu64
            ", \"strands_projected\": %" PRIu64 ", \"contacts\": %" PRIu64 ", \"ignited\": %" PRIu64
            ", \"holes_opened\": %" PRIu64 ", \"pieces_freed\": %" PRIu64 ", \"crossed_at_start\": %" PRIu64 "},\n",
            t->steps, t->heat_iterations, t->strands_projected, t->contacts, t->ignited, t->holes_opened,
            t->pieces_freed, t->crossed);
    fprintf(file, "  \"drawn\": {\"triangles\": %" PRIu32 ", \"triangles_fine\": %" PRIu32 "},\n", record->triangles,
            record->fine_triangles);

    static const char *const colours[] = {"red", "green", "blue", "yellow"};
    const SingeCounts *c = &record->counts;
    fprintf(file, "  \"counts\": {\"particles\": %" PRIu32 ", \"cells\": %" PRIu32 ", \"springs\": {", c->particles,
            c->cells);
    for (int i = 0; i < SINGE_COLOUR_COUNT; i++)
        fprintf(file, "%s\"%s\": %" PRIu32, i ? ", " : "", colours[i], c->springs[i]);
    fputs("}, \"thickening\": ", file);
    text_json_number(file, (double)record->thickening);
    fprintf(file, ", \"memory\": %zu},\n", c->memory);
}

SingeResult record_write(const Record *record, const char *path, const Job *job, SingeError *error) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file) {
        const Scene *scene = job->scene;
        fputs("{\n  \"program\": \"singe\",\n", file);
        member(file, "version", singe_version());
        member(file, "result", record->result);

        if (record->error.code) {
            fputs("  \"error\": {\"code\": ", file);
            text_json_string(file, singe_result_name(record->error.code));
            fputs(", \"stage\": ", file);
            text_json_string(file, record->error.stage);
            fprintf(file, ", \"element\": %" PRId64 ", \"message\": ", record->error.element);
            text_json_string(file, record->error.message);
            fputs("},\n", file);
        } else {
            fputs("  \"error\": null,\n", file);
        }

        member(file, "started", record->started);

        // the folder is absolute, so that `singe render` finds the scene's files from anywhere
        const char *slash = strrchr(record->scene_path, '/');
        const int length = slash ? (int)(slash - record->scene_path) + (slash == record->scene_path) : 0;
        char *folder = slash ? text_format("%.*s", length, record->scene_path) : text_format(".");
        char *whole = realpath(folder, NULL);

        member(file, "scene_file", record->scene_path);
        member(file, "scene_folder", whole ? whole : folder);
        free(whole);
        free(folder);

        member(file, "name", scene->name);
        fprintf(file, "  \"frames\": %d,\n  \"frames_done\": %d,\n  \"resumed_from\": %d,\n  \"fps\": ", scene->frames,
                record->frames_done, record->resumed_from);
        text_json_number(file, (double)scene->fps);
        fprintf(file, ",\n  \"steps_per_frame\": %d,\n  \"seed\": %" PRIu64 ",\n  \"threads\": %d,\n", scene->steps,
                scene->sim.seed, job->hooks.thread_count);
        fprintf(file, "  \"preview\": %s,\n  \"video\": %s,\n", record->preview ? "true" : "false",
                record->video ? "true" : "false");

        write_numbers(file, record);
        fputs("  \"scene\": ", file);
        scene_dump(scene, SCENE_JSON, 2, file);
        if (record->from) fprintf(file, ",\n  \"from\": %s", record->from);
        fputs("\n}\n", file);
    }

    SingeResult result = SINGE_ERROR_MEMORY;
    if (text_stream_end(file, &text)) result = file_write(path, text, size, error);
    else *error = (SingeError){.code = result, .stage = "run.json", .element = -1};
    free(text);
    return result;
}
