// Creates and destroys a preview: the Def is checked field by field, then everything for a frame is allocated.

#include "preview/ground.h"
#include "preview/airborne.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool all_between(const float *values, int count, float low, float high) {
    for (int i = 0; i < count; i++)
        if (!(values[i] >= low && values[i] <= high)) return false;
    return true;
}

static SingeResult preview_refuse(SingeError *error, int64_t element, const char *what) {
    return preview_fail(error, SINGE_ERROR_ARGUMENT, element, "%s", what);
}

/// The numbers of a Def that are rows of preview.def.
static SingeResult check_rows(const PreviewDef *def, SingeError *error) {
#define DEGREE (3.14159265358979323846 / 180)
#define WITHIN(low, high) (float)(low), (float)(high), "between " #low " and " #high
#define FLOAT(place) &(place)
#define VECTOR(place) (place)
#define INT(place) \
    &(const float) { (float)(place) }
#define PREVIEW_APART(TYPE, target, range) {#target, TYPE(def->target), 1, range},
#define PREVIEW_MAIN(TYPE, key, target, length, dimension, standard, range, text) \
    {#target, TYPE(def->target), length, range},
#define PREVIEW_CAMERA PREVIEW_MAIN
#define PREVIEW_LIGHT PREVIEW_MAIN
#define PREVIEW_LAMP PREVIEW_MAIN
#define PREVIEW_ENVIRONMENT PREVIEW_MAIN
#define PREVIEW_GROUND PREVIEW_MAIN
    const struct {
        const char *name;
        const float *values;
        int count;
        float low, high;
        const char *range;
    } rows[] = {
#include "preview/preview.def"
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!all_between(rows[i].values, rows[i].count, rows[i].low, rows[i].high))
            return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "%s must be %s", rows[i].name, rows[i].range);
    return SINGE_OK;
}

static SingeResult check_shapes(const PreviewShape *shapes, uint32_t count, SingeError *error) {
    if (count && !shapes) return preview_refuse(error, -1, "shapes: there is a count but no array");
    for (uint32_t i = 0; i < count; i++) {
        const PreviewShape *shape = &shapes[i];
        const float *q = shape->rotation, length = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        bool good = all_between(shape->position, 3, -1e4f, 1e4f) && all_between(shape->velocity, 3, -1e4f, 1e4f) &&
                    all_between(shape->colour, 3, 0, 1e4f) && shape->temperature >= 0 && shape->temperature < 1e5f &&
                    shape->surface >= PREVIEW_SURFACE_MATT && shape->surface <= PREVIEW_SURFACE_CORD;
        switch (shape->kind) {
        case SINGE_COLLIDER_PLANE: break;
        case SINGE_COLLIDER_SPHERE: good = good && shape->radius > 0 && shape->radius <= 1e4f; break;
        case SINGE_COLLIDER_BOX: good = good && all_between(shape->half_size, 3, 1e-7f, 1e4f); break;
        case SINGE_COLLIDER_CAPSULE:
            good = good && shape->radius > 0 && shape->radius <= 1e4f && shape->height >= 0 && shape->height <= 1e4f;
            break;
        case SINGE_COLLIDER_HEIGHTFIELD:
        case SINGE_COLLIDER_MESH: good = good && shape->solid; break;
        default: good = false;
        }

        if (shape->kind != SINGE_COLLIDER_SPHERE) good = good && fabsf(length - 1) < 0.01f;
        if (!good)
            return preview_refuse(error, i,
                                  "shape: kind, size, position, rotation, surface or temperature is out of range");
    }

    return SINGE_OK;
}

static bool image_is_good(const Image *image) {
    return image->rgb && image->width >= 1 && image->height >= 1 && image->width <= SIZE_LIMIT &&
           image->height <= SIZE_LIMIT;
}

static SingeResult check_view(const PreviewDef *def, SingeError *error) {
    const PreviewCamera *camera = &def->camera;
    Float3 up = float3_load(camera->up), view = float3_sub(float3_load(camera->target), float3_load(camera->eye));
    if (!(float3_dot(view, view) > 1e-12f))
        return preview_refuse(error, -1, "camera: eye and target are the same point");
    if (!(float3_dot(up, up) > 1e-12f)) return preview_refuse(error, -1, "camera: up must not be zero");

    Float3 sun = float3_load(def->sun_direction);
    if (!(float3_dot(sun, sun) > 1e-20f)) return preview_refuse(error, -1, "sun_direction must not be zero");
    if (def->sky == PREVIEW_SKY_PICTURE && !(def->sky_picture && image_is_good(def->sky_picture)))
        return preview_refuse(error, -1, "sky_picture is missing, empty or too large");
    if (def->wall_distance > 1e4f || (def->wall_distance < -1e4f && isfinite(def->wall_distance)) ||
        isnan(def->wall_distance))
        return preview_refuse(error, -1, "wall_distance must lie within 10 km, or be -infinity for none");
    float ground = def->ground_height;
    if (!(ground <= 1e4f) || (ground < -1e4f && isfinite(ground)))
        return preview_refuse(error, -1, "ground_height must lie within 10 km, or be -infinity for none");

    return SINGE_OK;
}

static SingeResult check_def(const PreviewDef *def, SingeError *error) {
    SingeResult result = check_rows(def, error);
    if (!result) result = check_view(def, error);
    if (!result) result = check_shapes(def->shapes, def->shape_count, error);
    for (uint32_t s = 0; !result && def->pictures && s < def->sheet_count; s++) {
        if (def->pictures[s] && !image_is_good(def->pictures[s]))
            result = preview_refuse(error, s, "a sheet's picture is empty or too large");
    }
    for (uint32_t s = 0; !result && def->backs && s < def->sheet_count; s++)
        if (def->backs[s] && !image_is_good(def->backs[s]))
            result = preview_refuse(error, s, "the picture on a sheet's back is empty or too large");

    for (uint32_t s = 0; !result && def->colours && s < def->sheet_count; s++)
        if (!all_between(def->colours[s], 3, 0, 1e4f))
            result = preview_refuse(error, s, "a sheet's colour is out of range");
    for (uint32_t s = 0; !result && def->starts && s < def->sheet_count; s++) {
        const PreviewStart *start = &def->starts[s];
        bool good = (!start->vertex_count || start->positions) && (!start->cell_count || start->cells);
        for (size_t k = 0; good && k < 4 * (size_t)start->cell_count; k++) good = start->cells[k] < start->vertex_count;
        if (!good) result = preview_refuse(error, s, "a sheet's start lacks an array, or uses a vertex it has not");
    }

    for (uint32_t s = 0; !result && def->looks && s < def->sheet_count; s++)
        if (!all_between(&def->looks[s].weave, 1, 0, 0.1f) || !all_between(&def->looks[s].coating, 1, 0, 1))
            result =
                preview_refuse(error, s, "a sheet's weave must lie between 0 and 0.1 m, its coating between 0 and 1");
    for (uint32_t s = 0; !result && def->transmittances && s < def->sheet_count; s++)
        if (!all_between(&def->transmittances[s], 1, 0, 1))
            result = preview_refuse(error, s, "a sheet's transmittance must lie between 0 and 1");

    return result;
}

static size_t pixel_count(const PreviewDef *def) { return (size_t)def->width * (size_t)def->height; }

static size_t glow_count(const PreviewDef *def) {
    return (size_t)((def->width + 3) / 4) * (size_t)((def->height + 3) / 4);
}

static SingeResult preview_allocate(Preview *preview, SingeError *error) {
    const PreviewDef *def = &preview->def;
    const SingeAllocator *allocator = &preview->allocator;
    preview->picture = allocator_resize(*allocator, NULL, 0, pixel_count(def) * sizeof(Float3));
    preview->table = allocator_resize(*allocator, NULL, 0, pixel_count(def) * sizeof(Table));
    preview->lit = allocator_resize(*allocator, NULL, 0, pixel_count(def) * sizeof *preview->lit);
    preview->seen = allocator_resize(*allocator, NULL, 0, pixel_count(def) * sizeof *preview->seen);
    preview->veil = allocator_resize(*allocator, NULL, 0, pixel_count(def) * sizeof *preview->veil);
    preview->mask = allocator_resize(*allocator, NULL, 0, mask_size(preview));

    for (int i = 0; i < 2; i++)
        preview->glow[i] = allocator_resize(*allocator, NULL, 0, glow_count(def) * sizeof(Float3));
    const size_t texture_bytes = 2 * def->sheet_count * sizeof(Texture);
    preview->textures = allocator_resize(*allocator, NULL, 0, texture_bytes);
    if (preview->textures) memset(preview->textures, 0, texture_bytes);
    preview->weaves = allocator_resize(*allocator, NULL, 0, def->sheet_count * sizeof(Weave));
    if (!preview->picture || !preview->lit || !preview->seen || !preview->table || !preview->veil || !preview->mask ||
        !preview->glow[0] || !preview->glow[1] || (def->sheet_count && !(preview->textures && preview->weaves)))
        return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a picture of %d x %d", def->width,
                            def->height);
    for (uint32_t s = 0; s < def->sheet_count; s++) cloth_count(def, s, &preview->weaves[s]);
    for (uint32_t s = 0; s < def->sheet_count; s++) {
        Texture *back = &preview->textures[s + def->sheet_count];
        if (def->pictures) TRY(texture_create(preview, &preview->textures[s], def->pictures[s], error));
        if (def->backs) TRY(texture_create(preview, back, def->backs[s], error));
    }
    return SINGE_OK;
}

SingeResult preview_create(const PreviewDef *def, SingeAllocator allocator, Preview **out, SingeError *error) {
    *out = NULL;
    SingeResult result = check_def(def, error);
    if (result) return result;

    Preview *preview = allocator_resize(allocator, NULL, 0, sizeof *preview);
    if (!preview) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory");
    *preview = (Preview){.def = *def, .allocator = allocator, .camera = camera_make(def)};
    preview->scene.cell = noise_cell_best();

    preview->sun = float3_unit_or(float3_load(def->sun_direction), float3(0, 0, 1));
    float3_frame(preview->sun, &preview->sun_right, &preview->sun_up);
    preview->sun_light = float3_scale(float3_load(def->sun_colour), FILM_SPEED);
    preview->sun_spread = tanf(def->sun_angle);
    preview->wall_along = float3(cosf(def->wall_turn), sinf(def->wall_turn), 0);
    preview->sun_light = float3_scale(preview->sun_light, wall_clears(preview));
    for (int i = 0; i < 256; i++) {
        float s = (float)i / 255;
        preview->linear[i] = s <= 0.04045f ? s / 12.92f : powf((s + 0.055f) / 1.055f, 2.4f);
    }

    blackbody_fill(preview->blackbody);
    sky_fill(preview);

    result = preview_allocate(preview, error);
    if (!result) result = stain_create(preview, error);
    if (!result) result = mirror_create(preview, error);
    if (!result) result = preview_set_shapes(preview, def->shapes, def->shape_count, error);
    if (result) preview_destroy(preview);
    else *out = preview;

    return result;
}

SingeResult preview_set_camera(Preview *preview, const PreviewCamera *camera, SingeError *error) {
    if (memcmp(&preview->def.camera, camera, sizeof *camera) == 0) return SINGE_OK;
    PreviewDef def = preview->def;
    def.camera = *camera;
    SingeResult result = check_rows(&def, error);
    if (!result) result = check_view(&def, error);
    if (result) return result;
    preview->def.camera = *camera;
    preview->camera = camera_make(&preview->def);
    preview->table_known = false;
    return SINGE_OK;
}

SingeResult preview_set_shapes(Preview *preview, const PreviewShape *shapes, uint32_t count, SingeError *error) {
    SingeResult result = check_shapes(shapes, count, error);
    if (result) return result;
    uint32_t drawn = 0; // planes are drawn as the ground only
    for (uint32_t i = 0; i < count; i++) drawn += shapes[i].kind != SINGE_COLLIDER_PLANE;
    PreviewShape *copy = allocator_resize(preview->allocator, NULL, 0, drawn * sizeof *copy);
    if (drawn && !copy) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for %u shapes", count);

    for (uint32_t i = 0, next = 0; i < count && !result; i++) {
        if (shapes[i].kind == SINGE_COLLIDER_PLANE) continue;
        PreviewShape *shape = &copy[next++];
        *shape = shapes[i];
        shape->facets = NULL;
        if (shape->solid) result = facets_get(preview, shape->solid, &shape->facets, error);
    }

    if (result) {
        allocator_resize(preview->allocator, copy, drawn * sizeof *copy, 0);
        return result;
    }

    allocator_resize(preview->allocator, preview->shapes, preview->shape_count * sizeof *preview->shapes, 0);
    preview->shapes = copy;
    preview->shape_count = drawn;
    facets_drop(preview);
    return SINGE_OK;
}

void preview_destroy(Preview *preview) {
    if (!preview) return;
    const PreviewDef *def = &preview->def;
    SingeAllocator allocator = preview->allocator;
    tracer_free(preview);
    fire_free(preview);
    stain_free(preview);
    mirror_free(preview);
    facets_free(preview);

    for (uint32_t s = 0; preview->textures && s < 2 * def->sheet_count; s++)
        texture_free(preview, &preview->textures[s]);
    allocator_resize(allocator, preview->textures, 2 * def->sheet_count * sizeof(Texture), 0);
    allocator_resize(allocator, preview->weaves, preview->weaves ? def->sheet_count * sizeof(Weave) : 0, 0);
    allocator_resize(allocator, preview->shapes, preview->shape_count * sizeof *preview->shapes, 0);
    allocator_resize(allocator, preview->picture, pixel_count(def) * sizeof(Float3), 0);
    allocator_resize(allocator, preview->lit, preview->lit ? pixel_count(def) * sizeof *preview->lit : 0, 0);
    allocator_resize(allocator, preview->seen, preview->seen ? pixel_count(def) * sizeof *preview->seen : 0, 0);
    allocator_resize(allocator, preview->table, pixel_count(def) * sizeof(Table), 0);
    allocator_resize(allocator, preview->veil, preview->veil ? pixel_count(def) * sizeof *preview->veil : 0, 0);
    allocator_resize(allocator, preview->mask, mask_size(preview), 0);

    for (int i = 0; i < 2; i++) allocator_resize(allocator, preview->glow[i], glow_count(def) * sizeof(Float3), 0);
    allocator_resize(allocator, preview, sizeof *preview, 0);
}
