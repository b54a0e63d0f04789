// Describes the values that a row takes, in words.
#include "scene/schema.h"

#include <string.h>

/// A bound in the unit of bare numbers, in its shortest form: 1e-06 is written 1e-6.
static void bound_print(const SchemaRow *row, double bound, char *buffer, size_t size) {
    if (row->type == ROW_INT || row->type == ROW_INTS || row->type == ROW_INDICES || row->type == ROW_UINT32) {
        snprintf(buffer, size, "%.0f", bound);
        return;
    }

    quantity_print((float)bound, row->dimension, buffer, size);
    char *power = strchr(buffer, 'e');
    if (power) {
        char *digits = power + 1 + (power[1] == '-'), *rest = power + 2;
        rest += strspn(rest, "0");
        memmove(digits, rest, strlen(rest) + 1);
    }
}

void row_range(const SchemaRow *row, char *buffer, size_t size) {
    char low[32], high[32];
    buffer[0] = 0;
    switch (row->type) {
    case ROW_UINT32:
    case ROW_UINT64:
        if (row->max <= row->min) {
            snprintf(buffer, size, "0 to %s", row->type == ROW_UINT32 ? "4294967295" : "18446744073709551615");
            return;
        }
        break;
    case ROW_PARAM:
    case ROW_FLOAT:
    case ROW_VECTOR:
    case ROW_POSITION:
    case ROW_ROTATION:
    case ROW_POINTS:
    case ROW_STRENGTH:
    case ROW_INT:
    case ROW_INTS:
    case ROW_INDICES: break;
    default: return;
    }

    bound_print(row, row->min, low, sizeof low);
    bound_print(row, row->max, high, sizeof high);
    snprintf(buffer, size, "%s%s to %s%s", row->flags & ROW_OPEN_MIN ? "> " : "", low,
             row->flags & ROW_OPEN_MAX ? "< " : "", high);
}

static size_t expected_add(char *buffer, size_t size, const char *text) {
    size_t used = strlen(buffer);
    snprintf(buffer + used, size - used, "%s", text);
    return strlen(buffer);
}

static void add_names(char *buffer, size_t size, const char *const *names) {
    const char *last = NULL; // the one before is added when it is known whether another follows
    for (int i = 0, added = 0; names[i]; i++) {
        if (!names[i][0]) continue; // scenes have no word for it
        if (last) expected_add(buffer, size, added++ ? ", " : "");
        if (last) expected_add(buffer, size, last);
        last = names[i];
    }

    expected_add(buffer, size, names[0] == last ? "" : " or ");
    expected_add(buffer, size, last);
}

static void add_base(char *buffer, size_t size) {
    char names[160];
    expected_add(buffer, size, "a material (");
    expected_add(buffer, size, base_names(names, sizeof names));
    expected_add(buffer, size, ") or a material file (mine.yaml)");
}

static void add_quantity(char *buffer, size_t size, const SchemaRow *row) {
    char units[80];
    quantity_units(row->dimension, units, sizeof units);
    expected_add(buffer, size, quantity_article(row->dimension));
    expected_add(buffer, size, " ");
    expected_add(buffer, size, quantity_name(row->dimension));

    if (units[0]) {
        expected_add(buffer, size, " (");
        expected_add(buffer, size, units);
        expected_add(buffer, size, ")");
    }

    if (row->flags & ROW_INF) expected_add(buffer, size, " or inf");
    if (row->flags & ROW_NONE) expected_add(buffer, size, " or none");
}

void row_expected(const SchemaRow *row, char *buffer, size_t size) {
    char count[40];
    snprintf(count, sizeof count, "a list of %d ", row->length);
    buffer[0] = 0;

    switch (row->type) {
    case ROW_BOOL: expected_add(buffer, size, "true or false"); break;
    case ROW_INT:
    case ROW_UINT32:
    case ROW_UINT64: expected_add(buffer, size, "a whole number"); break;
    case ROW_STRENGTH: expected_add(buffer, size, "a number or a list of {time, value}"); break;
    case ROW_FLOAT:
    case ROW_PARAM:
        add_quantity(buffer, size, row);
        if (row->type == ROW_PARAM)
            expected_add(buffer, size, ", a map {from, to, texture | attribute | noise} or a list of {time, value}");
        break;
    case ROW_POSITION:
    case ROW_ROTATION:
    case ROW_VECTOR:
        expected_add(buffer, size, count);
        expected_add(buffer, size, row->dimension ? "numbers, each " : "numbers");
        if (row->dimension) add_quantity(buffer, size, row);
        break;
    case ROW_INTS:
        expected_add(buffer, size, count);
        expected_add(buffer, size, "whole numbers");
        break;
    case ROW_TEXT: expected_add(buffer, size, "a text"); break;
    case ROW_NAME:
        expected_add(
            buffer, size,
            "a name of at most 100 characters and 200 bytes, all of them printable, without / \\ : * ? \" < > | % or a "
            "dot in front");
        break;
    case ROW_FILE: expected_add(buffer, size, "the name of a file"); break;
    case ROW_NODE: expected_add(buffer, size, "any value"); break;
    case ROW_BASE: add_base(buffer, size); break;
    case ROW_ENUM: add_names(buffer, size, row->names); break;
    case ROW_ORDER: expected_add(buffer, size, "a list of red, green, blue and yellow, each once"); break;
    case ROW_FORMATS:
        expected_add(buffer, size, "a list of ");
        for (int i = 0; i < OUTPUT_COUNT; i++) {
            if (i) expected_add(buffer, size, i + 1 < OUTPUT_COUNT ? ", " : " and ");
            expected_add(buffer, size, output_formats[i].name);
        }

        expected_add(buffer, size, ", each at most once");
        break;
    case ROW_MAP:
        expected_add(buffer, size, "a map (key: value)");
        for (int i = 0; row->sub && row->sub->choice && i < row->sub->row_count; i++)
            if (strcmp(row->sub->rows[i].key, row->sub->choice) == 0) {
                expected_add(buffer, size, " or ");
                if (row->sub->rows[i].type == ROW_BASE) add_base(buffer, size);
                else if (row->sub->rows[i].type == ROW_BOOL) expected_add(buffer, size, "yes or no");
                else add_names(buffer, size, row->sub->rows[i].names);
            }
        break;
    case ROW_LIST: expected_add(buffer, size, "a list of maps"); break;
    case ROW_POINTS: expected_add(buffer, size, "a list of points [x, y, z], at least one"); break;
    case ROW_INDICES: expected_add(buffer, size, "a list of whole numbers, at least one"); break;
    }
}
