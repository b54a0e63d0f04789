// The distance of a row from the measurements.
#include "sweep/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/folder.h"
#include "cli/frame_files.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "formats/uv_raster.h"
#include "sweep/csv.h"

// ---- a curve

static ExitCode refuse_curve(Console *console, const char *path, const char *why) {
    console_error(console, "%s: %s", path, why);
    return EXIT_INPUT;
}

static ExitCode read_curve(FitCurve *curve, const char *path, Console *console) {
    Csv csv;
    ExitCode code = csv_read(&csv, path, console);
    if (code) return code;
    const int time = csv_column(&csv, "time"), temperature = csv_column(&csv, "temperature");
    curve->times = csv_numbers(&csv, time, (CsvLines){0}, &curve->count);
    uint32_t count = 0;
    curve->temperatures = csv_numbers(&csv, temperature, (CsvLines){0}, &count);
    double low = INFINITY, high = -INFINITY;
    bool ascending = true;
    for (uint32_t i = 0; i < count; i++) {
        low = fmin(low, curve->temperatures[i]);
        high = fmax(high, curve->temperatures[i]);
        ascending = ascending && (i == 0 || i >= curve->count || curve->times[i] > curve->times[i - 1]);
    }
    csv_free(&csv);
    if (time < 0 || temperature < 0) return refuse_curve(console, path, "needs columns 'time' and 'temperature'");
    if (count != curve->count || count < 2)
        return refuse_curve(console, path, "needs at least two lines, each with a time and a temperature");
    if (!ascending) return refuse_curve(console, path, "times must ascend");
    if (!(high > low)) return refuse_curve(console, path, "all temperatures are the same");
    return EXIT_GOOD;
}

ExitCode fit_target_read(FitTarget *target, const PlanTarget *plan, Console *console) {
    *target = (FitTarget){.plan = plan};
    return plan->curve ? read_curve(&target->curve, plan->curve, console) : EXIT_GOOD;
}

void fit_target_free(FitTarget *target) {
    free(target->curve.times), free(target->curve.temperatures);
    *target = (FitTarget){0};
}

/// Linear between the points of a simulated curve, constant beyond them.
static double curve_at(const double *times, const double *values, uint32_t count, double time) {
    uint32_t i = 1;
    if (time <= times[0]) return values[0];
    while (i < count && times[i] < time) i++;
    if (i == count) return values[count - 1];
    const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
}

static bool curve_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error) {
    char *folder = sweep_row_folder(sweep, row, true), *path = text_format("%s/probes.csv", folder);
    const FitCurve *measured = &target->curve;
    Csv csv = {0};
    uint32_t count = 0, times_count = 0;
    bool good = !csv_read(&csv, path, sweep->console);
    const CsvLines lines = {"probe", target->plan->probe, "temperature"}; // none once the paper is gone
    double *values = csv_numbers(&csv, csv_column(&csv, "temperature"), lines, &count);
    double *times = csv_numbers(&csv, csv_column(&csv, "time"), lines, &times_count);
    if (good && (count == 0 || times_count != count)) {
        console_error(sweep->console, "%s has no temperatures of probe '%s'", path, target->plan->probe);
        good = false;
    }
    double sum = 0, low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; good && i < measured->count; i++) {
        // once the paper is gone the last temperature remains
        const double simulated = curve_at(times, values, count, measured->times[i]);
        sum += pow(simulated - measured->temperatures[i], 2);
        low = fmin(low, measured->temperatures[i]);
        high = fmax(high, measured->temperatures[i]);
    }
    if (good) *error += sum / measured->count / pow(high - low, 2);
    csv_free(&csv);
    free(values), free(times), free(path), free(folder);
    return good;
}

// ---- the front

static bool front_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error) {
    char *folder = sweep_row_folder(sweep, row, true), *path = text_format("%s/stats.csv", folder);
    Csv csv = {0};
    uint32_t count = 0;
    bool good = !csv_read(&csv, path, sweep->console);
    double *speeds = csv_numbers(&csv, csv_column(&csv, "front_speed"), (CsvLines){0}, &count);
    if (good && count == 0) {
        console_error(sweep->console, "%s has no front_speed", path);
        good = false;
    }
    if (good) *error += pow(speeds[count - 1] / target->plan->front_speed - 1, 2);
    csv_free(&csv);
    free(speeds), free(path), free(folder);
    return good;
}

// ---- masks

enum { MASK_SIZE = 256 };

typedef struct MaskDrawing {
    uint8_t *pixels;
    float burn[3]; ///< of the triangle's corners; all 0: the sheet as a whole
} MaskDrawing;

/// A pixel that is less than half burnt counts as paper.
static void draw_fresh(void *context, size_t pixel, const float weight[3]) {
    MaskDrawing *drawing = context;
    const float *burn = drawing->burn;
    if (weight[0] * burn[0] + weight[1] * burn[1] + weight[2] * burn[2] < 0.5f) drawing->pixels[pixel] = 1;
}

/// 1 where a frame's first sheet is paper; everywhere on it if `whole`.
static bool draw_mask(const Folder *folder, int number, bool whole, uint8_t *pixels, Console *console) {
    Frame frame = {0};
    SingeError error = {0};
    MaskDrawing drawing = {.pixels = pixels};
    const bool good = !frame_read_surface(folder, number, &frame, &error);
    memset(pixels, 0, (size_t)MASK_SIZE * MASK_SIZE);
    for (uint32_t t = 0; good && t < frame.surface.triangle_count; t++) {
        const uint32_t *v = frame.surface.triangles[t];
        float uv[3][2];
        if (frame.surface.sheet[v[0]] != 0) continue;
        for (int i = 0; i < 3; i++) {
            memcpy(uv[i], frame.surface.uv[v[i]], sizeof uv[i]);
            drawing.burn[i] = whole ? 0 : frame.surface.burn[v[i]];
        }
        uv_triangle(MASK_SIZE, (const float(*)[2])uv, draw_fresh, &drawing);
    }
    if (!good) console_result(console, &error);
    frame_free(&frame);
    return good;
}

static char *mask_path(const char *pattern, int frame) {
    const char *slash = strrchr(pattern, '/'), *run = strchr(slash ? slash : pattern, '#');
    const int width = (int)strspn(run, "#");
    return text_format("%.*s%0*d%s", (int)(run - pattern), pattern, width, frame, run + width);
}

static bool read_mask(const char *path, Image *image, Console *console) {
    Bytes bytes = {0};
    SingeError error = {0};
    const bool good = !file_read(path, (SingeAllocator){0}, &bytes, &error) &&
                      !image_read(path, bytes.data, bytes.size, (SingeAllocator){0}, image, &error);
    if (!good) console_result(console, &error);
    bytes_free(&bytes);
    return good;
}

/// Share of the sheet's pixels that are burnt in only one of the two.
static double mask_difference(const Image *image, const uint8_t *fresh, const uint8_t *sheet) {
    uint32_t different = 0, all = 0;
    for (int y = 0; y < MASK_SIZE; y++)
        for (int x = 0; x < MASK_SIZE; x++) {
            const size_t pixel = (size_t)y * MASK_SIZE + (size_t)x;
            const size_t column = (size_t)x * (size_t)image->width / MASK_SIZE;
            const size_t line = (size_t)y * (size_t)image->height / MASK_SIZE;
            const uint8_t *rgb = image->rgb + 3 * (line * (size_t)image->width + column);
            const bool burnt = rgb[0] + rgb[1] + rgb[2] >= 3 * 128;
            if (!sheet[pixel]) continue;
            all++;
            different += burnt == (fresh[pixel] != 0);
        }
    return all ? (double)different / all : 1;
}

static bool masks_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error) {
    const size_t pixels = (size_t)MASK_SIZE * MASK_SIZE;
    char *path = sweep_row_folder(sweep, row, true);
    Folder folder = folder_name(path, sweep->name);
    uint8_t *sheet = malloc(pixels), *fresh = malloc(pixels);
    bool good = sheet && fresh && draw_mask(&folder, 1, true, sheet, sweep->console);
    uint32_t count = 0;
    double sum = 0;
    for (uint32_t frame = 1; good && frame <= sweep->frames[row]; frame++) {
        char *mask = mask_path(target->plan->masks, (int)frame);
        Image image = {0};
        if (access(mask, F_OK) == 0) {
            good =
                read_mask(mask, &image, sweep->console) && draw_mask(&folder, (int)frame, false, fresh, sweep->console);
            if (good) sum += mask_difference(&image, fresh, sheet), count++;
        }
        image_free(&image);
        free(mask);
    }
    if (good && !count) {
        console_error(sweep->console, "%s: there is no such file for any frame", target->plan->masks);
        good = false;
    }
    if (good) *error += sum / count;
    free(sheet), free(fresh), free(path);
    folder_free(&folder);
    return good;
}

bool fit_error(const FitTarget *target, const Sweep *sweep, uint32_t row, double *error) {
    *error = 0;
    if (target->plan->front_speed > 0 && !front_error(target, sweep, row, error)) return false;
    if (target->plan->curve && !curve_error(target, sweep, row, error)) return false;
    return !target->plan->masks || masks_error(target, sweep, row, error);
}
