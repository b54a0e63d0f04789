// singe verify: reads a cache and counts its faults, frame by frame.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/findings.h"
#include "cli/args.h"
#include "cli/cli.h"
#include "cli/console.h"
#include "cli/csv.h"
#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/job.h"
#include "cli/text.h"
#include "common/store.h"

typedef struct Row {
    uint32_t vertices, triangles;
    uint64_t count[FAULT_COUNT], near, folded, from_start;
} Row;

typedef struct Verify {
    Console console;
    Folder folder;
    StatsTable stats;
    const char *path, *csv;
    int frames[2]; ///< asked for; 0: all
    double stretch;
    bool crossed;          ///< at the start
    int first, last, done; ///< frames
    Row *rows;             ///< of every frame
    Findings findings;
} Verify;

static const ArgOption verify_options[] = {
    {ARGS_FRAMES("reads", " [all]"), offsetof(Verify, frames)},
    {"stretch", 0, "X", "counts edges longer than X times their rest length as stretched [2]", .read = args_number,
     offsetof(Verify, stretch), 1, ARG_HIGHEST},
    {"csv", 0, "FILE", "also writes the counts of every frame to FILE", .read = args_text, offsetof(Verify, csv)},
};

const ArgCommand verify_command = {
    "verify",
    "DIR",
    "Reads a cache and counts crossings, inverted cells and other faults.",
    ARGS_OPTIONS(verify_options),
    "docs/cli.md defines the faults. Exit codes: 0 no faults, 1 faults or interrupted, 2 a frame cannot be read.",
    "singe verify out\n"
    "singe verify out --stretch 1.5 --csv faults.csv",
    .operand_field = offsetof(Verify, path)};

static const struct {
    const char *key, *title;
} faults[FAULT_COUNT] = {
    [FAULT_CROSSING] = {"crossings", "pairs of triangles that cross"},
    [FAULT_INVERTED] = {"inverted_cells", "inverted cells (stats.csv)"},
    [FAULT_STRETCHED] = {"stretched_edges", "stretched edges"},
    [FAULT_NON_MANIFOLD] = {"non_manifold_edges", "edges of more than two triangles"},
    [FAULT_WINDING] = {"winding", "edges whose triangles are wound against each other"},
    [FAULT_DEGENERATE] = {"degenerate_triangles", "triangles without area"},
    [FAULT_DUPLICATE] = {"duplicate_triangles", "triangles that occur twice"},
    [FAULT_NOT_FINITE] = {"not_finite", "values that are not finite"},
    [FAULT_MISSING] = {"missing", "missing properties"},
    [FAULT_INDEX] = {"index", "triangles with an index out of range"},
    [FAULT_STATS] = {"stats", "contradictions of stats.csv"},
};

// ---- one frame

static void verify_report(void *context, bool fault, const char *message) {
    if (fault) console_error(context, "%s", message);
    else console_warn(context, "%s", message);
}

static SingeResult verify_frame(Verify *verify, int frame, Row *row, SingeError *error) {
    CacheFrame cache;
    Findings *findings = &verify->findings;
    char *path = folder_ply(&verify->folder, frame);

    memset(findings->count, 0, sizeof findings->count);
    findings->near = findings->folded = findings->from_start = 0;
    findings->file = path;
    findings->begins = frame == 1 && verify->crossed;

    SingeResult result = cache_read(path, &cache, error);
    if (!result) {
        check_values(&cache, findings);

        // what the run wrote about the frame besides its surface
        const StatsRow *stats = stats_table_row(&verify->stats, frame);
        if (verify->stats.rows && !stats)
            findings_add(findings, FAULT_STATS, "stats.csv has no line for frame %d", frame);
        if (stats && stats->triangles != cache.triangle_count)
            findings_add(findings, FAULT_STATS, "stats.csv lists %.0f triangles, but the frame has %u",
                         stats->triangles, cache.triangle_count);
        if (stats && !isnan(cache.time) && !(fabs(stats->time - cache.time) <= 1e-6 * fmax(1, fabs(cache.time))))
            findings_add(findings, FAULT_STATS, "stats.csv gives the time %.9g s, but the frame %.9g s", stats->time,
                         cache.time);

        if (stats && stats->inverted_cells != 0) {
            findings_add(findings, FAULT_INVERTED, "%.0f inverted cells, by stats.csv", stats->inverted_cells);
            findings->count[FAULT_INVERTED] += (uint64_t)stats->inverted_cells - 1;
        }

        if (!check_surface(&cache, findings)) {
            result = refuse(error, SINGE_ERROR_MEMORY, "", -1, "out of memory while frame %d was verified", frame);
        }

        *row = (Row){.vertices = cache.vertex_count,
                     .triangles = cache.triangle_count,
                     .near = findings->near,
                     .folded = findings->folded,
                     .from_start = findings->from_start};
        memcpy(row->count, findings->count, sizeof row->count);
    }

    cache_free(&cache);
    free(path);
    return result;
}

// ---- the whole

static uint64_t faults_of(const Row *row) {
    uint64_t sum = 0;
    for (int f = 0; f < FAULT_COUNT; f++) sum += row->count[f];
    return sum;
}

/// Prints the frames with faults and the totals. Returns the number of all faults.
static uint64_t print_table(const Verify *verify) {
    uint64_t total[FAULT_COUNT] = {0}, all = 0, near = 0, folded = 0, from_start = 0, triangles = 0;
    int frames[FAULT_COUNT] = {0}, worst[FAULT_COUNT] = {0}, bad = 0;

    for (int i = 0; i < verify->done; i++) {
        const Row *row = &verify->rows[i];
        for (int f = 0; f < FAULT_COUNT; f++) {
            total[f] += row->count[f];
            frames[f] += row->count[f] > 0;
            if (row->count[f] > verify->rows[worst[f]].count[f]) worst[f] = i;
        }

        bad += faults_of(row) > 0;
        all += faults_of(row);
        triangles += row->triangles;
        near += row->near;
        folded += row->folded;
        from_start += row->from_start;
    }

    // the frames with faults, with a column for each kind that occurs
    if (all) printf("%7s%11s", "frame", "triangles");
    for (int f = 0; f < FAULT_COUNT; f++)
        if (total[f]) printf("  %s", faults[f].key);
    if (all) putchar('\n');

    for (int i = 0; i < verify->done; i++) {
        const Row *row = &verify->rows[i];
        if (faults_of(row) == 0) continue;
        printf("%7d%11" PRIu32, verify->first + i, row->triangles);
        for (int f = 0; f < FAULT_COUNT; f++)
            if (total[f]) printf("  %*" PRIu64, (int)strlen(faults[f].key), row->count[f]);
        putchar('\n');
    }

    if (all) putchar('\n');

    // the kinds of faults
    printf("%-52s%12s%8s%10s%7s\n", "fault", "all frames", "frames", "worst", "frame");

    for (int f = 0; f < FAULT_COUNT; f++) {
        const bool known = verify->stats.rows || (f != FAULT_INVERTED && f != FAULT_STATS);
        printf("%-52s", faults[f].title);
        if (!known) printf("%12s\n", "-");
        else if (!total[f]) printf("%12d\n", 0);
        else
            printf("%12" PRIu64 "%8d%10" PRIu64 "%7d\n", total[f], frames[f], verify->rows[worst[f]].count[f],
                   verify->first + worst[f]);
    }

    printf("%-52s%12" PRIu64 "\n", "(of the crossings: of neighbours at rest)", near);
    printf("%-52s%12" PRIu64 "\n", "(no fault: edges folded onto each other)", folded);
    printf("%-52s%12" PRIu64 "\n", "(no fault: crossings that began in frame 1)", from_start);
    printf("\n%d frames, %" PRIu64 " triangles: ", verify->done, triangles);
    if (all) printf("%" PRIu64 " faults in %d frames\n", all, bad);
    else printf("no faults\n");
    return all;
}

static void print_csv(FILE *file, const void *context) {
    const Verify *verify = context;
    fputs("frame,vertices,triangles", file);
    for (int f = 0; f < FAULT_COUNT; f++) fprintf(file, ",%s", faults[f].key);
    fputs(",near_crossings,folded_edges,initial_crossings\n", file);

    for (int i = 0; i < verify->done; i++) {
        const Row *row = &verify->rows[i];
        fprintf(file, "%d,%" PRIu32 ",%" PRIu32, verify->first + i, row->vertices, row->triangles);
        for (int f = 0; f < FAULT_COUNT; f++) fprintf(file, ",%" PRIu64, row->count[f]);
        fprintf(file, ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 "\n", row->near, row->folded, row->from_start);
    }
}

static ExitCode verify_all(Verify *verify) {
    const int frames = verify->last - verify->first + 1;
    const double begun = console_clock();
    SingeError error = {0};

    verify->rows = calloc((size_t)frames, sizeof *verify->rows);
    bool memory = verify->rows;

    // what crosses from the start is in the first frame, whether or not it is among those asked for
    if (memory && verify->first != 1 && verify->crossed) {
        CacheFrame cache;
        char *path = folder_ply(&verify->folder, 1);
        if (!cache_read(path, &cache, &error)) memory = check_start(&cache, &verify->findings);
        cache_free(&cache);
        free(path);
    }

    if (!memory) {
        console_error(&verify->console, "out of memory for the counts of %d frames", frames);
        return EXIT_FAILED;
    }

    SingeResult result = SINGE_OK;
    while (verify->done < frames && !result && !interrupt_asked()) {
        result = verify_frame(verify, verify->first + verify->done, &verify->rows[verify->done], &error);
        verify->done += !result;
        const double seconds = console_clock() - begun;
        if (seconds > 1)
            console_picture(&verify->console, verify->first + verify->done - 1, verify->last, seconds / verify->done);
    }

    console_clear(&verify->console);
    if (result) {
        console_result(&verify->console, &error);
        return result == SINGE_ERROR_MEMORY ? EXIT_FAILED : EXIT_INPUT;
    }

    ExitCode code = print_table(verify) ? EXIT_FAILED : EXIT_GOOD;
    if (verify->csv && console_write_table(&verify->console, verify->csv, print_csv, verify)) code = EXIT_FAILED;
    if (verify->done == frames) return code;

    console_error(&verify->console, "interrupted: frames %d-%d are not verified", verify->first + verify->done,
                  verify->last);
    return EXIT_FAILED;
}

// ---- the cache

int command_verify(int argc, char **argv) {
    Verify verify = {.console = console_make(false), .stretch = 2};
    ExitCode code;
    if (!args_read(&verify_command, argc, argv, &verify, &code)) return code;

    interrupt_watch();
    verify.findings = (Findings){.report = verify_report, .context = &verify.console, .stretch = verify.stretch};
    verify.first = verify.frames[0];
    verify.last = verify.frames[1];

    // the name of the run's files, from its record; and whether the run has reported that it began with crossings
    JobRecord record;
    code = job_record_open(&record, &verify.console, verify.path);
    if (!code) {
        JsonText totals, crossed;
        char *name = text_json_words(record.json, "name");
        if (name) verify.folder = folder_name(verify.path, name);
        else code = job_record_refuse(&record, &verify.console);
        verify.crossed = text_json_member(record.json, "totals", &totals) &&
                         text_json_member(totals, "crossed_at_start", &crossed) && crossed.size &&
                         *crossed.text >= '1' && *crossed.text <= '9';
        free(name);
    }
    job_record_close(&record);

    if (!code) code = folder_span(&verify.folder, &verify.console, &verify.first, &verify.last);
    if (!code) code = stats_table_read(&verify.stats, verify.folder.stats, &verify.console);
    if (!code) code = verify_all(&verify);

    initial_free(&verify.findings.initial);
    stats_table_free(&verify.stats);
    folder_free(&verify.folder);
    free(verify.rows);

    return code;
}
