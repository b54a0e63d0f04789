// A table of results: printed row by row as they arrive, and as JSON or CSV at the end.
#ifndef BENCH_TABLE_H
#define BENCH_TABLE_H

#include <stdbool.h>
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

enum { BENCH_FACTS_MAX = 24 };

typedef struct BenchTable {
    const char *command; ///< the measurement's name
    const BenchColumn *columns;
    int column_count, row_count, capacity;
    BenchValue *values; ///< [row_count * column_count]
    FILE *text;         ///< where rows are printed as they arrive, or NULL
    BenchFact facts[BENCH_FACTS_MAX];
    int fact_count;
} BenchTable;

BenchTable table_begin(const char *command, const BenchColumn *columns, int column_count, FILE *text);

/// Adds a number about the whole table; before the first row.
void table_fact(BenchTable *table, const char *name, double number);

/// Adds a row of `column_count` values. False when out of memory.
bool table_add(BenchTable *table, const BenchValue *row);

void table_write_json(const BenchTable *table, FILE *file);
void table_write_csv(const BenchTable *table, FILE *file);
void table_free(BenchTable *table);

static inline BenchValue bench_number(double number) { return (BenchValue){.number = {number}}; }
static inline BenchValue bench_text(const char *text) { return (BenchValue){.text = text}; }

#endif
