// A scene that continues from a frame of another: what may differ between the two, and how a simulation takes it over.
//
// Two scenes are compared key by key, as text, with the schema's tables; the files that they name by their contents. The
// keys in `changeable` may differ, and parameters of materials that do not fix a sheet's mass, shape or start. All else
// is part of what the frames so far were made with.
#include "scene/builder.h"
#include "scene/dump.h"
#include "scene/faults.h"
#include "scene/schema_rows.h"
#include "scene/assets.h"

#include <stdlib.h>
#include <string.h>

/// Without the numbers of list entries.
static const char *const changeable[] = {
    "name",
    "frames",
    "pace",
    "burn_by",
    "gravity",
    "ambient_temperature",
    "wind",
    "checkpoints",
    "sources",
    "colliders",
    "pins",
    "preview",
    "output.formats",
    "output.texture_size",
    "gas.detail",
    "sheets.picture",
    "sheets.back",
    "sheets.colour",
    "sheets.transmittance",
    "sheets.mesh", // compared by its contents
    "sheets.material.name",
    "sheets.material.measured",
    "sheets.material.look",
};

/// Two scenes, and what has been found.
typedef struct Comparison {
    SceneWhole now, before;
    SceneMessages *messages;
    bool no_memory;
} Comparison;

static bool texts_equal(char *a, char *b, bool *no_memory) {
    if (!a || !b) *no_memory = true;
    const bool equal = a && b && strcmp(a, b) == 0;
    free(a);
    free(b);
    return equal;
}

/// Where the value at a path such as "sheets.0.material.grammage" is written, or the map that lacks it.
static SceneLocation location_of(const Scene *scene, const char *path) {
    const YamlNode *node = scene->text->root;
    SceneLocation location = {0};
    for (const char *part = path; node && *part;) {
        char key[64];
        const size_t length = strcspn(part, ".");
        snprintf(key, sizeof key, "%.*s", (int)length, part);
        part += length + (part[length] == '.');

        if (node->kind == NODE_LIST) {
            unsigned long index = strtoul(key, NULL, 10);
            for (node = node->first; node && index; index--) node = node->next;
        } else {
            node = node->kind == NODE_MAP ? node_find(node, key) : NULL;
        }
        if (node) location = node->location;
    }

    return location;
}

static void refuse_change(Comparison *comparison, const char *path, const char *was) {
    char seen[80];
    snprintf(seen, sizeof seen, "%s", was);
    message_add(comparison->messages, comparison->now.scene->text, location_of(comparison->now.scene, path),
                "%s cannot change in a branch%s%s", path, *seen ? ": it was " : "", seen);
}

/// Compares two maps key by key. `shown` is their path, and `path` the same without numbers; both are "" or end in a
/// dot.
static void compare_maps(Comparison *comparison, const Schema *schema, const void *now, const void *before,
                         const char *shown_as, const char *path) {
    const unsigned kind = schema_kind(schema, now);
    const bool material = strncmp(path, "sheets.material.", 16) == 0;

    for (int i = 0; i < schema->row_count && !comparison->no_memory; i++) {
        const SchemaRow *row = &schema->rows[i];
        char key[160], name[200];
        snprintf(key, sizeof key, "%s%s", path, row->key);
        snprintf(name, sizeof name, "%s%s", shown_as, row->key);

        bool may = false;
        for (size_t k = 0; k < sizeof changeable / sizeof *changeable; k++) may |= strcmp(key, changeable[k]) == 0;
        if (may) continue;
        if (material && row->type == ROW_PARAM && !scene_param_lasts(row->key)) continue;

        char *was = dump_row_text(row, kind, before), *is = dump_row_text(row, kind, now);
        const bool whole = was && is && *was && *is; // both are given
        if (was && is && strcmp(was, is) != 0) {
            const size_t at = row->offset;
            const char *a = (const char *)now + at, *b = (const char *)before + at;
            uint32_t counts[2] = {0};
            if (row->type == ROW_LIST) {
                memcpy(&counts[0], (const char *)now + row->extra, sizeof counts[0]);
                memcpy(&counts[1], (const char *)before + row->extra, sizeof counts[1]);
            }

            const char *value = strchr(was, ':');
            if (row->type == ROW_MAP && whole) {
                snprintf(key, sizeof key, "%s%s.", path, row->key);
                snprintf(name, sizeof name, "%s%s.", shown_as, row->key);
                compare_maps(comparison, row->sub, a, b, name, key);
            } else if (row->type == ROW_LIST && counts[0] == counts[1]) {
                const char *items[2];
                memcpy(&items[0], a, sizeof items[0]);
                memcpy(&items[1], b, sizeof items[1]);
                for (uint32_t k = 0; k < counts[0]; k++) {
                    snprintf(key, sizeof key, "%s%s.", path, row->key);
                    snprintf(name, sizeof name, "%s%s.%u.", shown_as, row->key, (unsigned)k);
                    compare_maps(comparison, row->sub, items[0] + k * row->sub->size, items[1] + k * row->sub->size,
                                 name, key);
                }
            } else {
                refuse_change(comparison, name,
                              row->type == ROW_MAP || row->type == ROW_LIST || !value ? "" : value + 2);
            }
        }

        if (!was || !is) comparison->no_memory = true;
        free(was);
        free(is);
    }
}

static bool arrays_equal(const void *a, const void *b, size_t count, size_t size) {
    if (!a || !b) return a == b;
    return memcmp(a, b, count * size) == 0;
}

static bool pictures_equal(const SingeTexture *a, const SingeTexture *b) {
    return a->width == b->width && a->height == b->height &&
           arrays_equal(a->values, b->values, (size_t)a->width * (size_t)a->height, sizeof(float));
}

static bool images_equal(const Image *a, const Image *b) {
    return a->width == b->width && a->height == b->height &&
           arrays_equal(a->rgb, b->rgb, (size_t)a->width * (size_t)a->height, 3 * sizeof *a->rgb);
}

static bool solids_equal(const PreviewSolid *a, const PreviewSolid *b) {
    return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
           arrays_equal(a->vertices, b->vertices, a->vertex_count, 3 * sizeof(float)) &&
           arrays_equal(a->triangles, b->triangles, a->triangle_count, 3 * sizeof(uint32_t));
}

/// Whether both begin alike; later frames may differ, as they are set one by one.
static bool motions_equal(const SceneSequence *a, const SceneSequence *b) {
    if (!a->frame_count || !b->frame_count) return a->frame_count == b->frame_count;
    return solids_equal(&a->frames[0], &b->frames[0]);
}

SingeResult scene_may_branch(SceneWhole scene, SceneWhole before, SceneMessages *messages) {
    Comparison comparison = {scene, before, messages, false};
    const uint32_t found = message_total(messages);
    compare_maps(&comparison, &schema_scene, scene.scene, before.scene, "", "");

    // values that stay may still give other cells, as a file's contents do
    for (uint32_t i = 0; message_total(messages) == found && i < scene.scene->sheet_count; i++) {
        char path[40];
        snprintf(path, sizeof path, "sheets.%u.mesh", (unsigned)i);

        const Mesh *a = &scene.assets->meshes[i], *b = &before.assets->meshes[i];
        bool equal = a->vertex_count == b->vertex_count && a->cell_count == b->cell_count &&
                     a->source_count == b->source_count && a->attribute_count == b->attribute_count &&
                     arrays_equal(a->positions, b->positions, a->vertex_count, 3 * sizeof(float)) &&
                     arrays_equal(a->cells, b->cells, a->cell_count, 4 * sizeof(uint32_t)) &&
                     arrays_equal(a->uv, b->uv, a->vertex_count, 2 * sizeof(float)) &&
                     arrays_equal(a->corner_uv, b->corner_uv, a->cell_count, 8 * sizeof(float)) &&
                     arrays_equal(a->became, b->became, a->source_count, sizeof(uint32_t));
        for (uint32_t k = 0; equal && k < a->attribute_count; k++)
            equal = strcmp(a->attributes[k].name, b->attributes[k].name) == 0 &&
                    arrays_equal(a->attributes[k].values, b->attributes[k].values, a->vertex_count, sizeof(float));
        if (!equal) refuse_change(&comparison, path, "");
    }

    // earlier frames have no events in the table
    if (scene.scene->output.events && !before.scene->output.events)
        refuse_change(&comparison, "output.events", "false");
    if (comparison.no_memory) return SINGE_ERROR_MEMORY;

    return message_total(messages) == found ? SINGE_OK : SINGE_ERROR_ARGUMENT;
}

bool scene_looks_alike(SceneWhole scene, SceneWhole before) {
    bool no_memory = false, alike = scene.scene->sheet_count == before.scene->sheet_count;
    alike = alike &&
            texts_equal(dump_text(&schema_preview, &scene.scene->preview),
                        dump_text(&schema_preview, &before.scene->preview), &no_memory) &&
            images_equal(&scene.assets->sky, &before.assets->sky);
    for (uint32_t i = 0; alike && i < scene.scene->sheet_count; i++) {
        const SceneSheet *a = &scene.scene->sheets[i], *b = &before.scene->sheets[i];
        const uint32_t back = scene.scene->sheet_count + i;
        alike = memcmp(a->colour, b->colour, sizeof a->colour) == 0 && a->transmittance == b->transmittance &&
                memcmp(&a->material.look, &b->material.look, sizeof a->material.look) == 0 &&
                images_equal(&scene.assets->images[i], &before.assets->images[i]) &&
                images_equal(&scene.assets->images[back], &before.assets->images[back]);
    }

    return alike;
}

// ---- taking over

/// A pin's text without its look.
static char *pin_text(const ScenePin *pin) {
    ScenePin bare = *pin;
    bare.holder = PREVIEW_HOLDER_NONE;
    return dump_text(&schema_pin, &bare);
}

/// Whether an entry of a list (0: sources, 1: colliders, 2: pins) is the same in both scenes, with the contents of its
/// files. An entry that only one has is not.
static bool entries_equal(int list, SceneWhole a, SceneWhole b, uint32_t i, bool *no_memory) {
    if (list == 0)
        return i < a.scene->source_count && i < b.scene->source_count &&
               pictures_equal(&a.assets->source_textures[i], &b.assets->source_textures[i]) &&
               texts_equal(dump_text(&schema_source, &a.scene->sources[i]),
                           dump_text(&schema_source, &b.scene->sources[i]), no_memory);
    if (list == 2)
        return i < a.scene->pin_count && i < b.scene->pin_count &&
               motions_equal(&a.assets->pin_motions[i], &b.assets->pin_motions[i]) &&
               texts_equal(pin_text(&a.scene->pins[i]), pin_text(&b.scene->pins[i]), no_memory);

    if (i >= a.scene->collider_count || i >= b.scene->collider_count) return false;
    const SceneSolid *one = &a.assets->solids[i], *other = &b.assets->solids[i];
    return solids_equal(&one->surface, &other->surface) &&
           motions_equal(&a.assets->collider_motions[i], &b.assets->collider_motions[i]) &&
           one->columns == other->columns && one->rows == other->rows &&
           arrays_equal(one->heights, other->heights, (size_t)one->columns * one->rows, sizeof(float)) &&
           texts_equal(dump_text(&schema_collider, &a.scene->colliders[i]),
                       dump_text(&schema_collider, &b.scene->colliders[i]), no_memory);
}

/// Both lists in the simulation are those of `before`, in order; slots that are freed are filled again in order, so the
/// order remains, which scene_follow relies on.
static SingeResult branch_objects(const SceneBuilder *builder, SceneWhole now, SceneWhole before, int frame,
                                  SceneFault *fault) {
    SingeSim *sim = builder->sim;
    bool no_memory = false;
    SingeResult result = SINGE_OK;
    const uint32_t lengths[][2] = {{now.scene->source_count, before.scene->source_count},
                                   {now.scene->collider_count, before.scene->collider_count},
                                   {now.scene->pin_count, before.scene->pin_count}};

    for (int list = 0; list < 3 && !result; list++) {
        const uint32_t is = lengths[list][0], was = lengths[list][1], most = is > was ? is : was;
        bool *equal = calloc((size_t)most + 1, sizeof *equal);
        SingeSourceId *sources = calloc((size_t)most + 1, sizeof *sources);
        SingeColliderId *colliders = calloc((size_t)most + 1, sizeof *colliders);
        SingePinId *pins = calloc((size_t)most + 1, sizeof *pins);
        if (!equal || !sources || !colliders || !pins) no_memory = true;

        // remove what differs
        if (!no_memory && list == 0) singe_sim_sources(sim, sources, was);
        if (!no_memory && list == 1) singe_sim_colliders(sim, colliders, was);
        if (!no_memory && list == 2) singe_sim_pins(sim, pins, was);

        for (uint32_t i = 0; i < most && !no_memory && !result; i++) {
            equal[i] = entries_equal(list, now, before, i, &no_memory);
            if (equal[i] || i >= was) continue;
            result = list == 0   ? singe_sim_remove_source(sim, sources[i])
                     : list == 1 ? singe_sim_remove_collider(sim, colliders[i])
                                 : singe_sim_remove_pin(sim, pins[i]);
            if (result) fault->error = *singe_sim_error(sim);
        }

        // add what is new
        for (uint32_t i = 0; i < is && !no_memory && !result; i++) {
            if (equal[i]) continue;
            fault->object = list == 0 ? FAULT_SOURCE : list == 1 ? FAULT_COLLIDER : FAULT_PIN;
            fault->index = i;
            result = list == 0   ? builder_add_source(builder, i)
                     : list == 1 ? builder_add_collider(builder, i)
                                 : builder_add_pin(builder, i);

            // a mesh that moves is where it is at this frame, and not where it began
            const SceneSequence *motion = list == 1 ? &now.assets->collider_motions[i] : NULL;
            if (result || !motion || !motion->frame_count) continue;
            const uint32_t last = motion->frame_count - 1, at = (uint32_t)frame - 1 < last ? (uint32_t)frame - 1 : last;

            singe_sim_colliders(sim, colliders, i + 1);
            result = singe_sim_set_collider_vertices(sim, colliders[i], motion->frames[at].vertices, 0);
            if (result) fault->error = *singe_sim_error(sim);
        }
        free(equal);
        free(sources);
        free(colliders);
        free(pins);
        if (no_memory) result = fault->error.code = SINGE_ERROR_MEMORY;
    }

    return result;
}

/// What the scene says besides its objects: wind, gravity, pace, the temperature of the room.
static SingeResult branch_settings(SceneWhole scene, SceneWhole before, SingeSim *sim, SceneMessages *messages) {
    char *winds[2] = {NULL, NULL};
    for (int i = 0; i < schema_scene.row_count; i++)
        if (strcmp(schema_scene.rows[i].key, "wind") == 0) {
            winds[0] = dump_row_text(&schema_scene.rows[i], ~0u, scene.scene);
            winds[1] = dump_row_text(&schema_scene.rows[i], ~0u, before.scene);
        }

    bool no_memory = false;
    const bool wind = !texts_equal(winds[0], winds[1], &no_memory);

    const SingeSimDef *now = &scene.scene->sim, *was = &before.scene->sim;
    const char *path = "wind";
    SingeResult result = wind ? singe_sim_set_wind(sim, &now->wind) : SINGE_OK;
    if (!result && memcmp(now->gravity, was->gravity, sizeof now->gravity) != 0) {
        path = "gravity";
        result = singe_sim_set_gravity(sim, now->gravity);
    }

    // one that has keys, or follows the fire, is where that has led
    const SceneBurnBy *by = &scene.scene->burn_by, *by_before = &before.scene->burn_by;
    const bool led = before.scene->pace_count || (by_before->given && !by->given);
    if (!result && (now->pace != was->pace || led)) {
        path = "pace";
        result = singe_sim_set_pace(sim, now->pace);
    }

    if (!result && now->ambient_temperature != was->ambient_temperature) {
        path = "ambient_temperature";
        result = singe_sim_set_ambient_temperature(sim, now->ambient_temperature);
    }

    if (result)
        message_add(messages, scene.scene->text, location_of(scene.scene, path), "%s", singe_sim_error(sim)->message);
    return result;
}

SingeResult scene_branch(SceneWhole scene, SceneWhole before, int frame, SingeSim *sim, SceneMessages *messages) {
    SceneFault fault = {.object = FAULT_SIM};
    const uint32_t sheets = scene.scene->sheet_count;
    bool no_memory = false;
    SceneBuilder builder = {scene.scene, scene.assets, sim, calloc((size_t)sheets + 1, sizeof *builder.sheets),
                            &fault.error};
    SingeResult result = builder.sheets ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (!result) singe_sim_sheets(sim, builder.sheets, sheets);

    for (uint32_t i = 0; i < sheets && !result; i++) {
        bool equal = texts_equal(dump_text(&schema_material, &scene.scene->sheets[i].material),
                                 dump_text(&schema_material, &before.scene->sheets[i].material), &no_memory);
        for (int k = 0; k < SCENE_PARAM_SLOTS && equal; k++)
            equal = pictures_equal(&scene.assets->fields[i][k].texture, &before.assets->fields[i][k].texture);
        if (equal) continue;

        // scene_follow makes the step to this frame
        const int last = frame > 1 ? frame - 1 : 1;
        result = no_memory ? SINGE_ERROR_MEMORY
                           : follow_material(scene.scene, scene.assets, sim, i, last, true, &fault.error);
        if (!result) continue;

        char path[40];
        snprintf(path, sizeof path, "sheets.%u.material", (unsigned)i);
        message_add(messages, scene.scene->text, location_of(scene.scene, path), "the material cannot change: %s",
                    no_memory ? "out of memory" : fault.error.message);
    }

    const uint32_t found = message_total(messages);
    if (!result) result = branch_settings(scene, before, sim, messages);
    if (!result) result = branch_objects(&builder, scene, before, frame, &fault);

    if (result && message_total(messages) == found) {
        fault.error.code = result;
        fault_report(scene.scene, scene.assets, &fault, messages);
    }
    free(builder.sheets);
    return result;
}
