// From a scene to its preview: the Def, the default camera, and the shapes of a time.
#include "common/float3.h"
#include "scene/assets.h"
#include "scene/space.h"
#include "scene/scene.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

void scene_preview(const Scene *scene, const SceneAssets *assets, PreviewDef *def) {
    const ScenePreview *preview = &scene->preview;
    *def = preview->def;
    def->shutter = preview->shutter / scene->fps;
    def->pace = (float)scene->sim.pace;
    def->seed = (uint32_t)scene->sim.seed;
    if (assets->sky.rgb) {
        def->sky = PREVIEW_SKY_PICTURE;
        def->sky_picture = &assets->sky;
    }

    def->pictures = assets->pictures;
    def->backs = assets->pictures + assets->sheet_count;
    def->colours = (const float(*)[3])assets->colours;
    def->transmittances = assets->transmittances;
    def->looks = assets->looks;
    def->sheet_count = assets->sheet_count;
    scene_camera(scene, 0, &def->camera);
}

// ---- a camera that moves

/// The cubic through p[1] and p[2] at their times t[1] and t[2], with the slopes there of the parabolas through three
/// neighbours (Catmull & Rom 1974, for times that are not evenly spaced).
static float camera_between(const double t[4], const float p[4], double time) {
    double span = t[2] - t[1], s = fmin(fmax((time - t[1]) / span, 0), 1), slope[2], step[3];
    for (int k = 0; k < 3; k++) step[k] = t[k + 1] > t[k] ? ((double)p[k + 1] - (double)p[k]) / (t[k + 1] - t[k]) : 0;
    for (int k = 0; k < 2; k++) {
        double before = t[k + 1] - t[k], after = t[k + 2] - t[k + 1];
        slope[k] = before > 0 && after > 0 ? (step[k] * after + step[k + 1] * before) / (before + after) : 0;
    }
    double u = s * s * (3 - 2 * s), rise = s * (1 - s) * (1 - s) * slope[0] - s * s * (1 - s) * slope[1];
    return (float)((1 - u) * (double)p[1] + u * (double)p[2] + span * rise);
}

void scene_camera(const Scene *scene, double time, PreviewCamera *camera) {
    const ScenePreview *preview = &scene->preview;
    const SceneCameraKey *keys = preview->camera_keys;
    const uint32_t count = preview->camera_key_count;
    *camera = preview->def.camera;
    if (!count) return;

    // the two keys before the time and the two after it; at the ends the last one again
    uint32_t next = 0, at[4];
    while (next < count && (double)keys[next].time <= time) next++;
    at[1] = next ? next - 1 : 0;
    at[2] = next < count ? next : count - 1;
    at[0] = at[1] && next < count ? at[1] - 1 : at[1];
    at[3] = next && at[2] + 1 < count ? at[2] + 1 : at[2];

    double t[4];
    for (int k = 0; k < 4; k++) t[k] = (double)keys[at[k]].time;

    const size_t members[] = {offsetof(SceneCameraKey, eye), offsetof(SceneCameraKey, target),
                              offsetof(SceneCameraKey, fov), offsetof(SceneCameraKey, focus)};
    float *const into[] = {camera->eye, camera->target, &camera->fov, &camera->focus};
    for (int m = 0; m < 4; m++)
        for (int c = 0; c < (m < 2 ? 3 : 1); c++) {
            float p[4];
            for (int k = 0; k < 4; k++) {
                memcpy(&p[k], (const char *)&keys[at[k]] + members[m] + (size_t)c * sizeof(float), sizeof(float));
                if (m == 2 && !(p[k] > 0)) p[k] = preview->def.camera.fov;
                if (m == 3 && !(p[k] > 0)) // the target's distance
                    p[k] = float3_length(float3_sub(float3_load(keys[at[k]].target), float3_load(keys[at[k]].eye)));
            }
            into[m][c] = at[2] > at[1] ? camera_between(t, p, time) : p[1];
        }

    camera->fov = fmaxf(1e-3f, fminf(camera->fov, 3.1f)); // a cubic may overshoot
    camera->focus = fmaxf(0, camera->focus);
}

// ---- the default camera: the sheets fill the picture

/// Max distance of a camera from the origin, m.
static const double farthest = 1e4;
/// Min distance of a camera from what it looks at, m near the origin.
static const double nearest = 1e-5;

/// Unit vectors from the box to the camera, and to the right and up in the picture. Flat sheets are seen from above,
/// upright ones from the front (-y), a little from the side.
static void camera_look(const Box *box, const float up[3], double back[3], double right[3], double top[3]) {
    double vertical[3] = {(double)up[0], (double)up[1], (double)up[2]}, front[3] = {0, -1, 0}, height = 0, max = 0;
    unit3(vertical);
    if (fabs(vertical[1]) > 0.9) {
        front[1] = 0;
        front[2] = 1;
    }

    for (int i = 0; i < 3; i++) {
        height += fabs(vertical[i]) * (box->high[i] - box->low[i]);
        max = fmax(max, box->high[i] - box->low[i]);
    }

    double lift = 0.15 + 0.85 * (1 - fmin(height / max, 1));
    cross3(vertical, front, right); // to the right in the picture, seen from the front
    unit3(right);
    cross3(right, vertical, front);

    for (int i = 0; i < 3; i++) back[i] = front[i] + 0.25 * right[i] + lift * vertical[i];
    unit3(back);
    cross3(vertical, back, right);
    unit3(right);
    cross3(back, right, top);
}

void scene_frame(Scene *scene, const SceneAssets *assets) {
    PreviewCamera *camera = &scene->preview.def.camera;
    if (scene->preview.camera_given) return;

    Box box = BOX_EMPTY;
    for (uint32_t s = 0; s < assets->sheet_count; s++)
        box_add_points(&box, assets->meshes[s].positions, assets->meshes[s].vertex_count);
    double size = 0, longest = 0;

    for (int i = 0; i < 3; i++) {
        size += box.high[i] - box.low[i];
        longest = fmax(longest, box.high[i] - box.low[i]);
    }

    if (!isfinite(size) || !(size > 0)) return;

    double back[3], right[3], top[3], distance = 0;
    camera_look(&box, camera->up, back, right, top);
    if (scene->source_count) box.high[2] += 0.3 * longest; // for flames

    // as far back as the corners of the box need, with a margin of 15 %
    double half = tan(0.5 * (double)camera->fov), aspect = (double)scene->preview.def.width / scene->preview.def.height;

    for (int corner = 0; corner < 8; corner++) {
        double d[3]; // from the centre to the corner
        for (int i = 0; i < 3; i++) d[i] = 0.5 * (box.high[i] - box.low[i]) * (corner >> i & 1 ? 1 : -1);
        double across = fmax(fabs(dot3(d, right)) / aspect, fabs(dot3(d, top)));
        distance = fmax(distance, dot3(d, back) + 1.15 * across / half);
    }

    double target[3], eye[3], off = 0;
    for (int i = 0; i < 3; i++) {
        target[i] = 0.5 * (box.low[i] + box.high[i]);
        off = fmax(off, fabs(target[i]));
    }

    distance = fmax(distance, nearest * (1 + off)); // else eye and target may be the same floats
    for (int i = 0; i < 3; i++) {
        eye[i] = target[i] + distance * back[i];
        if (fabs(eye[i]) > farthest) return;
    }

    for (int i = 0; i < 3; i++) {
        camera->target[i] = (float)target[i];
        camera->eye[i] = (float)eye[i];
    }
}

// ---- shapes

/// Interpolates like the library: positions linearly, quaternions linearly and normalised, constant beyond the ends.
void keys_pose(const SceneKey *keys, uint32_t count, double time, PreviewShape *shape) {
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

#define MOMENT 1e-3f ///< s

/// The velocity of the shape, from where it is a moment later. Rotation causes no blur.
static void shape_blur(const PreviewShape *later, PreviewShape *shape) {
    for (int i = 0; i < 3; i++)
        shape->velocity[i] = fmaxf(-1e4f, fminf((later->position[i] - shape->position[i]) / MOMENT, 1e4f));
}

static void shape_move(const SceneKey *keys, uint32_t count, double time, PreviewShape *shape) {
    PreviewShape later;
    keys_pose(keys, count, time, shape);
    keys_pose(keys, count, time + (double)MOMENT, &later);
    shape_blur(&later, shape);
}

bool scene_shape(const Scene *scene, const SceneAssets *assets, uint32_t slot, double time, PreviewShape *shape) {
    if (slot >= scene->collider_count + scene->source_count) {
        const SceneHolder *holder = &assets->holders[slot - scene->collider_count - scene->source_count];
        PreviewShape later;
        holder_pose(scene, holder, time, shape);
        holder_pose(scene, holder, time + (double)MOMENT, &later);
        shape_blur(&later, shape);
        shape->temperature = scene->sim.ambient_temperature;
        shape->solid = &holder->part.solid;
        return true;
    }

    if (slot >= scene->collider_count) {
        const SceneSource *source = &scene->sources[slot - scene->collider_count];
        const SingeSourceDef *def = &source->def;
        bool drawn = def->kind == SINGE_SOURCE_BALL && source->visible && source->key_count && def->radius > 0 &&
                     time >= (double)def->start && time <= (double)def->end;
        if (!drawn) return false;

        *shape = (PreviewShape){.kind = SINGE_COLLIDER_SPHERE,
                                .radius = def->radius,
                                .colour = {0.05f, 0.05f, 0.05f},
                                .temperature = def->temperature};
        shape_move(source->keys, source->key_count, time, shape);
        return true;
    }

    const SceneCollider *collider = &scene->colliders[slot];
    const SingeColliderDef *def = &collider->def;
    const bool has_shape = def->kind >= SINGE_COLLIDER_SPHERE && def->kind <= SINGE_COLLIDER_MESH;
    if (!has_shape || !collider->visible || !collider->key_count) return false;

    *shape = (PreviewShape){.kind = def->kind,
                            .radius = def->radius,
                            .height = def->height,
                            .surface = (PreviewSurface)collider->surface,
                            .temperature = def->conductance > 0 ? def->temperature : scene->sim.ambient_temperature};
    if (def->kind == SINGE_COLLIDER_MESH || def->kind == SINGE_COLLIDER_HEIGHTFIELD)
        shape->solid = &assets->solids[slot].surface;

    const SceneSequence *sequence = &assets->collider_motions[slot];
    if (sequence->frame_count) {
        const double frame = floor(time * (double)scene->fps + 0.5), last = (double)sequence->frame_count - 1;
        shape->solid = &sequence->frames[(uint32_t)fmax(0, fmin(frame, last))];
    }

    memcpy(shape->half_size, def->half_size, sizeof shape->half_size);
    memcpy(shape->colour, collider->colour, sizeof shape->colour);
    shape_move(collider->keys, collider->key_count, time, shape);
    return true;
}

uint32_t scene_shapes(const Scene *scene, const SceneAssets *assets, double time, PreviewShape *shapes, uint32_t max) {
    uint32_t count = 0;
    PreviewShape shape;
    for (uint32_t i = 0; i < scene_slots(scene, assets); i++) {
        if (!scene_shape(scene, assets, i, time, &shape)) continue;
        if (count < max) shapes[count] = shape;
        count++;
    }
    return count;
}
