// Reads CSV tables: a header, and lines with as many cells.
#pragma once

#include "cli/cli.h"
#include "cli/console.h"
#include "formats/formats.h"

typedef struct Csv {
    Bytes bytes;
} Csv;

/// Reads the file; the error has been printed unless the result is EXIT_GOOD.
ExitCode csv_read(Csv *csv, const char *path, Console *console);
void csv_free(Csv *csv);

/// The index of a column, -1 if there is none.
int csv_column(const Csv *csv, const char *name);

/// The name of a column, as a range of bytes; false after the last.
bool csv_column_name(const Csv *csv, int column, const char **name, size_t *size);

/// Selects lines whose cell in the column `where` is `is`, and that have a number in the column `with`.
typedef struct CsvLines {
    const char *where, *is; ///< NULL: all
    const char *with;       ///< NULL: all
} CsvLines;

/// The numbers of a column in those lines, from malloc; other cells are skipped. NULL with *count 0 if there is none,
/// or no such column.
double *csv_numbers(const Csv *csv, int column, CsvLines lines, uint32_t *count);

typedef struct StatsRow {
    double frame, time, triangles, inverted_cells; ///< columns of docs/formats.md
} StatsRow;

typedef struct StatsTable {
    StatsRow *rows; ///< NULL where there is no file
    int count;
} StatsTable;

/// Reads the file. If it is missing, a warning is printed; any other table is bad input.
ExitCode stats_table_read(StatsTable *table, const char *path, Console *console);
void stats_table_free(StatsTable *table);

/// The line of a frame, or NULL.
const StatsRow *stats_table_row(const StatsTable *table, int frame);
