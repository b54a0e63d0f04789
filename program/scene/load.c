// Reads the files of a scene: meshes, which are transformed, and pictures.
#include "common/printable.h"
#include "common/store.h"
#include "scene/faults.h"
#include "scene/space.h"
#include "scene/schema.h"
#include "scene/assets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Loader {
    const Scene *scene;
    SceneAssets *assets;
    SceneMessages *messages;
    bool no_memory;
} Loader;

static SingeResult loader_fail(Loader *loader, const SceneFile *file, SingeResult result, const char *why) {
    message_add(loader->messages, loader->scene->text, file->location, "%s", why);
    if (result == SINGE_ERROR_MEMORY) loader->no_memory = true;
    return result;
}

static SingeResult read_image(const char *path, Image *image, SingeError *error) {
    Bytes bytes = {0};
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result) result = image_read(path, bytes.data, bytes.size, (SingeAllocator){0}, image, error);
    bytes_free(&bytes);
    return result;
}

static SingeResult load_image(Loader *loader, const SceneFile *file, Image *image) {
    SingeError error = {0};
    SingeResult result = read_image(file->path, image, &error);
    return result ? loader_fail(loader, file, result, error.message) : SINGE_OK;
}

SingeResult luminance_read(const char *path, SingeTexture *picture, SingeError *error) {
    Image image = {0};
    SingeResult result = read_image(path, &image, error);
    if (!result) result = image_luminance(&image, (SingeAllocator){0}, picture, error);
    image_free(&image);
    return result;
}

/// Of a numbered file the first, after a check that none is missing.
static void load_luminance(Loader *loader, const SceneFile *file, SingeTexture *picture) {
    SingeError error = {0};
    const bool numbered = sequence_name_fits(file->name);
    char *first = numbered ? sequence_path(file->path, 1) : NULL;
    int length;
    SingeResult result = numbered && !first ? SINGE_ERROR_MEMORY : SINGE_OK;
    if (!result && numbered) result = sequence_length(file->path, 1, loader->scene->frames, &length, &error);
    if (!result) result = luminance_read(first ? first : file->path, picture, &error);
    free(first);
    if (result) loader_fail(loader, file, result, error.message);
}

/// The simulation reports positions farther out as divergence.
static const float coordinate_max = 1e4f;

/// Grids are in metres.
double metres_per_unit(int unit, float scale) {
    static const double units[] = {[SCENE_UNITS_M] = 1,
                                   [SCENE_UNITS_CM] = 0.01,
                                   [SCENE_UNITS_MM] = 0.001,
                                   [SCENE_UNITS_IN] = 0.0254,
                                   [SCENE_UNITS_FT] = 0.3048};
    return units[unit] * (double)scale;
}

/// Scales, rotates and translates positions, of a file or of a grid. Returns whether all can be simulated.
static bool transform(const SceneSheet *sheet, bool file, float *positions, uint32_t count) {
    const double scale = metres_per_unit(file ? sheet->units : SCENE_UNITS_M, sheet->scale);
    double r[9];
    rotation_matrix(sheet->rotate, r);
    bool near = true;
    bool turned = sheet->rotate[0] != 0 || sheet->rotate[1] != 0 || sheet->rotate[2] != 0;

    for (uint32_t v = 0; v < count; v++) {
        float *p = positions + 3 * (size_t)v;
        double x = (double)p[0] * scale, y = (double)p[1] * scale, z = (double)p[2] * scale;
        if (file && sheet->up == SCENE_UP_Y) {
            double up = y;
            y = -z;
            z = up;
        }

        double q[3] = {x, y, z};
        for (int i = 0; i < 3 && turned; i++) q[i] = r[3 * i] * x + r[3 * i + 1] * y + r[3 * i + 2] * z;
        for (int i = 0; i < 3; i++)
            near = fabsf(p[i] = (float)(q[i] + (double)sheet->translate[i])) < coordinate_max && near;
    }

    return near;
}

static const char too_far[] = "the sheet reaches beyond 10 km from the origin";

/// Reads a file's polygons and puts them where the sheet is.
static SingeResult read_polygons(const SceneSheet *sheet, const char *path, Polygons *polygons, SingeError *error) {
    Bytes bytes = {0};
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result) result = polygons_read(path, bytes.data, bytes.size, (SingeAllocator){0}, polygons, error);
    bytes_free(&bytes);
    if (result || transform(sheet, true, polygons->positions, polygons->vertex_count)) return result;
    return refuse(error, SINGE_ERROR_MESH, "mesh", -1, "%s", too_far);
}

/// Reads a file's polygons and converts them to quads, or makes the grid.
static void load_mesh(Loader *loader, const SceneSheet *sheet, Mesh *mesh, MeshReport *report) {
    SingeError error = {0};
    if (!sheet->mesh.name) {
        const SingeGridDef *grid = &sheet->grid.def;
        const SceneFile at = {.location = sheet->location};
        SingeResult result =
            mesh_grid(grid->size[0], grid->size[1], grid->cells[0], grid->cells[1], (SingeAllocator){0}, mesh, &error);
        if (result) {
            loader_fail(loader, &at, result, error.message);
            return;
        }

        mesh_grid_wear(mesh, grid->cells[0], grid->cells[1], &(GridWear){grid->jitter, grid->displacement, grid->seed});
        if (!transform(sheet, false, mesh->positions, mesh->vertex_count))
            message_add(loader->messages, loader->scene->text, at.location, "%s", too_far);
        return;
    }

    Polygons polygons = {0};
    MeshOptions options = mesh_default_options();
    options.weld = sheet->weld;
    options.quads = sheet->quads;

    const char *path = sheet->mesh.path;
    SingeResult result = read_polygons(sheet, path, &polygons, &error);
    if (!result) result = mesh_make(path, &polygons, &options, (SingeAllocator){0}, mesh, report, &error);
    polygons_free(&polygons);
    if (result) loader_fail(loader, &sheet->mesh, result, error.message);
}

/// The mesh that is drawn in place of a sheet.
static void load_render_mesh(Loader *loader, const SceneSheet *sheet, RenderFile *file) {
    const SceneRenderMesh *given = &sheet->render_mesh;
    Polygons polygons = {0};
    SingeError error = {0};
    if (!given->mesh.name) return;

    SingeResult result = read_polygons(sheet, given->mesh.path, &polygons, &error);
    if (!result) result = render_file_make(given->mesh.path, &polygons, file, &error);
    polygons_free(&polygons);
    if (result) loader_fail(loader, &given->mesh, result, error.message);
    file->def.reach = given->def.reach;
    file->def.edge_max = given->def.edge_max;
    file->def.rigid = given->def.rigid;
    file->def.beside = given->def.beside;
    file->def.by_uv = given->def.by_uv;
}

static void load_sheet(Loader *loader, uint32_t index) {
    const Scene *scene = loader->scene;
    const SceneSheet *sheet = &scene->sheets[index];
    SceneAssets *assets = loader->assets;
    Mesh *mesh = &assets->meshes[index];
    load_mesh(loader, sheet, mesh, &assets->reports[index]);
    load_render_mesh(loader, sheet, &assets->renders[index]);
    memcpy(assets->colours[index], sheet->colour, sizeof sheet->colour);

    assets->transmittances[index] = sheet->transmittance;
    assets->looks[index] = sheet->material.look;
    if (sheet->picture.name && !load_image(loader, &sheet->picture, &assets->images[index]))
        assets->pictures[index] = &assets->images[index];

    const uint32_t back = scene->sheet_count + index;
    if (sheet->back.name && !load_image(loader, &sheet->back, &assets->images[back]))
        assets->pictures[back] = &assets->images[back];

    // what the material's parameters follow
    SingeMaterialDef material = sheet->material.def;
    const SceneFile *attribute = NULL;
    bool changes = false; // over time
    SceneParam row;

    for (int i = 0; scene_param(i, &row); i++) {
        const SingeField *field = scene_param_at(&material, &row)->field;
        const SceneFollowed *followed = &sheet->material.followed[row.slot];
        const SceneFile *file = &followed->texture;
        changes = changes || followed->key_count || (file->name && sequence_name_fits(file->name));
        if (!field) continue;

        if (field->kind == SINGE_FIELD_ATTRIBUTE) attribute = file;
        assets->fields[index][row.slot] = *field;
        if (field->kind == SINGE_FIELD_TEXTURE) {
            load_luminance(loader, file, &assets->fields[index][row.slot].texture);
            if (mesh->positions && !mesh->uv)
                message_add(loader->messages, scene->text, file->location,
                            "%s follows a texture, but the mesh has no uv", row.key);
        }
        if (field->kind != SINGE_FIELD_ATTRIBUTE || !mesh->positions) continue;

        Nearest nearest = {.word = field->attribute};
        uint32_t a = 0;
        for (; a < mesh->attribute_count && strcmp(mesh->attributes[a].name, field->attribute) != 0; a++)
            nearest_offer(&nearest, mesh->attributes[a].name);
        char hint[80];
        if (a < mesh->attribute_count) continue;

        if (file->location.file) // the contents of files other than the scene are not shown
            message_add(loader->messages, scene->text, file->location, "%s: the mesh has no such attribute", row.key);
        else
            message_add(loader->messages, scene->text, file->location, "%s: the mesh has no attribute '%s'%s", row.key,
                        shown(field->attribute).text, nearest_hint(&nearest, hint, sizeof hint));
    }

    if (changes && attribute)
        message_add(
            loader->messages, scene->text, attribute->location,
            "a material that changes over time, by keys or by a picture for each frame, cannot follow an attribute");
}

/// Reads the files of a collider or pin that moves with a mesh.
static void load_motion(Loader *loader, const SceneMotion *motion, SceneSequence *sequence) {
    SingeError error = {0};
    SingeResult result = sequence_read(motion, loader->scene->frames, sequence, &error);
    if (result) loader_fail(loader, &motion->mesh, result, error.message);
}

/// A collider's mesh or heights.
static void load_solid(Loader *loader, uint32_t index) {
    const SceneCollider *collider = &loader->scene->colliders[index];
    SceneSolid *solid = &loader->assets->solids[index];
    SingeError error = {0};
    SingeResult result = SINGE_OK;
    const SceneFile *file = &collider->mesh;
    if (collider->def.kind == SINGE_COLLIDER_MESH && collider->motion.given) {
        load_motion(loader, &collider->motion, &loader->assets->collider_motions[index]);
    } else if (collider->def.kind == SINGE_COLLIDER_MESH) {
        Bytes bytes = {0};
        result = file_read(file->path, (SingeAllocator){0}, &bytes, &error);
        if (!result)
            result = solid_read_mesh(file->path, bytes.data, bytes.size,
                                     metres_per_unit(collider->units, collider->scale), solid, &error);
        bytes_free(&bytes);
    } else if (collider->def.kind == SINGE_COLLIDER_HEIGHTFIELD) {
        SingeTexture picture = {0};
        file = &collider->picture;
        load_luminance(loader, file, &picture);
        if (picture.values) result = solid_make_heights(&picture, collider->def.size, collider->heights, solid, &error);
        free((void *)picture.values);
    }

    if (result) loader_fail(loader, file, result, error.message);
}

/// Refuses formats that the sheets cannot be written in, before a run computes its first frame.
static void check_formats(const Loader *loader) {
    const Scene *scene = loader->scene;
    uint32_t with_uv = 0;
    if (!output_has(scene->output.formats, OUTPUT_textures)) return;

    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const Mesh *mesh = &loader->assets->meshes[i];
        if (!mesh->positions) return; // its file has a fault, and perhaps uv
        with_uv += mesh->uv || mesh->corner_uv;
    }

    if (!with_uv)
        message_add(loader->messages, scene->text, scene->output.location,
                    "the format 'textures' needs a sheet with uv; no sheet has any");
    else if (with_uv > OUTPUT_TEXTURE_SHEETS)
        message_add(loader->messages, scene->text, scene->output.location,
                    "the format 'textures' takes at most %d sheets with uv, not %u", OUTPUT_TEXTURE_SHEETS, with_uv);
}

static void *many(Loader *loader, size_t count, size_t size) {
    void *items = calloc(count ? count : 1, size);
    loader->no_memory = loader->no_memory || !items;
    return items;
}

SingeResult scene_load(const Scene *scene, SceneAssets *assets, SceneMessages *messages) {
    Loader loader = {scene, assets, messages, false};
    uint32_t before = message_total(messages), first = messages->count;

    *assets = (SceneAssets){.sheet_count = scene->sheet_count,
                            .source_count = scene->source_count,
                            .collider_count = scene->collider_count,
                            .pin_count = scene->pin_count};
    assets->meshes = many(&loader, scene->sheet_count, sizeof *assets->meshes);
    assets->reports = many(&loader, scene->sheet_count, sizeof *assets->reports);
    assets->renders = many(&loader, scene->sheet_count, sizeof *assets->renders);
    assets->images = many(&loader, 2 * (size_t)scene->sheet_count, sizeof *assets->images);
    assets->pictures = many(&loader, 2 * (size_t)scene->sheet_count, sizeof *assets->pictures);
    assets->colours = many(&loader, scene->sheet_count, sizeof *assets->colours);
    assets->transmittances = many(&loader, scene->sheet_count, sizeof *assets->transmittances);
    assets->looks = many(&loader, scene->sheet_count, sizeof *assets->looks);
    assets->fields = many(&loader, scene->sheet_count, sizeof *assets->fields);
    assets->source_textures = many(&loader, scene->source_count, sizeof *assets->source_textures);
    assets->solids = many(&loader, scene->collider_count, sizeof *assets->solids);
    assets->probes = many(&loader, scene->probe_count, sizeof *assets->probes);
    assets->collider_motions = many(&loader, scene->collider_count, sizeof *assets->collider_motions);
    assets->pin_motions = many(&loader, scene->pin_count, sizeof *assets->pin_motions);
    if (loader.no_memory) message_add(messages, scene->text, (SceneLocation){0}, "out of memory");

    for (uint32_t i = 0; i < scene->sheet_count && !loader.no_memory; i++) load_sheet(&loader, i);
    for (uint32_t i = 0; i < scene->source_count && !loader.no_memory; i++)
        if (scene->sources[i].texture.name)
            load_luminance(&loader, &scene->sources[i].texture, &assets->source_textures[i]);
    for (uint32_t i = 0; i < scene->collider_count && !loader.no_memory; i++) load_solid(&loader, i);
    for (uint32_t i = 0; i < scene->pin_count && !loader.no_memory; i++)
        if (scene->pins[i].motion.given) load_motion(&loader, &scene->pins[i].motion, &assets->pin_motions[i]);

    if (scene->preview.environment_picture.name && !loader.no_memory)
        (void)load_image(&loader, &scene->preview.environment_picture, &assets->sky);
    if (!loader.no_memory) check_formats(&loader);
    if (message_total(messages) == before && !loader.no_memory) probes_find(scene, assets, messages);
    if (message_total(messages) == before && !loader.no_memory && !holders_make(scene, assets)) {
        loader.no_memory = true;
        message_add(messages, scene->text, (SceneLocation){0}, "out of memory");
    }
    if (message_total(messages) == before && !loader.no_memory) return SINGE_OK;

    if (!loader.no_memory) sheet_faults(scene, assets, FAULTS_OF_MESHES, messages);
    messages_sort(messages, first);
    scene_assets_free(assets);

    return loader.no_memory ? SINGE_ERROR_MEMORY : SINGE_ERROR_FORMAT;
}

static void picture_free(SingeTexture *picture) {
    free((void *)picture->values); // image_luminance allocated them with libc's allocator
    *picture = (SingeTexture){0};
}

void scene_assets_free(SceneAssets *assets) {
    for (uint32_t i = 0; i < assets->sheet_count; i++) {
        if (assets->meshes) mesh_free(&assets->meshes[i]);
        if (assets->renders) render_file_free(&assets->renders[i]);
        for (int side = 0; side < 2 && assets->images; side++) image_free(&assets->images[2 * i + side]);
        for (int p = 0; p < SCENE_PARAM_SLOTS && assets->fields; p++) picture_free(&assets->fields[i][p].texture);
    }

    for (uint32_t i = 0; i < assets->source_count && assets->source_textures; i++)
        picture_free(&assets->source_textures[i]);
    for (uint32_t i = 0; i < assets->collider_count && assets->solids; i++) solid_free(&assets->solids[i]);
    for (uint32_t i = 0; i < assets->collider_count && assets->collider_motions; i++)
        sequence_free(&assets->collider_motions[i]);
    for (uint32_t i = 0; i < assets->pin_count && assets->pin_motions; i++) sequence_free(&assets->pin_motions[i]);
    holders_free(assets);
    image_free(&assets->sky);
    free(assets->collider_motions);
    free(assets->pin_motions);
    free(assets->solids);
    free(assets->probes);
    free(assets->meshes);
    free(assets->reports);
    free(assets->renders);
    free(assets->images);
    free(assets->pictures);
    free(assets->colours);
    free(assets->transmittances);
    free(assets->looks);
    free(assets->fields);
    free(assets->source_textures);
    *assets = (SceneAssets){0};
}
