// singe measure: the appearance of a cache in numbers, frame by frame and as a whole.
//
// Jitter is the part of a vertex's velocity that its trajectory does not show: for vertices that never ignited, in
// three frames dt apart,
//
//   j = v(t) - (x(t + dt) - x(t - dt))/(2 dt)
//
// A cache's v is (x(t) - x(t - dt))/dt, so j is half the change of velocity from one frame to the next. A smooth motion
// of frequency f has pi f dt of its speed in j: 13 % at a hertz and 24 frames a second.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/numbers.h"
#include "analysis/rim.h"
#include "analysis/wrinkles.h"
#include "cli/args.h"
#include "cli/cli.h"
#include "cli/console.h"
#include "cli/folder.h"
#include "cli/job.h"
#include "cli/pictures.h"
#include "common/float3.h"
#include "common/store.h"

enum { DRAWN_FRAMES = 4, RUN = 64 };

/// m at rest from all that has ignited, beyond which the sheet is cold.
static const float cold_from = 0.09f;

typedef struct MeasureOptions {
    const char *path, *csv;
    int frames[2]; ///< the first and the last; 0: all
    bool no_preview;
} MeasureOptions;

static const ArgOption measure_options[] = {
    {ARGS_FRAMES("reads", " [all]"), offsetof(MeasureOptions, frames)},
    {"csv", 0, "FILE", "also writes the numbers of every frame to FILE", .read = args_text,
     offsetof(MeasureOptions, csv)},
    {"no-preview", 0, NULL, "draws no frames, so embers and flames are not measured", .read = args_switch,
     offsetof(MeasureOptions, no_preview)},
};

const ArgCommand measure_command = {"measure",
                                    "DIR",
                                    "Measures the look of a cache: creases, wrinkles, jitter, embers, flames.",
                                    ARGS_OPTIONS(measure_options),
                                    "docs/cli.md describes the numbers. Exit codes: 0 success, 1 failed, 2 bad input.",
                                    "singe measure out\n"
                                    "singe measure out --frames 10-40 --csv shape.csv",
                                    .operand_field = offsetof(MeasureOptions, path)};

/// A number of every frame, and how it is summarized.
typedef enum Number {
    BIAS,
    BEND,
    BURNT,
    UNBURNT,
    FOLD,
    CURL,
    CURL_STRONG,
    CURL_MAX,
    JITTER,
    JITTER_COLD,
    STILL,
    EMBER,
    PALE,
    LEMON,
    FOOT,
    FOOT_STRONG,
    ASTRAY,
    NUMBERS
} Number;

static const float STILL_SPEED = 1e-4f; // m/s, as the title says

static const struct {
    const char *key, *title, *format;
    bool more_is_worse;
} numbers[NUMBERS] = {
    [BIAS] = {"crease_axis_over_diagonal", "creases along axes over diagonals", "%.3f", true},
    [BEND] = {"crease_bend_per_m", "bend of creases, 1/m", "%.2f", true},
    [BURNT] = {"burnt_angle_deg", "normal at 3-15 mm where burnt, rms degrees", "%.3f", false},
    [UNBURNT] = {"unburnt_angle_deg", "normal at 3-15 mm where not, rms degrees", "%.3f", true},
    [FOLD] = {"fold_angle_deg", "normal along folds below 3 cells, rms degrees", "%.3f", true},
    [CURL] = {"curl_p50_deg", "curl of the rim over 10 mm, median degrees", "%.1f", false},
    [CURL_STRONG] = {"curl_p90_deg", "curl of the rim over 10 mm, p90", "%.1f", false},
    [CURL_MAX] = {"curl_max_deg", "curl of the rim over 10 mm, max", "%.1f", false},
    [JITTER] = {"jitter_mm_per_s", "jitter of the unburnt, mm/s rms", "%.3f", true},
    [JITTER_COLD] = {"jitter_cold_mm_per_s", "jitter 90 mm and more from the fire, mm/s", "%.3f", true},
    [STILL] = {"still_percent", "vertices slower than 0.1 mm/s, %", "%.1f", false},
    [EMBER] = {"ember_width_mm", "width of the ember line in some frames, mm", "%.2f", true},
    [PALE] = {"flame_pale_percent", "flames nearly white in some frames, %", "%.1f", true},
    [LEMON] = {"flame_lemon_percent", "flames of one clipped yellow in some, %", "%.1f", true},
    [FOOT] = {"flame_foot_p50_mm", "flames' feet from what burns, median mm", "%.1f", true},
    [FOOT_STRONG] = {"flame_foot_p90_mm", "flames' feet from what burns, p90", "%.1f", true},
    [ASTRAY] = {"flame_astray_percent", "flames before paper, on nothing, %", "%.1f", true},
};

/// Vertices of the input mesh that have not burnt, in one frame.
typedef struct Moment {
    double time;
    uint32_t count; ///< room
    float (*position)[3], (*velocity)[3];
    bool *there, *cold;
} Moment;

/// A box around RUN vertices that have ignited.
typedef struct Box {
    float low[3], high[3];
} Box;

typedef struct Measure {
    Console console;
    Folder folder;
    const char *csv;
    int first, last;         ///< frames; first 0: all
    double (*rows)[NUMBERS]; ///< of every frame
    double *times;
    Rim *rims; ///< of every frame
    Wrinkles all;
    Folds all_folds;
    Rim all_rim;
    Moment moments[3]; ///< this frame's at index frame mod 3
    Job job;
    Pictures *embers, *flames; ///< NULL where none are drawn
} Measure;

// ---- one frame

static void moment_free(Moment *moment) {
    free(moment->position);
    free(moment->velocity);
    free(moment->there);
    free(moment->cold);
    *moment = (Moment){0};
}

/// Whether a position at rest is farther than `cold_from` from all that has burnt.
static bool is_cold(const float *rest, uint32_t count, float (*burnt)[3], const Box *boxes) {
    const double square = pow((double)cold_from, 2);
    for (uint32_t first = 0; first < count; first += RUN) {
        const Box *box = &boxes[first / RUN];
        double gap = 0;
        for (int k = 0; k < 3; k++)
            gap += pow(fmax(0, fmax((double)box->low[k] - (double)rest[k], (double)rest[k] - (double)box->high[k])), 2);

        for (uint32_t i = first; i < count && i < first + RUN && gap < square; i++) {
            double distance = 0;
            for (int k = 0; k < 3; k++) distance += pow((double)burnt[i][k] - (double)rest[k], 2);
            if (distance < square) return false;
        }
    }

    return true;
}

/// Keeps the vertices of the input mesh that have not ignited. False when out of memory.
static bool moment_take(const SingeSurface *surface, double time, Moment *moment) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < surface->vertex_count; v++)
        if (surface->source_vertex[v] >= 0 && (uint32_t)surface->source_vertex[v] >= count)
            count = (uint32_t)surface->source_vertex[v] + 1;
    moment_free(moment);

    moment->position = malloc(((size_t)count + 1) * sizeof *moment->position);
    moment->velocity = malloc(((size_t)count + 1) * sizeof *moment->velocity);
    moment->there = calloc((size_t)count + 1, sizeof *moment->there);
    moment->cold = calloc((size_t)count + 1, sizeof *moment->cold);
    moment->count = count;
    moment->time = time;

    float(*burnt)[3] = malloc(((size_t)surface->vertex_count + 1) * sizeof *burnt);
    Box *boxes = malloc(((size_t)surface->vertex_count / RUN + 1) * sizeof *boxes);
    const bool good = moment->position && moment->velocity && moment->there && moment->cold && burnt && boxes;

    // what has ignited, at rest, with a box around each run of it
    uint32_t burnt_count = 0;
    for (uint32_t v = 0; v < surface->vertex_count && good; v++) {
        if (surface->time_ignited[v] < 0) continue;

        Box *box = &boxes[burnt_count / RUN];
        const bool first = burnt_count % RUN == 0;
        for (int k = 0; k < 3; k++) {
            const float x = surface->rest_position[v][k];
            box->low[k] = !first && box->low[k] < x ? box->low[k] : x;
            box->high[k] = !first && box->high[k] > x ? box->high[k] : x;
            burnt[burnt_count][k] = x;
        }

        burnt_count++;
    }

    for (uint32_t v = 0; v < surface->vertex_count && good; v++) {
        if (surface->source_vertex[v] < 0 || surface->time_ignited[v] >= 0) continue;
        const uint32_t i = (uint32_t)surface->source_vertex[v];
        memcpy(moment->position[i], surface->position[v], sizeof moment->position[i]);
        memcpy(moment->velocity[i], surface->velocity[v], sizeof moment->velocity[i]);
        moment->there[i] = true;
        moment->cold[i] = is_cold(surface->rest_position[v], burnt_count, burnt, boxes);
    }

    free(burnt);
    free(boxes);
    return good;
}

/// m/s, root mean square, of all vertices or the cold ones; NaN if none is left.
static double jitter(const Moment *before, const Moment *now, const Moment *after, bool cold) {
    double sum = 0, inverse = 1 / (after->time - before->time);
    uint32_t count = now->count, counted = 0;
    if (count > before->count) count = before->count;
    if (count > after->count) count = after->count;

    for (uint32_t i = 0; i < count; i++) {
        if (!before->there[i] || !now->there[i] || !after->there[i] || (cold && !now->cold[i])) continue;
        for (int k = 0; k < 3; k++) {
            double moved = ((double)after->position[i][k] - (double)before->position[i][k]) * inverse;
            sum += pow((double)now->velocity[i][k] - moved, 2);
        }
        counted++;
    }

    return counted && after->time > before->time ? sqrt(sum / counted) : (double)NAN;
}

static double degrees(double power) { return sqrt(power) * 180 / acos(-1); }

/// The numbers of a frame's wrinkles and rim; `area` is what creases were looked for on.
static void fill_row(const Wrinkles *frame, const Folds *folds, const Rim *rim, double area, double *row) {
    double bend = 0;
    for (int b = 0; b < WRINKLE_BINS; b++) bend += frame->crease[b];

    row[BIAS] = wrinkles_bias(frame);
    row[BEND] = area > 0 ? bend / area : (double)NAN;
    row[BURNT] = degrees(wrinkles_burnt(frame));
    row[UNBURNT] = degrees(wrinkles_unburnt(frame));
    row[FOLD] = folds_angle(folds);
    row[CURL] = rim_percentile(rim->curl, 0.5);
    row[CURL_STRONG] = rim_percentile(rim->curl, 0.9);
    row[CURL_MAX] = isnan(row[CURL]) ? (double)NAN : rim->curl_max;
    row[JITTER] = row[JITTER_COLD] = row[EMBER] = row[PALE] = row[LEMON] = (double)NAN;
    row[FOOT] = row[FOOT_STRONG] = row[ASTRAY] = (double)NAN;
}

static SingeResult out_of_memory(SingeError *error) {
    return refuse(error, SINGE_ERROR_MEMORY, "", -1, "out of memory while a frame was measured");
}

/// The area at rest, on which creases are looked for, m2.
static double rest_area(const SingeSurface *surface) {
    double area = 0;
    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        const uint32_t *t = surface->triangles[f];
        double twice[3];
        area3(surface->rest_position[t[0]], surface->rest_position[t[1]], surface->rest_position[t[2]], twice);
        area += 0.5 * sqrt(dot3(twice, twice));
    }
    return area;
}

static SingeResult measure_frame(Measure *measure, int frame, SingeError *error) {
    const int index = frame - measure->first;
    double *row = measure->rows[index];

    // embers and flames are measured in DRAWN_FRAMES of the frames, evenly spread
    const int count = measure->last - measure->first + 1;
    const bool drawn =
        measure->embers && (count <= DRAWN_FRAMES || (index + 1) * DRAWN_FRAMES / count > index * DRAWN_FRAMES / count);
    Frame read;
    SingeResult result = drawn ? frame_read(&measure->folder, frame, &read, error)
                               : frame_read_surface(&measure->folder, frame, &read, error);
    const SingeSurface *surface = &read.surface;
    measure->times[index] = read.time;

    Wrinkles wrinkles = {0};
    Folds folds = {0};
    Rim *rim = &measure->rims[index];
    if (!result && (!wrinkles_add(surface, &wrinkles) || !folds_add(surface, &folds) || !rim_add(surface, rim) ||
                    !moment_take(surface, read.time, &measure->moments[index % 3])))
        result = out_of_memory(error);

    if (!result) {
        fill_row(&wrinkles, &folds, rim, rest_area(surface), row);

        // of all vertices: what a solver in which what rests sleeps could leave out
        uint32_t still = 0;
        for (uint32_t v = 0; v < surface->vertex_count; v++)
            still += float3_length(float3_load(surface->velocity[v])) < STILL_SPEED;
        row[STILL] = surface->vertex_count ? 100.0 * still / surface->vertex_count : (double)NAN;

        const Moment *m = measure->moments;
        for (int cold = 0; cold < 2 && index >= 2; cold++)
            measure->rows[index - 1][cold ? JITTER_COLD : JITTER] =
                1e3 * jitter(&m[(index + 1) % 3], &m[(index + 2) % 3], &m[index % 3], cold);

        // what all frames have in common
        for (int b = 0; b < WRINKLE_BINS; b++) measure->all.crease[b] += wrinkles.crease[b];
        measure->all.axis += wrinkles.axis;
        measure->all.diagonal += wrinkles.diagonal;
        measure->all.burnt_power += wrinkles.burnt_power;
        measure->all.burnt_area += wrinkles.burnt_area;
        measure->all.unburnt_power += wrinkles.unburnt_power;
        measure->all.unburnt_area += wrinkles.unburnt_area;
        measure->all_folds.power += folds.power;
        measure->all_folds.count += folds.count;
        rim_sum(rim, &measure->all_rim);
    }

    if (!result && drawn) {
        double width;
        const uint8_t *rgb;
        result = pictures_ember_width(measure->embers, surface, read.time, &width, error);
        if (!result) result = frame_draw(&read, measure->flames, &rgb, error);
        FlameFeet feet;
        if (!result) result = pictures_flame_feet(measure->flames, surface, &feet, error);

        if (!result) {
            const FlameShares shares = pictures_flame_shares(measure->flames);
            row[EMBER] = 1e3 * width;
            row[PALE] = 100 * shares.pale;
            row[LEMON] = 100 * shares.lemon;
            row[FOOT] = 1e3 * feet.median;
            row[FOOT_STRONG] = 1e3 * feet.most;
            row[ASTRAY] = 100 * feet.astray;
        }
    }

    frame_free(&read);
    return result;
}

// ---- the whole

/// Median and worst over the frames that have the number, and the frame of the worst; false if none has.
static bool summary(const Measure *measure, Number number, double *median, double *worst, int *worst_frame) {
    const int frames = measure->last - measure->first + 1;
    double *values = malloc((size_t)frames * sizeof *values);
    int count = 0;

    for (int i = 0; values && i < frames; i++) {
        double value = measure->rows[i][number];
        if (isnan(value)) continue;
        if (count == 0 || (numbers[number].more_is_worse ? value > *worst : value < *worst)) {
            *worst = value;
            *worst_frame = measure->first + i;
        }
        values[count++] = value;
    }

    if (count) *median = numbers_median(values, count);
    free(values);
    return count > 0;
}

static void print_number(const char *format, double number) {
    char text[32] = "-";
    if (!isnan(number)) snprintf(text, sizeof text, format, number);
    printf("%10s", text);
}

/// A value of a band of the rim.
typedef enum RimNumber { RIM_AREA, RIM_MASS, RIM_SLOPE, RIM_SLOPE_STRONG, RIM_HEIGHT, RIM_NUMBERS } RimNumber;

static const struct {
    const char *key, *title, *format;
} rim_numbers[RIM_NUMBERS] = {
    [RIM_AREA] = {"area", "area/rest", "%.3f"},           [RIM_MASS] = {"mass", "mass", "%.3f"},
    [RIM_SLOPE] = {"slope_p50_deg", "slope p50", "%.1f"}, [RIM_SLOPE_STRONG] = {"slope_p90_deg", "slope p90", "%.1f"},
    [RIM_HEIGHT] = {"height_mm", "height mm", "%.2f"},
};

/// NaN where the band has no area.
static void fill_band(const RimBand *band, double *values) {
    const double area = band->rest_area > 0 ? band->rest_area : (double)NAN;
    values[RIM_AREA] = band->area / area;
    values[RIM_MASS] = band->mass / area;
    values[RIM_SLOPE] = rim_percentile(band->slope, 0.5);
    values[RIM_SLOPE_STRONG] = rim_percentile(band->slope, 0.9);
    values[RIM_HEIGHT] = 1e3 * band->height / area;
}

static void print_summary(const Measure *measure) {
    double all[NUMBERS]; // over all frames, weighted by area; NaN where that is meaningless
    fill_row(&measure->all, &measure->all_folds, &measure->all_rim, 0, all);
    printf("%-44s%10s%10s%10s%7s\n", "measure", "all", "median", "worst", "frame");

    for (int n = 0; n < NUMBERS; n++) {
        double median = 0, worst = 0;
        int frame = 0;
        printf("%-44s", numbers[n].title);
        print_number(numbers[n].format, all[n]);

        if (!summary(measure, (Number)n, &median, &worst, &frame)) {
            printf("%10s%10s%7s\n", "-", "-", "-");
            continue;
        }

        print_number(numbers[n].format, median);
        print_number(numbers[n].format, worst);
        printf("%7d\n", frame);
    }

    printf("\nrim of the largest piece, by distance from its burnt edge at rest\n%-14s", "mm");
    for (int n = 0; n < RIM_NUMBERS; n++) printf("%10s", rim_numbers[n].title);

    for (int b = 0; b < RIM_BANDS; b++) {
        double values[RIM_NUMBERS];
        fill_band(&measure->all_rim.band[b], values);
        printf("\n%4.0f - %-7.0f", 1e3 * rim_band_limits[b], 1e3 * rim_band_limits[b + 1]);
        for (int n = 0; n < RIM_NUMBERS; n++) print_number(rim_numbers[n].format, values[n]);
    }

    printf("\n\ncreases by direction, degrees from that of growing u: share of all bend\n");
    double total = 0;
    for (int b = 0; b < WRINKLE_BINS; b++) total += measure->all.crease[b];
    for (int b = 0; b < WRINKLE_BINS; b++)
        printf("%s%5.1f %.4f%s", b % 6 ? "   " : "", (b + 0.5) * 180 / WRINKLE_BINS,
               total > 0 ? measure->all.crease[b] / total : 0, b % 6 == 5 ? "\n" : "");
}

static void write_values(FILE *file, const double *values, int count) {
    for (int n = 0; n < count; n++)
        if (isfinite(values[n])) fprintf(file, ",%.6g", values[n]);
        else fputc(',', file);
}

static void print_csv(FILE *file, const void *context) {
    const Measure *measure = context;
    fputs("frame,time", file);
    for (int n = 0; n < NUMBERS; n++) fprintf(file, ",%s", numbers[n].key);
    for (int b = 0; b < RIM_BANDS; b++)
        for (int n = 0; n < RIM_NUMBERS; n++)
            fprintf(file, ",rim_%.0f_%.0f_%s", 1e3 * rim_band_limits[b], 1e3 * rim_band_limits[b + 1],
                    rim_numbers[n].key);

    for (int i = 0; i <= measure->last - measure->first; i++) {
        fprintf(file, "\n%d,%.9g", measure->first + i, measure->times[i]);
        write_values(file, measure->rows[i], NUMBERS);
        for (int b = 0; b < RIM_BANDS; b++) {
            double values[RIM_NUMBERS];
            fill_band(&measure->rims[i].band[b], values);
            write_values(file, values, RIM_NUMBERS);
        }
    }

    fputc('\n', file);
}

static ExitCode measure_all(Measure *measure) {
    const size_t frames = (size_t)(measure->last - measure->first) + 1;
    SingeError error = {0};

    measure->rows = calloc(frames, sizeof *measure->rows);
    measure->times = calloc(frames, sizeof *measure->times);
    measure->rims = calloc(frames, sizeof *measure->rims);
    SingeResult result = measure->rows && measure->times && measure->rims ? SINGE_OK : out_of_memory(&error);
    for (int frame = measure->first; frame <= measure->last && !result; frame++)
        result = measure_frame(measure, frame, &error);

    ExitCode code = EXIT_GOOD;
    if (result) {
        console_result(&measure->console, &error);
        code = result == SINGE_ERROR_MEMORY ? EXIT_FAILED : EXIT_INPUT;
    } else {
        print_summary(measure);
        if (measure->csv) code = console_write_table(&measure->console, measure->csv, print_csv, measure);
    }

    for (int k = 0; k < 3; k++) moment_free(&measure->moments[k]);
    free(measure->rows);
    free(measure->times);
    free(measure->rims);
    return code;
}

int command_measure(int argc, char **argv) {
    MeasureOptions options = {0};
    ExitCode code;
    if (!args_read(&measure_command, argc, argv, &options, &code)) return code;

    Measure measure = {
        .console = console_make(false), .csv = options.csv, .first = options.frames[0], .last = options.frames[1]};
    SetList sets = {0};
    code = job_reopen(&measure.job, &measure.console, options.path, &sets, job_threads());
    if (code) return code;

    measure.folder = folder_name(options.path, measure.job.scene->name);
    code = folder_span(&measure.folder, &measure.console, &measure.first, &measure.last);

    SingeError error = {0};
    if (!code && !options.no_preview &&
        (pictures_open_embers(&measure.job, &measure.embers, &error) ||
         pictures_open_sharp(&measure.job, &measure.flames, &error))) {
        console_result(&measure.console, &error);
        code = EXIT_FAILED;
    }

    if (!code) code = measure_all(&measure);
    pictures_close(measure.embers);
    pictures_close(measure.flames);
    folder_free(&measure.folder);
    job_close(&measure.job);
    return code;
}
