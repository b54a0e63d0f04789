#include "cli/outputs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text.h"

static SingeResult no_memory(SingeError *error) {
    *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "output", .element = -1};
    return SINGE_ERROR_MEMORY;
}

// ---- the scene, as passed to writers

/// The relative path from a folder to a file, with links resolved; the file's own path if either cannot be found.
static char *path_from(const char *folder, const char *file) {
    char *from = realpath(folder, NULL), *to = realpath(file, NULL), *relative = NULL;
    if (from && to) {
        size_t same = 0, i = 0;
        for (; from[i] && from[i] == to[i]; i++)
            if (from[i] == '/') same = i + 1;
        if (!from[i] && to[i] == '/') same = i + 1;
        const char *rest = strlen(from) < same ? "" : from + same;
        relative = text_format("%s", *rest ? "../" : "./");
        for (const char *c = rest; *c; c++) {
            if (*c != '/') continue;
            char *longer = text_format("../%s", relative);
            free(relative);
            relative = longer;
        }
        char *whole = text_format("%s%s", relative, to + same);
        free(relative);
        relative = whole;
    }
    free(from), free(to);
    return relative ? relative : text_format("%s", file);
}

static OutputMesh uncut(const Mesh *mesh) {
    return (OutputMesh){.vertex_count = mesh->vertex_count,
                        .cell_count = mesh->cell_count,
                        .positions = mesh->positions,
                        .uv = mesh->uv,
                        .corner_uv = mesh->corner_uv,
                        .cells = mesh->cells,
                        .source = mesh->source,
                        .became = mesh->became,
                        .source_count = mesh->source_count};
}

static void fill_sheet(const Outputs *outputs, uint32_t index) {
    const Job *job = outputs->job;
    const SceneSheet *sheet = &job->scene->sheets[index];
    if (sheet->picture.path) outputs->pictures[index] = path_from(outputs->folder->path, sheet->picture.path);
    outputs->sheets[index] = (OutputSheet){.name = sheet->name,
                                           .picture = outputs->pictures[index],
                                           .image = job->assets.pictures[index],
                                           .mesh = uncut(&job->assets.meshes[index])};
    memcpy(outputs->sheets[index].colour, sheet->colour, sizeof sheet->colour);
}

SingeResult outputs_open(Outputs *outputs, const Job *job, const Folder *folder, OutputSet formats, bool gas,
                         SingeError *error) {
    const Scene *scene = job->scene;
    const ScenePreview *preview = &scene->preview;
    *outputs = (Outputs){.job = job, .folder = folder, .formats = formats};
    outputs->sheets = calloc(scene->sheet_count + 1, sizeof *outputs->sheets);
    outputs->pictures = calloc(scene->sheet_count + 1, sizeof *outputs->pictures);
    if (!outputs->sheets || !outputs->pictures) return no_memory(error);
    for (uint32_t i = 0; i < scene->sheet_count; i++) fill_sheet(outputs, i);
    OutputScene *s = &outputs->scene;
    *s = (OutputScene){.name = scene->name,
                       .fps = scene->fps,
                       .gas = gas,
                       .texture_size = scene->output.texture_size,
                       .sheet_count = scene->sheet_count,
                       .sheets = outputs->sheets,
                       .fov = preview->camera.fov,
                       .aspect = (float)preview->size[0] / (float)preview->size[1],
                       .aperture = preview->camera.aperture,
                       .focus = preview->camera.focus,
                       .light_angle = preview->light_angle,
                       .ground_height = preview->ground_height};
    memcpy(s->eye, preview->camera.eye, sizeof s->eye);
    memcpy(s->target, preview->camera.target, sizeof s->target);
    memcpy(s->up, preview->camera.up, sizeof s->up);
    memcpy(s->light_direction, preview->light_direction, sizeof s->light_direction);
    memcpy(s->light_colour, preview->light_colour, sizeof s->light_colour);
    memcpy(s->sky, preview->sky, sizeof s->sky);
    memcpy(s->ground_colour, preview->ground_colour, sizeof s->ground_colour);
    return SINGE_OK;
}

void outputs_close(Outputs *outputs) {
    for (uint32_t i = 0; outputs->pictures && i < outputs->scene.sheet_count; i++) free(outputs->pictures[i]);
    free(outputs->pictures);
    free(outputs->sheets);
    *outputs = (Outputs){0};
}

// ---- frames

SingeResult outputs_write(const Outputs *outputs, int format, const char *path, const Frame *frame, int number,
                          SingeError *error) {
    OutputFrame view = {.surface = &frame->surface, .time = frame->time, .number = number};
    return output_formats[format].write_frame(path, &outputs->scene, &view, error);
}

OutputSet outputs_missing(const Outputs *outputs, int number) {
    OutputSet missing = 0;
    for (int i = 0; i < OUTPUT_COUNT; i++) {
        if (i == OUTPUT_ply || !output_has(outputs->formats, i)) continue;
        char *path = folder_output(outputs->folder, i, number);
        if (!folder_has(path)) missing |= 1u << i;
        free(path);
    }
    return missing;
}

SingeResult outputs_convert(const Outputs *outputs, int number, OutputSet formats, SingeError *error) {
    Frame frame = {0};
    SingeResult result = frame_read_surface(outputs->folder, number, &frame, error);
    for (int i = 0; i < OUTPUT_COUNT && !result; i++) {
        if (i == OUTPUT_ply || !output_has(formats, i)) continue;
        char *path = folder_output(outputs->folder, i, number);
        result = outputs_write(outputs, i, path, &frame, number, error);
        free(path);
    }
    frame_free(&frame);
    return result;
}

// ---- roots

/// The shape drawn at a slot of the scene, and its trajectory over the frames. False if nothing is ever drawn there.
static bool follow_shape(const Outputs *outputs, uint32_t slot, int frames, OutputPose *poses, OutputShape *shape) {
    const Job *job = outputs->job;
    bool ever = false;
    for (int frame = frames - 1; frame >= 0; frame--) {
        PreviewShape now;
        poses[frame] = (OutputPose){.rotation = {0, 0, 0, 1}};
        if (!scene_shape(job->scene, &job->assets, slot, frame * scene_frame_time(job->scene), &now)) continue;
        ever = poses[frame].visible = true;
        memcpy(poses[frame].position, now.position, sizeof now.position);
        memcpy(poses[frame].rotation, now.rotation, sizeof now.rotation);
        *shape = (OutputShape){.kind = now.kind,
                               .radius = now.radius,
                               .height = now.height,
                               .temperature = now.temperature,
                               .poses = poses};
        memcpy(shape->half_size, now.half_size, sizeof now.half_size);
        memcpy(shape->colour, now.colour, sizeof now.colour);
        if (!now.solid) continue;
        shape->vertex_count = now.solid->vertex_count;
        shape->triangle_count = now.solid->triangle_count;
        shape->vertices = now.solid->vertices;
        shape->triangles = now.solid->triangles;
        poses[frame].vertices = now.solid->vertices;
    }
    return ever;
}

/// The scene's objects other than sheets, and their trajectories over the frames.
typedef struct WholeScene {
    OutputScene scene;
    OutputPose *poses;
    OutputShape *shapes;
} WholeScene;

static SingeResult whole_open(WholeScene *whole, const Outputs *outputs, int frames, SingeError *error) {
    const Scene *scene = outputs->job->scene;
    const uint32_t slots = scene->collider_count + scene->source_count;
    whole->scene = outputs->scene;
    whole->poses = calloc((size_t)slots * (size_t)frames + 1, sizeof *whole->poses);
    whole->shapes = calloc(slots + 1, sizeof *whole->shapes);
    if (!whole->poses || !whole->shapes) return no_memory(error);
    whole->scene.frames = frames;
    whole->scene.shapes = whole->shapes;
    for (uint32_t i = 0; i < slots; i++)
        whole->scene.shape_count += follow_shape(outputs, i, frames, whole->poses + (size_t)i * (size_t)frames,
                                                 &whole->shapes[whole->scene.shape_count]);
    return SINGE_OK;
}

static void whole_close(WholeScene *whole) { free(whole->poses), free(whole->shapes); }

SingeResult outputs_write_roots(const Outputs *outputs, int frames, SingeError *error) {
    WholeScene whole;
    SingeResult result = whole_open(&whole, outputs, frames, error);
    for (int i = 0; i < OUTPUT_COUNT && !result; i++) {
        if (!output_has(outputs->formats, i) || !output_formats[i].write_root) continue;
        char *path = folder_root(outputs->folder, i);
        result = output_formats[i].write_root(path, &whole.scene, error);
        free(path);
    }
    whole_close(&whole);
    return result;
}

// ---- all frames at once

typedef struct CacheReader {
    const Outputs *outputs;
    Frame frame;
    OutputsProgress *progress;
    void *context;
} CacheReader;

static SingeResult read_next(void *context, int number, OutputFrame *view, SingeError *error) {
    CacheReader *reader = context;
    frame_free(&reader->frame);
    if (!reader->progress(reader->context, number)) {
        *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "output", .element = -1, .message = "interrupted"};
        return SINGE_ERROR_STATE;
    }
    SingeResult result = frame_read_surface(reader->outputs->folder, number, &reader->frame, error);
    *view = (OutputFrame){.surface = &reader->frame.surface, .time = reader->frame.time, .number = number};
    return result;
}

SingeResult outputs_write_single(const Outputs *outputs, int single, int frames, OutputsProgress *progress,
                                 void *context, SingeError *error) {
    const OutputSingle *format = &output_singles[single];
    CacheReader reader = {.outputs = outputs, .progress = progress, .context = context};
    const OutputCache cache = {.frames = frames, .read = read_next, .context = &reader};
    WholeScene whole;
    SingeResult result = whole_open(&whole, outputs, frames, error);
    char *path = folder_single(outputs->folder, single), *slash = strrchr(path, '/');
    if (!result && !format->ending) {
        *slash = 0;
        result = folder_make(path, error);
        *slash = '/';
    }
    if (!result) result = format->write(path, &whole.scene, &cache, error);
    free(path);
    frame_free(&reader.frame);
    whole_close(&whole);
    return result;
}
