// Reads a plan: YAML by the tree of scene files, so that errors have their lines.
#include "sweep/plan_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/job.h"
#include "formats/formats.h"
#include "formats/number.h"
#include "common/printable.h"
#include "scene/messages.h"
#include "scene/units.h"

enum { PLAN_BYTES_MAX = 1 << 20 };

static const char *const methods[PLAN_METHODS] = {"grid", "list", "random", "latin-hypercube"};

static const char *const searches[PLAN_SEARCHES] = {"local", "global"};

void plan_complain(PlanReader *reader, const Node *node, const char *key, const char *expected) {
    char seen[NODE_WORDS];
    message_add(&reader->messages, &reader->text, node->location, "%s: expected %s, got %s", key, expected,
                node_describe(node, seen, sizeof seen));
}

// ---- values

/// A value in flow style, as --set reads it; strings keep their quotes.
static void write_flow(const Node *node, FILE *file) {
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
    for (const Node *child = node->first; child; child = child->next) {
        fputs(between, file);
        if (node->kind == NODE_MAP) fprintf(file, "%s: ", child->key);
        write_flow(child, file);
        between = ", ";
    }
    fputc(node->kind == NODE_LIST ? ']' : '}', file);
}

static char *flow_text(Plan *plan, const Node *node, const char *prefix) {
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

static void read_count(PlanReader *reader, const Node *node, const char *key, uint32_t low, uint32_t high,
                       uint32_t *count) {
    char expected[64];
    int64_t number = -1;
    if (node->kind == NODE_VALUE && !node->quoted) {
        const uint8_t *at = (const uint8_t *)node->text, *end = at + strlen(node->text);
        if (number_integer(&at, end, &number) != NUMBER_OK || at != end) number = -1;
    }
    snprintf(expected, sizeof expected, "a whole number from %u to %u", low, high);
    if (number >= low && number <= high) *count = (uint32_t)number;
    else plan_complain(reader, node, key, expected);
}

static bool read_switch(PlanReader *reader, const Node *node, const char *key) {
    const char *text = node->kind == NODE_VALUE ? node->text : "";
    const bool yes = strcmp(text, "yes") == 0 || strcmp(text, "true") == 0;
    if (!yes && strcmp(text, "no") != 0 && strcmp(text, "false") != 0) plan_complain(reader, node, key, "yes or no");
    return yes;
}

/// "850 C": the number, and the unit as written.
static void read_quantity(PlanReader *reader, const Node *node, const char *key, double *number, const char **unit) {
    *unit = "";
    if (node->kind == NODE_VALUE && !node->quoted) {
        const uint8_t *at = (const uint8_t *)node->text, *end = at + strlen(node->text);
        if (number_double(&at, end, number) == NUMBER_OK) {
            while (*at == ' ') at++;
            *unit = (const char *)at;
            return;
        }
    }
    plan_complain(reader, node, key, "a number, with a unit or without");
}

// ---- parameters

static void read_range(PlanReader *reader, const Node *map, PlanParameter *parameter) {
    const char *units[2] = {"", ""};
    bool ends[2] = {false, false};
    for (const Node *node = map->first; node; node = node->next) {
        const char *key = node->key;
        if (strcmp(key, "from") == 0) read_quantity(reader, node, key, &parameter->from, &units[0]), ends[0] = true;
        else if (strcmp(key, "to") == 0) read_quantity(reader, node, key, &parameter->to, &units[1]), ends[1] = true;
        else if (strcmp(key, "steps") == 0) read_count(reader, node, key, 2, PLAN_ROWS_MAX, &parameter->steps);
        else if (strcmp(key, "whole") == 0) parameter->whole = read_switch(reader, node, key);
        else if (strcmp(key, "logarithmic") == 0) parameter->logarithmic = read_switch(reader, node, key);
        else
            message_add(&reader->messages, &reader->text, node->key_location,
                        "unknown key '%s' of a range: expected from, to, steps, logarithmic or whole", shown(key).text);
    }
    parameter->unit = arena_text(reader->plan->arena, units[0], strlen(units[0]));
    if (!ends[0] || !ends[1])
        message_add(&reader->messages, &reader->text, map->location, "a range needs both 'from' and 'to'");
    else if (strcmp(units[0], units[1]) != 0)
        message_add(&reader->messages, &reader->text, map->location,
                    "a range needs one unit: 'from' has %s and 'to' has %s", *units[0] ? shown(units[0]).text : "none",
                    *units[1] ? shown(units[1]).text : "none");
    else if (parameter->logarithmic && !(parameter->from > 0 && parameter->to > 0))
        message_add(&reader->messages, &reader->text, map->location, "a logarithmic range must be above 0");
}

static void read_parameter(PlanReader *reader, const Node *node) {
    Plan *plan = reader->plan;
    PlanParameter *parameter = &plan->parameters[plan->parameter_count++];
    parameter->key = node->key;
    parameter->location = node->location;
    if (strcmp(node->key, "name") == 0)
        message_add(&reader->messages, &reader->text, node->key_location, "all rows have the scene's name");
    if (node->kind == NODE_MAP) {
        read_range(reader, node, parameter);
    } else if (node->kind == NODE_LIST && node->count) {
        parameter->values = arena_new(plan->arena, node->count, sizeof *parameter->values);
        for (const Node *value = node->first; value && parameter->values; value = value->next)
            parameter->values[parameter->count++] = flow_text(plan, value, "");
    } else {
        plan_complain(reader, node, node->key, "a list of values, or a range {from: A, to: B, steps: N}");
    }
}

static void read_parameters(PlanReader *reader, const Node *node) {
    Plan *plan = reader->plan;
    if (node->kind != NODE_MAP || !node->count || node->count > PLAN_PARAMETERS_MAX) {
        plan_complain(reader, node, "parameters", "a map of 1 to 64 keys of the scene");
        return;
    }
    plan->parameters = arena_new(plan->arena, node->count, sizeof *plan->parameters);
    for (const Node *child = node->first; child && plan->parameters; child = child->next) read_parameter(reader, child);
}

static void read_sets(PlanReader *reader, const Node *node) {
    Plan *plan = reader->plan;
    if (node->kind != NODE_MAP) {
        plan_complain(reader, node, "set", "a map of keys of the scene");
        return;
    }
    plan->sets = arena_new(plan->arena, (size_t)node->count + 1, sizeof *plan->sets);
    for (const Node *child = node->first; child && plan->sets; child = child->next) {
        char *prefix = arena_new(plan->arena, strlen(child->key) + 2, 1);
        if (!prefix) return;
        sprintf(prefix, "%s=", child->key);
        plan->sets[plan->set_count++] = flow_text(plan, child, prefix);
    }
}

// ---- the plan

char *plan_read_path(PlanReader *reader, const Node *node, const char *key) {
    if (node->kind != NODE_VALUE || !node->text[0]) {
        plan_complain(reader, node, key, "the path of a file");
        return NULL;
    }
    const char *folder = node->text[0] == '/' ? "" : reader->folder;
    char *path = arena_new(reader->plan->arena, strlen(folder) + strlen(node->text) + 1, 1);
    if (path) sprintf(path, "%s%s", folder, node->text);
    return path;
}

/// The index of a word in a list.
static int read_word(PlanReader *reader, const Node *node, const char *key, const char *const *words, int count,
                     const char *expected) {
    for (int i = 0; i < count && node->kind == NODE_VALUE; i++)
        if (strcmp(node->text, words[i]) == 0) return i;
    plan_complain(reader, node, key, expected);
    return 0;
}

static void read_key(PlanReader *reader, const Node *node) {
    Plan *plan = reader->plan;
    const char *key = node->key;
    if (strcmp(key, "scene") == 0) plan->scene = plan_read_path(reader, node, key);
    else if (strcmp(key, "method") == 0)
        plan->method =
            (PlanMethod)read_word(reader, node, key, methods, PLAN_METHODS, "grid, list, random or latin-hypercube");
    else if (strcmp(key, "samples") == 0) read_count(reader, node, key, 1, PLAN_ROWS_MAX, &plan->samples);
    else if (strcmp(key, "seed") == 0) read_count(reader, node, key, 0, UINT32_MAX, &plan->seed);
    else if (strcmp(key, "set") == 0) read_sets(reader, node);
    else if (strcmp(key, "parameters") == 0) read_parameters(reader, node);
    else if (strcmp(key, "target") == 0) plan_read_target(reader, node);
    else if (strcmp(key, "search") == 0)
        plan->search = (PlanSearch)read_word(reader, node, key, searches, PLAN_SEARCHES, "local or global");
    else if (strcmp(key, "evaluations") == 0) read_count(reader, node, key, 1, PLAN_ROWS_MAX, &plan->evaluations);
    else
        message_add(&reader->messages, &reader->text, node->key_location,
                    "unknown key '%s' of a plan: expected scene, method, samples, seed, set, parameters, and for a fit "
                    "target, search, evaluations",
                    shown(key).text);
}

static void check_plan(PlanReader *reader, const Node *root, bool fit) {
    Plan *plan = reader->plan;
    const bool drawn = plan->method == PLAN_RANDOM || plan->method == PLAN_LATIN_HYPERCUBE;
    if (!plan->scene) message_add(&reader->messages, &reader->text, root->location, "a plan needs 'scene'");
    if (!plan->parameter_count)
        message_add(&reader->messages, &reader->text, root->location, "a plan needs 'parameters'");
    if (drawn && !plan->samples)
        message_add(&reader->messages, &reader->text, root->location, "method %s needs 'samples'",
                    methods[plan->method]);
    if (fit && !plan->target.given && !reader->messages.count)
        message_add(&reader->messages, &reader->text, root->location, "a fit needs 'target'");
    if (!fit && plan->target.given)
        message_add(&reader->messages, &reader->text, root->location, "a plan with 'target' belongs to singe fit");
    if (reader->messages.count || arena_failed(plan->arena)) return;
    uint32_t parameter = 0;
    char message[200];
    if (!plan_make_rows(plan, &parameter, message, sizeof message) && !arena_failed(plan->arena))
        message_add(&reader->messages, &reader->text, plan->parameters[parameter].location, "%s", message);
}

static void read_plan(PlanReader *reader, bool fit) {
    Plan *plan = reader->plan;
    const SceneText *text = &reader->text;
    Node *root = tree_read(plan->arena, text, text->bytes, text->size, (SceneLocation){0}, &reader->messages);
    if (!root) return;
    if (root->kind != NODE_MAP) {
        plan_complain(reader, root, "a plan", "a map (key: value)");
        return;
    }
    for (const Node *node = root->first; node; node = node->next) read_key(reader, node);
    check_plan(reader, root, fit);
}

/// "plans/wind.yaml": the folder "plans/" and the name "wind".
static void take_path(PlanReader *reader, const char *path) {
    Plan *plan = reader->plan;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    reader->folder = arena_text(plan->arena, path, (size_t)(name - path));
    plan->name = arena_text(plan->arena, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
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
    PlanReader reader = {.plan = plan, .text = {.name = path, .bytes = (const char *)bytes.data, .size = bytes.size}};
    take_path(&reader, path);
    read_plan(&reader, fit);
    const bool failed = arena_failed(plan->arena);
    const bool bad = reader.messages.count || reader.messages.left_out;
    scene_messages_print(&reader.messages, stderr);
    scene_messages_free(&reader.messages);
    bytes_free(&bytes);
    if (failed) console_error(console, "out of memory");
    if (failed || bad) plan_free(plan);
    return failed ? EXIT_FAILED : bad ? EXIT_INPUT : EXIT_GOOD;
}

void plan_free(Plan *plan) {
    if (plan->arena) arena_destroy(plan->arena);
    *plan = (Plan){0};
}

static bool ends_alike(const Plan *plan, uint32_t parameter, const char *label) {
    const size_t length = strlen(label);
    for (uint32_t i = 0; i < plan->parameter_count; i++) {
        const char *key = plan->parameters[i].key;
        const size_t key_length = strlen(key);
        if (i != parameter && key_length > length && strcmp(key + key_length - length, label) == 0) return true;
    }
    return false;
}

const char *plan_label(const Plan *plan, uint32_t parameter) {
    const char *key = plan->parameters[parameter].key, *label = key + strlen(key);
    do {
        label -= label > key;
        while (label > key && label[-1] != '.') label--;
    } while (label > key && ends_alike(plan, parameter, label));
    return label;
}
