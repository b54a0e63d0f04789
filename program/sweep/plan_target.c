// Reads the target of a fit from its plan.
#include <stdio.h>
#include <string.h>

#include "common/printable.h"
#include "scene/units.h"
#include "sweep/plan_reader.h"

static void read_curve(PlanReader *reader, const YamlNode *map) {
    PlanTarget *target = &reader->plan->target;
    if (map->kind != NODE_MAP) {
        plan_complain(reader, map, "temperature", "{file: CURVE.csv, probe: NAME}");
        return;
    }
    for (const YamlNode *node = map->first; node; node = node->next)
        if (strcmp(node->key, "file") == 0) target->curve = plan_read_path(reader, node, "file");
        else if (strcmp(node->key, "probe") == 0 && node->kind == NODE_VALUE) target->probe = node->text;
        else
            message_add(&reader->messages, &reader->text, node->key_location,
                        "unknown key '%s' of a curve: expected file or probe", shown(node->key).text);
    if (!node_find(map, "file") || !node_find(map, "probe"))
        message_add(&reader->messages, &reader->text, map->location, "a curve needs 'file' and 'probe'");
}

static void read_masks(PlanReader *reader, const YamlNode *node) {
    char *path = plan_read_path(reader, node, "masks");
    const char *name = path ? strrchr(path, '/') : NULL, *run = path ? strchr(name ? name : path, '#') : NULL;
    reader->plan->target.masks = path;
    if (path && (!run || strchr(run + strspn(run, "#"), '#') || (name && memchr(path, '#', (size_t)(name - path)))))
        plan_complain(reader, node, "masks", "a file name with one run of # for the frame's number");
}

void plan_read_target(PlanReader *reader, const YamlNode *map) {
    PlanTarget *target = &reader->plan->target;
    if (map->kind != NODE_MAP || !map->count) {
        plan_complain(reader, map, "target", "a map of front_speed, temperature or masks");
        return;
    }
    target->given = true;
    for (const YamlNode *node = map->first; node; node = node->next) {
        const char *key = node->key;
        if (strcmp(key, "front_speed") == 0) {
            if (node->kind != NODE_VALUE || quantity_read(node->text, DIM_SPEED, &target->front_speed) ||
                !(target->front_speed > 0 && target->front_speed < 1e3))
                plan_complain(reader, node, key, "a speed above 0 such as 2.5 mm/s");
        } else if (strcmp(key, "temperature") == 0) {
            read_curve(reader, node);
        } else if (strcmp(key, "masks") == 0) {
            read_masks(reader, node);
        } else {
            message_add(&reader->messages, &reader->text, node->key_location,
                        "unknown key '%s' of a target: expected front_speed, temperature or masks", shown(key).text);
        }
    }
}
