#include "cli/csv.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/job.h"
#include "formats/lines.h"
#include "formats/number.h"

ExitCode csv_read(Csv *csv, const char *path, Console *console) {
    SingeError error = {0};
    const SingeResult result = file_read(path, (SingeAllocator){0}, &csv->bytes, &error);
    if (result) console_result(console, &error);
    return job_exit(result);
}

void csv_free(Csv *csv) { bytes_free(&csv->bytes); }

static Text csv_text(const Csv *csv) {
    const uint8_t *at = csv->bytes.data;
    return (Text){at, at ? at + csv->bytes.size : at, 1};
}

/// Reads the cell at the cursor, which advances to the next cell of the line. Quotes are not interpreted: numbers have
/// none.
static void next_cell(Text *text, const uint8_t **begin, const uint8_t **end) {
    *begin = text->at;
    while (!text_at_line_end(text) && *text->at != ',') text->at++;
    *end = text->at;
    if (!text_at_line_end(text)) text->at++;
}

bool csv_column_name(const Csv *csv, int column, const char **name, size_t *size) {
    Text text = csv_text(csv);
    const uint8_t *begin = text.at, *end = text.at;
    for (int i = 0; i <= column; i++) {
        if (text_at_line_end(&text)) return false;
        next_cell(&text, &begin, &end);
    }

    *name = (const char *)begin;
    *size = (size_t)(end - begin);
    return true;
}

int csv_column(const Csv *csv, const char *name) {
    const char *found;
    size_t size;
    for (int i = 0; csv_column_name(csv, i, &found, &size); i++)
        if (size == strlen(name) && memcmp(found, name, size) == 0) return i;
    return -1;
}

/// The cell of the line that begins at `text`.
static void cell_of(Text text, int column, const uint8_t **begin, const uint8_t **end) {
    *begin = *end = text.at;
    for (int i = 0; i <= column; i++) next_cell(&text, begin, end);
}

static bool cell_number(const Text *text, int column, double *number) {
    const uint8_t *begin, *end;
    cell_of(*text, column, &begin, &end);
    return begin < end && number_double(&begin, end, number) == NUMBER_OK && begin == end;
}

double *csv_numbers(const Csv *csv, int column, CsvLines lines, uint32_t *count) {
    const int where = lines.where ? csv_column(csv, lines.where) : 0;
    const int with = lines.with ? csv_column(csv, lines.with) : 0;

    *count = 0;
    if (column < 0 || where < 0 || with < 0) return NULL;

    Text text = csv_text(csv);
    double other, *values = malloc((csv->bytes.size / 2 + 1) * sizeof *values);
    for (text_next_line(&text); values && text.at < text.end; text_next_line(&text)) {
        const uint8_t *begin, *end;
        cell_of(text, where, &begin, &end);
        if (lines.where && !text_word_is(begin, end, lines.is)) continue;
        if (lines.with && !cell_number(&text, with, &other)) continue;
        *count += cell_number(&text, column, &values[*count]);
    }

    if (*count) return values;

    free(values);
    return NULL;
}

// ---- stats.csv

enum { FRAME, TIME, TRIANGLES, INVERTED, COLUMNS };
static const char *const stats_names[COLUMNS] = {"frame", "time", "triangles", "inverted_cells"};

ExitCode stats_table_read(StatsTable *table, const char *path, Console *console) {
    if (access(path, F_OK) != 0 && errno == ENOENT) {
        console_warn(console, "%s is missing, so inverted cells cannot be counted", path);
        return EXIT_GOOD;
    }

    Csv csv;
    ExitCode code = csv_read(&csv, path, console);
    if (code) return code;

    int column[COLUMNS];
    bool good = true;
    for (int c = 0; c < COLUMNS; c++) {
        column[c] = csv_column(&csv, stats_names[c]);
        good = good && column[c] >= 0;
    }

    // a line of four numbers has seven bytes at least, and reading ends with the first that has not
    Text text = csv_text(&csv);
    table->rows = calloc(csv.bytes.size / 7 + 2, sizeof *table->rows);
    if (good) text_next_line(&text);
    while (good && table->rows && text.at < text.end) {
        StatsRow *row = &table->rows[table->count++];
        double *const values[COLUMNS] = {&row->frame, &row->time, &row->triangles, &row->inverted_cells};
        for (int c = 0; c < COLUMNS && good; c++) good = cell_number(&text, column[c], values[c]);
        good = good && row->inverted_cells >= 0 && row->triangles >= 0;
        if (good) text_next_line(&text);
    }

    if (!table->rows) console_error(console, "%s: out of memory", path);
    else if (!good) console_error(console, "%s:%lld: expected a line of statistics", path, (long long)text.line);
    csv_free(&csv);
    if (!table->rows) return EXIT_FAILED;
    return good ? EXIT_GOOD : EXIT_INPUT;
}

void stats_table_free(StatsTable *table) {
    free(table->rows);
    *table = (StatsTable){0};
}

const StatsRow *stats_table_row(const StatsTable *table, int frame) {
    for (int i = 0; i < table->count; i++)
        if (table->rows[i].frame == frame) return &table->rows[i];
    return NULL;
}
