#include "cli/pictures.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "cli/cryptomatte.h"
#include "cli/interrupt.h"
#include "common/store.h"

struct Pictures {
    const Scene *scene;
    const SceneAssets *assets;
    PreviewDef def;
    Preview *preview;
    PreviewShape *shapes;
    PreviewStart *starts;
    uint32_t shape_max;
    uint8_t *rgb;
    PreviewLayers layers; ///< empty unless they are kept
};

static SingeResult no_memory(SingeError *error) {
    return refuse(error, SINGE_ERROR_MEMORY, "preview", -1, "out of memory");
}

static SingeResult open_def(const Job *job, const PreviewDef *def, Pictures **made, SingeError *error) {
    *made = NULL;
    Pictures *pictures = calloc(1, sizeof *pictures);
    if (!pictures) return no_memory(error);

    pictures->scene = job->scene;
    pictures->assets = &job->assets;
    pictures->def = *def;
    pictures->starts = calloc(job->assets.sheet_count + 1, sizeof *pictures->starts);
    for (uint32_t s = 0; pictures->starts && s < job->assets.sheet_count; s++) {
        const Mesh *mesh = &job->assets.meshes[s];
        pictures->starts[s] = (PreviewStart){mesh->vertex_count, mesh->cell_count, mesh->positions,
                                             mesh->cells,        mesh->uv,         mesh->corner_uv};
    }

    pictures->def.starts = pictures->starts;
    pictures->shape_max = scene_shapes(job->scene, &job->assets, 0, NULL, 0);
    pictures->shapes = calloc(pictures->shape_max + 1, sizeof *pictures->shapes);
    pictures->rgb = malloc((size_t)pictures->def.width * (size_t)pictures->def.height * 3);
    SingeResult result = pictures->shapes && pictures->starts && pictures->rgb ? SINGE_OK : no_memory(error);
    if (!result) result = preview_create(&pictures->def, (SingeAllocator){0}, &pictures->preview, error);
    if (result) pictures_close(pictures);
    else *made = pictures;
    return result;
}

static PreviewDef scene_def(const Job *job) {
    PreviewDef def;
    scene_preview(job->scene, &job->assets, &def);
    def.thread_count = job->hooks.thread_count;
    def.stop = interrupt_overdue;
    return def;
}

SingeResult pictures_open(const Job *job, Pictures **pictures, SingeError *error) {
    const PreviewDef def = scene_def(job);
    return open_def(job, &def, pictures, error);
}

static SingeResult open_layers(const Job *job, PreviewDef *def, Pictures **pictures, SingeError *error) {
    def->samples = 4;
    def->camera.aperture = 0;
    def->shutter = 0;
    SingeResult result = open_def(job, def, pictures, error);
    if (!result) result = pictures_keep_layers(*pictures, error);

    if (result) {
        pictures_close(*pictures);
        *pictures = NULL;
    }

    return result;
}

SingeResult pictures_open_sharp(const Job *job, Pictures **pictures, SingeError *error) {
    PreviewDef def = scene_def(job);
    return open_layers(job, &def, pictures, error);
}

SingeResult pictures_open_embers(const Job *job, Pictures **pictures, SingeError *error) {
    enum { SCALE = 3, WIDE = 4096 }; // embers are thinner than a pixel, unless the pictures are large
    PreviewDef def = scene_def(job);
    const int longest = def.width > def.height ? def.width : def.height;
    int scale = SCALE;
    while (scale > 1 && scale * longest > WIDE) scale--;
    def.width *= scale;
    def.height *= scale;

    // what glows is measured, and nothing that is lit
    def.ground_height = def.wall_distance = -INFINITY;
    for (int k = 0; k < 3; k++) def.sun_colour[k] = def.lamp_colour[k] = def.sky_colour[k] = 0;
    return open_layers(job, &def, pictures, error);
}

const uint8_t *pictures_draw(Pictures *pictures, const SingeSurface *surface, const SingeGas *gas, double time,
                             SingeError *error) {
    // a ball may become hot later, so the number may have grown
    uint32_t count = scene_shapes(pictures->scene, pictures->assets, time, NULL, 0);
    if (count > pictures->shape_max) {
        PreviewShape *shapes = realloc(pictures->shapes, count * sizeof *shapes);
        if (!shapes) {
            *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "preview", .element = -1};
            return NULL;
        }
        pictures->shapes = shapes;
        pictures->shape_max = count;
    }

    count = scene_shapes(pictures->scene, pictures->assets, time, pictures->shapes, pictures->shape_max);
    PreviewCamera camera;
    scene_camera(pictures->scene, time, &camera);
    camera.aperture = pictures->def.camera.aperture; // a picture to be measured is sharp
    pictures->def.camera = camera;                   // measures look through it

    SingeResult result = preview_set_camera(pictures->preview, &camera, error);
    if (!result) result = preview_set_shapes(pictures->preview, pictures->shapes, count, error);
    if (!result) result = preview_set_gas(pictures->preview, gas, error);
    if (!result)
        result = preview_draw_layers(pictures->preview, surface, time, pictures->rgb, &pictures->layers, error);
    return result ? NULL : pictures->rgb;
}

SingeResult pictures_bake(Pictures *pictures, const SingeSurface *surface, const SingeGas *gas, double time, int detail,
                          float *smoke, float *flame, SingeError *error) {
    SingeResult result = preview_set_gas(pictures->preview, gas, error);
    if (!result) result = preview_bake_gas(pictures->preview, surface, time, detail, smoke, flame, error);
    return result;
}

SingeResult pictures_keep_layers(Pictures *pictures, SingeError *error) {
    size_t count = (size_t)pictures->def.width * (size_t)pictures->def.height;
    PreviewLayers *l = &pictures->layers;

    l->beauty = calloc(count, sizeof *l->beauty);
    l->glow = calloc(count, sizeof *l->glow);
    l->normal = calloc(count, sizeof *l->normal);
    l->coverage = calloc(count, sizeof *l->coverage);
    l->fire = calloc(count, sizeof *l->fire);
    l->temperature = calloc(count, sizeof *l->temperature);
    l->burn = calloc(count, sizeof *l->burn);
    l->depth = calloc(count, sizeof *l->depth);
    l->sheet = calloc(count, sizeof *l->sheet);
    l->piece = calloc(count, sizeof *l->piece);
    l->mattes = calloc(count, sizeof *l->mattes);

    bool all = l->beauty && l->glow && l->normal && l->coverage && l->fire && l->temperature && l->burn && l->depth &&
               l->sheet && l->piece && l->mattes;
    return all ? SINGE_OK : no_memory(error);
}

SingeResult pictures_ember_width(Pictures *pictures, const SingeSurface *surface, double time, double *width,
                                 SingeError *error) {
    if (!pictures_draw(pictures, surface, NULL, time, error)) return error->code;
    return preview_glow_width(&pictures->def, &pictures->layers, width, error);
}

FlameShares pictures_flame_shares(const Pictures *pictures) {
    FlameShares shares;
    preview_flame_shares(&pictures->def, &pictures->layers, pictures->rgb, &shares);
    return shares;
}

SingeResult pictures_flame_feet(const Pictures *pictures, const SingeSurface *surface, FlameFeet *feet,
                                SingeError *error) {
    return preview_flame_feet(&pictures->def, &pictures->layers, pictures->rgb, surface, feet, error);
}

/// Ids as they are written: counted from 1, so that 0 is none.
static uint32_t *count_ids(const int32_t *ids, size_t count) {
    uint32_t *counted = malloc(count * sizeof *counted);
    for (size_t i = 0; counted && i < count; i++) counted[i] = ids[i] < 0 ? 0 : (uint32_t)ids[i] + 1;
    return counted;
}

enum { LAYER_CHANNELS = 19, MATTE_LAYERS = 2 };

static SingeResult write_layers(const Pictures *pictures, const char *path, const uint32_t *sheet,
                                const uint32_t *piece, const Cryptomatte mattes[MATTE_LAYERS], SingeError *error) {
    const PreviewLayers *l = &pictures->layers;
    ExrChannel channels[LAYER_CHANNELS + MATTE_LAYERS * CRYPTOMATTE_CHANNELS] = {
        {"R", EXR_KIND_HALF, &l->beauty[0][0], 3},
        {"G", EXR_KIND_HALF, &l->beauty[0][1], 3},
        {"B", EXR_KIND_HALF, &l->beauty[0][2], 3},
        {"Z", EXR_KIND_FLOAT, l->depth, 1},
        {"glow.R", EXR_KIND_HALF, &l->glow[0][0], 3},
        {"glow.G", EXR_KIND_HALF, &l->glow[0][1], 3},
        {"glow.B", EXR_KIND_HALF, &l->glow[0][2], 3},
        {"fire.R", EXR_KIND_HALF, &l->fire[0][0], 4},
        {"fire.G", EXR_KIND_HALF, &l->fire[0][1], 4},
        {"fire.B", EXR_KIND_HALF, &l->fire[0][2], 4},
        {"fire.A", EXR_KIND_HALF, &l->fire[0][3], 4},
        {"normal.X", EXR_KIND_HALF, &l->normal[0][0], 3},
        {"normal.Y", EXR_KIND_HALF, &l->normal[0][1], 3},
        {"normal.Z", EXR_KIND_HALF, &l->normal[0][2], 3},
        {"temperature.K", EXR_KIND_FLOAT, l->temperature, 1},
        {"char.Y", EXR_KIND_HALF, l->burn, 1},
        {"coverage.Y", EXR_KIND_HALF, l->coverage, 1},
        {"id.sheet", EXR_KIND_ID, sheet, 1},
        {"id.piece", EXR_KIND_ID, piece, 1},
    };

    ExrText texts[MATTE_LAYERS * CRYPTOMATTE_TEXTS + 1] = {{NULL, NULL}};
    for (int m = 0; m < MATTE_LAYERS; m++) {
        memcpy(channels + LAYER_CHANNELS + m * CRYPTOMATTE_CHANNELS, mattes[m].channels, sizeof mattes[m].channels);
        memcpy(texts + m * CRYPTOMATTE_TEXTS, mattes[m].texts, sizeof mattes[m].texts);
    }

    return exr_write(path, pictures->def.width, pictures->def.height, channels,
                     (int)(sizeof channels / sizeof *channels), texts, error);
}

SingeResult pictures_write_layers(const Pictures *pictures, const char *path, SingeError *error) {
    const PreviewLayers *l = &pictures->layers;
    const size_t pixels = (size_t)pictures->def.width * (size_t)pictures->def.height;
    const PreviewMatte(*shares)[PREVIEW_MATTES] = (const PreviewMatte(*)[PREVIEW_MATTES])l->mattes;
    uint32_t *sheet = count_ids(l->sheet, pixels), *piece = count_ids(l->piece, pixels);
    const Scene *scene = pictures->scene;

    // the sheets' own names, or their numbers
    enum { LONG = 24 };
    const char **names = calloc(scene->sheet_count + 1, sizeof *names + LONG);
    for (uint32_t i = 0; names && i < scene->sheet_count; i++) {
        char *own = (char *)(names + scene->sheet_count + 1) + LONG * (size_t)i;
        snprintf(own, LONG, "sheet %u", i);
        names[i] = scene->sheets[i].name ? scene->sheets[i].name : own;
    }

    Cryptomatte mattes[MATTE_LAYERS] = {{.values = NULL}, {.values = NULL}};
    bool room = sheet && piece && names;
    room = room && cryptomatte_make(&mattes[0], "CryptoSheet", false, names, shares, pixels);
    room = room && cryptomatte_make(&mattes[1], "CryptoPiece", true, names, shares, pixels);

    SingeResult result = room ? write_layers(pictures, path, sheet, piece, mattes, error) : no_memory(error);
    for (int m = 0; m < MATTE_LAYERS; m++) cryptomatte_free(&mattes[m]);
    free(names);
    free(sheet);
    free(piece);
    return result;
}

void pictures_size(const Pictures *pictures, int *width, int *height) {
    *width = pictures->def.width;
    *height = pictures->def.height;
}

void pictures_close(Pictures *pictures) {
    if (!pictures) return;
    preview_destroy(pictures->preview);

    const PreviewLayers *l = &pictures->layers;
    void *const layers[] = {l->beauty, l->glow,  l->normal, l->coverage, l->fire,  l->temperature,
                            l->burn,   l->depth, l->sheet,  l->piece,    l->mattes};
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) free(layers[i]);
    free(pictures->shapes);
    free(pictures->starts);
    free(pictures->rgb);
    free(pictures);
}

// ---- frames

void frame_free(Frame *frame) {
    singe_surface_free(&frame->surface);
    gas_free(&frame->gas);
    *frame = (Frame){0};
}

SingeResult frame_take_surface(SingeSim *sim, Frame *frame, SingeError *error) {
    SingeResult result = singe_sim_surface(sim, &frame->surface);
    if (result) *error = *singe_sim_error(sim);
    frame->stats = singe_sim_stats(sim);
    frame->time = frame->stats.time;
    return result;
}

SingeResult frame_take_gas(SingeSim *sim, Frame *frame, SingeError *error) {
    SingeGas gas = singe_sim_gas(sim);
    gas_free(&frame->gas);
    return gas.size[0] > 0 ? gas_copy(&gas, (SingeAllocator){0}, &frame->gas, error) : SINGE_OK;
}

SingeResult frame_read_surface(const Folder *folder, int number, Frame *frame, SingeError *error) {
    Bytes bytes = {0};
    *frame = (Frame){0};

    char *path = folder_ply(folder, number);
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result)
        result =
            ply_read_surface(path, bytes.data, bytes.size, (SingeAllocator){0}, &frame->surface, &frame->time, error);
    bytes_free(&bytes);
    free(path);
    return result;
}

SingeResult frame_read(const Folder *folder, int number, Frame *frame, SingeError *error) {
    SingeResult result = frame_read_surface(folder, number, frame, error);
    if (result) return result;

    // the gas is empty if the cache has no file of it
    Bytes bytes = {0};
    char *path = folder_vdb(folder, number);
    if (access(path, F_OK) == 0 || errno != ENOENT) {
        result = file_read(path, (SingeAllocator){0}, &bytes, error);
        if (!result) result = vdb_read_gas(path, bytes.data, bytes.size, (SingeAllocator){0}, &frame->gas, NULL, error);
        bytes_free(&bytes);
    }
    free(path);

    return result;
}

SingeResult frame_draw(const Frame *frame, Pictures *pictures, const uint8_t **rgb, SingeError *error) {
    *rgb = pictures_draw(pictures, &frame->surface, &frame->gas.view, frame->time, error);
    if (*rgb) return SINGE_OK;
    return error->code ? error->code : SINGE_ERROR_STATE;
}

SingeResult frame_write_picture(Pictures *pictures, const uint8_t *rgb, const char *png, const char *exr,
                                SingeError *error) {
    int width, height;
    pictures_size(pictures, &width, &height);
    SingeResult result = png_write(png, width, height, rgb, error);
    return result || !exr ? result : pictures_write_layers(pictures, exr, error);
}

// ---- contact sheets

enum { SHEET_WIDTH = 1920 };

SingeResult contact_sheet_make(ContactSheet *sheet, int columns, int rows, int frame_width, int frame_height,
                               SingeError *error) {
    int shrink = (columns * frame_width + SHEET_WIDTH - 1) / SHEET_WIDTH;
    int shortest = frame_width < frame_height ? frame_width : frame_height;
    if (shrink > shortest) shrink = shortest;
    if (shrink < 1) shrink = 1;

    *sheet = (ContactSheet){.columns = columns,
                            .rows = rows,
                            .frame_width = frame_width,
                            .frame_height = frame_height,
                            .shrink = shrink,
                            .width = columns * (frame_width / shrink),
                            .height = rows * (frame_height / shrink)};
    sheet->rgb = calloc((size_t)sheet->width * 3, (size_t)sheet->height);
    if (sheet->rgb) return SINGE_OK;

    return refuse(error, SINGE_ERROR_MEMORY, "sheet.png", -1, "out of memory");
}

void contact_sheet_put(ContactSheet *sheet, int tile, const uint8_t *rgb) {
    const int shrink = sheet->shrink, w = sheet->frame_width / shrink, h = sheet->frame_height / shrink;
    const int left = tile % sheet->columns * w, top = tile / sheet->columns * h;
    const unsigned count = (unsigned)(shrink * shrink);

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int k = 0; k < 3; k++) {
                unsigned sum = 0;
                for (int i = 0; i < shrink; i++)
                    for (int j = 0; j < shrink; j++)
                        sum +=
                            rgb[3 * ((size_t)(y * shrink + i) * (size_t)sheet->frame_width + (size_t)(x * shrink + j)) +
                                (size_t)k];
                sheet->rgb[3 * ((size_t)(top + y) * (size_t)sheet->width + (size_t)(left + x)) + (size_t)k] =
                    (uint8_t)((sum + count / 2) / count);
            }
}

void contact_sheet_free(ContactSheet *sheet) {
    free(sheet->rgb);
    *sheet = (ContactSheet){0};
}

int contact_sheet_frame(int tile, int tiles, int first, int last) {
    return tiles < 2 ? first : first + (int)(((long)(last - first) * tile + (tiles - 1) / 2) / (tiles - 1));
}
