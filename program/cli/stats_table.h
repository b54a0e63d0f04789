// stats.csv read back.
#ifndef CLI_STATS_TABLE_H
#define CLI_STATS_TABLE_H

#include "cli/cli.h"
#include "cli/console.h"

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

#endif
