// The results of a sweep: report.csv, a line per row; index.html, to sort and compare; sheet.svg, three pictures of
// each row above its parameters.
//
// A row's numbers come from its tables: from stats.csv those of the last frame, from measure.csv the median over the
// frames that have the number.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/numbers.h"
#include "cli/csv.h"
#include "cli/folder.h"
#include "cli/tables.h"
#include "cli/text.h"
#include "cli/video.h"
#include "formats/formats.h"
#include "scene/builtin.h"
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
} Report;

// ---- tables

static bool read_table(Report *report, uint32_t row, const char *table, bool median) {
    char *folder = sweep_row_folder(report->sweep, row, true), *path = text_format("%s/%s.csv", folder, table);
    Csv csv = {0};
    const bool good = !csv_read(&csv, path, report->sweep->console);
    const char *cell;
    size_t size;

    for (int c = 0; csv_column_name(&csv, c, &cell, &size); c++) {
        if ((size == 5 && memcmp(cell, "frame", 5) == 0) || (size == 4 && memcmp(cell, "time", 4) == 0)) continue;

        // the report's column of that name, which is added if it is new
        char name[sizeof(Column)];
        snprintf(name, sizeof name, "%s.%.*s", table, (int)size, cell);
        int column = 0;
        while (column < report->column_count && strcmp(report->columns[column].name, name) != 0) column++;
        if (column == NUMBERS_MAX) continue;
        if (column == report->column_count) memcpy(report->columns[report->column_count++].name, name, sizeof name);

        uint32_t count;
        double *values = csv_numbers(&csv, c, (CsvLines){0}, &count);
        if (count)
            report->numbers[(size_t)row * NUMBERS_MAX + (size_t)column] =
                median ? numbers_median(values, (int)count) : values[count - 1];
        free(values);
    }

    csv_free(&csv);
    free(path);
    free(folder);
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

// ---- report.csv

static void put_cell(FILE *file, const char *text) {
    fputc(',', file);
    text_csv_cell(file, text);
}

static void write_table(const Report *report, FILE *file) {
    const Plan *plan = &report->sweep->plan;
    fputs("row,state", file);
    for (uint32_t p = 0; p < plan->parameter_count; p++) put_cell(file, plan->parameters[p].key);
    for (int c = 0; c < report->column_count; c++) put_cell(file, report->columns[c].name);

    for (uint32_t row = 0; row < plan->row_count; row++) {
        fprintf(file, "\n%u,%s", row + 1, report->complete[row] ? "complete" : "missing");
        for (uint32_t p = 0; p < plan->parameter_count; p++) put_cell(file, plan_value(plan, row, p));
        for (int c = 0; c < report->column_count; c++)
            if (isnan(number_of(report, row, c))) fputc(',', file);
            else fprintf(file, ",%.9g", number_of(report, row, c));
    }

    fputc('\n', file);
}

// ---- index.html

/// Writes a member with a string, or null, and frees the string.
static void put_member(FILE *file, const char *key, char *text) {
    fprintf(file, ", \"%s\": ", key);
    if (text) text_json_string(file, text);
    else fputs("null", file);
    free(text);
}

/// The data of the page as JSON.
static char *page_data(const Report *report) {
    const Plan *plan = &report->sweep->plan;
    char *json;
    FILE *file = text_open(&json);
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

    // names of measure.csv end with their units
    fputs("], \"units\": [", file);
    for (int c = 0; c < report->column_count; c++) {
        const char *name = report->columns[c].name;
        if (c) fputs(", ", file);
        text_json_string(file, strncmp(name, "stats.", 6) == 0 ? tables_unit(name + 6) : "");
    }

    fputs("],\n\"rows\": [", file);

    for (uint32_t row = 0; row < plan->row_count; row++) {
        fprintf(file, "%s{\"row\": %u, \"complete\": %s, \"values\": [", row ? ",\n" : "\n", row + 1,
                report->complete[row] ? "true" : "false");
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
        put_member(file, "picture", row_picture(report, row, 2));
        put_member(file, "video", row_file(report, row, "preview.mp4"));
        fputc('}', file);
    }

    fputs("]}", file);
    text_close(file, &json);
    return json;
}

static void write_page(const Report *report, FILE *page) {
    char *json = page_data(report);

    // the page, with the data in it: no '<' may end the script's element
    static const char mark[] = "{{DATA}}";
    const char *begin = sweep_pages[0].bytes, *end = begin + sweep_pages[0].size, *at = begin;
    while (at + sizeof mark <= end && memcmp(at, mark, sizeof mark - 1) != 0) at++;
    fwrite(begin, 1, (size_t)(at - begin), page);

    for (const char *c = json; *c; c++)
        if (*c == '<') fputs("\\u003c", page);
        else fputc(*c, page);
    free(json);
    at += sizeof mark - 1;
    fwrite(at, 1, (size_t)(end - at), page);
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

    for (uint32_t row = 0; row < plan->row_count; row++) {
        const uint32_t x = row % columns * STRIP_WIDTH, y = row / columns * height;
        for (uint32_t third = 1; third <= STRIP_PICTURES; third++) {
            char *picture = row_picture(report, row, third);
            if (picture) {
                fprintf(file, "<image x=\"%u\" y=\"%u\" width=\"%d\" height=\"%d\" href=\"",
                        x + (third - 1) * TILE_WIDTH, y, TILE_WIDTH, TILE_HEIGHT);
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

    fputs("</svg>\n", file);
}

// ---- all

static bool write_file(const Report *report, const char *name, void (*write)(const Report *report, FILE *file)) {
    char *path = text_format("%s/%s", report->sweep->folder, name), *text;
    SingeError error = {0};
    FILE *file = text_open(&text);
    write(report, file);
    text_close(file, &text);

    const bool good = !file_write(path, text, strlen(text), &error);
    if (!good) console_result(report->sweep->console, &error);
    free(text);
    free(path);
    return good;
}

ExitCode sweep_report(Sweep *sweep) {
    const uint32_t rows = sweep->plan.row_count;
    Report report = {.sweep = sweep,
                     .numbers = malloc((size_t)rows * NUMBERS_MAX * sizeof *report.numbers),
                     .complete = calloc(rows, sizeof *report.complete)};
    if (!report.numbers || !report.complete) {
        console_error(sweep->console, "out of memory");
        free(report.numbers);
        free(report.complete);
        return EXIT_FAILED;
    }

    bool good = true;
    double fps = 0; // of the first complete row
    for (uint32_t row = 0; row < rows; row++) {
        for (int c = 0; c < NUMBERS_MAX; c++) report.numbers[(size_t)row * NUMBERS_MAX + (size_t)c] = (double)NAN;
        report.complete[row] = sweep_row_state(sweep, row) == ROW_COMPLETE;
        if (!report.complete[row]) continue;
        good = read_table(&report, row, "stats", false) && good;
        good = read_table(&report, row, "measure", true) && good;

        char *path = sweep_row_folder(sweep, row, true);
        Job job;
        if (!fps) {
            const bool read = !job_reopen(&job, sweep->console, path, &(SetList){0}, 1);
            fps = read ? (double)job.scene->fps : 24;
            if (read) job_close(&job);
        }

        // the video, if the pictures were drawn in parts
        Folder folder = folder_name(path, sweep->name);
        bool all = !folder_has(folder.video);
        for (uint32_t frame = 1; frame <= sweep->frames[row] && all; frame++) {
            char *png = folder_png(&folder, (int)frame);
            all = folder_has(png);
            free(png);
        }

        if (all) video_make(sweep->console, &folder, fps, 1, (int)sweep->frames[row]);
        folder_free(&folder);
        free(path);
    }

    good = write_file(&report, "report.csv", write_table) && good;
    good = write_file(&report, "sheet.svg", write_sheet) && good;
    good = write_file(&report, "index.html", write_page) && good;
    free(report.numbers);
    free(report.complete);
    return good ? EXIT_GOOD : EXIT_FAILED;
}
