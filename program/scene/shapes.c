// The shapes of a scene that the preview draws.
#include "scene/rotation.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

void scene_preview(const Scene *scene, const SceneAssets *assets, PreviewDef *def) {
    const ScenePreview *preview = &scene->preview;
    *def = (PreviewDef){
        .width = preview->size[0],
        .height = preview->size[1],
        .samples = preview->samples,
        .thread_count = 1,
        .camera = preview->camera,
        .sun_angle = preview->light_angle,
        .ground_height = preview->ground_height,
        .exposure = preview->exposure,
        .shutter = preview->shutter / scene->fps,
        .pace = (float)scene->sim.pace,
        .sky = assets->sky.rgb ? PREVIEW_SKY_PICTURE : preview->environment,
        .sky_picture = assets->sky.rgb ? &assets->sky : NULL,
        .sky_turn = preview->environment_turn,
        .ground = preview->ground,
        .seed = (uint32_t)scene->sim.seed,
        .pictures = assets->pictures,
        .colours = (const float(*)[3])assets->colours,
        .transmittances = assets->transmittances,
        .sheet_count = assets->sheet_count,
    };
    memcpy(def->sun_direction, preview->light_direction, sizeof def->sun_direction);
    memcpy(def->sun_colour, preview->light_colour, sizeof def->sun_colour);
    memcpy(def->sky_colour, preview->sky, sizeof def->sky_colour);
    memcpy(def->ground_colour, preview->ground_colour, sizeof def->ground_colour);
    memcpy(def->background, preview->background, sizeof def->background);
}

// Interpolates like the library: positions linearly, quaternions linearly and normalised, constant beyond the ends.
static void shape_pose(const SceneKey *keys, uint32_t count, double time, PreviewShape *shape) {
    uint32_t next = 0;
    while (next < count && (double)keys[next].time <= time) next++;
    const SceneKey *a = &keys[next ? next - 1 : 0], *b = &keys[next < count ? next : count - 1];
    double span = (double)b->time - (double)a->time, s = span > 0 ? (time - (double)a->time) / span : 0;
    float qa[4], qb[4];
    rotation_quaternion(a->rotation, qa);
    rotation_quaternion(b->rotation, qb);
    double dot = 0, norm = 0, q[4];
    for (int i = 0; i < 4; i++) dot += (double)qa[i] * (double)qb[i];
    for (int i = 0; i < 4; i++) {
        q[i] = (1 - s) * (double)qa[i] + s * (dot < 0 ? -(double)qb[i] : (double)qb[i]);
        norm += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++) shape->rotation[i] = (float)(q[i] / sqrt(norm));
    for (int i = 0; i < 3; i++)
        shape->position[i] = (float)((1 - s) * (double)a->position[i] + s * (double)b->position[i]);
}

/// The velocity of the shape, from its displacement over a thousandth of a second. Rotation causes no blur.
static void shape_move(const SceneKey *keys, uint32_t count, double time, PreviewShape *shape) {
    PreviewShape later = *shape;
    const float span = 1e-3f;
    shape_pose(keys, count, time, shape);
    shape_pose(keys, count, time + (double)span, &later);
    for (int i = 0; i < 3; i++)
        shape->velocity[i] = fmaxf(-1e4f, fminf((later.position[i] - shape->position[i]) / span, 1e4f));
}

static bool source_shape(const SceneSource *source, double time, PreviewShape *shape) {
    bool drawn = source->def.kind == SINGE_SOURCE_BALL && source->visible && source->key_count &&
                 source->def.radius > 0 && time >= (double)source->def.start && time <= (double)source->def.end;
    if (!drawn) return false;
    *shape = (PreviewShape){.kind = SINGE_COLLIDER_SPHERE,
                            .radius = source->def.radius,
                            .colour = {0.05f, 0.05f, 0.05f},
                            .temperature = source->def.temperature};
    shape_move(source->keys, source->key_count, time, shape);
    return true;
}

static bool collider_shape(const Scene *scene, const SceneAssets *assets, uint32_t index, double time,
                           PreviewShape *shape) {
    const SceneCollider *collider = &scene->colliders[index];
    if (collider->def.kind == SINGE_COLLIDER_PLANE || !collider->visible || !collider->key_count) return false;
    const SingeColliderDef *def = &collider->def;
    *shape = (PreviewShape){.kind = def->kind,
                            .radius = def->radius,
                            .height = def->height,
                            .temperature = def->conductance > 0 ? def->temperature : scene->sim.ambient_temperature};
    if (def->kind == SINGE_COLLIDER_MESH || def->kind == SINGE_COLLIDER_HEIGHTFIELD)
        shape->solid = &assets->solids[index].surface;
    const SceneSequence *sequence = &assets->collider_motions[index];
    if (sequence->frame_count) {
        const double frame = floor(time * (double)scene->fps + 0.5), last = (double)sequence->frame_count - 1;
        shape->solid = &sequence->frames[(uint32_t)fmax(0, fmin(frame, last))];
    }
    memcpy(shape->half_size, def->half_size, sizeof shape->half_size);
    memcpy(shape->colour, collider->colour, sizeof shape->colour);
    shape_move(collider->keys, collider->key_count, time, shape);
    return true;
}

bool scene_shape(const Scene *scene, const SceneAssets *assets, uint32_t slot, double time, PreviewShape *shape) {
    if (slot < scene->collider_count) return collider_shape(scene, assets, slot, time, shape);
    return source_shape(&scene->sources[slot - scene->collider_count], time, shape);
}

uint32_t scene_shapes(const Scene *scene, const SceneAssets *assets, double time, PreviewShape *shapes, uint32_t max) {
    uint32_t count = 0;
    PreviewShape shape;
    for (uint32_t i = 0; i < scene->collider_count + scene->source_count; i++) {
        if (!scene_shape(scene, assets, i, time, &shape)) continue;
        if (count < max) shapes[count] = shape;
        count++;
    }
    return count;
}
