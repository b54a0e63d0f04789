// Reads a plan: YAML by the tree of scene files, so that errors have their lines.
#include "sweep/sweep_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/job.h"
#include "common/printable.h"
#include "formats/formats.h"
#include "formats/number.h"
#include "scene/messages.h"
#include "scene/units.h"

typedef struct PlanReader {
    Plan *plan;
    SceneText text;
    SceneMessages messages;
    const char *folder; ///< of the plan, "" or ending in a slash
} PlanReader;

enum { PLAN_BYTES_MAX = 1 << 20, PLAN_KEYS_MAX = 1000 };

static const char *const methods[PLAN_METHODS] = {"grid", "list", "random", "latin-hypercube"};

static const char *const searches[PLAN_SEARCHES] = {"local", "global"};

/// Reports an error: what was expected at a node, and what it is.
static void plan_complain(PlanReader *reader, const YamlNode *node, const char *key, const char *expected) {
    char seen[NODE_WORDS];
    message_add(&reader->messages, &reader->text, node->location, "%s: expected %s, got %s", key, expected,
                node_describe(node, seen, sizeof seen));
}

// ---- values

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

static void read_count(PlanReader *reader, const YamlNode *node, const char *key, uint32_t low, uint32_t high,
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

static bool read_switch(PlanReader *reader, const YamlNode *node, const char *key) {
    const char *text = node->kind == NODE_VALUE ? node->text : "";
    const bool yes = strcmp(text, "yes") == 0 || strcmp(text, "true") == 0;
    if (!yes && strcmp(text, "no") != 0 && strcmp(text, "false") != 0) plan_complain(reader, node, key, "yes or no");
    return yes;
}

/// A path from the plan's folder; NULL after an error.
static char *read_path(PlanReader *reader, const YamlNode *node, const char *key) {
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
static int read_word(PlanReader *reader, const YamlNode *node, const char *key, const char *const *words, int count,
                     const char *expected) {
    for (int i = 0; i < count && node->kind == NODE_VALUE; i++)
        if (strcmp(node->text, words[i]) == 0) return i;
    plan_complain(reader, node, key, expected);
    return 0;
}

/// Refuses keys that a map has twice: the last would count for some readers and the first for others. Returns false
/// after an error.
static bool check_once(PlanReader *reader, const YamlNode *map, const char *what) {
    const uint32_t before = message_total(&reader->messages);
    if (map->kind == NODE_MAP && map->count > PLAN_KEYS_MAX)
        message_add(&reader->messages, &reader->text, map->location, "%s has %u keys; at most %d are possible", what,
                    (unsigned)map->count, PLAN_KEYS_MAX);
    else if (map->kind == NODE_MAP)
        for (const YamlNode *node = map->first; node; node = node->next) {
            const YamlNode *last = node_find(map, node->key);
            if (last == node) continue;
            message_add(&reader->messages, &reader->text, last->key_location, "'%s' is given twice in %s",
                        shown(node->key).text, what);
        }
    return message_total(&reader->messages) == before;
}

// ---- parameters

static void read_range(PlanReader *reader, const YamlNode *map, PlanParameter *parameter) {
    const char *units[2] = {"", ""};
    bool ends[2] = {false, false};
    if (!check_once(reader, map, "a range")) return;

    for (const YamlNode *node = map->first; node; node = node->next) {
        const char *key = node->key;
        const int end = strcmp(key, "from") == 0 ? 0 : strcmp(key, "to") == 0 ? 1 : -1;
        if (end >= 0) {
            // "850 C": the number, and the unit as written
            const bool plain = node->kind == NODE_VALUE && !node->quoted;
            const uint8_t *at = (const uint8_t *)(plain ? node->text : ""), *last = at + strlen((const char *)at);
            ends[end] = true;
            if (number_double(&at, last, end ? &parameter->to : &parameter->from) != NUMBER_OK) {
                plan_complain(reader, node, key, "a number, with a unit or without");
                continue;
            }
            while (*at == ' ') at++;
            units[end] = (const char *)at;
        } else if (strcmp(key, "steps") == 0) {
            read_count(reader, node, key, 2, PLAN_ROWS_MAX, &parameter->steps);
        } else if (strcmp(key, "whole") == 0) {
            parameter->whole = read_switch(reader, node, key);
        } else if (strcmp(key, "logarithmic") == 0) {
            parameter->logarithmic = read_switch(reader, node, key);
        } else {
            message_add(&reader->messages, &reader->text, node->key_location,
                        "unknown key '%s' of a range: expected from, to, steps, logarithmic or whole", shown(key).text);
        }
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

/// The target of a fit.
static void read_target(PlanReader *reader, const YamlNode *map) {
    PlanTarget *target = &reader->plan->target;
    if (map->kind != NODE_MAP || !map->count) {
        plan_complain(reader, map, "target", "a map of front_speed, temperature or masks");
        return;
    }

    target->given = true;
    if (!check_once(reader, map, "a target")) return;

    for (const YamlNode *node = map->first; node; node = node->next) {
        const char *key = node->key;
        if (strcmp(key, "front_speed") == 0) {
            if (node->kind != NODE_VALUE || quantity_read(node->text, DIM_SPEED, &target->front_speed) ||
                !(target->front_speed > 0 && target->front_speed < 1e3))
                plan_complain(reader, node, key, "a speed above 0 such as 2.5 mm/s");
        } else if (strcmp(key, "temperature") == 0 && node->kind != NODE_MAP) {
            plan_complain(reader, node, key, "{file: CURVE.csv, probe: NAME}");
        } else if (strcmp(key, "temperature") == 0) {
            if (!check_once(reader, node, "a curve")) return;
            for (const YamlNode *part = node->first; part; part = part->next)
                if (strcmp(part->key, "file") == 0) target->curve = read_path(reader, part, "file");
                else if (strcmp(part->key, "probe") == 0 && part->kind == NODE_VALUE) target->probe = part->text;
                else
                    message_add(&reader->messages, &reader->text, part->key_location,
                                "unknown key '%s' of a curve: expected file or probe", shown(part->key).text);
            if (!node_find(node, "file") || !node_find(node, "probe"))
                message_add(&reader->messages, &reader->text, node->location, "a curve needs 'file' and 'probe'");
        } else if (strcmp(key, "masks") == 0) {
            char *path = target->masks = read_path(reader, node, key);
            const char *name = path ? strrchr(path, '/') : NULL, *run = path ? strchr(name ? name : path, '#') : NULL;
            const bool elsewhere = name && memchr(path, '#', (size_t)(name - path));
            if (path && (!run || strchr(run + strspn(run, "#"), '#') || elsewhere))
                plan_complain(reader, node, key, "a file name with one run of # for the frame's number");
        } else {
            message_add(&reader->messages, &reader->text, node->key_location,
                        "unknown key '%s' of a target: expected front_speed, temperature or masks", shown(key).text);
        }
    }
}

// ---- the plan

static void read_sets(PlanReader *reader, const YamlNode *node) {
    Plan *plan = reader->plan;
    if (!check_once(reader, node, "set")) return;
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

static void read_parameters(PlanReader *reader, const YamlNode *node) {
    Plan *plan = reader->plan;
    if (!check_once(reader, node, "parameters")) return;
    plan->parameters = arena_new(plan->arena, node->count, sizeof *plan->parameters);

    for (const YamlNode *child = node->first; child && plan->parameters; child = child->next) {
        PlanParameter *parameter = &plan->parameters[plan->parameter_count++];
        parameter->key = child->key;
        parameter->location = child->location;
        parameter->key_location = child->key_location;
        if (strcmp(child->key, "name") == 0)
            message_add(&reader->messages, &reader->text, child->key_location, "all rows have the scene's name");
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

static void read_key(PlanReader *reader, const YamlNode *node) {
    Plan *plan = reader->plan;
    const char *key = node->key;
    if (strcmp(key, "scene") == 0) {
        plan->scene = read_path(reader, node, key);
    } else if (strcmp(key, "from") == 0) {
        plan->from = read_path(reader, node, key);
    } else if (strcmp(key, "method") == 0) {
        plan->method =
            (PlanMethod)read_word(reader, node, key, methods, PLAN_METHODS, "grid, list, random or latin-hypercube");
    } else if (strcmp(key, "samples") == 0) {
        read_count(reader, node, key, 1, PLAN_ROWS_MAX, &plan->samples);
    } else if (strcmp(key, "seed") == 0) {
        read_count(reader, node, key, 0, UINT32_MAX, &plan->seed);
    } else if (strcmp(key, "set") == 0 && node->kind != NODE_MAP) {
        plan_complain(reader, node, "set", "a map of keys of the scene");
    } else if (strcmp(key, "set") == 0) {
        read_sets(reader, node);
    } else if (strcmp(key, "parameters") == 0 &&
               (node->kind != NODE_MAP || !node->count || node->count > PLAN_PARAMETERS_MAX)) {
        plan_complain(reader, node, "parameters", "a map of 1 to 64 keys of the scene");
    } else if (strcmp(key, "parameters") == 0) {
        read_parameters(reader, node);
    } else if (strcmp(key, "target") == 0) {
        read_target(reader, node);
    } else if (strcmp(key, "search") == 0) {
        plan->search = (PlanSearch)read_word(reader, node, key, searches, PLAN_SEARCHES, "local or global");
    } else if (strcmp(key, "evaluations") == 0) {
        read_count(reader, node, key, 1, PLAN_ROWS_MAX, &plan->evaluations);
    } else {
        message_add(
            &reader->messages, &reader->text, node->key_location,
            "unknown key '%s' of a plan: expected scene, from, method, samples, seed, set, parameters, and for a fit "
            "target, search, evaluations",
            shown(key).text);
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
static void check_overlaps(PlanReader *reader, const YamlNode *set) {
    const Plan *plan = reader->plan;
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        const PlanParameter *parameter = &plan->parameters[p];
        const YamlNode *given = set ? set->first : NULL;
        for (uint32_t i = 0; i < plan->set_count; i++, given = given->next) {
            const bool inside = path_covers(plan->sets[i], parameter->key);
            const YamlNode *word = inside ? path_blocked(given, plan->sets[i], parameter->key) : NULL;
            if (path_covers(parameter->key, plan->sets[i]))
                message_add(&reader->messages, &reader->text, parameter->key_location,
                            "'%s' is already set in line %d; remove one", shown(parameter->key).text,
                            plan->set_locations[i].line);
            if (word)
                message_add(&reader->messages, &reader->text, word->location,
                            "'%s' sets a part of this, so 'set' must give a map (of a material: {base: %s})",
                            shown(parameter->key).text, shown(word->text).text);
        }

        for (uint32_t q = 0; q < p; q++)
            if (path_covers(parameter->key, plan->parameters[q].key) ||
                path_covers(plan->parameters[q].key, parameter->key))
                message_add(&reader->messages, &reader->text, parameter->key_location,
                            "'%s' and '%s' set the same value; give one of them", shown(parameter->key).text,
                            shown(plan->parameters[q].key).text);
    }
}

static void read_plan(PlanReader *reader, bool fit) {
    Plan *plan = reader->plan;
    const SceneText *text = &reader->text;
    SceneMessages *messages = &reader->messages;
    YamlNode *root = tree_read(plan->arena, text, text->bytes, text->size, (SceneLocation){0}, messages);
    if (!root) return;
    if (root->kind != NODE_MAP) {
        plan_complain(reader, root, "a plan", "a map (key: value)");
        return;
    }

    if (!check_once(reader, root, "the plan")) return;
    for (const YamlNode *node = root->first; node; node = node->next) read_key(reader, node);
    if (!arena_failed(plan->arena)) check_overlaps(reader, node_find(root, "set"));

    const bool drawn = plan->method == PLAN_RANDOM || plan->method == PLAN_LATIN_HYPERCUBE;
    if (!node_find(root, "scene")) message_add(messages, text, root->location, "a plan needs 'scene'");
    if (!node_find(root, "parameters")) message_add(messages, text, root->location, "a plan needs 'parameters'");
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
    PlanReader reader = {.plan = plan,
                         .text = {.name = path, .bytes = (const char *)bytes.data, .size = bytes.size},
                         .folder = arena_text(plan->arena, path, (size_t)(name - path))};
    plan->name = arena_text(plan->arena, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
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
