// Writes docs/scene.md from the schema.
#include "scene/dump.h"

#include <stdlib.h>
#include <string.h>

enum { SECTION_MAX = 40 };

typedef struct Sections {
    const Schema *items[SECTION_MAX];
    int count;
} Sections;

static const char introduction[] =
    "# Scene files\n"
    "\n"
    "*This page is made by `singe scene-doc`; edit `schema*.c` or `docs.c` in `program/scene`.*\n"
    "\n"
    "A scene file says what burns, what heats it, what it rests on and how it is drawn. It is\n"
    "[YAML](https://yaml.org), and JSON is accepted, too. The smallest scene:\n"
    "\n"
    "```yaml\n"
    "sheets:\n"
    "  - grid: {size: [210 mm, 297 mm], cells: [52, 74]}\n"
    "sources:\n"
    "  - {kind: spot, position: [0, 0, 0], end: 1 s}\n"
    "```\n"
    "\n"
    "`singe check SCENE` reads a scene and reports all errors, with their lines and columns. Unknown keys,\n"
    "wrong units, values out of range and missing files are errors; nothing is guessed. Keys come in any order.\n"
    "Paths of files are relative to the scene file's folder. Anchors, aliases and tags of YAML are not supported.\n"
    "A scene is a regular file of at most 1 MiB, and nested at most 64 levels deep. Messages quote at most 80 characters\n"
    "of a word, and escape what is not printable (`\\x1b`, `\\u202e`). For other files that it names, only the location\n"
    "of an error is reported. Objects that cannot have an effect, such as a pin that misses its sheet, cause a\n"
    "warning.\n"
    "\n"
    "The z axis is up. Rotations are three angles: about the x axis, then y, then z, all fixed in the world. Colours\n"
    "are linear red, green and blue.\n"
    "\n"
    "## Quantities\n"
    "\n"
    "A number may carry a unit: `80 g/m2`, `240 C`, `1.5 mm`, `5 %`. A bare number is in the first unit of its\n"
    "row: SI, kelvin and, for angles, degrees. Blanks between number and unit do not matter; within a unit they\n"
    "do, so that `3 m m` is an error. `m\u00b2` and `m^2` are `m2`, `\u00b5m` is `um`, `\u00b0C` is `C`, `kg\u00b7K` "
    "is `kg K`. In\n"
    "JSON a quantity with a unit is a string: `\"240 C\"`.\n"
    "\n"
    "| dimension | units |\n"
    "|---|---|\n";

static const char after_units[] =
    "\n"
    "## Values that vary\n"
    "\n"
    "Where a unit below is marked *varies*, the value may differ from place to place on the sheet. Instead of a\n"
    "number, give a map:\n"
    "\n"
    "```yaml\n"
    "mass_rate: {from: 0.004, to: 0.012, noise: {scale: 4 mm, octaves: 4, seed: 1}}\n"
    "thickness: {from: 1 mm, to: 2 mm, texture: thickness.png}   # from where it is black, to where it is white\n"
    "mass_loss: {from: 20 %, to: 30 %, attribute: density}       # a number per vertex of the mesh, 0 from, 1 to\n"
    "mass_rate: {from: 0, to: 0.009, texture: matte.####.png}    # a picture for each frame, from matte.0001.png on\n"
    "drag: [{time: 0, value: 1.3}, {time: 2 s, value: 4}]        # over time, interpolated\n"
    "```\n"
    "\n"
    "Keys and numbered pictures apply frame by frame ([directing.md](directing.md#values-over-time)). Initial\n"
    "values cannot change: `grammage`, `specific_heat`, `thickness`, `temperature`, `moisture`.\n"
    "\n"
    "## Changing a value from the command line\n"
    "\n"
    "`--set PATH=VALUE` overrides a value of the file. A path consists of keys and numbers of list\n"
    "entries, which count from 0: `--set sheets.0.material.grammage='60 g/m2'`, `--set sources[1].start=2`,\n"
    "`--set 'preview.camera.eye=[0, -1, 0.5]'`. `run.json` holds the scene that resulted, with every value.\n";

static void add_section(Sections *sections, const Schema *schema) {
    for (int i = 0; i < sections->count; i++)
        if (sections->items[i] == schema) return;
    if (sections->count == SECTION_MAX) return;
    sections->items[sections->count++] = schema;
    for (int i = 0; i < schema->row_count; i++) {
        if (schema->rows[i].sub) add_section(sections, schema->rows[i].sub);
        if (schema->rows[i].type == ROW_PARAM) add_section(sections, &schema_noise);
    }
}

static const char *bare_title(const Schema *schema) {
    const char *title = schema->title;
    return strncmp(title, "a ", 2) == 0 ? title + 2 : strncmp(title, "the ", 4) == 0 ? title + 4 : title;
}

static void put_type(FILE *file, const SchemaRow *row) {
    static const char *const names[] = {
        [ROW_BOOL] = "yes or no",      [ROW_INT] = "whole number",
        [ROW_UINT32] = "whole number", [ROW_UINT64] = "whole number",
        [ROW_TEXT] = "text",           [ROW_NAME] = "name",
        [ROW_FILE] = "file",           [ROW_BASE] = "material or file",
        [ROW_ORDER] = "4 colours",     [ROW_FORMATS] = "list of formats",
        [ROW_POINTS] = "points, m",    [ROW_INDICES] = "whole numbers",
    };

    const char *unit = quantity_unit(row->dimension);
    if (row->sub) {
        if (row->type != ROW_MAP) fputs(row->type == ROW_STRENGTH ? "number, or list of " : "list of ", file);
        const char *title = bare_title(row->sub);
        fprintf(file, "[%s](#", title);
        for (const char *c = title; *c; c++)
            if (*c != '\'') fputc(*c == ' ' ? '-' : *c, file);
        fputc(')', file);
    } else if (row->type == ROW_ENUM) {
        for (int i = 0; row->names[i]; i++)
            if (row->names[i][0]) fprintf(file, "%s`%s`", i ? ", " : "", row->names[i]);
    } else if (row->type == ROW_INTS) {
        fprintf(file, "%d whole numbers", row->length);
    } else if (row->type == ROW_FLOAT || row->type == ROW_PARAM) {
        fprintf(file, "%s%s", unit[0] ? unit : "number", row->type == ROW_PARAM ? ", *varies*" : "");
    } else if (row->length && row->type != ROW_POINTS && row->type != ROW_ORDER) {
        fprintf(file, "%d \u00d7 %s", row->length, unit[0] ? unit : "number");
    } else {
        fputs(names[row->type], file);
    }
}

static void put_table(FILE *file, const Schema *schema, const void *object, unsigned kind, bool shared) {
    fputs("| key | value | range | default | meaning |\n|---|---|---|---|---|\n", file);
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        bool common = !row->kinds;
        if (shared ? !common : common || !row_allowed(row, kind)) continue;

        char range[80];
        row_range(row, range, sizeof range);
        if (strcmp(range, "-1000000 to 1000000") == 0) // no real limit
            range[0] = 0;
        fprintf(file, "| `%s` | ", row->key);
        put_type(file, row);
        fprintf(file, " | %s%s%s | ", range, row->flags & ROW_INF ? ", inf" : "",
                row->flags & ROW_NONE ? ", none" : "");

        bool has_default = object && !(row->flags & (ROW_REQUIRED | ROW_SHORT)) && !row->sub;
        static const int without[] = {ROW_POSITION, ROW_ROTATION, ROW_TEXT,   ROW_NAME,
                                      ROW_FILE,     ROW_POINTS,   ROW_INDICES};
        for (size_t k = 0; k < sizeof without / sizeof *without; k++) has_default &= (int)row->type != without[k];
        if (row->flags & ROW_REQUIRED) fputs("*required*", file);
        else if (has_default) dump_value(row, object, file);
        fprintf(file, " | %s |\n", row->doc);
    }
}

// A section per map. If it has kinds, the shared keys come first, then those of each kind.
static void put_section(FILE *file, const Schema *schema, const void *object) {
    const char *title = bare_title(schema);
    fprintf(file, "\n## %c%s\n\n%s\n\n", title[0] + 'A' - 'a', title + 1, schema->doc);
    put_table(file, schema, object, ~0u, true);
    if (!schema->kind_offset) return;

    const char *const *names = schema->rows[0].names;
    for (int kind = 0; names[kind]; kind++) {
        bool any = false;
        for (int i = 0; i < schema->row_count; i++) any = any || (schema->rows[i].kinds & 1u << kind);
        if (!any) continue;
        fprintf(file, "\nOnly `%s`:\n\n", names[kind]);
        put_table(file, schema, object, 1u << kind, false);
    }
}

// An object of a schema with its defaults, found through the objects that contain it.
static const void *default_object(SceneArena *arena, const Schema *wanted, const Schema *schema, void *object) {
    if (wanted == schema) return object;

    for (int i = 0; i < schema->row_count && object; i++) {
        const SchemaRow *row = &schema->rows[i];
        SchemaRow noise = {.type = ROW_LIST, .sub = &schema_noise}; // the list that a ROW_PARAM may have
        if (row->type == ROW_PARAM) row = &noise;
        void *begun = row->sub ? row_begin(arena, row, object) : NULL;
        const void *found = begun ? default_object(arena, wanted, row->sub, begun) : NULL;
        if (found) return found;
    }

    return NULL;
}

void scene_document(FILE *file) {
    SceneArena *arena = arena_create();
    Scene *scene = arena ? arena_new(arena, 1, sizeof *scene) : NULL;
    if (scene && default_scene(arena, scene)) {
        char units[80];
        fputs(introduction, file);

        for (int d = 0; d < DIM_COUNT; d++) {
            quantity_units((Dimension)d, units, sizeof units);
            if (units[0])
                fprintf(file, "| %s | %s%s |\n", quantity_name((Dimension)d), d == DIM_FRACTION ? "bare, " : "", units);
        }

        fputs(after_units, file);
        Sections sections = {0};
        add_section(&sections, &schema_scene);
        for (int i = 0; i < sections.count; i++)
            put_section(file, sections.items[i], default_object(arena, sections.items[i], &schema_scene, scene));
    }

    arena_destroy(arena);
}
