// stats.csv read back.
#ifndef CLI_STATS_TABLE_H
#define CLI_STATS_TABLE_H

#include "cli/cli.h"
#include "cli/console.h"

typedef struct StatsRow {
    double frame, time, triangles, inverted_cells; ///< as docs/formats.md has them
} StatsRow;

typedef struct StatsTable {
    StatsRow *rows; ///< NULL where there is no file
    int count;
} StatsTable;

/// Reads the file. Where it is missing a warning says so; one that is not such a table is bad input.
ExitCode stats_table_read(StatsTable *table, const char *path, Console *console);
void stats_table_free(StatsTable *table);

/// The line of a frame, or NULL.
const StatsRow *stats_table_row(const StatsTable *table, int frame);

#endif
