#include "cli/stats_table.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/job.h"
#include "formats/formats.h"
#include "formats/number.h"
#include "formats/lines.h"

enum { FRAME, TIME, TRIANGLES, INVERTED, COLUMNS };
static const char *const names[COLUMNS] = {"frame", "time", "triangles", "inverted_cells"};

/// Reads the cell at the cursor, which advances to the next cell of the line.
static void next_cell(Text *text, const uint8_t **begin, const uint8_t **end) {
    *begin = text->at;
    while (!text_at_line_end(text) && *text->at != ',') text->at++;
    *end = text->at;
    if (!text_at_line_end(text)) text->at++;
}

static bool read_header(Text *text, int column[COLUMNS]) {
    for (int c = 0; c < COLUMNS; c++) column[c] = -1;
    bool twice = false;
    for (int i = 0; !text_at_line_end(text); i++) {
        const uint8_t *begin, *end;
        next_cell(text, &begin, &end);
        for (int c = 0; c < COLUMNS; c++) {
            if (!text_word_is(begin, end, names[c])) continue;
            twice |= column[c] >= 0;
            column[c] = i;
        }
    }
    text_next_line(text);
    bool all = true;
    for (int c = 0; c < COLUMNS; c++) all &= column[c] >= 0;
    return all && !twice;
}

/// Counts lines as the rows are read: a line need not end with a line feed.
static size_t count_lines(Text text) {
    size_t lines = 0;
    for (; text.at < text.end; lines++) {
        while (!text_at_line_end(&text)) text.at++;
        text_next_line(&text);
    }
    return lines;
}

static bool read_row(Text *text, const int column[COLUMNS], StatsRow *row) {
    double *const values[COLUMNS] = {&row->frame, &row->time, &row->triangles, &row->inverted_cells};
    int found = 0;
    for (int i = 0; !text_at_line_end(text); i++) {
        const uint8_t *begin, *end;
        next_cell(text, &begin, &end);
        for (int c = 0; c < COLUMNS; c++)
            if (column[c] == i && number_double(&begin, end, values[c]) == NUMBER_OK && begin == end) found++;
    }
    text_next_line(text);
    return found == COLUMNS && row->inverted_cells >= 0 && row->triangles >= 0;
}

ExitCode stats_table_read(StatsTable *table, const char *path, Console *console) {
    Bytes bytes = {0};
    SingeError error = {0};
    int column[COLUMNS];
    if (access(path, F_OK) != 0 && errno == ENOENT) {
        console_warn(console, "no %s: inverted cells are not known", path);
        return EXIT_GOOD;
    }
    const SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, &error);
    if (result) {
        console_result(console, &error);
        return job_exit(result);
    }
    Text text = {bytes.data, bytes.data + bytes.size, 1};
    bool good = read_header(&text, column);
    table->rows = calloc(count_lines(text) + 1, sizeof *table->rows);
    while (good && table->rows && text.at < text.end) good = read_row(&text, column, &table->rows[table->count++]);
    if (!table->rows) console_error(console, "%s: out of memory", path);
    else if (!good) console_error(console, "%s:%lld: not a line of statistics", path, (long long)text.line - 1);
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
