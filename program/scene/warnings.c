// Warns of valid settings that certainly have no effect, or not the intended one.
#include "scene/messages.h"
#include "scene/space.h"
#include "scene/warnings.h"

#include <math.h>

/// A motion that ends before the scene does.
static void warn_of_motion(const Scene *scene, const SceneMotion *motion, const SceneSequence *sequence,
                           const SingeLog *log) {
    if (sequence->frame_count && sequence->frame_count < (uint32_t)scene->frames)
        message_warn(log, scene->text, motion->mesh.location,
                     "the motion has files for %u of %d frames; it stops after them", sequence->frame_count,
                     scene->frames);
}

const char *source_heats_nothing(const Scene *scene, const SceneSource *source) {
    const SingeSourceDef *def = &source->def;
    const double end = (scene->frames - 1) / (double)scene->fps;
    bool weak = source->strength_count > 0;
    for (uint32_t i = 0; i < source->strength_count; i++) weak = weak && source->strength[i].value == 0;

    if (def->kind == SINGE_SOURCE_TEXTURE && (def->flux == 0 || weak)) return "its flux is 0";
    if (def->kind == SINGE_SOURCE_ARRIVAL || source_wets_or_blows(def)) return NULL;

    const bool round = source_is_round(def);
    const bool flame = scene->sim.gas.enabled && def->power > 0;
    if (round && def->conductance == 0 && !flame) return "its conductance is 0";
    if (round && def->radius + def->falloff == 0 && !flame) return "its radius and its falloff are 0";
    if (def->end <= def->start) return "it ends when it starts";

    return scene->frames > 1 && (double)def->start >= end ? "it starts after the last frame" : NULL;
}

/// Warns of meshes that are much too large or too far away.
static void warn_of_meshes(const Scene *scene, const SceneAssets *assets, const SingeLog *log) {
    // files that most likely are in cm or mm
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const SceneSheet *sheet = &scene->sheets[i];
        Box box = BOX_EMPTY;
        if (!sheet->mesh.name || sheet->units != SCENE_UNITS_M) continue;
        box_add_points(&box, assets->meshes[i].positions, assets->meshes[i].vertex_count);
        const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
        if (fmax(fmax(x, y), z) > 10)
            message_warn(log, scene->text, sheet->mesh.location,
                         "the mesh is %.3g x %.3g x %.3g m large: are its numbers cm or mm? (units: cm)", x, y, z);
    }

    // sheets so far away that positions in single precision are too coarse for their cells
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const Mesh *mesh = &assets->meshes[i];
        double farthest = 0, shortest = INFINITY;
        for (size_t k = 0; k < 3 * (size_t)mesh->vertex_count; k++)
            farthest = fmax(farthest, fabs((double)mesh->positions[k]));

        for (uint32_t c = 0; c < mesh->cell_count; c++) {
            const float *from = mesh->positions + 3 * (size_t)mesh->cells[4 * (size_t)c];
            const float *to = mesh->positions + 3 * (size_t)mesh->cells[4 * (size_t)c + 1];
            const double x = (double)to[0] - (double)from[0], y = (double)to[1] - (double)from[1];
            shortest = fmin(shortest, hypot(hypot(x, y), (double)to[2] - (double)from[2]));
        }

        const double rounded = farthest * 0x1p-23;
        if (rounded > 0.01 * shortest)
            message_warn(
                log, scene->text, scene->sheets[i].location,
                "the sheet lies %.3g m from the origin, where positions are rounded to %.2g mm, and its shortest "
                "side is %.2g mm: move the scene to the origin",
                farthest, 1e3 * rounded, 1e3 * shortest);
    }
}

/// Warns of blankets whose reach is within the distance that contact keeps.
static void warn_of_blankets(const Scene *scene, const SingeLog *log) {
    float thickest = 0;
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const SingeParam thickness = scene->sheets[i].material.def.thickness;
        thickest = fmaxf(thickest, fmaxf(thickness.value, thickness.to));
    }

    for (uint32_t i = 0; i < scene->sheet_count && scene->sim.contact.enabled; i++) {
        const SingeParam distance = scene->sheets[i].material.def.smother_distance;
        const float reach = fmaxf(distance.value, distance.to), kept = scene->sim.contact.thickness;
        if (reach > 0 && reach + thickest < kept)
            message_warn(
                log, scene->text, scene->sheets[i].location,
                "the sheet smothers nothing: its smother_distance, %.3g mm, is less than the %.3g mm that contact "
                "keeps between sheets (contact.thickness)",
                1e3 * (double)reach, 1e3 * (double)kept);
    }
}

void scene_warn(const Scene *scene, const SceneAssets *assets, const SingeLog *log) {
    if (!log->write) return;

    for (uint32_t i = 0; i < scene->source_count; i++) {
        const char *why = source_heats_nothing(scene, &scene->sources[i]);
        if (why) message_warn(log, scene->text, scene->sources[i].location, "the source heats nothing: %s", why);
    }

    warn_of_meshes(scene, assets, log);
    scene_warn_of_fires(scene, assets, log);
    for (uint32_t i = 0; i < scene->collider_count; i++)
        warn_of_motion(scene, &scene->colliders[i].motion, &assets->collider_motions[i], log);
    for (uint32_t i = 0; i < scene->pin_count; i++)
        warn_of_motion(scene, &scene->pins[i].motion, &assets->pin_motions[i], log);

    warn_of_blankets(scene, log);

    // probes whose point is not on the sheet: for uv by more than rounding, for points by a tenth of its diagonal, as pins
    for (uint32_t i = 0; i < scene->probe_count; i++) {
        const SceneProbe *probe = &scene->probes[i];
        const Mesh *mesh = &assets->meshes[probe->sheet_index];
        const double gap = assets->probes[i].distance;
        Box box = BOX_EMPTY;
        box_add_points(&box, mesh->positions, mesh->vertex_count);

        if (probe->kind == SCENE_PROBE_UV && gap > 1e-4)
            message_warn(log, scene->text, probe->location,
                         "the sheet has no uv [%.6g, %.6g]: the probe takes the nearest, %.3g away",
                         (double)probe->uv[0], (double)probe->uv[1], gap);
        else if (probe->kind == SCENE_PROBE_POINT && gap > 0.1 * box_diagonal(&box))
            message_warn(
                log, scene->text, probe->location,
                "the probe's point [%.6g, %.6g, %.6g] m misses the sheet: it takes the nearest point, %.3g m away",
                (double)probe->point[0], (double)probe->point[1], (double)probe->point[2], gap);
    }
}
