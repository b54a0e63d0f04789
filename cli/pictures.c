#include "cli/pictures.h"

#include <stdlib.h>

struct Pictures {
    const Scene *scene;
    PreviewDef def;
    Preview *preview;
    PreviewShape *shapes;
    uint32_t shape_max;
    uint8_t *rgb;
};

bool pictures_available(void) { return true; }

static SingeResult no_memory(SingeError *error) {
    *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "preview", .element = -1};
    return SINGE_ERROR_MEMORY;
}

SingeResult pictures_open(const Job *job, Pictures **made, SingeError *error) {
    *made = NULL;
    Pictures *pictures = calloc(1, sizeof *pictures);
    if (!pictures) return no_memory(error);
    pictures->scene = job->scene;
    scene_preview(job->scene, &job->assets, &pictures->def);
    pictures->def.thread_count = job->hooks.thread_count;
    pictures->shape_max = scene_shapes(job->scene, 0, NULL, 0);
    pictures->shapes = calloc(pictures->shape_max + 1, sizeof *pictures->shapes);
    pictures->rgb = malloc((size_t)pictures->def.width * (size_t)pictures->def.height * 3);
    SingeResult result = pictures->shapes && pictures->rgb ? SINGE_OK : no_memory(error);
    if (!result) result = preview_create(&pictures->def, (SingeAllocator){0}, &pictures->preview, error);
    if (result) pictures_close(pictures);
    else *made = pictures;
    return result;
}

const uint8_t *pictures_draw(Pictures *pictures, const SingeSurface *surface, double time, SingeError *error) {
    // a ball may be hot at one time and not at another, so the number may have grown
    uint32_t count = scene_shapes(pictures->scene, time, NULL, 0);
    if (count > pictures->shape_max) {
        PreviewShape *shapes = realloc(pictures->shapes, count * sizeof *shapes);
        if (!shapes) {
            *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "preview", .element = -1};
            return NULL;
        }
        pictures->shapes = shapes, pictures->shape_max = count;
    }
    count = scene_shapes(pictures->scene, time, pictures->shapes, pictures->shape_max);
    if (preview_set_shapes(pictures->preview, pictures->shapes, count, error)) return NULL;
    if (preview_draw(pictures->preview, surface, time, pictures->rgb, error)) return NULL;
    return pictures->rgb;
}

void pictures_size(const Pictures *pictures, int *width, int *height) {
    *width = pictures->def.width, *height = pictures->def.height;
}

void pictures_close(Pictures *pictures) {
    if (!pictures) return;
    preview_destroy(pictures->preview);
    free(pictures->shapes);
    free(pictures->rgb);
    free(pictures);
}
