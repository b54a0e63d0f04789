// The results of a sweep: report.csv, a line per row; index.html, to sort and compare; sheet.svg, three pictures of
// each row above its parameters.
//
// A row's numbers come from its tables: from stats.csv those of the last frame, from measure.csv the median over the
// frames that have the number.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "analysis/numbers.h"
#include "cli/folder.h"
#include "cli/text.h"
#include "cli/video.h"
#include "formats/formats.h"
#include "scene/builtin.h"
#include "sweep/csv.h"
#include "sweep/sweep.h"

extern const SceneBuiltin sweep_pages[];

enum { NUMBERS_MAX = 160 };

/// A column of a row's tables.
typedef struct Column {
    char name[64];
} Column;

typedef struct Report {
    Sweep *sweep;
    Column columns[NUMBERS_MAX];
    int column_count;
    double *numbers; ///< [row_count * NUMBERS_MAX], NaN if a row has none
    bool *complete;  ///< [row_count]
    double fps;
} Report;

// ---- tables

/// The index of a column, which is added if it is new; -1 if the table is full.
static int find_column(Report *report, const char *table, const char *cell, size_t size) {
    char name[sizeof(Column)];
    snprintf(name, sizeof name, "%s.%.*s", table, (int)size, cell);
    for (int i = 0; i < report->column_count; i++)
        if (strcmp(report->columns[i].name, name) == 0) return i;
    if (report->column_count == NUMBERS_MAX) return -1;
    memcpy(report->columns[report->column_count].name, name, sizeof name);
    return report->column_count++;
}

/// The number of a column: the last line's, or the median of all; NaN if there is none.
static double summarize(const Csv *csv, int column, bool median) {
    uint32_t count;
    double *values = csv_numbers(csv, column, (CsvLines){0}, &count), number = (double)NAN;
    if (count) number = median ? numbers_median(values, (int)count) : values[count - 1];
    free(values);
    return number;
}

static bool read_table(Report *report, uint32_t row, const char *table, bool median) {
    char *folder = sweep_row_folder(report->sweep, row, true), *path = text_format("%s/%s.csv", folder, table);
    Csv csv = {0};
    const bool good = !csv_read(&csv, path, report->sweep->console);
    const char *name;
    size_t size;
    for (int c = 0; csv_column_name(&csv, c, &name, &size); c++) {
        const bool counts =
            !(size == 5 && memcmp(name, "frame", 5) == 0) && !(size == 4 && memcmp(name, "time", 4) == 0);
        const int column = counts ? find_column(report, table, name, size) : -1;
        if (column >= 0) report->numbers[(size_t)row * NUMBERS_MAX + (size_t)column] = summarize(&csv, c, median);
    }
    csv_free(&csv);
    free(path), free(folder);
    return good;
}

static bool read_rows(Report *report) {
    bool good = true;
    for (uint32_t row = 0; row < report->sweep->plan.row_count; row++) {
        for (int c = 0; c < NUMBERS_MAX; c++) report->numbers[(size_t)row * NUMBERS_MAX + (size_t)c] = (double)NAN;
        report->complete[row] = sweep_row_state(report->sweep, row) == ROW_COMPLETE;
        if (!report->complete[row]) continue;
        good = read_table(report, row, "stats", false) && good;
        good = read_table(report, row, "measure", true) && good;
    }
    return good;
}

static double number_of(const Report *report, uint32_t row, int column) {
    return report->numbers[(size_t)row * NUMBERS_MAX + (size_t)column];
}

// ---- the files of a row

/// A path inside the sweep's folder, or NULL if there is no such file.
static char *row_file(const Report *report, uint32_t row, const char *name) {
    char *inside = text_format("rows/%04u/%s", row + 1, name);
    char *path = text_format("%s/%s", report->sweep->folder, inside);
    const bool has = folder_has(path);
    free(path);
    if (has) return inside;
    free(inside);
    return NULL;
}

/// The picture at a third, two thirds or the end of a row.
static char *row_picture(const Report *report, uint32_t row, uint32_t third) {
    const uint32_t frames = report->sweep->frames[row], frame = (frames * third + 2) / 3;
    char *name = text_format("frames/%s.%04u.png", report->sweep->name, frame);
    char *path = row_file(report, row, name);
    free(name);
    return path;
}

/// The video of a row whose pictures were drawn in parts.
static void make_video(const Report *report, uint32_t row) {
    char *path = sweep_row_folder(report->sweep, row, true);
    Folder folder = folder_name(path, report->sweep->name);
    bool all = !folder_has(folder.video);
    for (uint32_t frame = 1; frame <= report->sweep->frames[row] && all; frame++) {
        char *png = folder_png(&folder, (int)frame);
        all = folder_has(png);
        free(png);
    }
    if (all) video_make(report->sweep->console, &folder, report->fps, 1, (int)report->sweep->frames[row]);
    folder_free(&folder);
    free(path);
}

// ---- report.csv

static void write_table(const Report *report, FILE *file) {
    const Plan *plan = &report->sweep->plan;
    fputs("row,state", file);
    for (uint32_t p = 0; p < plan->parameter_count; p++) fputc(',', file), text_csv_cell(file, plan->parameters[p].key);
    for (int c = 0; c < report->column_count; c++) fputc(',', file), text_csv_cell(file, report->columns[c].name);
    for (uint32_t row = 0; row < plan->row_count; row++) {
        fprintf(file, "\n%u,%s", row + 1, report->complete[row] ? "complete" : "missing");
        for (uint32_t p = 0; p < plan->parameter_count; p++)
            fputc(',', file), text_csv_cell(file, plan_value(plan, row, p));
        for (int c = 0; c < report->column_count; c++)
            if (isnan(number_of(report, row, c))) fputc(',', file);
            else fprintf(file, ",%.9g", number_of(report, row, c));
    }
    fputc('\n', file);
}

// ---- index.html

static void write_json_file(FILE *file, const char *key, char *path) {
    fprintf(file, ", \"%s\": ", key);
    if (path) text_json_string(file, path);
    else fputs("null", file);
    free(path);
}

static void write_json_row(const Report *report, uint32_t row, FILE *file) {
    const Plan *plan = &report->sweep->plan;
    fprintf(file, "{\"row\": %u, \"complete\": %s, \"values\": [", row + 1, report->complete[row] ? "true" : "false");
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        if (p) fputs(", ", file);
        text_json_string(file, plan_value(plan, row, p));
    }
    fputs("], \"numbers\": [", file);
    for (int c = 0; c < report->column_count; c++) {
        if (c) fputs(", ", file);
        text_json_number(file, number_of(report, row, c));
    }
    fputc(']', file);
    write_json_file(file, "picture", row_picture(report, row, 2));
    write_json_file(file, "video", row_file(report, row, "preview.mp4"));
    fputc('}', file);
}

static void write_json(const Report *report, FILE *file) {
    const Plan *plan = &report->sweep->plan;
    fputs("{\"name\": ", file);
    text_json_string(file, plan->name);
    fputs(", \"parameters\": [", file);
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        if (p) fputs(", ", file);
        text_json_string(file, plan->parameters[p].key);
    }
    fputs("], \"columns\": [", file);
    for (int c = 0; c < report->column_count; c++) {
        if (c) fputs(", ", file);
        text_json_string(file, report->columns[c].name);
    }
    fputs("],\n\"rows\": [", file);
    for (uint32_t row = 0; row < plan->row_count; row++) {
        fputs(row ? ",\n" : "\n", file);
        write_json_row(report, row, file);
    }
    fputs("]}", file);
}

/// Escapes a text inside a script or a page: no '<' may end an element.
static void write_safe(FILE *file, const char *text) {
    for (; *text; text++)
        if (*text == '<') fputs("\\u003c", file);
        else fputc(*text, file);
}

static void write_page(const Report *report, FILE *file) {
    static const char mark[] = "{{DATA}}";
    const char *page = sweep_pages[0].bytes, *end = page + sweep_pages[0].size, *at = page;
    while (at + sizeof mark <= end && memcmp(at, mark, sizeof mark - 1) != 0) at++;
    char *json = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&json, &size);
    if (memory) write_json(report, memory);
    fwrite(page, 1, (size_t)(at - page), file);
    if (text_stream_end(memory, &json)) write_safe(file, json);
    at += sizeof mark - 1;
    fwrite(at, 1, (size_t)(end - at), file);
    free(json);
}

// ---- sheet.svg

enum { STRIP_PICTURES = 3, TILE_WIDTH = 240, TILE_HEIGHT = 180, TILE_LINE = 17, SHEET_COLUMNS_MAX = 3 };
enum { STRIP_WIDTH = STRIP_PICTURES * TILE_WIDTH + 8 };

static void write_xml(FILE *file, const char *text) {
    for (; *text; text++)
        if (*text == '<') fputs("&lt;", file);
        else if (*text == '&') fputs("&amp;", file);
        else if (*text == '"') fputs("&quot;", file);
        else if ((unsigned char)*text >= ' ') fputc(*text, file);
}

static void write_strip(const Report *report, uint32_t row, uint32_t x, uint32_t y, FILE *file) {
    const Plan *plan = &report->sweep->plan;
    for (uint32_t third = 1; third <= STRIP_PICTURES; third++) {
        char *picture = row_picture(report, row, third);
        if (picture) {
            fprintf(file, "<image x=\"%u\" y=\"%u\" width=\"%d\" height=\"%d\" href=\"", x + (third - 1) * TILE_WIDTH,
                    y, TILE_WIDTH, TILE_HEIGHT);
            write_xml(file, picture);
            fputs("\"/>\n", file);
        }
        free(picture);
    }
    fprintf(file, "<text x=\"%u\" y=\"%u\"><tspan font-weight=\"bold\">%u</tspan>%s</text>\n", x + 8,
            y + TILE_HEIGHT + TILE_LINE, row + 1, report->complete[row] ? "" : " not complete");
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        fprintf(file, "<text x=\"%u\" y=\"%u\">", x + 8, y + TILE_HEIGHT + TILE_LINE * (p + 2));
        write_xml(file, plan_label(plan, p));
        fputs(" = ", file);
        write_xml(file, plan_value(plan, row, p));
        fputs("</text>\n", file);
    }
}

static void write_sheet(const Report *report, FILE *file) {
    const Plan *plan = &report->sweep->plan;
    const uint32_t square = (uint32_t)ceil(sqrt((double)plan->row_count));
    const uint32_t columns = square < SHEET_COLUMNS_MAX ? square : SHEET_COLUMNS_MAX;
    const uint32_t rows = (plan->row_count + columns - 1) / columns;
    const uint32_t height = TILE_HEIGHT + TILE_LINE * (plan->parameter_count + 2);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" font-family=\"sans-serif\" "
            "font-size=\"13\" fill=\"#ddd\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#1b1b1b\"/>\n",
            columns * STRIP_WIDTH, rows * height);
    for (uint32_t row = 0; row < plan->row_count; row++)
        write_strip(report, row, row % columns * STRIP_WIDTH, row / columns * height, file);
    fputs("</svg>\n", file);
}

// ---- all

static bool write_file(const Report *report, const char *name, void (*write)(const Report *report, FILE *file)) {
    char *path = text_format("%s/%s", report->sweep->folder, name), *text = NULL;
    size_t size = 0;
    SingeError error = {.code = SINGE_ERROR_MEMORY, .stage = "report", .element = -1};
    FILE *file = open_memstream(&text, &size);
    if (file) write(report, file);
    const bool good = text_stream_end(file, &text) && !file_write(path, text, size, &error);
    if (!good) console_result(report->sweep->console, &error);
    free(text), free(path);
    return good;
}

/// Frames per second of the first complete row.
static double read_fps(const Sweep *sweep, const bool *complete) {
    Job job;
    SetList none = {0};
    double fps = 24;
    for (uint32_t row = 0; row < sweep->plan.row_count; row++) {
        if (!complete[row]) continue;
        char *folder = sweep_row_folder(sweep, row, true);
        if (!job_reopen(&job, sweep->console, folder, &none, 1)) fps = (double)job.scene->fps, job_close(&job);
        free(folder);
        break;
    }
    return fps;
}

ExitCode sweep_report(Sweep *sweep) {
    const size_t rows = sweep->plan.row_count;
    Report report = {.sweep = sweep,
                     .numbers = malloc(rows * NUMBERS_MAX * sizeof *report.numbers),
                     .complete = calloc(rows, sizeof *report.complete)};
    bool good = report.numbers && report.complete;
    if (!good) console_error(sweep->console, "out of memory");
    if (good) {
        good = read_rows(&report);
        report.fps = read_fps(sweep, report.complete);
        for (uint32_t row = 0; row < rows; row++)
            if (report.complete[row]) make_video(&report, row);
        good = write_file(&report, "report.csv", write_table) && good;
        good = write_file(&report, "sheet.svg", write_sheet) && good;
        good = write_file(&report, "index.html", write_page) && good;
    }
    free(report.numbers), free(report.complete);
    return good ? EXIT_GOOD : EXIT_FAILED;
}
