// Writes the JSON Schema of scene files from the tables that read them, so that editors complete and check scenes.
//
// A quantity is a number, within its range, or a text of a number and a unit. The ranges of numbers with units are left
// to `singe check`, and so is what several keys say together.
#include "scene/scene.h"
#include "scene/schema_rows.h"

#include <string.h>

enum { DEFINITIONS_MAX = 40 };

/// The schemas that `$defs` has, in the order in which rows refer to them.
typedef struct Definitions {
    FILE *file;
    const Schema *items[DEFINITIONS_MAX];
    int count;
} Definitions;

static const char number_pattern[] = "[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?";

static void put_string(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text; text++) fprintf(file, *text == '"' || *text == '\\' ? "\\%c" : *text == '\n' ? " " : "%c", *text);
    fputc('"', file);
}

/// A reference to a schema, which `$defs` will have.
static void put_reference(Definitions *definitions, const Schema *schema) {
    int i = 0;
    while (i < definitions->count && definitions->items[i] != schema) i++;
    if (i == definitions->count && i < DEFINITIONS_MAX) definitions->items[definitions->count++] = schema;
    fprintf(definitions->file, "{\"$ref\": \"#/$defs/%d\"}", i);
}

static void put_bound(FILE *file, const SchemaRow *row, const char *name, double bound) {
    char text[40];
    quantity_print((float)bound, row->dimension, text, sizeof text);
    fprintf(file, ", \"%s\": %s", name, text);
}

/// A bare number in its range, or a text with a unit, or the words that the row allows.
static void put_quantity(FILE *file, const SchemaRow *row) {
    fputs("{\"anyOf\": [{\"type\": \"number\"", file);
    if (row->max > row->min) {
        put_bound(file, row, row->flags & ROW_OPEN_MIN ? "exclusiveMinimum" : "minimum", row->min);
        put_bound(file, row, row->flags & ROW_OPEN_MAX ? "exclusiveMaximum" : "maximum", row->max);
    }
    fprintf(file, "}, {\"type\": \"string\", \"pattern\": \"^(%s *(", number_pattern);

    // units as they are written, and with blanks, dots or stars between their parts
    char units[80];
    quantity_units(row->dimension, units, sizeof units);
    for (const char *c = units; *c; c++) {
        if (*c == ',' && c[1] == ' ') {
            fputc('|', file);
            c++;
        } else if (*c == ' ') fputs("[ *\u00b7]?", file);
        else if (*c == '2' || *c == '3') fprintf(file, "(\\\\^?%c|%s)", *c, *c == '2' ? "\u00b2" : "\u00b3");
        else if (*c == 'u') fputs("[u\u00b5\u03bc]", file);
        else if ((*c == 'C' || *c == 'F') && row->dimension == DIM_TEMPERATURE) fprintf(file, "\u00b0?%c", *c);
        else if (*c == '(' || *c == ')') fprintf(file, "[%c]", *c);
        else fputc(*c, file);
    }

    if (row->dimension == DIM_ANGLE) fputs("|\u00b0", file);
    fputs(units[0] ? ")?" : ")", file);
    if (row->flags & ROW_INF) fputs("|inf", file);
    if (row->flags & ROW_NONE) fputs("|none", file);
    fputs(")$\"}]}", file);
}

static void put_words(FILE *file, const char *const *words) {
    fputs("{\"enum\": [", file);
    for (int i = 0, count = 0; words[i]; i++)
        if (words[i][0]) fprintf(file, "%s\"%s\"", count++ ? ", " : "", words[i]);
    fputs("]}", file);
}

static void put_whole(FILE *file, const SchemaRow *row) {
    fputs("{\"type\": \"integer\"", file);
    if (row->max > row->min) fprintf(file, ", \"minimum\": %.0f, \"maximum\": %.0f", row->min, row->max);
    else if (row->type != ROW_INT && row->type != ROW_INTS) fputs(", \"minimum\": 0", file);
    fputc('}', file);
}

/// A list of `length` values, or, for 0, of one or more.
static void put_list(FILE *file, int length, const SchemaRow *row, void (*put)(FILE *file, const SchemaRow *row)) {
    fputs("{\"type\": \"array\", \"items\": ", file);
    put(file, row);
    if (length) fprintf(file, ", \"minItems\": %d, \"maxItems\": %d}", length, length);
    else fputs(", \"minItems\": 1}", file);
}

static void put_point(FILE *file, const SchemaRow *row) { put_list(file, 3, row, put_quantity); }

/// A value at a time.
static void put_key(FILE *file, const SchemaRow *row) {
    const SchemaRow time = {"time", ROW_FLOAT, DIM_TIME, .min = 0, .max = 1e6};
    fputs("{\"type\": \"object\", \"properties\": {\"time\": ", file);
    put_quantity(file, &time);
    fputs(", \"value\": ", file);
    put_quantity(file, row);
    fputs("}, \"required\": [\"time\", \"value\"], \"additionalProperties\": false}", file);
}

/// A value, one between two by a texture, an attribute or noise, or keys.
static void put_param(Definitions *definitions, const SchemaRow *row) {
    FILE *file = definitions->file;
    fputs("{\"anyOf\": [", file);
    put_quantity(file, row);
    fputs(", {\"type\": \"object\", \"properties\": {\"from\": ", file);
    put_quantity(file, row);
    fputs(", \"to\": ", file);
    put_quantity(file, row);

    fputs(", \"texture\": {\"type\": \"string\"}, \"attribute\": {\"type\": \"string\"}, \"noise\": ", file);
    put_reference(definitions, &schema_noise);
    fputs("}, \"required\": [\"from\", \"to\"], \"minProperties\": 3, \"maxProperties\": 3, "
          "\"additionalProperties\": false}, ",
          file);
    put_list(file, 0, row, put_key);
    fputs("]}", file);
}

static void put_value(Definitions *definitions, const SchemaRow *row) {
    FILE *file = definitions->file;
    switch (row->type) {
    case ROW_BOOL: fputs("{\"enum\": [true, false, \"yes\", \"no\", \"on\", \"off\"]}", file); break;
    case ROW_INT:
    case ROW_UINT32:
    case ROW_UINT64: put_whole(file, row); break;
    case ROW_FLOAT: put_quantity(file, row); break;
    case ROW_VECTOR:
    case ROW_POSITION:
    case ROW_ROTATION: put_list(file, row->length, row, put_quantity); break;
    case ROW_INTS: put_list(file, row->length, row, put_whole); break;
    case ROW_POINTS: put_list(file, 0, row, put_point); break;
    case ROW_INDICES: put_list(file, 0, row, put_whole); break;
    case ROW_TEXT: fputs("{\"type\": [\"string\", \"number\"]}", file); break; // `sheet: 0` names one by its number
    case ROW_NAME:
        fputs("{\"type\": [\"string\", \"number\"], \"pattern\": \"^[^./\\\\\\\\:*?<>|%][^/\\\\\\\\:*?<>|%]*$\"}",
              file);
        break;
    case ROW_FILE:
        fprintf(file, "{\"type\": \"string\", \"minLength\": 1%s}",
                row->flags & ROW_NUMBERED ? ", \"pattern\": \"#\"" : "");
        break;
    case ROW_ENUM: put_words(file, row->names); break;
    case ROW_ORDER:
        fputs("{\"type\": \"array\", \"uniqueItems\": true, \"minItems\": 4, \"maxItems\": 4, \"items\": ", file);
        put_words(file, enum_words.SingeColour);
        fputc('}', file);
        break;
    case ROW_FORMATS:
        fputs("{\"type\": \"array\", \"uniqueItems\": true, \"items\": {\"enum\": [", file);
        for (int i = 0; i < OUTPUT_COUNT; i++) fprintf(file, "%s\"%s\"", i ? ", " : "", output_formats[i].name);
        fputs("]}}", file);
        break;
    case ROW_BASE:
        fputs("{\"anyOf\": [{\"enum\": [", file);
        for (int i = 0; scene_material_name(i); i++) fprintf(file, "%s\"%s\"", i ? ", " : "", scene_material_name(i));
        fputs("]}, {\"type\": \"string\", \"pattern\": \"/|[.](yaml|yml|json)$\"}]}", file);
        break;
    case ROW_PARAM: put_param(definitions, row); break;
    case ROW_MAP:
        if (!row->sub->choice) {
            put_reference(definitions, row->sub);
            break;
        }
        fputs("{\"anyOf\": [", file); // a bare word is the choice of the map
        put_reference(definitions, row->sub);
        for (int i = 0; i < row->sub->row_count; i++) {
            if (strcmp(row->sub->rows[i].key, row->sub->choice) != 0) continue;
            fputs(", ", file);
            put_value(definitions, &row->sub->rows[i]);
        }

        fputs("]}", file);
        break;
    case ROW_NODE: fputs("{}", file); break;
    case ROW_STRENGTH:
    case ROW_LIST:
        if (row->type == ROW_STRENGTH) {
            fputs("{\"anyOf\": [", file);
            put_quantity(file, row);
            fputs(", ", file);
        }

        fprintf(file, "{\"type\": \"array\", %s\"items\": ",
                row->type == ROW_STRENGTH || (row->flags & ROW_KEYED) ? "\"minItems\": 1, " : "");
        put_reference(definitions, row->sub);
        fputs(row->type == ROW_STRENGTH ? "}]}" : "}", file);
        break;
    }
}

/// The first row of a key: rows of other kinds may have it too.
static bool is_first(const Schema *schema, int row) {
    for (int i = 0; i < row; i++)
        if (strcmp(schema->rows[i].key, schema->rows[row].key) == 0) return false;
    return true;
}

/// A key with its documentation; where kinds differ, what each of them takes.
static void put_property(Definitions *definitions, const Schema *schema, int first) {
    FILE *file = definitions->file;
    const SchemaRow *row = &schema->rows[first];
    char range[80];
    row_range(row, range, sizeof range);

    const char *unit = quantity_unit(row->dimension);
    put_string(file, row->key);
    fputs(": {\"description\": \"", file);
    for (const char *c = row->doc; *c; c++) fprintf(file, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
    if (range[0]) fprintf(file, "; %s%s%s", range, unit[0] ? " " : "", unit);
    fputs("\", \"anyOf\": [", file);

    for (int i = first, count = 0; i < schema->row_count; i++) {
        if (strcmp(schema->rows[i].key, row->key) != 0) continue;
        if (count++) fputs(", ", file);
        put_value(definitions, &schema->rows[i]);
    }

    fputs("]}", file);
}

static void put_map(Definitions *definitions, const Schema *schema) {
    FILE *file = definitions->file;
    fputs("\"type\": \"object\", \"additionalProperties\": false, \"title\": ", file);
    put_string(file, schema->title);
    fputs(", \"description\": ", file);
    put_string(file, schema->doc);

    fputs(",\n \"properties\": {", file);
    for (int i = 0; i < schema->row_count; i++) {
        if (!is_first(schema, i)) continue;
        fputs(i ? ",\n  " : "\n  ", file);
        put_property(definitions, schema, i);
    }

    fputs("},\n \"required\": [", file);
    for (int i = 0, count = 0; i < schema->row_count; i++)
        if ((schema->rows[i].flags & ROW_REQUIRED) && !schema->rows[i].kinds)
            fprintf(file, "%s\"%s\"", count++ ? ", " : "", schema->rows[i].key);
    fputc(']', file);

    if (!schema->kind_offset) return;
    fputs(",\n \"allOf\": [", file);

    for (int kind = 0, count = 0; schema->rows[0].names[kind]; kind++) {
        if (!schema->rows[0].names[kind][0]) continue;
        fputs(count++ ? ",\n  " : "\n  ", file);

        // keys that maps of one kind need, or must not have
        fprintf(file, "{\"if\": {\"properties\": {\"kind\": {\"const\": \"%s\"}}}, \"then\": {\"required\": [\"kind\"",
                schema->rows[0].names[kind]);
        for (int i = 1; i < schema->row_count; i++)
            if ((schema->rows[i].flags & ROW_REQUIRED) && (schema->rows[i].kinds & 1u << kind))
                fprintf(file, ", \"%s\"", schema->rows[i].key);
        fputs("], \"properties\": {", file);

        for (int i = 0, refused = 0; i < schema->row_count; i++) {
            bool allowed = false;
            for (int j = 0; j < schema->row_count; j++)
                allowed = allowed || (strcmp(schema->rows[i].key, schema->rows[j].key) == 0 &&
                                      row_allowed(&schema->rows[j], 1u << kind));
            if (!allowed && is_first(schema, i))
                fprintf(file, "%s\"%s\": false", refused++ ? ", " : "", schema->rows[i].key);
        }

        fputs("}}}", file);
    }

    fputc(']', file);
}

void scene_json_schema(FILE *file) {
    Definitions definitions = {.file = file};
    fputs("{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n ", file);
    put_map(&definitions, &schema_scene);
    fputs(",\n\"$defs\": {", file);

    for (int i = 0; i < definitions.count; i++) { // each may add others
        fprintf(file, "%s\n\"%d\": {", i ? "," : "", i);
        put_map(&definitions, definitions.items[i]);
        fputc('}', file);
    }

    fputs("}}\n", file);
}
