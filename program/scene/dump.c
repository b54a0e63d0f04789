// Writes a scene with every value it uses, as YAML or JSON, from the schema's tables.
#include "scene/dump.h"

#include "scene/words.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

typedef struct Dumper {
    FILE *file;
    bool json;
} Dumper;

static const void *dump_at(const void *object, size_t offset) { return (const char *)object + offset; }

static uint32_t count_at(const void *object, const SchemaRow *row) {
    return *(const uint32_t *)dump_at(object, row->extra);
}

static const void *items_at(const void *object, const SchemaRow *row) {
    const void *items;
    memcpy(&items, dump_at(object, row->offset), sizeof items);
    return items;
}

static void put_text(FILE *file, const char *text) {
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\') fprintf(file, "\\%c", *c);
        else if (*c < 0x20 || *c == 0x7f) fprintf(file, "\\u%04x", *c);
        else fputc(*c, file);
    }

    fputc('"', file);
}

static void put_number(FILE *file, float value, Dimension dimension) {
    char text[40];
    if (isinf(value)) {
        fputs(value > 0 ? "\"inf\"" : "\"none\"", file);
        return;
    }
    quantity_print(value, dimension, text, sizeof text);
    fputs(text, file);
}

static void put_numbers(FILE *file, const float *values, int count, Dimension dimension) {
    for (int i = 0; i < count; i++) {
        fputs(i ? ", " : "[", file);
        put_number(file, values[i], dimension);
    }
    fputc(']', file);
}

static void put_param(FILE *file, const SchemaRow *row, const SingeParam *param, const SceneFollowed *followed) {
    const SingeField *field = param->field;
    for (uint32_t i = 0; i < followed->key_count; i++) {
        fputs(i ? ", {\"time\": " : "[{\"time\": ", file);
        put_number(file, followed->keys[i].time, DIM_TIME);
        fputs(", \"value\": ", file);
        put_number(file, followed->keys[i].value, row->dimension);
        fputs(i + 1 < followed->key_count ? "}" : "}]", file);
    }

    if (followed->key_count) return;
    if (!field) {
        put_number(file, param->value, row->dimension);
        return;
    }

    fputs("{\"from\": ", file);
    put_number(file, param->value, row->dimension);
    fputs(", \"to\": ", file);
    put_number(file, param->to, row->dimension);

    if (field->kind == SINGE_FIELD_NOISE) {
        fputs(", \"noise\": {\"scale\": ", file);
        put_number(file, field->noise.scale, DIM_LENGTH);
        fprintf(file, ", \"octaves\": %d, \"seed\": %" PRIu32 "}", field->noise.octaves, field->noise.seed);
    } else {
        bool is_texture = field->kind == SINGE_FIELD_TEXTURE;
        const char *name = is_texture ? followed->texture.name : field->attribute;
        fprintf(file, ", \"%s\": ", is_texture ? "texture" : "attribute");
        put_text(file, name ? name : "");
    }

    fputc('}', file);
}

void dump_value(const SchemaRow *row, const void *object, FILE *file) {
    const void *field = dump_at(object, row->offset);
    switch (row->type) {
    case ROW_BOOL: fputs(*(const bool *)field ? "true" : "false", file); break;
    case ROW_INT: fprintf(file, "%d", *(const int *)field); break;
    case ROW_UINT32: fprintf(file, "%" PRIu32, *(const uint32_t *)field); break;
    case ROW_UINT64: fprintf(file, "%" PRIu64, *(const uint64_t *)field); break;
    case ROW_FLOAT: put_number(file, *(const float *)field, row->dimension); break;
    case ROW_VECTOR: put_numbers(file, field, row->length, row->dimension); break;
    case ROW_INTS:
        for (int i = 0; i < row->length; i++) fprintf(file, "%s%d", i ? ", " : "[", ((const int *)field)[i]);
        fputc(']', file);
        break;
    case ROW_TEXT:
    case ROW_NAME: put_text(file, *(char *const *)field); break;
    case ROW_FILE: put_text(file, ((const SceneFile *)field)->name); break;
    case ROW_ENUM: {
        int value;
        memcpy(&value, field, sizeof value);
        put_text(file, row->names[value]);
        break;
    }
    case ROW_ORDER:
        for (int i = 0; i < SINGE_COLOUR_COUNT; i++)
            fprintf(file, "%s\"%s\"", i ? ", " : "[", enum_words.SingeColour[((const SingeColour *)field)[i]]);
        fputc(']', file);
        break;
    case ROW_FORMATS: {
        const char *between = "";
        fputc('[', file);
        for (int i = 0; i < OUTPUT_COUNT; i++) {
            if (!output_has(*(const OutputSet *)field, i)) continue;
            fprintf(file, "%s\"%s\"", between, output_formats[i].name);
            between = ", ";
        }

        fputc(']', file);
        break;
    }
    case ROW_PARAM: put_param(file, row, field, dump_at(object, row->extra)); break;
    case ROW_POINTS: {
        const ScenePoint *points = items_at(object, row);
        fputc('[', file);
        for (uint32_t i = 0; i < count_at(object, row); i++) {
            fputs(i ? ", " : "", file);
            put_numbers(file, points[i].position, 3, DIM_LENGTH);
        }
        fputc(']', file);
        break;
    }
    case ROW_INDICES: {
        const uint32_t *indices = items_at(object, row);
        for (uint32_t i = 0; i < count_at(object, row); i++) fprintf(file, "%s%" PRIu32, i ? ", " : "[", indices[i]);
        fputs(count_at(object, row) ? "]" : "[]", file);
        break;
    }
    case ROW_POSITION: put_numbers(file, ((const SceneKey *)items_at(object, row))->position, 3, row->dimension); break;
    case ROW_ROTATION: put_numbers(file, ((const SceneKey *)items_at(object, row))->rotation, 3, row->dimension); break;
    case ROW_BASE: // its values are all written
    case ROW_MAP:
    case ROW_LIST:
    case ROW_STRENGTH:    // dump_row
    case ROW_NODE: break; // scenes have none
    }
}

// Short keys and absent values are left out.
static bool row_present(const SchemaRow *row, unsigned kind, const void *object) {
    if (!row_allowed(row, kind) || (row->flags & ROW_SHORT)) return false;

    switch (row->type) {
    case ROW_TEXT:
    case ROW_NAME: return *(char *const *)dump_at(object, row->offset) != NULL;
    case ROW_FILE: return ((const SceneFile *)dump_at(object, row->offset))->name != NULL;
    case ROW_MAP: return !row->extra || *(const bool *)dump_at(object, row->extra);
    case ROW_LIST:
    case ROW_STRENGTH:
    case ROW_POINTS:
    case ROW_INDICES: return count_at(object, row) > 0;
    default: return true;
    }
}

static void dump_line(const Dumper *dumper, int indent) { fprintf(dumper->file, "\n%*s", indent, ""); }

static void dump_map(const Dumper *dumper, const Schema *schema, const void *object, int indent, bool inline_first);

static void dump_row(const Dumper *dumper, const SchemaRow *row, const void *object, int indent) {
    fprintf(dumper->file, dumper->json ? "\"%s\":" : "%s:", row->key);
    if (row->type == ROW_MAP) {
        if (dumper->json) fputc(' ', dumper->file);
        dump_map(dumper, row->sub, dump_at(object, row->offset), indent + 2, dumper->json);
    } else if (row->type == ROW_LIST || row->type == ROW_STRENGTH) {
        if (dumper->json) fputc(' ', dumper->file);
        const char *items = items_at(object, row);
        const uint32_t count = count_at(object, row);
        for (uint32_t i = 0; i < count; i++) {
            if (dumper->json) fputs(i ? "," : "[", dumper->file);
            dump_line(dumper, indent + 2);
            if (!dumper->json) fputs("- ", dumper->file);
            dump_map(dumper, row->sub, items + i * row->sub->size, dumper->json ? indent + 2 : indent + 4, true);
        }

        if (dumper->json) fputc(']', dumper->file);
    } else {
        fputc(' ', dumper->file);
        dump_value(row, object, dumper->file);
    }
}

// `inline_first`: the map begins on the current line.
static void dump_map(const Dumper *dumper, const Schema *schema, const void *object, int indent, bool inline_first) {
    unsigned kind = schema_kind(schema, object);
    bool first = true;
    const char *keyed = ""; // a list that stands for the number of this key
    if (dumper->json) fputc('{', dumper->file);

    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        if (!row_present(row, kind, object) || strcmp(row->key, keyed) == 0) continue;
        if (row->flags & ROW_KEYED) keyed = row->key;
        if (!first && dumper->json) fputc(',', dumper->file);
        if (!first || !inline_first || dumper->json) dump_line(dumper, indent + (dumper->json ? 2 : 0));
        dump_row(dumper, row, object, indent);
        first = false;
    }

    if (dumper->json) {
        dump_line(dumper, indent);
        fputc('}', dumper->file);
    }
}

/// The text of a stream of open_memstream, which it closes; NULL when out of memory.
static char *stream_text(FILE *file, char **text) {
    bool good = file && !ferror(file);
    if (file && fclose(file) != 0) good = false;
    if (good) return *text;
    free(*text);
    return NULL;
}

char *dump_text(const Schema *schema, const void *object) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file) dump_map(&(Dumper){file, true}, schema, object, 0, true);
    return stream_text(file, &text);
}

char *dump_row_text(const SchemaRow *row, unsigned kind, const void *object) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file && row_present(row, kind, object)) dump_row(&(Dumper){file, true}, row, object, 0);
    return stream_text(file, &text);
}

void scene_dump(const Scene *scene, SceneSyntax syntax, int indent, FILE *file) {
    Dumper dumper = {file, syntax == SCENE_JSON};
    dump_map(&dumper, &schema_scene, scene, indent, true);
    if (!indent) fputc('\n', file);
}
