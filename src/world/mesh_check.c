// Checks that a mesh has an inside: each edge belongs to two triangles that run along it in opposite directions.
#include "world/mesh_solid.h"

#include <string.h>

/// m; beyond this, squares of differences are too inaccurate for contact.
static const float MESH_POSITION_MAX = 1e4f;

/// m2, min of twice a triangle's area: its square must not vanish.
static const float MESH_AREA_MIN = 1e-17f;

static SingeResult mesh_bad(SingeError *error, int64_t element, const char *text) {
    return error_set(error, SINGE_ERROR_MESH, "collider", element, "%s", text);
}

static SingeResult mesh_memory(SingeError *error) {
    return error_set(error, SINGE_ERROR_MEMORY, "collider", -1, "out of memory for the mesh");
}

// ---- a table from three numbers to one, by open addressing

typedef struct PairTable {
    size_t capacity; ///< a power of two
    uint32_t (*keys)[3], *values;
} PairTable;

static bool table_create(Memory *memory, PairTable *table, size_t count) {
    table->capacity = 16;
    while (table->capacity < 2 * count) table->capacity *= 2;
    bool ok = NEW(memory, table->keys, table->capacity) && NEW(memory, table->values, table->capacity);
    for (size_t k = 0; ok && k < table->capacity; k++) table->values[k] = UINT32_MAX;
    return ok;
}

static void table_free(Memory *memory, PairTable *table) {
    FREE(memory, table->keys, table->capacity);
    FREE(memory, table->values, table->capacity);
}

/// The location of a key's value; UINT32_MAX there if it has none yet.
static uint32_t *table_find(const PairTable *table, const uint32_t key[3]) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 3; i++) {
        hash = (hash ^ key[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }

    size_t k = (size_t)hash & (table->capacity - 1);
    while (table->values[k] != UINT32_MAX && memcmp(table->keys[k], key, sizeof *table->keys) != 0)
        k = (k + 1) & (table->capacity - 1);
    memcpy(table->keys[k], key, sizeof *table->keys);
    return &table->values[k];
}

// ---- the steps

/// Writes to `first` the number of the first vertex at each vertex's position.
static SingeResult mesh_join(Memory *memory, const MeshSolid *solid, uint32_t *first, SingeError *error) {
    PairTable table = {0};
    bool ok = table_create(memory, &table, solid->vertex_count);

    for (uint32_t v = 0; ok && v < solid->vertex_count; v++) {
        uint32_t key[3];
        memcpy(key, solid->vertices[v], sizeof key);
        uint32_t *position = table_find(&table, key);
        if (*position == UINT32_MAX) *position = v;
        first[v] = *position;
    }

    table_free(memory, &table);
    return ok ? SINGE_OK : mesh_memory(error);
}

/// Writes the triangles with the joined vertices, without those that have become degenerate; `source` gets their
/// original numbers.
static SingeResult mesh_gather(const uint32_t *triangles, const uint32_t *first, uint32_t *source, MeshSolid *solid,
                               SingeError *error) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < solid->triangle_count; t++) {
        uint32_t *corner = solid->triangles[count];
        Float3 v[3];
        for (int i = 0; i < 3; i++) {
            corner[i] = first[triangles[3 * (size_t)t + (size_t)i]];
            v[i] = float3_load(solid->vertices[corner[i]]);
        }

        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        source[count++] = t;
        if (!(float3_length(float3_cross(float3_sub(v[1], v[0]), float3_sub(v[2], v[0]))) > MESH_AREA_MIN))
            return error_set(error, SINGE_ERROR_MESH, "collider", t, "triangle %u of the mesh has no area", t);
    }

    memset(solid->triangles[count], 0, (solid->triangle_count - count) * sizeof *solid->triangles);
    solid->triangle_count = count;
    return count ? SINGE_OK : mesh_bad(error, -1, "all triangles of the mesh are degenerate");
}

/// Flips a mesh that is inside out, which its volume shows: the sum over the tetrahedra of its triangles.
static void mesh_turn(MeshSolid *solid) {
    double volume = 0;
    Float3 o = float3_load(solid->vertices[solid->triangles[0][0]]);

    for (uint32_t t = 0; t < solid->triangle_count; t++) {
        const uint32_t *corner = solid->triangles[t];
        double p[3][3];
        for (int i = 0; i < 3; i++) {
            Float3 v = float3_sub(float3_load(solid->vertices[corner[i]]), o);
            p[i][0] = (double)v.x;
            p[i][1] = (double)v.y;
            p[i][2] = (double)v.z;
        }

        for (int i = 0; i < 3; i++) {
            int e = (i + 1) % 3, f = (i + 2) % 3;
            volume += p[0][i] * (p[1][e] * p[2][f] - p[1][f] * p[2][e]);
        }
    }

    // inside out: flip all
    solid->turned = volume < 0;
    for (uint32_t t = 0; solid->turned && t < solid->triangle_count; t++) {
        uint32_t second = solid->triangles[t][1];
        solid->triangles[t][1] = solid->triangles[t][2];
        solid->triangles[t][2] = second;
    }
}

static SingeResult mesh_link(const PairTable *edges, const uint32_t *source, MeshSolid *solid, SingeError *error) {
    // each directed edge belongs to one triangle
    for (uint32_t t = 0; t < solid->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t key[3] = {solid->triangles[t][i], solid->triangles[t][(i + 1) % 3], 0};
            uint32_t *position = table_find(edges, key);
            if (*position != UINT32_MAX)
                return error_set(error, SINGE_ERROR_MESH, "collider", source[t],
                                 "triangles %u and %u of the mesh both run from vertex %u to vertex %u: one is turned "
                                 "the wrong way round, or more than two meet there",
                                 source[*position], source[t], key[0], key[1]);
            *position = t;
        }

    for (uint32_t t = 0; t < solid->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t key[3] = {solid->triangles[t][(i + 1) % 3], solid->triangles[t][i], 0};
            uint32_t other = *table_find(edges, key);
            if (other == UINT32_MAX)
                return error_set(error, SINGE_ERROR_MESH, "collider", source[t],
                                 "the mesh is open: triangle %u has no neighbour along vertices %u and %u", source[t],
                                 key[1], key[0]);
            solid->neighbours[t][i] = other;
        }

    return SINGE_OK;
}

SingeResult mesh_solid_take(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                            const uint32_t *triangles, MeshSolid *solid, SingeError *error) {
    if (!vertices || !triangles) return mesh_bad(error, -1, "the mesh's vertices or triangles are missing");
    if (triangle_count < 4) return mesh_bad(error, -1, "a closed mesh has at least 4 triangles");
    if (triangle_count > INT32_MAX / 4 || vertex_count > INT32_MAX / 4)
        return error_set(error, SINGE_ERROR_LIMIT, "collider", -1, "the mesh is too large");

    for (size_t k = 0; k < 3 * (size_t)vertex_count; k++)
        if (!(fabsf(vertices[k]) <= MESH_POSITION_MAX))
            return error_set(error, SINGE_ERROR_MESH, "collider", (int64_t)(k / 3),
                             "vertex %zu of the mesh is not finite or beyond 10 km", k / 3);

    for (size_t k = 0; k < 3 * (size_t)triangle_count; k++)
        if (triangles[k] >= vertex_count)
            return error_set(error, SINGE_ERROR_MESH, "collider", (int64_t)(k / 3),
                             "triangle %zu of the mesh names vertex %u, but there are %u", k / 3, triangles[k],
                             vertex_count);

    uint32_t *first = NULL, *source = NULL;
    PairTable edges = {0};
    solid->vertex_count = vertex_count;
    solid->triangle_count = triangle_count;
    solid->room = triangle_count + 1;

    // memory
    bool ok = NEW(memory, solid->vertices, vertex_count) && NEW(memory, solid->triangles, solid->room) &&
              NEW(memory, solid->neighbours, solid->room) && NEW(memory, first, vertex_count) &&
              NEW(memory, source, triangle_count) && table_create(memory, &edges, 3 * (size_t)triangle_count);
    SingeResult result = ok ? SINGE_OK : mesh_memory(error);

    // join vertices, keep triangles that have an area, check that the mesh is closed
    for (size_t k = 0; ok && k < 3 * (size_t)vertex_count; k++)
        solid->vertices[k / 3][k % 3] = vertices[k] + 0.0f; // turns -0 into 0
    if (!result) result = mesh_join(memory, solid, first, error);
    if (!result) result = mesh_gather(triangles, first, source, solid, error);
    if (!result) mesh_turn(solid);
    if (!result) result = mesh_link(&edges, source, solid, error);

    table_free(memory, &edges);
    FREE(memory, first, vertex_count);
    FREE(memory, source, triangle_count);

    return result;
}
