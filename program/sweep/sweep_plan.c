// Reads a plan as scenes are read, by tables of its keys, so that errors have their lines.
#include "sweep/sweep_plan.h"

#include <stdlib.h>

#include "cli/job.h"
#include "common/printable.h"
#include "formats/number.h"
#include "scene/schema_rows.h"

enum { PLAN_BYTES_MAX = 1 << 20, PLAN_KEYS_MAX = 1000 };

/// Reports an error: what was expected at a node, and what it is.
static void plan_complain(Reader *reader, const YamlNode *node, const char *key, const char *expected) {
    char seen[NODE_WORDS];
    complain(reader, node->location, "%s: expected %s, got %s", key, expected, node_describe(node, seen, sizeof seen));
}

// ---- tables of keys

static const SchemaRow curve_rows[] = {
    {"file", ROW_FILE, DIM_NONE, AT(PlanTarget, curve), .flags = ROW_REQUIRED, .doc = "a CSV table"},
    {"probe", ROW_TEXT, DIM_NONE, AT(PlanTarget, probe), .flags = ROW_REQUIRED, .doc = "the name of the scene's probe"},
};
static const Schema schema_curve = {.title = "a curve", .size = sizeof(PlanTarget), ROWS(curve_rows)};

static void finish_target(Reader *reader, const YamlNode *map, void *object) {
    PlanTarget *target = object;
    const YamlNode *speed = node_find(map, "front_speed");
    if (!map->count) complain(reader, map->location, "a target needs front_speed, temperature or masks");
    if (target->speed_text && (quantity_read(target->speed_text, DIM_SPEED, &target->front_speed) ||
                               !(target->front_speed > 0 && target->front_speed < 1e3)))
        plan_complain(reader, speed, "front_speed", "a speed above 0 such as 2.5 mm/s");
}

static const SchemaRow target_rows[] = {
    {"front_speed", ROW_TEXT, DIM_NONE, AT(PlanTarget, speed_text), .doc = "of the last frame"},
    {"temperature", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_curve, .doc = "of a probe over time"},
    {"masks", ROW_FILE, DIM_NONE, AT(PlanTarget, masks), .flags = ROW_NUMBERED, .doc = "where the sheet has burnt"},
};
static const Schema schema_target = {
    .title = "a target", .size = sizeof(PlanTarget), ROWS(target_rows), .finish = finish_target};

typedef struct PlanEnds {
    char *from, *to;
    PlanParameter parameter;
} PlanEnds;

static const SchemaRow range_rows[] = {
    {"from", ROW_TEXT, DIM_NONE, AT(PlanEnds, from), .flags = ROW_REQUIRED, .doc = "its first value"},
    {"to", ROW_TEXT, DIM_NONE, AT(PlanEnds, to), .flags = ROW_REQUIRED, .doc = "its last value"},
    {"steps", ROW_UINT32, DIM_NONE, AT(PlanEnds, parameter.steps), WITHIN(2, PLAN_ROWS_MAX), .doc = "how many values"},
    {"logarithmic", ROW_BOOL, DIM_NONE, AT(PlanEnds, parameter.logarithmic), .doc = "equal ratios"},
    {"whole", ROW_BOOL, DIM_NONE, AT(PlanEnds, parameter.whole), .doc = "whole numbers"},
};
static const Schema schema_range = {.title = "a range", .size = sizeof(PlanEnds), ROWS(range_rows)};

static const char *const methods[] = {"grid", "list", "random", "latin-hypercube", NULL};
static const char *const searches[] = {"local", "global", NULL};

static const SchemaRow plan_rows[] = {
    {"scene", ROW_FILE, DIM_NONE, AT(Plan, scene), .flags = ROW_REQUIRED, .doc = "the scene file"},
    {"from", ROW_FILE, DIM_NONE, AT(Plan, from), .doc = "DIR:FRAME of an earlier run"},
    {"method", ROW_ENUM, DIM_NONE, AT(Plan, method), .names = methods, .doc = "of making rows"},
    {"samples", ROW_UINT32, DIM_NONE, AT(Plan, samples), WITHIN(1, PLAN_ROWS_MAX), .doc = "rows that are drawn"},
    {"seed", ROW_UINT32, DIM_NONE, AT(Plan, seed), .doc = "of the random numbers"},
    {"set", ROW_NODE, DIM_NONE, AT(Plan, set), .doc = "keys of the scene and their values for all rows"},
    {"parameters", ROW_NODE, DIM_NONE, AT(Plan, varied), .flags = ROW_REQUIRED, .doc = "keys of the scene that vary"},
    {"target", ROW_MAP, DIM_NONE, AT(Plan, target), EXTRA(Plan, target.given), .sub = &schema_target,
     .doc = "of a fit"},
    {"search", ROW_ENUM, DIM_NONE, AT(Plan, search), .names = searches, .doc = "of a fit"},
    {"evaluations", ROW_UINT32, DIM_NONE, AT(Plan, evaluations), WITHIN(1, PLAN_ROWS_MAX), .doc = "at most, of a fit"},
};
static const Schema schema_plan = {.title = "a plan", .size = sizeof(Plan), ROWS(plan_rows)};

// ---- keys of the scene

/// A value in flow style, as --set reads it; strings keep their quotes.
static void write_flow(const YamlNode *node, FILE *file) {
    const char *between = "";
    if (node->kind == NODE_VALUE && !node->quoted) {
        fputs(node->text, file);
        return;
    }

    if (node->kind == NODE_VALUE) {
        fputc('"', file);
        for (const char *c = node->text; *c; c++)
            if (*c == '\n') fputs("\\n", file);
            else fprintf(file, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
        fputc('"', file);
        return;
    }

    fputc(node->kind == NODE_LIST ? '[' : '{', file);

    for (const YamlNode *child = node->first; child; child = child->next) {
        fputs(between, file);
        if (node->kind == NODE_MAP) fprintf(file, "%s: ", child->key);
        write_flow(child, file);
        between = ", ";
    }

    fputc(node->kind == NODE_LIST ? ']' : '}', file);
}

static char *flow_text(Plan *plan, const YamlNode *node, const char *prefix) {
    char *text = NULL, *kept = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file) {
        fputs(prefix, file);
        write_flow(node, file);
    }

    if (file && fclose(file) == 0 && text) kept = arena_text(plan->arena, text, size);
    else arena_fail(plan->arena);
    free(text);
    return kept;
}

/// Refuses keys that a map has twice: the last would count for some readers and the first for others. Returns false
/// after an error.
static bool check_once(Reader *reader, const YamlNode *map, const char *what) {
    const uint32_t before = message_total(reader->messages);
    if (map->count > PLAN_KEYS_MAX)
        complain(reader, map->location, "%s has %u keys; at most %d are possible", what, (unsigned)map->count,
                 PLAN_KEYS_MAX);

    for (const YamlNode *node = map->count > PLAN_KEYS_MAX ? NULL : map->first; node; node = node->next) {
        const YamlNode *last = node_find(map, node->key);
        if (last == node) continue;
        complain(reader, last->key_location, "'%s' is given twice in %s", shown(node->key).text, what);
    }

    return message_total(reader->messages) == before;
}

/// "850 C": the number, and the unit as written. Returns NULL after an error.
static const char *read_end(Reader *reader, const YamlNode *map, const char *key, const char *text, double *number) {
    const uint8_t *at = (const uint8_t *)text;
    if (number_double(&at, at + strlen(text), number) != NUMBER_OK) {
        plan_complain(reader, node_find(map, key), key, "a number, with a unit or without");
        return NULL;
    }

    while (*at == ' ') at++;
    return (const char *)at;
}

static void read_range(Reader *reader, const YamlNode *map, PlanParameter *parameter) {
    PlanEnds ends = {.parameter = *parameter};
    schema_read(reader, &schema_range, map, &ends);
    *parameter = ends.parameter;
    if (!ends.from || !ends.to) return;

    const char *unit = read_end(reader, map, "from", ends.from, &parameter->from);
    const char *other = read_end(reader, map, "to", ends.to, &parameter->to);
    if (!unit || !other) return;

    parameter->unit = unit;
    if (strcmp(unit, other) != 0)
        complain(reader, map->location, "a range needs one unit: 'from' has %s and 'to' has %s",
                 *unit ? shown(unit).text : "none", *other ? shown(other).text : "none");
    else if (parameter->logarithmic && !(parameter->from > 0 && parameter->to > 0))
        complain(reader, map->location, "a logarithmic range must be above 0");
}

static void read_sets(Reader *reader, Plan *plan) {
    const YamlNode *node = plan->set;
    if (node->kind != NODE_MAP) plan_complain(reader, node, "set", "a map of keys of the scene");
    if (node->kind != NODE_MAP || !check_once(reader, node, "set")) return;

    plan->sets = arena_new(plan->arena, (size_t)node->count + 1, sizeof *plan->sets);
    plan->set_locations = arena_new(plan->arena, (size_t)node->count + 1, sizeof *plan->set_locations);
    for (const YamlNode *child = node->first; child && plan->sets && plan->set_locations; child = child->next) {
        char *prefix = arena_new(plan->arena, strlen(child->key) + 2, 1);
        if (!prefix) return;
        sprintf(prefix, "%s=", child->key);
        plan->set_locations[plan->set_count] = child->key_location;
        plan->sets[plan->set_count++] = flow_text(plan, child, prefix);
    }
}

static void read_parameters(Reader *reader, Plan *plan) {
    const YamlNode *node = plan->varied;
    if (node->kind != NODE_MAP || !node->count || node->count > PLAN_PARAMETERS_MAX) {
        plan_complain(reader, node, "parameters", "a map of 1 to 64 keys of the scene");
        return;
    }

    if (!check_once(reader, node, "parameters")) return;
    plan->parameters = arena_new(plan->arena, node->count, sizeof *plan->parameters);

    for (const YamlNode *child = node->first; child && plan->parameters; child = child->next) {
        PlanParameter *parameter = &plan->parameters[plan->parameter_count++];
        parameter->key = child->key;
        parameter->location = child->location;
        parameter->key_location = child->key_location;
        if (strcmp(child->key, "name") == 0) complain(reader, child->key_location, "all rows have the scene's name");

        if (child->kind == NODE_MAP) {
            read_range(reader, child, parameter);
        } else if (child->kind == NODE_LIST && child->count) {
            parameter->values = arena_new(plan->arena, child->count, sizeof *parameter->values);
            for (const YamlNode *value = child->first; value && parameter->values; value = value->next)
                parameter->values[parameter->count++] = flow_text(plan, value, "");
        } else {
            plan_complain(reader, child, child->key, "a list of values, or a range {from: A, to: B, steps: N}");
        }
    }
}

/// The next step of a path of --set, as tree_set takes them apart: "sources[01].start" has the steps of
/// "sources.1.start". Returns its length; 0 at the end.
static size_t path_step(const char **rest, const char **step) {
    const char *c = *rest;
    c += strspn(c, ".[]");
    size_t length = strcspn(c, ".[]=");
    *rest = c + length;
    for (; length > 1 && *c == '0' && c[1] >= '0' && c[1] <= '9'; length--) c++;
    *step = c;
    return length;
}

/// Whether a value at path `a` replaces what is set at `b`: it is the same, or contains it.
static bool path_covers(const char *a, const char *b) {
    for (;;) {
        const char *step, *other;
        const size_t length = path_step(&a, &step), size = path_step(&b, &other);
        if (!length) return true;
        if (length != size || memcmp(step, other, size) != 0) return false;
    }
}

/// What a set value has at the path, which begins with `skipped`, the set's own: a value without parts where the path
/// goes on, or NULL.
static const YamlNode *path_blocked(const YamlNode *node, const char *skipped, const char *path) {
    const char *step;
    while (path_step(&skipped, &step)) path_step(&path, &step);

    for (size_t length; node && (length = path_step(&path, &step));) {
        const YamlNode *child = node->first;
        if (node->kind == NODE_VALUE) return node;
        if (node->kind == NODE_LIST)
            for (unsigned long index = strtoul(step, NULL, 10); child && index; index--) child = child->next;
        else
            while (child && (strlen(child->key) != length || memcmp(child->key, step, length) != 0))
                child = child->next;
        node = child;
    }

    return NULL;
}

/// Refuses parameters that replace each other or what `set` gives. A parameter may be a part of what `set` gives as a map.
static void check_overlaps(Reader *reader, const Plan *plan) {
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        const PlanParameter *parameter = &plan->parameters[p];
        const YamlNode *given = plan->set ? plan->set->first : NULL;
        for (uint32_t i = 0; i < plan->set_count; i++, given = given->next) {
            const bool inside = path_covers(plan->sets[i], parameter->key);
            const YamlNode *word = inside ? path_blocked(given, plan->sets[i], parameter->key) : NULL;

            if (path_covers(parameter->key, plan->sets[i]))
                complain(reader, parameter->key_location, "'%s' is already set in line %d; remove one",
                         shown(parameter->key).text, plan->set_locations[i].line);
            if (word)
                complain(reader, word->location,
                         "'%s' sets a part of this, so 'set' must give a map (of a material: {base: %s})",
                         shown(parameter->key).text, shown(word->text).text);
        }

        for (uint32_t q = 0; q < p; q++)
            if (path_covers(parameter->key, plan->parameters[q].key) ||
                path_covers(plan->parameters[q].key, parameter->key))
                complain(reader, parameter->key_location, "'%s' and '%s' set the same value; give one of them",
                         shown(parameter->key).text, shown(plan->parameters[q].key).text);
    }
}

static void read_plan(Reader *reader, Plan *plan, bool fit) {
    const SceneText *text = reader->text;
    SceneMessages *messages = reader->messages;
    YamlNode *root = tree_read(plan->arena, text, text->bytes, text->size, (SceneLocation){0}, messages);
    if (!root) return;
    if (root->kind != NODE_MAP) {
        plan_complain(reader, root, "a plan", "a map (key: value)");
        return;
    }

    schema_read(reader, &schema_plan, root, plan);
    if (plan->set) read_sets(reader, plan);
    if (plan->varied) read_parameters(reader, plan);
    if (!arena_failed(plan->arena)) check_overlaps(reader, plan);

    const bool drawn = plan->method == PLAN_RANDOM || plan->method == PLAN_LATIN_HYPERCUBE;
    if (drawn && !node_find(root, "samples"))
        message_add(messages, text, root->location, "method %s needs 'samples'", methods[plan->method]);
    if (fit && !plan->target.given && !messages->count)
        message_add(messages, text, root->location, "a fit needs 'target'");
    if (!fit && plan->target.given)
        message_add(messages, text, root->location, "a plan with 'target' belongs to singe fit");
    if (messages->count || arena_failed(plan->arena)) return;

    uint32_t at = 0;
    char why[200] = "";
    plan_make_rows(plan, fit, &at, why, sizeof why);
    if (*why) message_add(messages, text, plan->parameters[at].location, "%s", why);
}

ExitCode plan_read(const char *path, bool fit, Console *console, Plan *plan) {
    Bytes bytes = {0};
    SingeError error = {0};

    *plan = (Plan){.arena = arena_create(), .evaluations = 40};
    SingeResult result =
        plan->arena ? file_read_max(path, PLAN_BYTES_MAX, (SingeAllocator){0}, &bytes, &error) : SINGE_ERROR_MEMORY;
    if (result) {
        error.code = result;
        console_result(console, &error);
        plan_free(plan);
        return job_exit(result);
    }

    // "plans/wind.yaml": the folder "plans/" and the name "wind"
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    SceneText text = {.name = path, .bytes = (const char *)bytes.data, .size = bytes.size};
    SceneMessages messages = {0};
    Reader reader = {.arena = plan->arena,
                     .text = &text,
                     .messages = &messages,
                     .prefix = arena_text(plan->arena, path, (size_t)(name - path))};

    plan->name = arena_text(plan->arena, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
    if (reader.prefix) read_plan(&reader, plan, fit);

    messages_sort(&messages, 0);
    const bool failed = arena_failed(plan->arena);
    const bool bad = message_total(&messages) > 0;

    scene_messages_print(&messages, stderr);
    scene_messages_free(&messages);
    bytes_free(&bytes);
    if (failed) console_error(console, "out of memory");
    if (failed || bad) plan_free(plan);
    return failed ? EXIT_FAILED : bad ? EXIT_INPUT : EXIT_GOOD;
}

void plan_free(Plan *plan) {
    if (plan->arena) arena_destroy(plan->arena);
    *plan = (Plan){0};
}

const char *plan_label(const Plan *plan, uint32_t parameter) {
    const char *key = plan->parameters[parameter].key, *label = key + strlen(key);
    for (bool alike = true; alike;) {
        label -= label > key;
        while (label > key && label[-1] != '.') label--;

        const size_t length = strlen(label);
        alike = false;
        for (uint32_t i = 0; i < plan->parameter_count && label > key; i++) {
            const char *other = plan->parameters[i].key;
            const size_t size = strlen(other);
            alike = alike || (i != parameter && size > length && strcmp(other + size - length, label) == 0);
        }
    }

    return label;
}
