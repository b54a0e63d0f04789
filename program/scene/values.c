// Reads single values: numbers, words and file names.
#include "scene/values.h"

#include "common/printable.h"
#include "scene/assets.h"
#include "scene/words.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

void value_wrong(Reader *reader, const YamlNode *node, const SchemaRow *row) {
    char expected[240], seen[NODE_WORDS];
    row_expected(row, expected, sizeof expected);
    complain(reader, node->location, "%s must be %s, not %s", row->key, expected,
             node_describe(node, seen, sizeof seen));
}

// ---- numbers

static bool between(const SchemaRow *row, double value, double low, double high) {
    return (row->flags & ROW_OPEN_MIN ? value > low : value >= low) &&
           (row->flags & ROW_OPEN_MAX ? value < high : value <= high);
}

static void out_of_range(Reader *reader, const SchemaRow *row, const YamlNode *node) {
    char range[80], seen[NODE_WORDS];
    const char *unit = quantity_unit(row->dimension);
    row_range(row, range, sizeof range);
    complain(reader, node->location, "%s is out of range: %s must be %s%s%s", node_describe(node, seen, sizeof seen),
             row->key, range, unit[0] ? " " : "", unit);
}

bool value_float(Reader *reader, const SchemaRow *row, const YamlNode *node, float *result) {
    double value = 0;
    if (node->kind != NODE_VALUE) {
        value_wrong(reader, node, row);
        return false;
    }

    if ((row->flags & ROW_INF) && strcmp(node->text, "inf") == 0) {
        *result = INFINITY;
        return true;
    }
    if ((row->flags & ROW_NONE) && strcmp(node->text, "none") == 0) {
        *result = -INFINITY;
        return true;
    }

    NumberFault fault = quantity_read(node->text, row->dimension, &value);
    if (fault == NUMBER_BAD_UNIT) {
        char units[80], seen[NODE_WORDS];
        quantity_units(row->dimension, units, sizeof units);
        complain(reader, node->location, "%s has an unknown unit for %s %s; possible are: %s",
                 node_describe(node, seen, sizeof seen), quantity_article(row->dimension),
                 quantity_name(row->dimension), units[0] ? units : "none, only a bare number");
        return false;
    }

    if (fault) {
        value_wrong(reader, node, row);
        return false;
    }

    float narrow = (float)value;
    // the bounds are floats like the value, so that the bound itself, as printed, is inside
    if (!isfinite(narrow) || !between(row, (double)narrow, (double)(float)row->min, (double)(float)row->max)) {
        out_of_range(reader, row, node);
        return false;
    }

    *result = narrow;
    return true;
}

static bool read_whole(Reader *reader, const SchemaRow *row, const YamlNode *node, uint64_t highest, bool negative,
                       int64_t *result) {
    const char *c = node->kind == NODE_VALUE ? node->text : "";
    bool minus = negative && *c == '-';
    uint64_t value = 0;
    bool good = c[minus] != 0;
    bool large = false;
    for (c += minus; good && *c; c++) {
        good = *c >= '0' && *c <= '9';
        uint64_t digit = (uint64_t)(*c - '0');
        large = large || (good && value > (highest - digit) / 10);
        value = value * 10 + digit;
    }

    if (!good) {
        value_wrong(reader, node, row);
        return false;
    }

    int64_t number = large ? 0 : minus ? -(int64_t)value : (int64_t)value;
    if (large || (row->max > row->min && !between(row, (double)number, row->min, row->max))) {
        out_of_range(reader, row, node);
        return false;
    }

    *result = number;
    return true;
}

bool value_vector(Reader *reader, const SchemaRow *row, const YamlNode *node, float *result) {
    if (node->kind != NODE_LIST || (int)node->count != row->length) {
        value_wrong(reader, node, row);
        return false;
    }

    SchemaRow element = *row;
    element.type = ROW_FLOAT;

    bool good = true;
    int i = 0;
    for (const YamlNode *child = node->first; child; child = child->next, i++)
        good = value_float(reader, &element, child, &result[i]) && good;
    return good;
}

void value_integer(Reader *reader, const SchemaRow *row, const YamlNode *node, void *field) {
    int64_t value;
    if (row->type == ROW_UINT64) {
        if (read_whole(reader, row, node, UINT64_MAX, false, &value)) *(uint64_t *)field = (uint64_t)value;
    } else if (row->type == ROW_UINT32) {
        if (read_whole(reader, row, node, UINT32_MAX, false, &value)) *(uint32_t *)field = (uint32_t)value;
    } else if (read_whole(reader, row, node, INT32_MAX, true, &value)) {
        *(int *)field = (int)value;
    }
}

void value_ints(Reader *reader, const SchemaRow *row, const YamlNode *node, int *field) {
    if (node->kind != NODE_LIST || (int)node->count != row->length) {
        value_wrong(reader, node, row);
        return;
    }
    SchemaRow element = *row;
    element.type = ROW_INT;
    for (const YamlNode *child = node->first; child; child = child->next)
        value_integer(reader, &element, child, field++);
}

// ---- words

void value_bool(Reader *reader, const SchemaRow *row, const YamlNode *node, bool *field) {
    static const char *const words[] = {"false", "true", "no", "yes", "off", "on"};
    if (node->kind == NODE_VALUE)
        for (int i = 0; i < 6; i++)
            if (strcmp(node->text, words[i]) == 0) {
                *field = i % 2;
                return;
            }
    value_wrong(reader, node, row);
}

bool value_word(Reader *reader, const SchemaRow *row, const YamlNode *node, const char *const *names, int *result) {
    if (node->kind != NODE_VALUE) {
        value_wrong(reader, node, row);
        return false;
    }

    const char *word = node->text;
    Nearest nearest = {.word = word};
    for (int i = 0; names[i]; i++) {
        if (!names[i][0]) continue; // scenes have no word for it
        if (strcmp(word, names[i]) == 0) {
            *result = i;
            return true;
        }
        nearest_offer(&nearest, names[i]);
    }

    char expected[240], seen[NODE_WORDS], hint[80];
    SchemaRow choice = *row;
    choice.type = ROW_ENUM;
    choice.names = names;
    row_expected(&choice, expected, sizeof expected);
    complain(reader, node->location, "%s must be %s, not %s%s", row->key, expected,
             node_describe(node, seen, sizeof seen), nearest_hint(&nearest, hint, sizeof hint));
    return false;
}

void value_order(Reader *reader, const SchemaRow *row, const YamlNode *node, SingeColour *field) {
    if (node->kind != NODE_LIST || node->count != SINGE_COLOUR_COUNT) {
        value_wrong(reader, node, row);
        return;
    }

    int seen = 0;
    for (const YamlNode *child = node->first; child; child = child->next) {
        int colour = 0;
        if (!value_word(reader, row, child, enum_words.SingeColour, &colour)) return;
        if (seen & 1 << colour) {
            complain(reader, child->location, "'%s' is repeated; each colour comes once",
                     enum_words.SingeColour[colour]);
            return;
        }

        seen |= 1 << colour;
        *field++ = (SingeColour)colour;
    }
}

void value_formats(Reader *reader, const SchemaRow *row, const YamlNode *node, OutputSet *field) {
    if (node->kind != NODE_LIST) {
        value_wrong(reader, node, row);
        return;
    }

    const char *names[OUTPUT_COUNT + 1] = {NULL};
    for (int i = 0; i < OUTPUT_COUNT; i++) names[i] = output_formats[i].name;

    OutputSet set = 0;
    for (const YamlNode *child = node->first; child; child = child->next) {
        int format = 0;
        if (!value_word(reader, row, child, names, &format)) return;
        if (output_has(set, format)) {
            complain(reader, child->location, "'%s' is repeated", names[format]);
            return;
        }
        set |= 1u << format;
    }

    *field = set | 1u << OUTPUT_ply;
}

bool value_is_text(const YamlNode *node) {
    char seen[NODE_WORDS];
    return node->kind == NODE_VALUE && strcmp(node_describe(node, seen, sizeof seen), "nothing") != 0 && node->text[0];
}

bool value_names_files(const char *text) {
    // systems take file names of 255 bytes; 200 leave room for endings
    bool good = *text && *text != '.' && strlen(text) <= 200 && printable_count(text) <= 100 && printable_is(text);
    return good && !strpbrk(text, "/\\:*?\"<>|%");
}

void value_name(Reader *reader, const SchemaRow *row, const YamlNode *node, char **field) {
    if (value_is_text(node) && value_names_files(node->text)) *field = node->text;
    else value_wrong(reader, node, row);
}

// A name relative to a folder, unless it is absolute. NULL when out of memory.
static char *value_join(SceneArena *arena, const char *folder, const char *slash, char *name) {
    size_t length = strlen(folder) + strlen(slash) + strlen(name) + 1;
    if (path_is_absolute(name) || !(folder[0] || slash[0])) return name;
    char *joined = arena_new(arena, length, 1);
    if (joined) snprintf(joined, length, "%s%s%s", folder, slash, name);
    return joined;
}

void value_file(Reader *reader, const SchemaRow *row, const YamlNode *node, SceneFile *field) {
    if (!value_is_text(node) || strlen(node->text) > 4000) {
        value_wrong(reader, node, row);
        return;
    }

    if (row->flags & ROW_NUMBERED && !sequence_name_fits(node->text)) {
        complain(reader, node->location,
                 "%s: the file's name needs one run of # for the number of the frame, as in 'body.####.ply'", row->key);
        return;
    }

    field->location = node->location;
    field->name = field->path = value_join(reader->arena, reader->prefix, "", node->text);
    if (!reader->base_dir || !field->name) return;

    if (reader->base_dir[0]) field->path = value_join(reader->arena, reader->base_dir, "/", field->name);
    struct stat status;
    const char *fault = NULL;
    if (!field->path || row->flags & ROW_NUMBERED) return;

    if (stat(field->path, &status)) fault = "there is no such file";
    else if (S_ISDIR(status.st_mode)) fault = "this is a folder";
    else if (access(field->path, R_OK)) fault = "the file cannot be read";
    if (fault && node->location.file) complain(reader, node->location, "%s: %s", row->key, fault);
    else if (fault) complain(reader, node->location, "%s: %s (%s)", row->key, fault, shown_path(field->path).text);
}
