// A table of results: printed row by row as they arrive, and as JSON or CSV at the end.
#pragma once

#include <stdio.h>

#include "singe/singe.h"

/// A cell: a text, or a number, or three of them. The text is not copied: a literal.
typedef struct BenchValue {
    const char *text;
    double number[3];
} BenchValue;

typedef struct BenchColumn {
    const char *name;   ///< the heading, and the key in JSON and CSV
    const char *format; ///< printf's, of one number; NULL for a text
    int width;          ///< characters
    const char *parts;  ///< "max/p99/mean": three numbers, keys name_max and so on; NULL for one
} BenchColumn;

/// A number about the whole table, printed above it: "fma_peak_gflops".
typedef struct BenchFact {
    const char *name;
    double number;
} BenchFact;

enum { BENCH_FACTS_MAX = 24, BENCH_COLUMNS_MAX = 32 };

typedef struct BenchTable {
    const char *command; ///< the measurement's name
    BenchColumn columns[BENCH_COLUMNS_MAX];
    int column_count, row_count;
    int cell_count, capacity;
    BenchValue *cells; ///< [row_count * column_count], and those of the row that is not ended
    FILE *text;        ///< where rows are printed as they arrive, or NULL
    BenchFact facts[BENCH_FACTS_MAX];
    int fact_count;
} BenchTable;

/// Adds a number about the whole table; before the first row.
void table_fact(BenchTable *table, const char *name, double number);

/// Add the cells of a row from left to right. The first row makes the columns; every other one has the same.
void table_number(BenchTable *table, const char *name, const char *format, int width, double number);
void table_text(BenchTable *table, const char *name, int width, const char *text);
void table_parts(BenchTable *table, const char *name, const char *format, int width, const char *parts,
                 BenchValue value);

/// Ends and prints the row. SINGE_ERROR_MEMORY if one of its cells found no room.
SingeResult table_end_row(BenchTable *table);

void table_write_json(const BenchTable *table, FILE *file);
void table_write_csv(const BenchTable *table, FILE *file);
void table_free(BenchTable *table);
