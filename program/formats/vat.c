// Vertex animation textures: the uncut mesh, whose vertices a shader moves by textures, and hides where they have
// burnt. For engines, whose meshes cannot change from frame to frame.
//
//     NAME.glb           the mesh as in frame 1, y up: TEXCOORD_0 the sheet's uv, TEXCOORD_1 where its texel is
//     NAME.position.exr  R G B position (m, in the GLB's axes), A 1 where the vertex is there, 0 where it is gone
//     NAME.normal.exr    R G B unit normal
//     NAME.json          frames, rows a frame, bounds
//
// One texel per vertex and frame: vertex i of frame f (both from 0) is in column i mod width, row f * rows + i / width,
// so that the v of frame f is TEXCOORD_1's plus f * rows / height, from the first row on.
//
// Vertices of the cache and the mesh are matched by rest position, sheet and, if present, number in the file. A vertex
// that is gone follows its remaining neighbours, so that faces at the rim keep their shape.
#include "formats/glb.h"
#include "common/store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VAT_HEIGHT_MAX = 16384 };

typedef struct Vat {
    const OutputScene *scene;
    const OutputCache *cache;
    uint32_t count;                     ///< vertices of all sheets
    int width, rows, height;            ///< of the textures
    float (*position)[4], (*normal)[4]; ///< [width * height]
    float (*at)[3], (*facing)[3];       ///< [count] in the current frame, in the GLB's axes
    float (*moved)[4];      ///< [count] sum and count of the neighbours' displacements, or its own displacement
    uint8_t *found;         ///< [count]
    uint32_t *table, *next; ///< hash of (sheet, rest): the first vertex + 1, and the next of the same hash
    uint32_t *first;        ///< [sheet_count + 1] vertices
    uint32_t *source_first; ///< [sheet_count + 1] vertices of the files
    int log;
} Vat;

static SingeResult vat_make(Vat *vat, const char *path, SingeError *error) {
    const uint32_t sheets = vat->scene->sheet_count;
    vat->first = calloc(sheets + 1, 4);
    vat->source_first = calloc(sheets + 1, 4);
    if (!vat->first || !vat->source_first) return refuse_memory(error, "vat", path);

    for (uint32_t i = 0; i < sheets; i++) {
        const OutputMesh *mesh = &vat->scene->sheets[i].mesh;
        vat->first[i + 1] = vat->first[i] + mesh->vertex_count;
        vat->source_first[i + 1] = vat->source_first[i] + (mesh->source ? mesh->source_count : mesh->vertex_count);
    }

    vat->count = vat->first[sheets];

    // the narrowest textures that are not too high
    uint64_t height = UINT64_MAX;

    for (int widest = 4096; widest <= VAT_HEIGHT_MAX && height > VAT_HEIGHT_MAX; widest *= 2) {
        vat->width = vat->count < (uint32_t)widest ? (int)vat->count : widest;
        vat->rows = (int)((vat->count + (uint32_t)vat->width - 1) / (uint32_t)vat->width);
        height = (uint64_t)vat->rows * (uint64_t)vat->cache->frames;
    }

    if (height > VAT_HEIGHT_MAX)
        return refuse(error, SINGE_ERROR_LIMIT, "vat", -1, "%s: %u vertices by %d frames do not fit on %d x %d texels",
                      short_name(path), vat->count, vat->cache->frames, VAT_HEIGHT_MAX, VAT_HEIGHT_MAX);
    vat->height = (int)height;

    for (vat->log = 4; (uint64_t)1 << vat->log < 2 * (uint64_t)vat->count; vat->log++) {
    }

    const size_t texels = (size_t)vat->width * (size_t)vat->height;
    vat->position = calloc(texels, sizeof *vat->position);
    vat->normal = calloc(texels, sizeof *vat->normal);
    vat->at = calloc(vat->count, sizeof *vat->at);
    vat->facing = calloc(vat->count, sizeof *vat->facing);
    vat->moved = calloc(vat->count, sizeof *vat->moved);
    vat->found = calloc(vat->count, 1);
    vat->table = calloc((size_t)1 << vat->log, 4);
    vat->next = calloc(vat->count, 4);

    const bool all =
        vat->position && vat->normal && vat->at && vat->facing && vat->moved && vat->found && vat->table && vat->next;
    return all ? SINGE_OK : refuse_memory(error, "vat", path);
}

// ---- matching vertices

static uint32_t *vat_slot(const Vat *vat, uint32_t sheet, const float rest[3]) {
    uint32_t hash = 2166136261u ^ sheet;
    for (int c = 0; c < 3; c++) {
        const float value = rest[c] + 0.0f; // no -0
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 16777619u;
        hash ^= hash >> 15;
    }

    return &vat->table[hash * 2654435761u >> (32 - vat->log)];
}

/// The mesh's vertex, or UINT32_MAX if a cut or a tear created it.
static uint32_t vat_find(const Vat *vat, const SingeSurface *s, uint32_t i) {
    const uint32_t sheet = (uint32_t)s->sheet[i];
    if (sheet >= vat->scene->sheet_count) return UINT32_MAX;
    const OutputMesh *mesh = &vat->scene->sheets[sheet].mesh;

    for (uint32_t at = *vat_slot(vat, sheet, s->rest_position[i]); at; at = vat->next[at - 1]) {
        if (at - 1 < vat->first[sheet] || at - 1 >= vat->first[sheet + 1]) continue;
        const uint32_t v = at - 1 - vat->first[sheet];
        const float *rest = mesh->positions + 3 * (size_t)v, *have = s->rest_position[i];
        if (rest[0] != have[0] || rest[1] != have[1] || rest[2] != have[2]) continue;

        // on a seam, where several vertices of the file are one, the cache has the numbers of all of them
        const int32_t own = mesh->source ? mesh->source[v] : (int32_t)v, number = s->source_vertex[i];
        const uint32_t of_file = (uint32_t)number - vat->source_first[sheet];
        const bool fits = own < 0 || number < 0
                              ? own < 0 && number < 0
                              : of_file == (uint32_t)own ||
                                    (mesh->became && of_file < mesh->source_count && mesh->became[of_file] == v);
        if (fits) return at - 1;
    }

    return UINT32_MAX;
}

// ---- frames

static SingeResult take_frame(Vat *vat, int number, const char *path, SingeError *error) {
    OutputFrame frame;
    TRY(vat->cache->read(vat->cache->context, number, &frame, error));

    // moves the remaining vertices, and records their displacements
    memset(vat->found, 0, vat->count);
    memset(vat->moved, 0, vat->count * sizeof *vat->moved);

    for (uint32_t k = 0; k < frame.surface->vertex_count; k++) {
        const uint32_t vertex = vat_find(vat, frame.surface, k);
        float at[3], facing[3];
        if (vertex == UINT32_MAX || vat->found[vertex]) continue;
        vat->found[vertex] = 1;
        glb_turn(frame.surface->position[k], at), glb_turn(frame.surface->normal[k], facing);
        glb_make_unit(facing);
        for (int c = 0; c < 3; c++) vat->moved[vertex][c] = at[c] - vat->at[vertex][c];
        memcpy(vat->at[vertex], at, sizeof at), memcpy(vat->facing[vertex], facing, sizeof facing);
    }

    for (uint32_t v = 0; number == 1 && v < vat->count; v++)
        if (!vat->found[v])
            return refuse(error, SINGE_ERROR_FORMAT, "vat", v, "%s: vertex %u of the mesh is not in frame 1",
                          short_name(path), v);

    // moves the vertices that are gone by the mean displacement of the remaining ones in their cells
    for (uint32_t s = 0; s < vat->scene->sheet_count; s++) {
        const OutputMesh *quads = &vat->scene->sheets[s].mesh;
        for (size_t corner = 0; corner < 4 * (size_t)quads->cell_count; corner++) {
            const uint32_t gone = vat->first[s] + quads->cells[corner];
            for (size_t k = corner & ~(size_t)3, end = k + 4; k < end && !vat->found[gone]; k++) {
                const uint32_t other = vat->first[s] + quads->cells[k];
                if (!vat->found[other]) continue;
                for (int c = 0; c < 3; c++) vat->moved[gone][c] += vat->moved[other][c];
                vat->moved[gone][3]++;
            }
        }
    }

    for (uint32_t gone = 0; gone < vat->count; gone++)
        for (int c = 0; c < 3 && !vat->found[gone] && vat->moved[gone][3] > 0; c++)
            vat->at[gone][c] += vat->moved[gone][c] / vat->moved[gone][3];

    for (uint32_t v = 0; v < vat->count; v++) {
        const size_t texel = (size_t)(number - 1) * (size_t)vat->rows * (size_t)vat->width + v;
        memcpy(vat->position[texel], vat->at[v], sizeof vat->at[v]);
        memcpy(vat->normal[texel], vat->facing[v], sizeof vat->facing[v]);
        vat->position[texel][3] = vat->found[v];
    }

    return SINGE_OK;
}

// ---- files

static SingeResult write_texture(const char *path, const char *ending, const Vat *vat, float (*texels)[4],
                                 const char *letters, ExrKind kind, SingeError *error) {
    char name[4096];
    ExrChannel channels[4];
    static const char *const names[] = {"R", "G", "B", "A"};
    const int count = (int)strlen(letters);
    for (int i = 0; i < count; i++) channels[i] = (ExrChannel){names[i], kind, &texels[0][i], 4};
    if ((size_t)snprintf(name, sizeof name, "%s%s", path, ending) >= sizeof name)
        return refuse(error, SINGE_ERROR_LIMIT, "vat", -1, "%s: the name is too long", short_name(path));
    return exr_write(name, vat->width, vat->height, channels, count, NULL, error);
}

/// A vertex of the GLB: a vertex of the mesh with one uv.
typedef struct VatCorner {
    uint32_t vertex;
    float uv[2];
} VatCorner;

static void put_attribute(GlbFile *f, const char *name, size_t begin, uint32_t count, int width, const float *box) {
    sink_text(&f->meshes, "\"%s\":%u,", name, glb_put_accessor(f, begin, count, width, GLB_OF_VERTICES, box));
}

/// Copies values of the mesh's vertices, `stride` floats apart, to their corners.
static void put_values(GlbFile *f, const char *name, const VatCorner *corners, uint32_t count, float (*values)[4],
                       bool boxed) {
    const size_t begin = f->data.size;
    float box[6] = {0};
    for (uint32_t i = 0; i < count; i++) {
        const float *value = values[corners[i].vertex];
        box_grow(box, value, i == 0);
        sink_words(&f->data, value, 3);
    }

    put_attribute(f, name, begin, count, 3, boxed ? box : NULL);
}

/// Equal corners of the cells become one vertex, whose `number` each corner has. Returns how many there are; 0 without
/// memory.
static uint32_t number_corners(const OutputMesh *mesh, VatCorner *corners, uint32_t *number) {
    const size_t all = 4 * (size_t)mesh->cell_count;
    uint32_t *first = calloc(mesh->vertex_count, 4), *next = calloc(all, 4), count = 0;

    for (size_t i = 0; first && next && i < all; i++) {
        VatCorner corner = {.vertex = mesh->cells[i]};
        if (output_mesh_has_uv(mesh)) output_mesh_uv(mesh, (uint32_t)(i / 4), (int)(i & 3), corner.uv);

        uint32_t at = first[corner.vertex];
        while (at && memcmp(corners[at - 1].uv, corner.uv, sizeof corner.uv) != 0) at = next[at - 1];

        if (!at) {
            corners[count++] = corner;
            next[count - 1] = first[corner.vertex];
            at = first[corner.vertex] = count;
        }

        number[i] = at - 1;
    }

    free(first);
    free(next);
    return count;
}

static bool put_sheet(GlbFile *f, const Vat *vat, uint32_t sheet) {
    const OutputMesh *mesh = &vat->scene->sheets[sheet].mesh;
    const size_t all = 4 * (size_t)mesh->cell_count;
    VatCorner *corners = calloc(all, sizeof *corners);
    uint32_t *number = calloc(all, 4);
    const uint32_t count = corners && number ? number_corners(mesh, corners, number) : 0;

    if (count) {
        sink_text(&f->meshes, "%s{\"name\":", f->mesh_count ? "," : "");
        glb_put_string(&f->meshes, f->scene->sheets[sheet].name);
        sink_text(&f->meshes, ",\"primitives\":[{\"material\":%u,\"attributes\":{", sheet);
        put_values(f, "POSITION", corners, count, vat->position + vat->first[sheet], true);
        put_values(f, "NORMAL", corners, count, vat->normal + vat->first[sheet], false);

        size_t uv_begin = f->data.size;
        for (uint32_t k = 0; k < count; k++) {
            const float uv[2] = {corners[k].uv[0], 1 - corners[k].uv[1]};
            sink_words(&f->data, uv, 2);
        }

        put_attribute(f, "TEXCOORD_0", uv_begin, count, 2, NULL);
        uv_begin = f->data.size;

        for (uint32_t k = 0; k < count; k++) {
            const uint32_t v = vat->first[sheet] + corners[k].vertex, width = (uint32_t)vat->width;
            const float uv[2] = {((float)(v % width) + 0.5f) / (float)width,
                                 ((float)(v / width) + 0.5f) / (float)vat->height};
            sink_words(&f->data, uv, 2);
        }

        put_attribute(f, "TEXCOORD_1", uv_begin, count, 2, NULL);

        f->meshes.size--; // the last comma
        const size_t begin = f->data.size;

        for (uint32_t c = 0; c < mesh->cell_count; c++) {
            static const int cut[6] = {0, 1, 2, 0, 2, 3};
            for (int k = 0; k < 6; k++) sink_u32(&f->data, number[4 * (size_t)c + (size_t)cut[k]]);
        }

        sink_text(&f->meshes, "},\"indices\":%u}]}",
                  glb_put_accessor(f, begin, 6 * mesh->cell_count, 1, GLB_OF_CORNERS, NULL));
        sink_text(&f->nodes, "%s{\"mesh\":%u}", f->node_count ? "," : "", f->node_count);
        f->mesh_count++, f->node_count++;
    }

    free(corners);
    free(number);
    return count > 0;
}

static void put_triple(Sink *sink, const char *name, const float value[3]) {
    sink_text(sink, "  \"%s\": [", name);
    for (int c = 0; c < 3; c++) {
        sink_text(sink, c ? ", " : "");
        sink_float(sink, value[c]);
    }
    sink_text(sink, "],\n");
}

SingeResult vat_write(const char *path, const OutputScene *scene, const OutputCache *cache, SingeError *error) {
    Vat vat = {.scene = scene, .cache = cache};
    SingeResult result = vat_make(&vat, path, error);

    if (!result) {
        for (uint32_t s = 0; s < vat.scene->sheet_count; s++) {
            const OutputMesh *mesh = &vat.scene->sheets[s].mesh;
            for (uint32_t v = mesh->vertex_count; v-- > 0;) {
                uint32_t *slot = vat_slot(&vat, s, mesh->positions + 3 * (size_t)v);
                vat.next[vat.first[s] + v] = *slot;
                *slot = vat.first[s] + v + 1;
            }
        }
    }

    for (int i = 1; i <= cache->frames && !result; i++) result = take_frame(&vat, i, path, error);
    if (!result) result = write_texture(path, ".position.exr", &vat, vat.position, "RGBA", EXR_KIND_FLOAT, error);
    if (!result) result = write_texture(path, ".normal.exr", &vat, vat.normal, "RGB", EXR_KIND_HALF, error);

    if (!result) {
        GlbFile file;
        char name[4096];
        bool all = snprintf(name, sizeof name, "%s.glb", path) < (int)sizeof name;
        glb_begin(&file, scene, (SingeAllocator){0});
        for (uint32_t i = 0; i < scene->sheet_count && all; i++) all = put_sheet(&file, &vat, i);
        result = all ? glb_finish(&file, "../", "{}", name, error) : refuse_memory(error, "vat", path);
        glb_free(&file);
    }

    if (!result) {
        char name[4096];
        Sink sink = {0};
        float box[6] = {0};
        for (int f = 0; f < vat.cache->frames; f++)
            for (uint32_t v = 0; v < vat.count; v++)
                box_grow(box, vat.position[(size_t)f * (size_t)vat.rows * (size_t)vat.width + v], !f && !v);

        sink_text(&sink, "{\n  \"generator\": \"Singe " SINGE_VERSION "\",\n  \"frames\": %d,\n  \"fps\": ",
                  vat.cache->frames);
        sink_float(&sink, vat.scene->fps);
        sink_text(&sink, ",\n  \"vertices\": %u,\n  \"width\": %d,\n  \"height\": %d,\n  \"rows_per_frame\": %d,\n",
                  vat.count, vat.width, vat.height, vat.rows);
        put_triple(&sink, "bounds_min", box), put_triple(&sink, "bounds_max", box + 3);
        sink_text(&sink, "  \"up\": \"y\",\n  \"unit\": \"m\"\n}\n");
        if (snprintf(name, sizeof name, "%s.json", path) >= (int)sizeof name) sink.failed = true;
        result = sink_write(&sink, name, error);
    }

    free(vat.position), free(vat.normal), free(vat.at), free(vat.facing), free(vat.moved), free(vat.found);
    free(vat.table), free(vat.next), free(vat.first), free(vat.source_first);

    return result;
}
