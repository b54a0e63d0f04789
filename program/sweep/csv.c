#include "sweep/csv.h"

#include <stdlib.h>
#include <string.h>

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

static bool cell_is(const Text *text, int column, const char *word) {
    const uint8_t *begin, *end;
    cell_of(*text, column, &begin, &end);
    return text_word_is(begin, end, word);
}

double *csv_numbers(const Csv *csv, int column, CsvLines lines, uint32_t *count) {
    const int chosen = lines.where ? csv_column(csv, lines.where) : 0,
              with = lines.with ? csv_column(csv, lines.with) : 0;
    Text text = csv_text(csv);
    double other;
    *count = 0;
    if (column < 0 || chosen < 0 || with < 0) return NULL;
    double *values = malloc((csv->bytes.size / 2 + 1) * sizeof *values);
    for (text_next_line(&text); values && text.at < text.end; text_next_line(&text)) {
        if (lines.where && !cell_is(&text, chosen, lines.is)) continue;
        if (lines.with && !cell_number(&text, with, &other)) continue;
        *count += cell_number(&text, column, &values[*count]);
    }
    if (*count) return values;
    free(values);
    return NULL;
}
