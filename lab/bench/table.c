#include "bench/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/machine.h"

BenchTable table_begin(const char *command, const BenchColumn *columns, int column_count, FILE *text) {
    return (BenchTable){.command = command, .columns = columns, .column_count = column_count, .text = text};
}

void table_fact(BenchTable *table, const char *name, double number) {
    if (table->fact_count == BENCH_FACTS_MAX) return;
    table->facts[table->fact_count++] = (BenchFact){name, number};
    if (table->text) fprintf(table->text, "%s %.4g\n", name, number);
}

bool table_add(BenchTable *table, const BenchValue *row) {
    size_t width = (size_t)table->column_count;
    if (table->row_count == table->capacity) {
        int capacity = table->capacity ? 2 * table->capacity : 16;
        BenchValue *values = realloc(table->values, (size_t)capacity * width * sizeof *values);
        if (!values) return false;
        table->values = values;
        table->capacity = capacity;
    }

    memcpy(table->values + (size_t)table->row_count * width, row, width * sizeof *row);
    if (table->text && table->row_count == 0) {
        for (int c = 0; c < table->column_count; c++)
            fprintf(table->text, "%s%*s", c ? "  " : "", table->columns[c].width, table->columns[c].name);
        fputc('\n', table->text);
    }

    if (table->text) {
        for (int c = 0; c < table->column_count; c++) {
            if (c) fputs("  ", table->text);

            char shown[96];
            int length = 0;
            if (row[c].text) length = snprintf(shown, sizeof shown, "%s", row[c].text);
            for (int part = 0; !row[c].text && part < (table->columns[c].parts ? 3 : 1); part++) {
                size_t left = sizeof shown - (size_t)length;
                if (part) length += snprintf(shown + length, left, "/"), left--;
                if (isnan(row[c].number[part])) length += snprintf(shown + length, left, "-");
                else length += snprintf(shown + length, left, table->columns[c].format, row[c].number[part]);
            }

            fprintf(table->text, "%*s", table->columns[c].width, shown);
        }

        fputc('\n', table->text);
        fflush(table->text);
    }

    table->row_count++;
    return true;
}

void table_free(BenchTable *table) {
    free(table->values);
    table->values = NULL;
    table->row_count = table->capacity = 0;
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

static void write_json_text(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') fputc('\\', file);
        if ((unsigned char)*text >= ' ') fputc(*text, file);
    }
    fputc('"', file);
}

void table_write_json(const BenchTable *table, FILE *file) {
    fputs("{\"command\": ", file);
    write_json_text(file, table->command);
    fputs(", \"machine\": ", file);
    write_json_text(file, machine_name());
    fputs(", \"version\": ", file);
    write_json_text(file, singe_version());
    for (int f = 0; f < table->fact_count; f++) {
        fprintf(file, ", \"%s\": ", table->facts[f].name);
        write_number(file, table->facts[f].number, "null");
    }

    fputs(", \"rows\": [", file);
    for (int r = 0; r < table->row_count; r++) {
        fputs(r ? ",\n  {" : "\n  {", file);

        const BenchValue *row = table->values + (size_t)r * (size_t)table->column_count;
        const char *comma = "";
        for (int c = 0; c < table->column_count; c++)
            for (int part = 0; part < (table->columns[c].parts ? 3 : 1); part++) {
                fprintf(file, "%s\"", comma);
                write_key(file, &table->columns[c], part);
                fputs("\": ", file);
                if (row[c].text) write_json_text(file, row[c].text);
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
                const BenchValue *value = r < 0 ? NULL : &table->values[r * table->column_count + c];
                if (c || part) fputc(',', file);
                if (!value) write_key(file, &table->columns[c], part);
                else if (value->text) fputs(value->text, file);
                else write_number(file, value->number[part], "");
            }
        fputc('\n', file);
    }
}
