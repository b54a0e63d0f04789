// A frame as textures over the sheets' uv, for programs that keep the sheet's mesh and burn its material: an EXR with R
// the temperature (K), G the burnt fraction (0 fresh to 1 ash), B the emission of embers (in red, 2.5 at 1200 K) and A
// 1 where the sheet remains. The first sheet with uv has these channel names; those of later sheets have the sheet's
// name as a prefix.
//
// Values are dilated by 16 pixels beyond the remaining sheet, so that filters at a seam or a rim see no others. A is
// dilated only beyond the charts of the uncut sheet: holes remain.
#include "formats/burn_colour.h"
#include "formats/output.h"
#include "common/store.h"
#include "formats/usd.h"
#include "formats/uv_raster.h"

#include <stdio.h>
#include <string.h>

enum { TEXTURE_MARGIN = 16, TEXTURE_CHANNELS = 4 };

typedef struct Canvas {
    int size;
    size_t pixels;
    float *values;                      ///< [pixels][4] R G B A
    uint8_t *covered;                   ///< [pixels] the sheet remains
    uint8_t *chart;                     ///< [pixels] in a chart of the uncut sheet
    uint32_t *nearest, *queue;          ///< [pixels]
    float corners[3][TEXTURE_CHANNELS]; ///< of the triangle that is drawn
} Canvas;

static void draw_values(void *context, size_t pixel, const float weight[3]) {
    Canvas *c = context;
    c->covered[pixel] = c->chart[pixel] = 1;
    for (int k = 0; k < 3; k++)
        c->values[TEXTURE_CHANNELS * pixel + (size_t)k] =
            weight[0] * c->corners[0][k] + weight[1] * c->corners[1][k] + weight[2] * c->corners[2][k];
}

static void draw_chart(void *context, size_t pixel, const float weight[3]) {
    (void)weight;
    ((Canvas *)context)->chart[pixel] = 1;
}

typedef struct Layers {
    uint32_t count;
    uint32_t sheets[OUTPUT_TEXTURE_SHEETS];
    float *values[OUTPUT_TEXTURE_SHEETS];
    char names[OUTPUT_TEXTURE_SHEETS * TEXTURE_CHANNELS][USD_NAME + 8];
    ExrChannel channels[OUTPUT_TEXTURE_SHEETS * TEXTURE_CHANNELS];
} Layers;

static void canvas_draw(Canvas *canvas, const OutputScene *scene, const OutputFrame *frame, uint32_t sheet) {
    // the uncut sheet: each cell as four triangles around the mean of its corners
    for (uint32_t cell = 0; cell < scene->sheets[sheet].mesh.cell_count; cell++) {
        float cell_uv[4][2], centroid[2] = {0, 0};
        for (size_t corner = 0; corner < 4; corner++) {
            output_mesh_uv(&scene->sheets[sheet].mesh, cell, (int)corner, cell_uv[corner]);
            for (int k = 0; k < 2; k++) centroid[k] += cell_uv[corner][k] / 4;
        }

        for (int corner = 0; corner < 4; corner++) {
            const int j = (corner + 1) & 3;
            const float triangle[3][2] = {
                {centroid[0], centroid[1]}, {cell_uv[corner][0], cell_uv[corner][1]}, {cell_uv[j][0], cell_uv[j][1]}};
            uv_triangle(canvas->size, triangle, draw_chart, canvas);
        }
    }

    for (uint32_t t = 0; t < frame->surface->triangle_count; t++) {
        const uint32_t *v = frame->surface->triangles[t];
        float uv[3][2];
        if (frame->surface->sheet[v[0]] != (int32_t)sheet) continue;

        for (int k = 0; k < 3; k++) {
            memcpy(uv[k], frame->surface->uv[v[k]], sizeof uv[k]);
            canvas->corners[k][0] = frame->surface->temperature[v[k]];
            canvas->corners[k][1] = frame->surface->burn[v[k]];
            canvas->corners[k][2] = ember_light(frame->surface, v[k]);
        }

        uv_triangle(canvas->size, (const float(*)[2])uv, draw_values, canvas);
    }

    uv_spread(canvas->size, TEXTURE_MARGIN, canvas->chart, canvas->nearest, canvas->queue);
    for (size_t i = 0; i < canvas->pixels; i++)
        canvas->values[TEXTURE_CHANNELS * i + 3] = canvas->nearest[i] != UV_NONE && canvas->covered[canvas->nearest[i]];
    uv_spread(canvas->size, TEXTURE_MARGIN, canvas->covered, canvas->nearest, canvas->queue);
    for (size_t i = 0; i < canvas->pixels; i++)
        if (canvas->nearest[i] != UV_NONE && canvas->nearest[i] != i)
            memcpy(canvas->values + TEXTURE_CHANNELS * i,
                   canvas->values + TEXTURE_CHANNELS * (size_t)canvas->nearest[i], 3 * sizeof(float));
}

static SingeResult draw_layer(Layers *layers, const OutputScene *scene, const OutputFrame *frame, uint32_t sheet,
                              const char *path, SingeError *error) {
    static const char letters[] = "RGBA";
    const SingeAllocator a = frame->surface->allocator;
    const size_t pixels = (size_t)scene->texture_size * (size_t)scene->texture_size;
    const size_t bytes = TEXTURE_CHANNELS * sizeof(float);
    Canvas canvas = {.size = scene->texture_size,
                     .pixels = pixels,
                     .values = store_new(a, pixels, bytes),
                     .covered = store_new(a, pixels, 1),
                     .chart = store_new(a, pixels, 1),
                     .nearest = store_new(a, pixels, 4),
                     .queue = store_new(a, pixels, 4)};
    const bool made = canvas.values && canvas.covered && canvas.chart && canvas.nearest && canvas.queue;
    if (made) {
        memset(canvas.values, 0, pixels * bytes);
        memset(canvas.covered, 0, pixels);
        memset(canvas.chart, 0, pixels);
        canvas_draw(&canvas, scene, frame, sheet);
        layers->values[layers->count] = canvas.values;
    }

    if (!made) store_free(a, canvas.values, pixels, bytes);
    store_free(a, canvas.covered, pixels, 1);
    store_free(a, canvas.chart, pixels, 1);
    store_free(a, canvas.nearest, pixels, 4);
    store_free(a, canvas.queue, pixels, 4);
    if (!made) return refuse_memory(error, "textures", path);
    char prim[USD_NAME];
    usd_sheet_name(scene, sheet, prim);

    for (uint32_t k = 0; k < TEXTURE_CHANNELS; k++) {
        const uint32_t n = TEXTURE_CHANNELS * layers->count + k;
        snprintf(layers->names[n], sizeof layers->names[n], "%s%s%c", layers->count ? prim : "",
                 layers->count ? "." : "", letters[k]);
        layers->channels[n] = (ExrChannel){layers->names[n], EXR_KIND_HALF, canvas.values + k, TEXTURE_CHANNELS};
    }

    layers->count++;
    return SINGE_OK;
}

SingeResult textures_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                 SingeError *error) {
    const SingeAllocator a = frame->surface->allocator;
    SingeResult result = SINGE_OK;
    Layers *layers = store_new(a, 1, sizeof *layers);

    if (!layers) return refuse_memory(error, "textures", path);
    layers->count = 0;

    for (uint32_t i = 0; i < scene->sheet_count && !result; i++) {
        if (!output_mesh_has_uv(&scene->sheets[i].mesh)) continue;
        if (layers->count == OUTPUT_TEXTURE_SHEETS)
            result = refuse(error, SINGE_ERROR_LIMIT, "textures", -1, "%s: more than %d sheets with uv",
                            short_name(path), OUTPUT_TEXTURE_SHEETS);
        else result = draw_layer(layers, scene, frame, i, path, error);
    }

    if (!result && !layers->count)
        result = refuse(error, SINGE_ERROR_MESH, "textures", -1, "%s: no sheet has uv", short_name(path));
    if (!result)
        result = exr_write(path, scene->texture_size, scene->texture_size, layers->channels,
                           (int)(TEXTURE_CHANNELS * layers->count), NULL, error);

    const size_t pixels = (size_t)scene->texture_size * (size_t)scene->texture_size;
    for (uint32_t i = 0; i < layers->count; i++)
        store_free(a, layers->values[i], pixels, TEXTURE_CHANNELS * sizeof(float));
    store_free(a, layers, 1, sizeof *layers);
    return result;
}
