#include "cli/outputs.h"

#include <math.h>
#include <stdlib.h>

#include "common/store.h"
#include "formats/gas_grid.h"
#include "scene/faults.h"

static SingeResult no_memory(SingeError *error) {
    return refuse(error, SINGE_ERROR_MEMORY, "output", -1, "out of memory");
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

    free(from);
    free(to);
    return relative ? relative : text_format("%s", file);
}

SingeResult outputs_open(Outputs *outputs, const Job *job, const Folder *folder, OutputSet formats, bool gas,
                         SingeError *error) {
    const Scene *scene = job->scene;
    *outputs = (Outputs){.job = job, .folder = folder, .formats = formats};
    outputs->sheets = calloc(scene->sheet_count + 1, sizeof *outputs->sheets);
    outputs->pictures = calloc(scene->sheet_count + 1, sizeof *outputs->pictures);
    if (!outputs->sheets || !outputs->pictures) return no_memory(error);

    bool wet = false;
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const SceneSheet *sheet = &scene->sheets[i];
        const Mesh *mesh = &job->assets.meshes[i];

        if (sheet->picture.path) outputs->pictures[i] = path_from(folder->path, sheet->picture.path);
        outputs->sheets[i] = (OutputSheet){.name = sheet->name,
                                           .picture = outputs->pictures[i],
                                           .image = job->assets.pictures[i],
                                           .mesh = {.vertex_count = mesh->vertex_count,
                                                    .cell_count = mesh->cell_count,
                                                    .positions = mesh->positions,
                                                    .uv = mesh->uv,
                                                    .corner_uv = mesh->corner_uv,
                                                    .cells = mesh->cells,
                                                    .source = mesh->source,
                                                    .became = mesh->became,
                                                    .source_count = mesh->source_count}};
        memcpy(outputs->sheets[i].colour, sheet->colour, sizeof sheet->colour);

        SingeSheetDef def;
        scene_sheet_def(scene, &job->assets, i, &def);
        const SingeParam moisture = def.material.moisture;
        wet |= moisture.value > 0 || (moisture.field && moisture.to > 0);
    }

    const PreviewDef *preview = &scene->preview.def;
    OutputScene *s = &outputs->scene;
    *s = (OutputScene){.name = scene->name,
                       .fps = scene->fps,
                       .gas = gas,
                       .wet = wet,
                       .texture_size = scene->output.texture_size,
                       .sheet_count = scene->sheet_count,
                       .sheets = outputs->sheets,
                       .fov = preview->camera.fov,
                       .aspect = (float)preview->width / (float)preview->height,
                       .aperture = preview->camera.aperture,
                       .focus = preview->camera.focus,
                       .light_angle = preview->sun_angle,
                       .ground_height = preview->ground_height};
    memcpy(s->eye, preview->camera.eye, sizeof s->eye);
    memcpy(s->target, preview->camera.target, sizeof s->target);
    memcpy(s->up, preview->camera.up, sizeof s->up);
    memcpy(s->light_direction, preview->sun_direction, sizeof s->light_direction);
    memcpy(s->light_colour, preview->sun_colour, sizeof s->light_colour);
    memcpy(s->sky, preview->sky_colour, sizeof s->sky);
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

/// The scene's objects other than sheets, and their trajectories over the frames.
typedef struct WholeScene {
    OutputScene scene;
    OutputPose *poses;
    OutputShape *shapes;
} WholeScene;

static SingeResult whole_open(WholeScene *whole, const Outputs *outputs, int frames, SingeError *error) {
    const Scene *scene = outputs->job->scene;
    const uint32_t slots = scene_slots(scene, &outputs->job->assets);

    whole->scene = outputs->scene;
    whole->poses = calloc((size_t)slots * (size_t)frames + 1, sizeof *whole->poses);
    whole->shapes = calloc(slots + 1, sizeof *whole->shapes);
    if (!whole->poses || !whole->shapes) return no_memory(error);

    whole->scene.frames = frames;
    whole->scene.shapes = whole->shapes;

    // the shape drawn at each slot, with its trajectory over the frames; slots where none ever is are left out
    for (uint32_t slot = 0; slot < slots; slot++) {
        OutputPose *poses = whole->poses + (size_t)slot * (size_t)frames;
        OutputShape *shape = &whole->shapes[whole->scene.shape_count];
        bool ever = false;
        for (int frame = frames - 1; frame >= 0; frame--) {
            PreviewShape now;
            poses[frame] = (OutputPose){.rotation = {0, 0, 0, 1}};
            if (!scene_shape(scene, &outputs->job->assets, slot, frame * scene_frame_time(scene), &now)) continue;

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

        whole->scene.shape_count += ever;
    }

    return SINGE_OK;
}

static void whole_close(WholeScene *whole) {
    free(whole->poses);
    free(whole->shapes);
}

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

// ---- gas on finer cells

// Smoke and flame are the preview's, at the centres of the fine cells. The velocity is interpolated between the centres
// of the coarse cells. The temperature is that of a black body as bright as the flame: renderers whose blackbody
// emission goes with its fourth power show the same tongues, in a flame's colours.

#define BRIGHTEST 2500.0f ///< K, where `flame` is 1: gives other renderers' pictures the colours of ours

/// The coarse cells on either side of a fine cell's centre along an axis, and the weight between them.
static void neighbours(uint32_t fine, int detail, uint32_t size, uint32_t pair[2], float *share) {
    const float at = ((float)fine + 0.5f) / (float)detail - 0.5f, low = at > 0 ? at : 0;
    pair[0] = (uint32_t)low < size - 1 ? (uint32_t)low : size - 1;
    pair[1] = pair[0] + 1 < size ? pair[0] + 1 : pair[0];
    *share = low - (float)pair[0];
}

SingeResult gas_detail_shape(const SingeGas *coarse, int detail, SingeGas *fine, SingeError *error) {
    *fine = *coarse;
    fine->cell = coarse->cell / (float)detail;
    for (int c = 0; c < 3; c++) fine->size[c] *= (uint32_t)detail;
    if (gas_shape_is_good(fine)) return SINGE_OK;
    return refuse(error, SINGE_ERROR_LIMIT, "gas", -1,
                  "the gas with detail %d has %u x %u x %u cells: the limits are 4096 a side and %d in total", detail,
                  fine->size[0], fine->size[1], fine->size[2], GAS_CELL_LIMIT);
}

SingeResult gas_detail_write_frame(const char *path, const Frame *frame, Pictures *pictures, int detail,
                                   SingeError *error) {
    Gas fine = {0};
    const SingeGas *coarse = &frame->gas.view;
    if (!coarse->size[0]) {
        return refuse(error, SINGE_ERROR_FILE, "output", -1, "%.200s: the frame has no gas", path);
    }

    SingeResult result = gas_detail_shape(coarse, detail, &fine.view, error);
    if (!result) result = gas_make(&fine, path, 0, error);
    if (!result)
        result = pictures_bake(pictures, &frame->surface, coarse, frame->time, detail, fine.extinction,
                               fine.flame_share, error);

    if (!result) {
        // the fine gas's velocity, between the coarse cells' centres, and its temperature
        const uint32_t *n = fine.view.size;
        uint32_t x[2], y[2], z[2];
        float s[3];
        size_t i = 0;

        for (uint32_t c = 0; c < n[2]; c++)
            for (uint32_t b = 0; b < n[1]; b++)
                for (uint32_t a = 0; a < n[0]; a++, i++) {
                    neighbours(a, detail, coarse->size[0], x, &s[0]);
                    neighbours(b, detail, coarse->size[1], y, &s[1]);
                    neighbours(c, detail, coarse->size[2], z, &s[2]);
                    float moved[3] = {0, 0, 0};
                    for (int k = 0; k < 8; k++) {
                        const size_t from = gas_index(coarse, x[k & 1], y[k >> 1 & 1], z[k >> 2]);
                        const float weight =
                            (k & 1 ? s[0] : 1 - s[0]) * (k >> 1 & 1 ? s[1] : 1 - s[1]) * (k >> 2 ? s[2] : 1 - s[2]);
                        for (int d = 0; d < 3; d++) moved[d] += weight * coarse->velocity[from][d];
                    }

                    for (int d = 0; d < 3; d++) fine.velocity[i][d] = moved[d];
                }

        const size_t count = gas_cells(&fine.view);
        for (i = 0; i < count; i++) {
            fine.temperature[i] = fine.flame_share[i] > 0 ? BRIGHTEST * sqrtf(sqrtf(fine.flame_share[i])) : 0;

            // practically clear air: half a metre of it hides a quarter of a percent. Most warm blocks become empty
            if (fine.extinction[i] >= 0.005f || fine.flame_share[i] >= 1e-4f) continue;
            fine.extinction[i] = fine.flame_share[i] = fine.temperature[i] = 0;
        }

        gas_decode(&fine);
        result = vdb_write_fine(path, &fine, frame->time, error);
    }

    gas_free(&fine);
    return result;
}

SingeResult gas_detail_convert(const Folder *folder, Pictures *pictures, int number, int detail, SingeError *error) {
    Frame frame = {0};
    char *path = folder_gas_detail(folder, number);
    SingeResult result = frame_read(folder, number, &frame, error);
    if (!result) result = gas_detail_write_frame(path, &frame, pictures, detail, error);
    frame_free(&frame);
    free(path);
    return result;
}

SingeResult gas_detail_write(const Job *job, const Folder *folder, int last, OutputsProgress *progress, void *context,
                             SingeError *error) {
    Pictures *pictures = NULL;
    SingeResult result = pictures_open(job, &pictures, error);
    for (int frame = 1; frame <= last && !result; frame++) {
        if (progress(context, frame)) {
            result = gas_detail_convert(folder, pictures, frame, job->scene->gas_detail, error);
            continue;
        }
        *error = (SingeError){.code = SINGE_ERROR_STATE, .stage = "gas", .element = -1, .message = "interrupted"};
        result = SINGE_ERROR_STATE;
    }

    pictures_close(pictures);
    return result;
}
