#include "formats/output.h"

#include "common/store.h"

#include <stdio.h>

#define VECTOR(name, member, width, index) \
    { name, offsetof(SingeSurface, member), false, width, index }
#define SCALAR(name, member, integer) \
    { name, offsetof(SingeSurface, member), integer, 1, 0 }

const SurfaceField surface_columns[SURFACE_COLUMNS] = {
    VECTOR("x", position, 3, 0),
    VECTOR("y", position, 3, 1),
    VECTOR("z", position, 3, 2),
    VECTOR("nx", normal, 3, 0),
    VECTOR("ny", normal, 3, 1),
    VECTOR("nz", normal, 3, 2),
    VECTOR("s", uv, 2, 0),
    VECTOR("t", uv, 2, 1),
    VECTOR("vx", velocity, 3, 0),
    VECTOR("vy", velocity, 3, 1),
    VECTOR("vz", velocity, 3, 2),
    VECTOR("rest_x", rest_position, 3, 0),
    VECTOR("rest_y", rest_position, 3, 1),
    VECTOR("rest_z", rest_position, 3, 2),
    SCALAR("temperature", temperature, false),
    SCALAR("temperature_peak", temperature_peak, false),
    SCALAR("mass", mass, false),
    SCALAR("burn_rate", burn_rate, false),
    SCALAR("char_fraction", char_fraction, false),
    SCALAR("ash_fraction", ash_fraction, false),
    SCALAR("burnt", burn, false),
    SCALAR("time_ignited", time_ignited, false),
    SCALAR("piece_id", piece, true),
    SCALAR("vertex_id", source_vertex, true),
    SCALAR("sheet", sheet, true),
    SCALAR("water", water, false), // only where a sheet holds water
};

#define OUTPUT_ROW(name, ...) {#name, __VA_ARGS__},
const OutputFormat output_formats[OUTPUT_COUNT] = {OUTPUT_FORMATS(OUTPUT_ROW)};

const OutputSingle output_singles[OUTPUT_SINGLE_COUNT] = {{"usd", true, ".usdc", usd_write_single},
                                                          {"usdz", false, ".usdz", usdz_write},
                                                          {"glb", true, ".glb", glb_write_single},
                                                          {"vat", false, NULL, vat_write}};

SingeResult ply_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    (void)scene;
    return ply_write_surface(path, frame->surface, frame->time, error);
}

SingeResult output_picture_read(const char *path, const char *picture, Bytes *bytes, SingeError *error) {
    char name[8192];
    const char *slash = strrchr(path, '/');
    const int folder = path_is_absolute(picture) || !slash ? 0 : (int)(slash - path) + 1;
    *bytes = (Bytes){0};
    if ((size_t)snprintf(name, sizeof name, "%.*s%s", folder, path, picture) >= sizeof name)
        return refuse(error, SINGE_ERROR_LIMIT, "output", -1, "%s: the name is too long", short_name(picture));
    return file_read(name, (SingeAllocator){0}, bytes, error);
}

// ---- sheets

/// Sorts 0 to count - 1 by sheet. first[sheet_count] is the count.
static void sort_by_sheet(const SheetParts *p, const uint32_t (*triangles)[3], uint32_t count, uint32_t *first,
                          uint32_t *sorted) {
    const int32_t *sheets = p->surface->sheet;
    memset(first, 0, (p->sheet_count + 1) * sizeof *first);
    for (uint32_t i = 0; i < count; i++) first[sheets[triangles ? triangles[i][0] : i] + 1]++;
    for (uint32_t i = 0; i < p->sheet_count; i++) first[i + 1] += first[i];
    for (uint32_t i = 0; i < count; i++) sorted[first[sheets[triangles ? triangles[i][0] : i]]++] = i;
    memmove(first + 1, first, p->sheet_count * sizeof *first);
    first[0] = 0;
}

SingeResult sheet_parts_make(SheetParts *p, const SingeSurface *s, uint32_t sheet_count, const char *path,
                             SingeError *error) {
    const SingeAllocator a = s->allocator;
    *p = (SheetParts){.surface = s, .sheet_count = sheet_count};

    for (uint32_t v = 0; v < s->vertex_count; v++)
        if (s->sheet[v] < 0 || (uint32_t)s->sheet[v] >= sheet_count)
            return refuse(error, SINGE_ERROR_FORMAT, "output", v,
                          "%s: vertex %u belongs to sheet %d; the scene has %u sheets", short_name(path), v,
                          (int)s->sheet[v], sheet_count);

    for (uint32_t t = 0; t < s->triangle_count; t++)
        for (int k = 1; k < 3; k++)
            if (s->sheet[s->triangles[t][k]] != s->sheet[s->triangles[t][0]])
                return refuse(error, SINGE_ERROR_FORMAT, "output", t, "%s: triangle %u belongs to two sheets",
                              short_name(path), t);

    p->vertex_first = store_new(a, (size_t)sheet_count + 1, 4);
    p->triangle_first = store_new(a, (size_t)sheet_count + 1, 4);
    p->vertices = store_new(a, s->vertex_count, 4);
    p->triangles = store_new(a, s->triangle_count, 4);
    p->local = store_new(a, s->vertex_count, 4);
    if (!p->vertex_first || !p->triangle_first || !p->vertices || !p->triangles || !p->local)
        return refuse_memory(error, "output", path);

    sort_by_sheet(p, NULL, s->vertex_count, p->vertex_first, p->vertices);
    sort_by_sheet(p, (const uint32_t(*)[3])s->triangles, s->triangle_count, p->triangle_first, p->triangles);

    for (uint32_t i = 0; i < s->vertex_count; i++) {
        const uint32_t v = p->vertices[i];
        p->local[v] = i - p->vertex_first[s->sheet[v]];
    }

    return SINGE_OK;
}

void sheet_parts_free(SheetParts *p) {
    const SingeSurface *s = p->surface;
    const SingeAllocator a = s->allocator;
    store_free(a, p->vertex_first, (size_t)p->sheet_count + 1, 4);
    store_free(a, p->triangle_first, (size_t)p->sheet_count + 1, 4);
    store_free(a, p->vertices, s->vertex_count, 4);
    store_free(a, p->triangles, s->triangle_count, 4);
    store_free(a, p->local, s->vertex_count, 4);
}
