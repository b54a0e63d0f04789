// draw_scene SEED: a random scene as JSON, drawn from the schema that reads scenes, so that a new key is drawn as well.
// draw_scene --ends: the keys of that schema and the ends of their ranges, for extremes.py.
//
// Half of all scenes keep near the defaults; in the others any value may be anywhere in its range. What scenes cost is
// kept small: few cells, frames and steps. Keys that name files are left out.
#include <math.h>
#include <stdlib.h>

#include "scene/schema.h"

typedef struct Draw {
    uint64_t state;
    bool wild;
    SceneArena *arena;
    double moment; ///< s, of the last key of a path
    bool first;    ///< of the map that is written
    bool keyed;    ///< the pace has keys, in place of a number, and of `burn_by`
    bool paper;    ///< the solver is not `strand`, and takes no `isotropic`
} Draw;

/// From 0 to 1 (splitmix64, Steele et al. 2014).
static double share(Draw *draw) {
    uint64_t x = draw->state += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return (double)((x ^ x >> 31) >> 11) / 9007199254740992.0;
}

static int pick(Draw *draw, int count) { return (int)(share(draw) * count); }

/// Keys whose random values would make a scene empty, too slow or too large. Values are in the units that a scene
/// stores.
typedef struct Limit {
    const char *schema, *key;
    double low, high;
} Limit;

static const Limit limits[] = {
    {"the scene", "frames", 2, 3},
    {"the scene", "steps", 1, 4},
    {"the scene", "detail", 2e-3, 1},
    {"the solver", "substeps", 0, 8},
    {"the solver", "projections", 1, 4},
    {"the gas", "cell_size", 0.01, 1},
    {"the gas", "height", 0.05, 0.3},
    {"a grid", "size", 0.02, 0.3},
    {"a grid", "cells", 1, 9},
    {"the preview", "size", 16, 32},
    {"the preview", "samples", 1, 2},
    {"a sheet", "translate", -0.02, 0.02},
    {"a sheet", "scale", 0.5, 2},
    {"a source", "position", -0.1, 0.1},
    {"a key", "position", -0.1, 0.1},
    {"a collider", "position", -0.1, 0.05},
    {"a material", "thickening", 1, 20},
    {"the scene", "fps", 1, 1000},
    {"the output", "texture_size", 16, 256},
};

/// Of numbers that any range holds, what may become of one: near what it is, far from it, or at an end of its range.
static double draw_number(Draw *draw, const Schema *schema, const SchemaRow *row, double usual) {
    double low = row->min, high = row->max;
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++)
        if (strcmp(limits[k].schema, schema->title) == 0 && strcmp(limits[k].key, row->key) == 0) {
            low = fmax(low, limits[k].low), high = fmin(high, limits[k].high);
            return low + share(draw) * (high - low);
        }

    double x = usual * exp(2 * share(draw) - 1), how = share(draw);
    if (usual == 0) x = 0.1 * share(draw) * fmin(high, 1);
    if (draw->wild && how < 0.1) x = how < 0.05 ? low : high;
    else if (draw->wild && how < 0.3 && low >= 0) x = exp(log(1e-6) + share(draw) * log(1e12));
    else if (draw->wild && how < 0.3) x = (2 * share(draw) - 1) * fmin(high, 1e3);
    x = fmin(fmax(x, low), high);
    if (x == low && (row->flags & ROW_OPEN_MIN)) x = low > 0 ? low * 1.001 : 1e-9;
    if (x == high && (row->flags & ROW_OPEN_MAX)) x = high * 0.999;
    return x;
}

static void put_number(Draw *draw, const Schema *schema, const SchemaRow *row, double usual) {
    char text[64];
    quantity_print((float)draw_number(draw, schema, row, usual), row->dimension, text, sizeof text);
    fputs(text, stdout);
}

static void put_key(Draw *draw, const char *key) {
    printf("%s\"%s\": ", draw->first ? "" : ", ", key);
    draw->first = false;
}

static void put_map(Draw *draw, const Schema *schema, void *object);

static void put_list(Draw *draw, const SchemaRow *row, void *object) {
    bool sheets = strcmp(row->key, "sheets") == 0;
    const bool some = sheets || (row->flags & (ROW_REQUIRED | ROW_KEYED)) || strcmp(row->key, "path") == 0;
    int count = some + pick(draw, sheets ? 5 : 3);
    draw->moment = 0;
    putchar('[');

    for (int i = 0; i < count; i++) {
        if (i) fputs(", ", stdout);
        void *item = row_begin(draw->arena, row, object);
        if (!item) exit(2);
        put_map(draw, row->sub, item);
    }
    putchar(']');
}

/// A number, keys over time, or a line between two by a noise.
static void put_param(Draw *draw, const Schema *schema, const SchemaRow *row, const void *object) {
    SingeParam param;
    memcpy(&param, (const char *)object + row->offset, sizeof param);
    if (pick(draw, 5)) {
        put_number(draw, schema, row, (double)param.value);
        return;
    }

    if (pick(draw, 3) == 0 && !scene_param_lasts(row->key)) {
        for (int i = 0, count = 1 + pick(draw, 3); i < count; i++) {
            printf("%s{\"time\": %g, \"value\": ", i ? ", " : "[", 0.03 * i);
            put_number(draw, schema, row, (double)param.value);
            fputs(i + 1 < count ? "}" : "}]", stdout);
        }
        return;
    }

    fputs("{\"from\": ", stdout);
    put_number(draw, schema, row, (double)param.value);
    fputs(", \"to\": ", stdout);
    put_number(draw, schema, row, (double)param.to);
    printf(", \"noise\": {\"scale\": %g, \"octaves\": %d, \"seed\": %d}}", 0.001 + 0.05 * share(draw),
           1 + pick(draw, 8), pick(draw, 1000));
}

static void put_numbers(Draw *draw, const Schema *schema, const SchemaRow *row, const float *usual) {
    putchar('[');
    for (int i = 0; i < row->length; i++) {
        if (i) fputs(", ", stdout);
        put_number(draw, schema, row, usual ? (double)usual[i] : 0);
    }
    putchar(']');
}

static void put_whole(Draw *draw, const Schema *schema, const SchemaRow *row, int count) {
    if (count > 1) putchar('[');
    for (int i = 0; i < count; i++)
        printf("%s%.0f", i ? ", " : "", floor(draw_number(draw, schema, row, 1 + 9 * share(draw))));
    if (count > 1) putchar(']');
}

static void put_names(Draw *draw, const SchemaRow *row) {
    int count = 0;
    while (row->names[count]) count++;
    const char *name = row->names[pick(draw, count)];
    draw->paper |= strcmp(row->key, "method") == 0 && strcmp(name, "strand") != 0;
    printf("\"%s\"", name);
}

static void put_base(Draw *draw) {
    char names[1024], *rest = NULL;
    int count = 1;
    base_names(names, sizeof names);
    for (const char *p = names; *p; p++) count += *p == ',';
    int chosen = pick(draw, count);
    const char *name = strtok_r(names, ", ", &rest);
    for (int i = 0; i < chosen && name; i++) name = strtok_r(NULL, ", ", &rest);
    printf("\"%s\"", name ? name : "");
}

static void put_order(Draw *draw) {
    const char *colours[] = {"red", "green", "blue", "yellow"};
    for (int i = 3; i > 0; i--) {
        int k = pick(draw, i + 1);
        const char *swapped = colours[i];
        colours[i] = colours[k], colours[k] = swapped;
    }
    printf("[\"%s\", \"%s\", \"%s\", \"%s\"]", colours[0], colours[1], colours[2], colours[3]);
}

static void put_value(Draw *draw, const Schema *schema, const SchemaRow *row, void *object) {
    const float *at = (const float *)(const void *)((const char *)object + row->offset);
    switch (row->type) {
    case ROW_BOOL: fputs(pick(draw, 2) ? "true" : "false", stdout); break;
    case ROW_INT:
    case ROW_UINT32:
    case ROW_UINT64: put_whole(draw, schema, row, 1); break;
    case ROW_INTS: put_whole(draw, schema, row, row->length); break;
    case ROW_FLOAT:
        if (strcmp(row->key, "time") == 0) printf("%g", draw->moment += 0.001 + 0.1 * share(draw));
        else put_number(draw, schema, row, (double)*at);
        break;
    case ROW_VECTOR: put_numbers(draw, schema, row, at); break;
    case ROW_POSITION:
    case ROW_ROTATION: put_numbers(draw, schema, row, NULL); break;
    case ROW_POINTS: printf("[[%g, %g, 0]]", 0.2 * share(draw) - 0.1, 0.2 * share(draw) - 0.1); break;
    case ROW_INDICES: printf("[%d, %d]", pick(draw, 2), 2 + pick(draw, 2)); break;
    case ROW_ENUM: put_names(draw, row); break;
    case ROW_ORDER: put_order(draw); break;
    case ROW_FORMATS: printf("[%s]", output_formats[pick(draw, OUTPUT_COUNT)].name); break;
    case ROW_BASE: put_base(draw); break;
    case ROW_PARAM: put_param(draw, schema, row, object); break;
    case ROW_LIST: put_list(draw, row, object); break;
    default: put_map(draw, row->sub, row_begin(draw->arena, row, object));
    }
}

static bool is_drawn(Draw *draw, const Schema *schema, const SchemaRow *row) {
    static const RowType left_out[] = {ROW_TEXT, ROW_NAME, ROW_FILE, ROW_STRENGTH};
    for (size_t k = 0; k < sizeof left_out / sizeof *left_out; k++)
        if (row->type == left_out[k]) return false;

    static const char *const always[] = {"frames",  "steps",     "sheets", "substeps",  "grid",     "size",
                                         "samples", "cell_size", "points", "translate", "position", "path"};
    if (row->type == ROW_BASE) return pick(draw, 2);
    if (strcmp(row->key, "measured") == 0) return false; // nothing is computed from it
    if (row->flags & ROW_SHORT) return false;
    if (strcmp(row->key, "height") == 0 && strcmp(schema->title, "the gas") == 0) return true;

    for (size_t k = 0; k < sizeof always / sizeof *always; k++)
        if (strcmp(always[k], row->key) == 0) return true;
    if (row->flags & ROW_REQUIRED) return true;

    return row->type == ROW_MAP || row->type == ROW_LIST ? pick(draw, 2) : pick(draw, 4) == 0;
}

static bool needs_file(const Schema *schema, unsigned kind) {
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        if (row->type == ROW_FILE && (row->flags & ROW_REQUIRED) && row_allowed(row, kind)) return true;
    }
    return false;
}

/// Chooses a kind that needs no file, and writes it.
static unsigned put_kind(Draw *draw, const Schema *schema) {
    const SchemaRow *row = NULL;
    for (int i = 0; i < schema->row_count; i++)
        if (strcmp(schema->rows[i].key, "kind") == 0) row = &schema->rows[i];
    int count = 0, kind;
    if (!row || !schema->kind_offset) return ~0u;

    while (row->names[count]) count++;
    do kind = pick(draw, count);
    while (!row->names[kind][0] || needs_file(schema, 1u << kind)); // kinds for programs have no name here
    put_key(draw, "kind");
    printf("\"%s\"", row->names[kind]);
    return 1u << kind;
}

static void put_map(Draw *draw, const Schema *schema, void *object) {
    bool outer = draw->first, path = false;
    if (!object) exit(2);
    draw->first = true;
    putchar('{');

    unsigned kind = put_kind(draw, schema);
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        if (!row_allowed(row, kind) || (kind != ~0u && strcmp(row->key, "kind") == 0)) continue;
        if (path && (row->type == ROW_LIST || row->type == ROW_ROTATION)) continue; // a place, or a path
        if (row->sub && needs_file(row->sub, ~0u)) continue;

        const bool paced = strcmp(row->key, "pace") == 0 || strcmp(row->key, "burn_by") == 0;
        const bool refused = (draw->keyed && paced) || (draw->paper && strcmp(row->key, "isotropic") == 0);
        if (refused || !is_drawn(draw, schema, row)) continue;

        draw->keyed |= (row->flags & ROW_KEYED) != 0;
        put_key(draw, row->key);
        put_value(draw, schema, row, object);
        path |= row->type == ROW_POSITION;
    }

    putchar('}');
    draw->first = outer;
}

/// The value at an end of a row's range; false if the row is no number, or has no ends but those of its type.
static bool end_of(const SchemaRow *row, bool high, double *end) {
    const bool real = row->type == ROW_FLOAT || row->type == ROW_VECTOR || row->type == ROW_PARAM ||
                      row->type == ROW_POSITION || row->type == ROW_ROTATION;
    const bool whole =
        row->type == ROW_INT || row->type == ROW_UINT32 || row->type == ROW_UINT64 || row->type == ROW_INTS;
    if ((!real && !whole) || !(row->max > row->min)) return false;

    *end = high ? row->max : row->min;
    if (real && !high && (row->flags & ROW_OPEN_MIN)) *end = (double)nextafterf((float)row->min, INFINITY);
    if (real && high && (row->flags & ROW_OPEN_MAX)) *end = (double)nextafterf((float)row->max, -INFINITY);
    return true;
}

/// One line of JSON for each number and each choice of a word, by its path from the scene; the first item of lists.
static void put_ends(const Schema *schema, const char *path) {
    const SchemaRow *kinds = NULL;
    for (int i = 0; i < schema->row_count; i++)
        if (strcmp(schema->rows[i].key, "kind") == 0) kinds = &schema->rows[i];

    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        char at[200], text[2][64];
        double end[2];
        snprintf(at, sizeof at, "%s%s%s%s", path, *path ? "." : "", row->key, row->type == ROW_LIST ? ".0" : "");
        if (row->sub && row->type != ROW_STRENGTH) put_ends(row->sub, at);

        const bool number = end_of(row, false, &end[0]) && end_of(row, true, &end[1]);
        if (!number && row->type != ROW_ENUM && row->type != ROW_BOOL) continue;

        printf("{\"path\": \"%s\", \"kinds\": [", at);
        bool first = true;
        for (int k = 0; kinds && kinds != row && kinds->names[k]; k++)
            if (row->kinds >> k & 1) printf("%s\"%s\"", first ? "" : ", ", kinds->names[k]), first = false;
        fputs("], \"values\": [", stdout);

        for (int k = 0; number && k < 2; k++) {
            quantity_print((float)end[k], row->dimension, text[k], sizeof text[k]);
            printf("%s%s", k ? ", " : "", text[k]);
        }

        if (number && (row->flags & ROW_INF)) fputs(", \"inf\"", stdout);
        if (row->type == ROW_BOOL) fputs("false, true", stdout);
        for (int k = 0; row->type == ROW_ENUM && row->names[k]; k++) printf("%s\"%s\"", k ? ", " : "", row->names[k]);
        printf("], \"varies\": %s, \"length\": %d}\n", row->type == ROW_PARAM ? "true" : "false",
               row->type == ROW_POSITION || row->type == ROW_ROTATION ? 3 : row->length);
    }
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "--ends") == 0) {
        put_ends(&schema_scene, "");
        return 0;
    }

    Draw draw = {.state = argc == 2 ? strtoull(argv[1], NULL, 10) * 7919 : 0, .arena = arena_create()};
    Scene *scene = draw.arena ? arena_new(draw.arena, 1, sizeof *scene) : NULL;
    if (argc != 2 || !scene || !default_scene(draw.arena, scene)) {
        fputs("usage: draw_scene SEED | --ends\n", stderr);
        return 2;
    }

    draw.wild = pick(&draw, 2);
    put_map(&draw, &schema_scene, scene);
    putchar('\n');
    arena_destroy(draw.arena);
    return 0;
}
