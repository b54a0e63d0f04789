// The memory that a scene needs, from its numbers and the sizes of its pictures. Bytes per cell were measured on sheets
// of 10,000 to 490,000 cells, which differ by 5 % (tests/cli/test_usage.py compares the estimate with a run).
#include "formats/formats.h"
#include "scene/messages.h"
#include "scene/space.h"
#include "scene/scene.h"
#include "scene/assets.h"

#include <math.h>
#include <stdlib.h>

/// Bytes of a cell with its springs and its share of the drawn mesh, and bytes added by contact: more than flat sheets
/// need, as the lists of contact grow where sheets crowd.
static const double cell_bytes = 3.6e3, contact_bytes = 3.2e3;
/// Gas: bytes per cell, default and max number of cells, and the margin around and below the sheets, m.
static const double gas_bytes = 160, gas_cells_usual = 200e3, gas_cells_max = 2e6, gas_margin = 0.045;
/// Bytes per pixel: of the drawn picture and of its layers while they are written (measured with 4 and 17 million pixels:
/// 153 to 160 and 158 to 165), of a sheet's picture, of a parameter's texture while it is read, and of a heightfield,
/// simulated (1 and 9 million pixels: 42 to 45) and drawn (2 million: 255).
static const double pixel_bytes = 160, layer_bytes = 165, picture_bytes = 3, texture_bytes = 7, height_bytes = 45,
                    drawn_height_bytes = 260;
/// Of a triangle of a mesh that is drawn in place of a sheet.
static const double render_bytes = 600;
static const double program_bytes = 40e6;

static uint64_t sheet_cells(const Scene *scene, const SceneAssets *assets, uint32_t index) {
    const SceneSheet *sheet = &scene->sheets[index];
    if (assets) return assets->meshes[index].cell_count;
    return sheet->grid.given ? (uint64_t)sheet->grid.def.cells[0] * sheet->grid.def.cells[1] : 0;
}

static double gas_cells(const Scene *scene, const SceneAssets *assets) {
    const double cell = (double)scene->sim.gas.cell_size;
    if (!(cell > 0)) return gas_cells_usual;

    // around the sheets, as far as they are known
    Box box = BOX_EMPTY;
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const SceneSheet *sheet = &scene->sheets[i];
        double turned[9], low[3], high[3];
        rotation_matrix(sheet->rotate, turned);

        for (int c = 0; c < 3 && sheet->grid.given; c++) {
            const float *size = sheet->grid.def.size;
            double half = fabs(turned[3 * c]) * (double)size[0] + fabs(turned[3 * c + 1]) * (double)size[1];
            half *= 0.5 * (double)sheet->scale;
            low[c] = (double)sheet->translate[c] - half;
            high[c] = (double)sheet->translate[c] + half;
        }

        if (sheet->grid.given) box_add(&box, low, high);
        else if (assets) box_add_points(&box, assets->meshes[i].positions, assets->meshes[i].vertex_count);
    }

    double cells = 1;
    for (int i = 0; i < 3; i++) {
        const double room = i == 2 ? gas_margin + (double)scene->sim.gas.height : 2 * gas_margin;
        cells *= (fmax(box.high[i] - box.low[i], 0) + room) / cell + 8; // at most a multiple of 8
    }

    return fmin(cells, gas_cells_max);
}

static double pixels_of(const SceneFile *file) {
    int width, height;
    char *first = file->path && sequence_name_fits(file->name) ? sequence_path(file->path, 1) : NULL;
    const char *path = first ? first : file->path;
    const double pixels = path && image_size(path, &width, &height) ? (double)width * (double)height : 0;
    free(first);
    return pixels;
}

/// Pixels of a collider's heights.
static double height_pixels(const SceneCollider *collider) {
    return collider->def.kind == SINGE_COLLIDER_HEIGHTFIELD ? pixels_of(&collider->picture) : 0;
}

SceneSize scene_size(const Scene *scene, const SceneAssets *assets) {
    SceneSize size = {.memory = program_bytes};
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        size.cells += sheet_cells(scene, assets, i);
        size.unread += !assets && scene->sheets[i].mesh.name;
    }

    size.memory += (double)size.cells * (cell_bytes + (scene->sim.contact.enabled ? contact_bytes : 0));

    for (uint32_t i = 0; i < scene->sheet_count && assets; i++)
        size.memory += render_bytes * (double)assets->renders[i].def.triangle_count;

    // all pictures that are read
    double pictures = picture_bytes * pixels_of(&scene->preview.environment_picture);
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        pictures += picture_bytes * (pixels_of(&scene->sheets[i].picture) + pixels_of(&scene->sheets[i].back));
        for (size_t k = 0; k < SCENE_PARAM_SLOTS; k++)
            pictures += texture_bytes * pixels_of(&scene->sheets[i].material.followed[k].texture);
    }

    for (uint32_t i = 0; i < scene->source_count; i++)
        pictures += texture_bytes * pixels_of(&scene->sources[i].texture);
    for (uint32_t i = 0; i < scene->collider_count; i++) pictures += height_bytes * height_pixels(&scene->colliders[i]);
    size.memory += pictures;

    if (scene->sim.gas.enabled) size.memory += gas_bytes * gas_cells(scene, assets);
    return size;
}

double scene_picture_memory(const Scene *scene, bool layers) {
    const double pixels = (double)scene->preview.def.width * (double)scene->preview.def.height;
    double memory = (pixel_bytes + (layers ? layer_bytes : 0)) * pixels;
    for (uint32_t i = 0; i < scene->collider_count; i++)
        if (scene->colliders[i].visible) memory += drawn_height_bytes * height_pixels(&scene->colliders[i]);
    return memory;
}

/// "4.3 GB", or "38 MB" where that many gigabytes would have no digit.
static const char *bytes_text(double bytes, char text[24]) {
    if (bytes < 0.995e9) snprintf(text, 24, "%.0f MB", 1e-6 * bytes);
    else snprintf(text, 24, "%.1f GB", 1e-9 * bytes);
    return text;
}

bool scene_fits(const Scene *scene, const SceneAssets *assets, double wanted, double room, SceneMessages *messages) {
    if (!(room > 0) || wanted <= room) return true;

    // a heightfield that needs more than half of the memory, or else the largest sheet
    const SceneCollider *heights = NULL;
    double pixels = 0;
    char needs[24], has[24];

    for (uint32_t i = 0; i < scene->collider_count; i++) {
        const double count = height_pixels(&scene->colliders[i]);
        if (count > pixels) {
            heights = &scene->colliders[i];
            pixels = count;
        }
    }

    if (pixels * (height_bytes + (heights && heights->visible ? drawn_height_bytes : 0)) > 0.5 * wanted) {
        message_add(messages, scene->text, heights->picture.location,
                    "the scene needs about %s of memory, but only %s are available: give its heightfield fewer pixels",
                    bytes_text(wanted, needs), bytes_text(room, has));
        return false;
    }

    const PreviewDef *preview = &scene->preview.def;
    if (wanted > 2 * scene_size(scene, assets).memory) {
        message_add(messages, scene->text, (SceneLocation){0},
                    "the scene needs about %s of memory, and there are %s: give its pictures fewer pixels than %d x %d "
                    "(preview.size), or leave out --exr, or all pictures (--no-preview)",
                    bytes_text(wanted, needs), bytes_text(room, has), preview->width, preview->height);
        return false;
    }

    uint32_t largest = 0;
    for (uint32_t i = 1; i < scene->sheet_count; i++)
        if (sheet_cells(scene, assets, i) > sheet_cells(scene, assets, largest)) largest = i;
    message_add(messages, scene->text, scene->sheets[largest].location, // there is at least one sheet
                "the scene needs about %s of memory, but only %s are available: give its sheets fewer cells",
                bytes_text(wanted, needs), bytes_text(room, has));

    return false;
}
