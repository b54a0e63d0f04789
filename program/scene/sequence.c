// A sequence of mesh files, one per frame, as the motion of a collider or of a pin's particles.
//
// A pin's particle is bound to the nearest triangle of the first frame, by the weights w of the closest point and the
// displacement d from it in the triangle's axes e. At another frame it is at
//
//   x = sum_k w_k v_k + sum_i d_i e_i,   e_0 along the first side, e_2 the normal, e_1 = e_2 x e_0.
//
// A pin can thus follow the mesh that its sheet was made from, vertex by vertex, or another mesh, of a body.

#include "common/store.h"
#include "scene/faults.h"
#include "scene/space.h"
#include "scene/schema.h"
#include "scene/assets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static SingeResult sequence_no_memory(SingeError *error) {
    return refuse(error, SINGE_ERROR_MEMORY, "scene", -1, "out of memory for a motion");
}

// ---- files

bool sequence_name_fits(const char *name) {
    const char *file = strrchr(name, '/'), *run = strchr(file ? file : name, '#');
    if (!run || (file && memchr(name, '#', (size_t)(file - name)))) return false;
    return !strchr(run + strspn(run, "#"), '#') && strspn(run, "#") <= 9;
}

char *sequence_path(const char *path, int number) {
    const char *file = strrchr(path, '/'), *run = strchr(file ? file : path, '#');
    const size_t size = strlen(path) + 16;
    char *made = malloc(size);
    if (made)
        snprintf(made, size, "%.*s%0*d%s", (int)(run - path), path, (int)strspn(run, "#"), number,
                 run + strspn(run, "#"));
    return made;
}

/// Whether a numbered file exists; also false when out of memory.
static bool sequence_has(const char *path, int number) {
    char *made = sequence_path(path, number);
    const bool there = made && access(made, F_OK) == 0;
    free(made);
    return there;
}

SingeResult sequence_length(const char *path, int first, int most, int *length, SingeError *error) {
    *length = 1;
    while (*length < most && sequence_has(path, first + *length)) ++*length;
    if (*length >= most || !sequence_has(path, first + *length + 1)) return SINGE_OK;

    char *missing = sequence_path(path, first + *length);
    if (!missing) return sequence_no_memory(error);

    SingeResult result = refuse(error, SINGE_ERROR_FILE, "scene", -1,
                                "%s: there is no such file, but the next one exists", short_name(missing));
    free(missing);
    return result;
}

/// Reads a frame; the first one allocates all.
static SingeResult sequence_read_frame(const SceneMotion *motion, const char *path, int frame, int frames,
                                       SceneSequence *sequence, SingeError *error) {
    Bytes bytes = {0};
    SceneSolid solid = {0};
    PreviewSolid *surface = &solid.surface;
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result)
        result =
            solid_read_mesh(path, bytes.data, bytes.size, metres_per_unit(motion->units, motion->scale), &solid, error);
    bytes_free(&bytes);

    if (!result && frame == 0) {
        sequence->vertex_count = surface->vertex_count;
        sequence->triangle_count = surface->triangle_count;
        sequence->triangles = surface->triangles;
        surface->triangles = NULL;
        sequence->frames = calloc((size_t)frames, sizeof *sequence->frames);
        if (!sequence->frames) result = sequence_no_memory(error);
    } else if (!result && (surface->vertex_count != sequence->vertex_count ||
                           surface->triangle_count != sequence->triangle_count)) {
        result = refuse(error, SINGE_ERROR_MESH, "scene", -1,
                        "%s has %u vertices and %u triangles, but the first file of the motion has %u and %u",
                        short_name(path), surface->vertex_count, surface->triangle_count, sequence->vertex_count,
                        sequence->triangle_count);
    }

    for (uint32_t v = 0; !result && v < surface->vertex_count; v++) {
        float *p = surface->vertices + 3 * (size_t)v, y = p[1];
        if (motion->up == SCENE_UP_Y) { // from y up to z up
            p[1] = -p[2];
            p[2] = y;
        }

        if (!(fabsf(p[0]) <= 1e4f && fabsf(p[1]) <= 1e4f && fabsf(p[2]) <= 1e4f))
            result = refuse(error, SINGE_ERROR_MESH, "scene", -1,
                            "%s: vertex %u (from 0) is not finite or beyond 10 km", short_name(path), v);
    }

    if (!result) {
        sequence->frames[frame] = (PreviewSolid){surface->vertex_count, surface->triangle_count, surface->vertices,
                                                 sequence->triangles, true};
        sequence->frame_count = (uint32_t)frame + 1;
        surface->vertices = NULL;
    }

    solid_free(&solid);
    return result;
}

SingeResult sequence_read(const SceneMotion *motion, int frames, SceneSequence *sequence, SingeError *error) {
    int length = 0; // the frames with files: the motion stops after the last
    *sequence = (SceneSequence){0};

    SingeResult result = sequence_length(motion->mesh.path, motion->first, frames, &length, error);
    for (int frame = 0; !result && frame < length; frame++) {
        char *path = sequence_path(motion->mesh.path, motion->first + frame);
        result = path ? sequence_read_frame(motion, path, frame, length, sequence, error) : sequence_no_memory(error);
        free(path);
    }

    if (!result && (sequence->vertex_count == 0 || sequence->triangle_count == 0))
        result = refuse(error, SINGE_ERROR_MESH, "scene", -1, "%s: the motion's mesh has no faces",
                        short_name(motion->mesh.path));
    if (result) sequence_free(sequence);
    return result;
}

void sequence_free(SceneSequence *sequence) {
    for (uint32_t f = 0; f < sequence->frame_count; f++) free(sequence->frames[f].vertices);
    free(sequence->frames);
    free(sequence->triangles);
    free(sequence->bonds);
    *sequence = (SceneSequence){0};
}

// ---- bonds

static void corners_of(const PreviewSolid *frame, uint32_t triangle, double v[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            v[i][k] =
                (double)frame->vertices[3 * (size_t)frame->triangles[3 * (size_t)triangle + (size_t)i] + (size_t)k];
}

static void axes_of(const double v[3][3], double e[3][3]) {
    double side[3], other[3];
    for (int k = 0; k < 3; k++) {
        e[0][k] = side[k] = v[1][k] - v[0][k];
        other[k] = v[2][k] - v[0][k];
    }

    for (int k = 0; k < 3; k++)
        e[2][k] = side[(k + 1) % 3] * other[(k + 2) % 3] - side[(k + 2) % 3] * other[(k + 1) % 3];

    for (int i = 0; i < 3; i += 2) {
        const double length = sqrt(dot3(e[i], e[i]));
        for (int k = 0; k < 3; k++) e[i][k] = length > 0 ? e[i][k] / length : 0; // an axis without extent remains 0
    }

    for (int k = 0; k < 3; k++) e[1][k] = e[2][(k + 1) % 3] * e[0][(k + 2) % 3] - e[2][(k + 2) % 3] * e[0][(k + 1) % 3];
}

/// Binds a pin's particles, at their rest positions, to the first frame. False when out of memory.
static bool bind_pin(const SingeSim *sim, SingePinId pin, SceneSequence *sequence) {
    const PreviewSolid *frame = &sequence->frames[0];
    const SingeView view = singe_sim_view(sim);
    uint32_t count;
    const uint32_t *particles = singe_sim_pin_particles(sim, pin, &count);
    sequence->bonds = calloc((size_t)count + 1, sizeof *sequence->bonds);
    if (!sequence->bonds) return false;

    sequence->bond_count = count;

    for (uint32_t b = 0; b < count; b++) {
        SceneBond *made = &sequence->bonds[b];
        const float *at = view.rest_position[particles[b]];
        const double p[3] = {(double)at[0], (double)at[1], (double)at[2]};
        double v[3][3], e[3][3], weights[3], best = INFINITY, away[3];
        for (uint32_t t = 0; t < frame->triangle_count; t++) {
            corners_of(frame, t, v);
            const double square = closest_on_triangle(p, (const double(*)[3])v, weights);
            if (!(square < best)) continue;
            best = square;
            made->triangle = t;
            memcpy(made->weights, weights, sizeof weights);
        }

        corners_of(frame, made->triangle, v);
        axes_of((const double(*)[3])v, e);
        for (int k = 0; k < 3; k++)
            away[k] = p[k] - made->weights[0] * v[0][k] - made->weights[1] * v[1][k] - made->weights[2] * v[2][k];
        for (int i = 0; i < 3; i++) made->away[i] = dot3(away, e[i]);
    }

    return true;
}

// ---- the simulation

static SingeResult follow_pin(SingeSim *sim, SingePinId pin, SceneSequence *sequence, uint32_t frame, double time,
                              SingeError *error) {
    if (!sequence->bonds && !bind_pin(sim, pin, sequence)) return sequence_no_memory(error);
    float *positions = malloc(3 * ((size_t)sequence->bond_count + 1) * sizeof *positions);
    if (!positions) return sequence_no_memory(error);

    for (uint32_t b = 0; b < sequence->bond_count; b++) {
        const SceneBond *made = &sequence->bonds[b];
        double v[3][3], e[3][3];
        corners_of(&sequence->frames[frame], made->triangle, v);
        axes_of((const double(*)[3])v, e);

        for (int k = 0; k < 3; k++) {
            double x = 0;
            for (int i = 0; i < 3; i++) x += made->weights[i] * v[i][k] + made->away[i] * e[i][k];
            positions[3 * (size_t)b + (size_t)k] = (float)x;
        }
    }

    SingeResult result = singe_sim_set_pin_positions(sim, pin, positions, time);
    free(positions);
    if (result) *error = *singe_sim_error(sim);
    return result;
}

/// Once a frame: the pace at which what is left to burn until the frame of `burn_by` burns evenly, if the fire goes on as
/// it does now. It changes by a quarter a frame at most, so that nobody sees it. It depends on the simulation alone, as
/// the frames of a run that is resumed or branched have to.
static SingeResult follow_burn_by(const Scene *scene, SingeSim *sim, int frame, SingeError *error) {
    static const double change = 1.25, most = 1000;
    const SceneBurnBy *by = &scene->burn_by;
    const double base = (double)scene->sim.pace;
    double pace = base;

    if (frame < by->frame && frame > 1) {
        const SingeView view = singe_sim_view(sim);
        double rate = 0, area = 0;
        for (uint32_t i = 0; i < view.particle_count; i++) {
            area += (double)view.area[i];
            if (view.particle_flags[i] & SINGE_ALIVE) rate += (double)view.burn_rate[i] * (double)view.area[i];
        }

        const SingeStats stats = singe_sim_stats(sim);
        const double left = (double)by->fraction - stats.burnt_fraction;
        const double needed = left * (double)scene->fps / (by->frame - frame), now = area > 0 ? rate / area : 0;
        const double factor = now > 0 ? needed / now : 1; // nothing burns yet
        pace = (double)stats.pace * fmin(fmax(factor, 1 / change), change);
        pace = fmin(fmax(pace, base / most), base * most);
        pace = fmin(fmax(pace, 1e-6), 1e6);
    }

    const SingeResult result = singe_sim_set_pace(sim, (float)pace);
    if (result) *error = *singe_sim_error(sim);
    return result;
}

/// Interpolates between keys; beyond the ends they are held.
static double keys_at(const SingeValueKey *keys, uint32_t count, double time) {
    uint32_t after = 0;
    while (after < count && (double)keys[after].time <= time) after++;
    double value = (double)keys[after ? after - 1 : 0].value;
    if (after > 0 && after < count) {
        const double begin = (double)keys[after - 1].time, end = (double)keys[after].time;
        value += (time - begin) / (end - begin) * ((double)keys[after].value - value);
    }
    return value;
}

SingeResult scene_begin_step(const Scene *scene, SingeSim *sim, int frame, int step, SingeError *error) {
    if (scene->burn_by.given) return step ? SINGE_OK : follow_burn_by(scene, sim, frame, error);
    if (!scene->pace_count) return SINGE_OK;
    const double time = ((double)(frame - 1) + (double)step / scene->steps) / (double)scene->fps;
    const double pace = keys_at(scene->paces, scene->pace_count, time);
    const SingeResult result = singe_sim_set_pace(sim, fmaxf((float)pace, SCENE_PACE_MIN));
    if (result) *error = *singe_sim_error(sim);
    return result;
}

// ---- materials over time

SingeResult follow_material(const Scene *scene, const SceneAssets *assets, SingeSim *sim, uint32_t sheet, int frame,
                            bool always, SingeError *error) {
    const SceneFollowed *followed = scene->sheets[sheet].material.followed;
    const double time = (frame - 1) / (double)scene->fps, before = (frame - 2) / (double)scene->fps;
    bool changed = always;
    for (int k = 0; k < SCENE_PARAM_SLOTS && frame > 1; k++) {
        const SceneFollowed *by = &followed[k];
        if (by->key_count)
            changed |= keys_at(by->keys, by->key_count, time) != keys_at(by->keys, by->key_count, before);
        else if (by->texture.name && sequence_name_fits(by->texture.name))
            changed |= sequence_has(by->texture.path, frame);
    }

    if (!changed) return SINGE_OK;

    SingeSheetDef def;
    SingeField fields[SCENE_PARAM_SLOTS];
    SceneParam param;
    SingeResult result = SINGE_OK;
    scene_sheet_def(scene, assets, sheet, &def);
    for (int k = 0; k < SCENE_PARAM_SLOTS; k++) fields[k].texture.values = NULL;

    for (int i = 0; scene_param(i, &param) && !result; i++) {
        const SceneFollowed *by = &followed[param.slot];
        SingeParam *value = scene_param_at(&def.material, &param);
        if (by->key_count) *value = singe_param((float)keys_at(by->keys, by->key_count, time));
        if (!by->texture.name || !sequence_name_fits(by->texture.name)) continue;

        int number = frame; // the last picture stays
        while (number > 1 && !sequence_has(by->texture.path, number)) number--;
        SingeField *field = &fields[param.slot];
        *field = assets->fields[sheet][param.slot];
        field->texture = (SingeTexture){0};

        char *path = sequence_path(by->texture.path, number);
        result = path ? luminance_read(path, &field->texture, error) : sequence_no_memory(error);
        free(path);
        value->field = field;
    }

    SingeSheetId *ids = calloc((size_t)scene->sheet_count + 1, sizeof *ids);
    if (!result && !ids) result = sequence_no_memory(error);

    if (!result) {
        singe_sim_sheets(sim, ids, scene->sheet_count);
        result = singe_sim_set_material(sim, ids[sheet], &def.material, NULL);
        if (result) *error = *singe_sim_error(sim);
    }

    free(ids);
    for (int k = 0; k < SCENE_PARAM_SLOTS; k++) free((void *)fields[k].texture.values);
    return result;
}

SingeResult scene_follow(const Scene *scene, SceneAssets *assets, SingeSim *sim, int frame, SingeError *error) {
    const double time = frame / (double)scene->fps;
    SingeResult result = SINGE_OK;

    // scene_build has added them in order, and a load keeps handles
    SingeColliderId *colliders = calloc((size_t)scene->collider_count + 1, sizeof *colliders);
    SingePinId *pins = calloc((size_t)scene->pin_count + 1, sizeof *pins);
    if (!colliders || !pins) result = sequence_no_memory(error);
    if (!result) singe_sim_colliders(sim, colliders, scene->collider_count);
    if (!result) singe_sim_pins(sim, pins, scene->pin_count);

    for (uint32_t i = 0; i < scene->collider_count && !result; i++) {
        const SceneSequence *sequence = &assets->collider_motions[i];
        if ((uint32_t)frame >= sequence->frame_count) continue;
        result = singe_sim_set_collider_vertices(sim, colliders[i], sequence->frames[frame].vertices, time);
        if (result) *error = *singe_sim_error(sim);
    }

    for (uint32_t i = 0; i < scene->pin_count && !result; i++)
        if ((uint32_t)frame < assets->pin_motions[i].frame_count)
            result = follow_pin(sim, pins[i], &assets->pin_motions[i], (uint32_t)frame, time, error);
    free(colliders);
    free(pins);

    for (uint32_t i = 0; i < scene->sheet_count && !result; i++)
        result = follow_material(scene, assets, sim, i, frame, false, error);
    return result;
}
