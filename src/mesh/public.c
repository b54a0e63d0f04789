// The public functions of singe/mesh.h.
#include "singe/mesh.h"

#include "common/def_table.h"
#include "common/store.h"
#include "mesh/to_quads.h"

#include <math.h>
#include <string.h>

struct SingeMesh {
    Mesh mesh;
    SingeAllocator allocator;
};

// ---- Defs

/// A caller's Def has `size` bytes, ours `known`: their common bytes are ours, the rest is 0.
static void fill_def(void *def, size_t size, const void *standard, size_t known) {
    if (size < sizeof size) return;
    memset(def, 0, size);
    memcpy(def, standard, size < known ? size : known);
    memcpy(def, &size, sizeof size);
}

/// Copies the common bytes of a caller's Def over *def, which holds the defaults. False if struct_size is unknown.
static bool read_def(void *def, size_t size, const void *given) {
    size_t known;
    if (!given) return false;
    memcpy(&known, given, sizeof known);
    if (!struct_size_is_possible(known)) return false;
    memcpy(def, given, known < size ? known : size);
    memcpy(def, &size, sizeof size);
    return true;
}

void singe_init_mesh(SingeMeshDef *def, size_t struct_size) {
    const SingeMeshDef standard = mesh_default();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_grid(SingeGridDef *def, size_t struct_size) {
    const SingeGridDef standard = mesh_grid_default();
    fill_def(def, struct_size, &standard, sizeof standard);
}

// ---- in

static SingeResult bad(SingeError *error, const char *what) {
    return refuse(error, SINGE_ERROR_ARGUMENT, "mesh", -1, "%s", what);
}

/// Whether all elements of a field are in its row's range. The error says which range is left.
static bool in_range(const char *name, const void *field, int length, bool whole, FieldRange range, SingeError *error) {
    for (int i = 0; i < length && range.words; i++) {
        const float number = whole ? (float)((const uint32_t *)field)[i] : ((const float *)field)[i];
        if (range_has(&range, number)) continue;
        refuse(error, SINGE_ERROR_ARGUMENT, "mesh", -1, "%s must be %s", name, range.words);
        return false;
    }
    return true;
}

// a row of the tables: checks its field of `def`
#define FLOAT false
#define VECTOR false
#define UINT32 true
#define UINTS true
#define ENUM(name) true
#define SINGE_ROWS_STAY
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    if (!in_range(#name, &def.name, length, TYPE, (FieldRange)range, error)) return SINGE_ERROR_ARGUMENT;
#define SINGE_NEEDED SINGE_FIELD
#define SINGE_HIDDEN SINGE_FIELD
#define SINGE_WORD(Enum, NAME, value, word, text) known |= def.quads == NAME;

/// Converts the Def for mesh_make, which does not write to its arrays. False when out of memory.
static bool take(const SingeMeshDef *def, uint32_t corners, Polygons *polygons) {
    *polygons = (Polygons){.vertex_count = def->vertex_count,
                           .face_count = def->face_count,
                           .corner_count = corners,
                           .attribute_count = def->attribute_count,
                           .allocator = def->allocator,
                           .positions = (float *)(uintptr_t)def->positions,
                           .corners = (uint32_t *)(uintptr_t)def->corners,
                           .attributes = (SingeAttribute *)(uintptr_t)def->attributes};
    polygons->first = store_new(def->allocator, (size_t)def->face_count + 1, sizeof *polygons->first);
    if (!polygons->first) return false;

    polygons->first[0] = 0;
    for (uint32_t f = 0; f < def->face_count; f++)
        polygons->first[f + 1] = polygons->first[f] + (def->face_sizes ? def->face_sizes[f] : 3);

    polygons->uv = (float *)(uintptr_t)def->corner_uv;
    if (def->corner_uv || !def->uv) return true;
    if (!(polygons->uv = store_new(def->allocator, corners, 2 * sizeof *polygons->uv))) return false;

    for (uint32_t h = 0; h < corners; h++) {
        const uint32_t v = def->corners[h]; // checked later, by mesh_make
        for (size_t k = 0; k < 2; k++)
            polygons->uv[2 * (size_t)h + k] = v < def->vertex_count ? def->uv[2 * (size_t)v + k] : 0;
    }

    return true;
}

static SingeMesh *new_mesh(SingeAllocator allocator) {
    SingeMesh *made = store_new(allocator, 1, sizeof *made);
    if (made) *made = (SingeMesh){.allocator = allocator};
    return made;
}

SingeResult singe_mesh_create(const SingeMeshDef *given, SingeMesh **mesh, SingeError *error) {
    SingeMeshDef def = singe_default_mesh();
    *mesh = NULL;
    if (!read_def(&def, sizeof def, given)) return bad(error, STRUCT_SIZE_UNKNOWN(singe_default_mesh));
    const char *name = def.name ? def.name : "mesh";

    // what mesh_make assumes
    uint64_t total = 0;
    if (!def.positions || !def.corners) return bad(error, "positions or corners are NULL");
    if (def.face_count == 0) return refuse(error, SINGE_ERROR_MESH, "mesh", -1, "%s: has no faces", short_name(name));
    if (def.attribute_count && !def.attributes) return bad(error, "attributes are NULL");

    for (uint32_t i = 0; i < def.attribute_count; i++)
        if (!def.attributes[i].name || !def.attributes[i].values)
            return bad(error, "an attribute has no name or no values");

    bool known = false;
#include "singe/mesh.def"
    if (!known) return bad(error, "quads has an unknown value");

    for (uint32_t f = 0; f < def.face_count; f++) {
        uint32_t size = def.face_sizes ? def.face_sizes[f] : 3;
        if (size < 3)
            return refuse(error, SINGE_ERROR_MESH, "mesh", f, "%s: face %u (from 0) has %u corners", short_name(name),
                          f, size);
        total += size;
    }

    if (total > INT32_MAX || def.vertex_count > INT32_MAX || def.face_count > INT32_MAX)
        return refuse(error, SINGE_ERROR_LIMIT, "mesh", -1, "%s: more vertices or corners than 2147483647",
                      short_name(name));
    const uint32_t corners = (uint32_t)total;

    Polygons polygons;
    MeshReport report = {0};
    const MeshOptions options = {def.quads, def.weld, def.smallest};
    SingeMesh *made = new_mesh(def.allocator);
    SingeResult result = take(&def, corners, &polygons) && made ? SINGE_OK : refuse_memory(error, "mesh", name);
    for (size_t i = 0; !result && polygons.uv && i < 2 * (size_t)corners; i++)
        if (!isfinite(polygons.uv[i]))
            result = refuse(error, SINGE_ERROR_MESH, "mesh", (int64_t)(i / 2),
                            "%s: corner %llu (from 0) has a uv that is not finite", short_name(name),
                            (unsigned long long)(i / 2));

    if (!result) result = mesh_make(name, &polygons, &options, def.allocator, &made->mesh, &report, error);
    store_free(def.allocator, polygons.first, (size_t)def.face_count + 1, sizeof *polygons.first);
    if (!def.corner_uv) store_free(def.allocator, polygons.uv, corners, 2 * sizeof *polygons.uv);

    if (result) {
        store_free(def.allocator, made, 1, sizeof *made);
        return result;
    }

    char line[256];
    for (int i = 0; def.log.write && mesh_report_line(&report, i, line, sizeof line); i++)
        def.log.write(def.log.context, SINGE_LOG_INFO, line);
    *mesh = made;
    return SINGE_OK;
}

SingeResult singe_mesh_create_grid(const SingeGridDef *given, SingeMesh **mesh, SingeError *error) {
    SingeGridDef def = singe_default_grid();
    *mesh = NULL;
    if (!read_def(&def, sizeof def, given)) return bad(error, STRUCT_SIZE_UNKNOWN(singe_default_grid));
#include "singe/grid.def"

    SingeMesh *made = new_mesh(def.allocator);
    if (!made) return refuse_memory(error, "grid", "grid");

    SingeResult result =
        mesh_grid(def.size[0], def.size[1], def.cells[0], def.cells[1], def.allocator, &made->mesh, error);
    if (result) {
        store_free(def.allocator, made, 1, sizeof *made);
        return result;
    }

    mesh_grid_wear(&made->mesh, def.cells[0], def.cells[1], &(GridWear){def.jitter, def.displacement, def.seed});
    *mesh = made;
    return SINGE_OK;
}

void singe_mesh_destroy(SingeMesh *mesh) {
    if (!mesh) return;
    mesh_free(&mesh->mesh);
    store_free(mesh->allocator, mesh, 1, sizeof *mesh);
}

// ---- out

void singe_mesh_read(const SingeMesh *mesh, SingeMeshView *view, size_t struct_size) {
    const Mesh *made = &mesh->mesh;
    const SingeMeshView ours = {
        .vertex_count = made->vertex_count,
        .cell_count = made->cell_count,
        .attribute_count = made->attribute_count,
        .source_count = made->source ? made->source_count : 0,
        .positions = made->positions,
        .cells = made->cells,
        .uv = made->uv,
        .corner_uv = made->corner_uv,
        .attributes = made->attributes,
        .source_vertex = made->source,
        .corner_source_vertex = made->corner_source,
        .became = made->became,
    };
    fill_def(view, struct_size, &ours, sizeof ours);
}
