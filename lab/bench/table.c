#include "bench/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/machine.h"
#include "cli/text.h"

void table_fact(BenchTable *table, const char *name, double number) {
    if (table->fact_count == BENCH_FACTS_MAX) return;
    table->facts[table->fact_count++] = (BenchFact){name, number};
    if (table->text) fprintf(table->text, "%s %.4g\n", name, number);
}

static void add_cell(BenchTable *table, BenchColumn column, BenchValue value) {
    if (table->row_count == 0 && table->column_count < BENCH_COLUMNS_MAX)
        table->columns[table->column_count++] = column;

    if (table->cell_count == table->capacity) {
        const int capacity = table->capacity ? 2 * table->capacity : 16 * BENCH_COLUMNS_MAX;
        BenchValue *cells = realloc(table->cells, (size_t)capacity * sizeof *cells);
        if (!cells) return;
        table->cells = cells;
        table->capacity = capacity;
    }

    table->cells[table->cell_count++] = value;
}

void table_number(BenchTable *table, const char *name, const char *format, int width, double number) {
    add_cell(table, (BenchColumn){name, format, width, NULL}, (BenchValue){.number = {number}});
}

void table_text(BenchTable *table, const char *name, int width, const char *text) {
    add_cell(table, (BenchColumn){name, NULL, width, NULL}, (BenchValue){.text = text});
}

void table_parts(BenchTable *table, const char *name, const char *format, int width, const char *parts,
                 BenchValue value) {
    add_cell(table, (BenchColumn){name, format, width, parts}, value);
}

SingeResult table_end_row(BenchTable *table) {
    const int begin = table->row_count * table->column_count;
    if (table->cell_count != begin + table->column_count) return SINGE_ERROR_MEMORY;
    table->row_count++;
    if (!table->text) return SINGE_OK;

    for (int c = 0; c < table->column_count && begin == 0; c++)
        fprintf(table->text, "%s%*s", c ? "  " : "", table->columns[c].width, table->columns[c].name);
    if (begin == 0) fputc('\n', table->text);

    for (int c = 0; c < table->column_count; c++) {
        const BenchColumn *column = &table->columns[c];
        const BenchValue *cell = &table->cells[begin + c];
        if (c) fputs("  ", table->text);

        char shown[96];
        int length = 0;
        if (cell->text) length = snprintf(shown, sizeof shown, "%s", cell->text);

        for (int part = 0; !cell->text && part < (column->parts ? 3 : 1); part++) {
            size_t left = sizeof shown - (size_t)length;
            if (part) length += snprintf(shown + length, left, "/"), left--;
            if (isnan(cell->number[part])) length += snprintf(shown + length, left, "-");
            else length += snprintf(shown + length, left, column->format, cell->number[part]);
        }

        fprintf(table->text, "%*s", column->width, shown);
    }

    fputc('\n', table->text);
    fflush(table->text);
    return SINGE_OK;
}

void table_free(BenchTable *table) {
    free(table->cells);
    table->cells = NULL;
    table->row_count = table->cell_count = table->capacity = 0;
}

static void write_key(FILE *file, const BenchColumn *column, int part) {
    fputs(column->name, file);
    if (!column->parts) return;
    int length;

    // the p-th word of "max/p99/mean"; its length in *length
    const char *parts = column->parts;
    int p = part;
    while (p--) parts = strchr(parts, '/') + 1;

    const char *end = strchr(parts, '/');
    length = (int)(end ? (size_t)(end - parts) : strlen(parts));
    const char *name = parts;

    fprintf(file, "_%.*s", length, name);
}

/// `nothing` replaces a number that is not finite.
static void write_number(FILE *file, double number, const char *nothing) {
    if (isfinite(number)) fprintf(file, "%.7g", number);
    else fputs(nothing, file);
}

void table_write_json(const BenchTable *table, FILE *file) {
    fputs("{\"command\": ", file);
    text_json_string(file, table->command);
    fputs(", \"machine\": ", file);
    text_json_string(file, machine_name());
    fputs(", \"version\": ", file);
    text_json_string(file, singe_version());

    for (int f = 0; f < table->fact_count; f++) {
        fprintf(file, ", \"%s\": ", table->facts[f].name);
        write_number(file, table->facts[f].number, "null");
    }

    fputs(", \"rows\": [", file);
    for (int r = 0; r < table->row_count; r++) {
        fputs(r ? ",\n  {" : "\n  {", file);

        const BenchValue *row = table->cells + (size_t)r * (size_t)table->column_count;
        const char *comma = "";
        for (int c = 0; c < table->column_count; c++)
            for (int part = 0; part < (table->columns[c].parts ? 3 : 1); part++) {
                fprintf(file, "%s\"", comma);
                write_key(file, &table->columns[c], part);
                fputs("\": ", file);
                if (row[c].text) text_json_string(file, row[c].text);
                else write_number(file, row[c].number[part], "null");
                comma = ", ";
            }

        fputc('}', file);
    }

    fputs("\n]}\n", file);
}

void table_write_csv(const BenchTable *table, FILE *file) {
    fprintf(file, "# singe bench %s, version %s, %s\n", table->command, singe_version(), machine_name());
    for (int f = 0; f < table->fact_count; f++)
        fprintf(file, "# %s %.7g\n", table->facts[f].name, table->facts[f].number);

    for (int r = -1; r < table->row_count; r++) {
        for (int c = 0; c < table->column_count; c++)
            for (int part = 0; part < (table->columns[c].parts ? 3 : 1); part++) {
                const BenchValue *value = r < 0 ? NULL : &table->cells[r * table->column_count + c];
                if (c || part) fputc(',', file);
                if (!value) write_key(file, &table->columns[c], part);
                else if (value->text) fputs(value->text, file);
                else write_number(file, value->number[part], "");
            }
        fputc('\n', file);
    }
}
