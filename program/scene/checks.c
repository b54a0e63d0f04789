// Checks that involve more than one key.
#include "common/printable.h"
#include "scene/schema_rows.h"
#include "scene/values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void check_times(Reader *reader, const YamlNode *list, const void *items, size_t size, uint32_t count) {
    const YamlNode *node = list && list->kind == NODE_LIST ? list->first : NULL;
    float before = -1;
    for (uint32_t i = 0; node && i < count; i++, node = node->next) {
        float time; // the first member of every kind of entry
        memcpy(&time, (const char *)items + i * size, sizeof time);
        if (time <= before && node_find(node, "time"))
            complain(reader, node_find(node, "time")->location, "times must increase from one entry to the next");
        before = time;
    }
}

/// Refuses `path` together with its short forms. Returns whether one of them is given.
static bool check_path(Reader *reader, const YamlNode *map, const SceneKey *keys, uint32_t count) {
    const YamlNode *path = node_find(map, "path"), *position = node_find(map, "position");
    const YamlNode *rotation = node_find(map, "rotation"), *other = position ? position : rotation;
    if (path && other)
        complain(reader, other->key_location, "'%s' stands for a path of one entry; give either it or 'path'",
                 other->key);
    if (path && path->kind == NODE_LIST && path->count == 0)
        complain(reader, path->location, "a path needs at least one entry");
    check_times(reader, path, keys, sizeof *keys, count);

    return path || position;
}

/// Measured values of the base do not hold for a changed material.
void finish_material(Reader *reader, const YamlNode *map, void *object) {
    SceneMaterial *material = object;
    const YamlNode *measured = node_find(map, "measured");
    for (const YamlNode *child = map->first; child && !measured && node_find(map, "base"); child = child->next)
        if (strcmp(child->key, "base") != 0 && strcmp(child->key, "name") != 0 && strcmp(child->key, "look") != 0)
            material->measured = (SceneMeasured){0};

    const float *ranges[] = {material->measured.speed, material->measured.temperature, material->measured.residue};
    static const char *const keys[] = {"speed", "temperature", "residue"};

    for (int i = 0; i < 3; i++)
        if (measured && node_find(measured, keys[i]) && ranges[i][0] > ranges[i][1])
            complain(reader, node_find(measured, keys[i])->location, "%s must be a range from low to high", keys[i]);

    const YamlNode *thickening = node_find(map, "thickening");
    float value = material->def.thickening;
    if (thickening && value > 0 && value < 1)
        complain(reader, thickening->location, "thickening must be 0 (as little as the cells need), or at least 1");
}

void finish_sheet(Reader *reader, const YamlNode *map, void *object) {
    SceneSheet *sheet = object;
    const YamlNode *mesh = node_find(map, "mesh"), *grid = node_find(map, "grid");
    if (mesh && grid) complain(reader, grid->key_location, "'grid' and 'mesh' exclude each other; give one");
    if (!mesh && !grid) complain(reader, map->location, "a sheet needs 'mesh' (a file) or 'grid' (size and cells)");
    if (grid && (double)sheet->grid.def.cells[0] * sheet->grid.def.cells[1] > 100e6)
        complain(reader, grid->location, "a grid has at most 100 million cells");
}

void finish_source(Reader *reader, const YamlNode *map, void *object) {
    SceneSource *source = object;
    if (!node_find(map, "kind")) return;

    const bool movable = SOURCES_MOVABLE & BIT(source->def.kind);
    if (movable && !check_path(reader, map, source->keys, source->key_count))
        complain(reader, map->location, "a source of this kind needs 'path' or 'position'");

    const YamlNode *end = node_find(map, "end");
    if (source->def.end < source->def.start)
        complain(reader, end ? end->location : map->location, "a source must not end before its start");
    check_times(reader, node_find(map, "strength"), source->strength, sizeof *source->strength, source->strength_count);
}

void finish_collider(Reader *reader, const YamlNode *map, void *object) {
    SceneCollider *collider = object;
    check_path(reader, map, collider->keys, collider->key_count);
    const YamlNode *mesh = node_find(map, "mesh"), *motion = node_find(map, "motion");
    if (!node_find(map, "kind") || collider->def.kind != SINGE_COLLIDER_MESH) return;
    if (mesh && motion) complain(reader, motion->key_location, "'mesh' and 'motion' exclude each other; give one");
    if (!mesh && !motion)
        complain(reader, map->location, "a mesh needs 'mesh' (a file) or 'motion' (a file for each frame)");
}

void finish_pin(Reader *reader, const YamlNode *map, void *object) {
    ScenePin *pin = object;
    if (!node_find(map, "points") && !node_find(map, "vertices"))
        complain(reader, map->location, "a pin needs 'points' or 'vertices'");
    const YamlNode *path = node_find(map, "path"), *motion = node_find(map, "motion");
    check_times(reader, path, pin->keys, sizeof *pin->keys, pin->key_count);
    if (path && motion) complain(reader, motion->key_location, "'path' and 'motion' exclude each other; give one");
    if (pin->holder && motion) complain(reader, motion->key_location, "a pin with 'motion' cannot have a 'holder'");
}

/// What the formats need of the sheets is known when those have been read.
void finish_output(Reader *reader, const YamlNode *map, void *object) {
    (void)reader;
    const YamlNode *formats = node_find(map, "formats");
    if (formats) ((SceneOutput *)object)->location = formats->location;
}

/// Whether the scene places the camera; otherwise scene_frame does.
static bool camera_given(const YamlNode *map) { return node_find(map, "eye") || node_find(map, "target"); }

void finish_camera(Reader *reader, const YamlNode *map, void *object) {
    const PreviewCamera *camera = &((const ScenePreview *)object)->def.camera;
    double view[3], cross[3], length = 0, across = 0;
    for (int i = 0; i < 3; i++) {
        view[i] = (double)camera->target[i] - (double)camera->eye[i];
        length += view[i] * view[i];
    }

    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        cross[i] = view[j] * (double)camera->up[k] - view[k] * (double)camera->up[j];
        across += cross[i] * cross[i];
    }

    const float *up = camera->up;
    const double min = 1.1e-12; // the preview's limit: it squares floats
    if ((double)up[0] * (double)up[0] + (double)up[1] * (double)up[1] + (double)up[2] * (double)up[2] < min)
        complain(reader, map->location, "the camera's up must be longer than 1e-6");
    else if (!camera_given(map)) return;
    else if (length < min) complain(reader, map->location, "the camera's eye and target are the same point");
    else if (!(across > 0)) complain(reader, map->location, "the camera's up must point away from the line of sight");
}

void finish_preview(Reader *reader, const YamlNode *map, void *object) {
    ScenePreview *preview = object;
    preview->camera_given = camera_given(node_find(map, "camera"));
    check_times(reader, node_find(map, "camera_path"), preview->camera_keys, sizeof *preview->camera_keys,
                preview->camera_key_count);

    const YamlNode *place = preview->camera_key_count ? node_find(map, "camera_path") : NULL;
    place = place && place->kind == NODE_LIST ? place->first : NULL;
    for (uint32_t i = 0; place && i < preview->camera_key_count; i++, place = place->next) {
        ScenePreview then = *preview;
        memcpy(then.def.camera.eye, preview->camera_keys[i].eye, sizeof then.def.camera.eye);
        memcpy(then.def.camera.target, preview->camera_keys[i].target, sizeof then.def.camera.target);
        finish_camera(reader, place, &then);
    }

    preview->camera_given = preview->camera_given || preview->camera_key_count > 0;
    const YamlNode *light = node_find(map, "light"), *direction = node_find(light, "direction");
    const float *d = preview->def.sun_direction;
    if (direction && (double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2] < 1e-18)
        complain(reader, direction->location, "the light's direction must be longer than 1e-9");
}

/// Numbers the entries of a list that have no name (`what` is "sheet" or "probe"), and refuses equal names. The name is
/// at `offset` of an entry's struct.
static void check_names(Reader *reader, const YamlNode *list, const char *what, void *items, size_t size, size_t offset,
                        uint32_t count) {
    const YamlNode *node = list->first;
    for (uint32_t i = 0; node && i < count; i++, node = node->next) {
        char **name = (char **)(void *)((char *)items + i * size + offset);
        char number[24];
        int length = snprintf(number, sizeof number, "%s%u", what, (unsigned)i + 1);
        if (!*name) *name = arena_text(reader->arena, number, (size_t)length);

        for (uint32_t j = 0; j < i && *name; j++) {
            const char *other = *(char **)(void *)((char *)items + j * size + offset);
            if (!other || strcmp(other, *name) != 0) continue;
            const YamlNode *given = node_find(node, "name");
            complain(reader, given ? given->location : node->location,
                     "two %ss are called '%s'; give each its own name", what, shown(*name).text);
            break;
        }
    }
}

/// Finds the sheet that a pin or a probe names, or gives the number of.
static void resolve_sheet(Reader *reader, const YamlNode *node, const Scene *scene, const char *word, uint32_t *index) {
    Nearest nearest = {.word = word};
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const char *name = scene->sheets[i].name;
        if (name && strcmp(name, word) == 0) {
            *index = i;
            return;
        }
        if (name) nearest_offer(&nearest, name);
    }

    const size_t digits = strspn(word, "0123456789");
    if (digits > 0 && digits < 10 && !word[digits]) {
        *index = (uint32_t)strtoul(word, NULL, 10);
        if (*index < scene->sheet_count) return;
    }

    const YamlNode *sheet = node_find(node, "sheet");
    char hint[80];
    complain(reader, sheet ? sheet->location : node->location, "there is no sheet '%s'%s", shown(word).text,
             nearest_hint(&nearest, hint, sizeof hint));
}

/// How many there are, their names, and the sheets that they name.
static void check_objects(Reader *reader, const YamlNode *map, Scene *scene) {
    const YamlNode *sheets = node_find(map, "sheets"), *pins = node_find(map, "pins"),
                   *probes = node_find(map, "probes");

    // the time of a step grows with the objects, and each name is compared with all others
    static const char *const lists[] = {"sheets", "sources", "colliders", "pins", "probes"};
    bool many = false;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        const YamlNode *list = node_find(map, lists[i]);
        if (!list || list->kind != NODE_LIST || list->count <= SCENE_OBJECTS_MAX) continue;
        complain(reader, list->location, "a scene has at most %d %s", SCENE_OBJECTS_MAX, lists[i]);
        many = true;
    }
    if (many) return;

    if (sheets && sheets->kind == NODE_LIST) {
        if (!sheets->count) complain(reader, sheets->location, "a scene needs at least one sheet");
        else
            check_names(reader, sheets, "sheet", scene->sheets, sizeof *scene->sheets, offsetof(SceneSheet, name),
                        scene->sheet_count);
    }

    const YamlNode *node = pins && pins->kind == NODE_LIST ? pins->first : NULL;
    for (uint32_t i = 0; node && i < scene->pin_count; i++, node = node->next)
        if (scene->pins[i].sheet && scene->sheet_count)
            resolve_sheet(reader, node, scene, scene->pins[i].sheet, &scene->pins[i].sheet_index);

    if (probes && probes->kind == NODE_LIST) {
        check_names(reader, probes, "probe", scene->probes, sizeof *scene->probes, offsetof(SceneProbe, name),
                    scene->probe_count);
        node = probes->first;
        for (uint32_t i = 0; node && i < scene->probe_count; i++, node = node->next)
            if (scene->probes[i].sheet && scene->sheet_count)
                resolve_sheet(reader, node, scene, scene->probes[i].sheet, &scene->probes[i].sheet_index);
    }
}

void finish_scene(Reader *reader, const YamlNode *map, void *object) {
    Scene *scene = object;
    const YamlNode *fps = node_find(map, "fps"), *steps = node_find(map, "steps");

    // the step of the simulation is 1/(fps * steps) seconds; the library takes 1e-9 to 10
    double rate = (double)scene->fps * scene->steps;
    if (!(rate >= 0.1 * (1 - 1e-6) && rate <= 1e9 * (1 + 1e-6)))
        complain(reader,
                 (fps     ? fps
                  : steps ? steps
                          : map)
                     ->location,
                 "%.6g frames a second of %d steps each are %.6g steps a second, which must be 0.1 to 1e9",
                 (double)scene->fps, scene->steps, rate);
    scene->sim.solver.tearing = scene->tearing && scene->sim.solver.method == SINGE_SOLVER_STRAND;

    const YamlNode *isotropic = node_find(node_find(map, "solver"), "isotropic");
    if (isotropic && scene->sim.solver.isotropic && scene->sim.solver.method != SINGE_SOLVER_STRAND)
        complain(reader, isotropic->key_location,
                 "'isotropic' needs the solver 'strand': the paper's solvers lack its springs");

    const YamlNode *detail = node_find(node_find(map, "gas"), "detail");
    if (detail) scene->gas_detail_location = detail->location;
    check_times(reader, node_find(map, "pace"), scene->paces, sizeof *scene->paces, scene->pace_count);
    if (scene->pace_count) scene->sim.pace = fmaxf(scene->paces[0].value, SCENE_PACE_MIN);
    if (scene->pace_count && scene->burn_by.given)
        complain(reader, node_find(map, "burn_by")->key_location,
                 "'burn_by' changes the pace, so 'pace' must be one number");

    check_objects(reader, map, scene);
}
