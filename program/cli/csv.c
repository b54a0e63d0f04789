#include "cli/csv.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/job.h"
#include "formats/formats.h"
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

/// Reads the header, which must name each of our columns once, and then all lines.
static bool read_rows(StatsTable *table, Text *text) {
    int column[COLUMNS] = {-1, -1, -1, -1};
    bool once = true;

    for (int i = 0; !text_at_line_end(text); i++) {
        const uint8_t *begin, *end;
        next_cell(text, &begin, &end);
        for (int c = 0; c < COLUMNS; c++) {
            if (!text_word_is(begin, end, stats_names[c])) continue;
            once = once && column[c] < 0;
            column[c] = i;
        }
    }

    text_next_line(text);
    for (int c = 0; c < COLUMNS; c++) once = once && column[c] >= 0;
    if (!once) return false;

    while (text->at < text->end) {
        StatsRow *row = &table->rows[table->count++];
        double *const values[COLUMNS] = {&row->frame, &row->time, &row->triangles, &row->inverted_cells};
        int read = 0;
        for (int i = 0; !text_at_line_end(text); i++) {
            const uint8_t *begin, *end;
            next_cell(text, &begin, &end);
            for (int c = 0; c < COLUMNS; c++)
                if (column[c] == i && number_double(&begin, end, values[c]) == NUMBER_OK && begin == end) read++;
        }

        text_next_line(text);
        if (read != COLUMNS || !(row->inverted_cells >= 0) || !(row->triangles >= 0)) return false;
    }

    return true;
}

ExitCode stats_table_read(StatsTable *table, const char *path, Console *console) {
    Bytes bytes = {0};
    SingeError error = {0};

    if (access(path, F_OK) != 0 && errno == ENOENT) {
        console_warn(console, "%s is missing, so inverted cells cannot be counted", path);
        return EXIT_GOOD;
    }

    const SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, &error);
    if (result) {
        console_result(console, &error);
        return job_exit(result);
    }

    // lines are counted as they are read: the last need not end with a line feed
    Text text = {bytes.data, bytes.data + bytes.size, 1};
    size_t lines = 0;
    for (Text walk = text; walk.at < walk.end; lines++) {
        while (!text_at_line_end(&walk)) walk.at++;
        text_next_line(&walk);
    }

    table->rows = calloc(lines + 1, sizeof *table->rows);
    const bool good = table->rows && read_rows(table, &text);
    if (!table->rows) console_error(console, "%s: out of memory", path);
    else if (!good) console_error(console, "%s:%lld: expected a line of statistics", path, (long long)text.line - 1);
    bytes_free(&bytes);
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
