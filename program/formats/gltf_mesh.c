// Polygons of a glTF's scene: a walk over its nodes. The vertices of their meshes' primitives follow in this order.
#include "formats/gltf.h"
#include "common/store.h"

#include <math.h>
#include <string.h>

enum { NODE_DEPTH = 1000 };

/// Rows of a transform: three axes and an origin.
typedef struct Transform {
    float m[3][4];
} Transform;

/// State of the walk.
typedef struct Instance {
    uint32_t mesh;
    Transform at;
} Instance;

/// The nodes of a list that are not yet walked. Hostile files nest them deep, and stacks are small: none is used.
typedef struct Level {
    int64_t at;    ///< the next value
    uint32_t left; ///< how many there are
    Transform parent;
} Level;

typedef struct Walk {
    Gltf *gltf;
    Level *levels; ///< [NODE_DEPTH + 1]
    Instance *instances;
    size_t count, capacity;
    uint8_t *seen; ///< [node_count]
    uint64_t max, vertices, faces, corners, primitives;
    bool uv;
} Walk;

// ---- transforms

static Transform chain(const Transform *outer, const Transform *inner) {
    Transform both;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            both.m[r][c] =
                inner->m[0][c] * outer->m[r][0] + inner->m[1][c] * outer->m[r][1] + inner->m[2][c] * outer->m[r][2];
            if (c == 3) both.m[r][c] += outer->m[r][3];
        }
    return both;
}

/// The numbers of a member. False if their count differs; unchanged without the member.
static bool take_numbers(const Json *json, int64_t object, const char *key, uint32_t count, float *numbers) {
    int64_t list = json_member(json, object, key), at = list + 1;
    if (list == JSON_NONE) return true;
    if (json_items(json, list) != count) return false;

    for (uint32_t i = 0; i < count; i++, at = json->values[at].after) {
        double number;
        if (!json_number(json, at, &number) || !(fabs(number) < 3e38)) return false;
        numbers[i] = (float)number;
    }

    return true;
}

static SingeResult node_transform(const Gltf *gltf, uint32_t node, Transform *at) {
    const Json *json = &gltf->json;
    int64_t object = gltf->nodes[node];
    float matrix[16] = {0}, move[3] = {0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    bool good = take_numbers(json, object, "matrix", 16, matrix) &&
                take_numbers(json, object, "translation", 3, move) &&
                take_numbers(json, object, "rotation", 4, rotation) && take_numbers(json, object, "scale", 3, scale);

    if (!good) return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "nodes[%u]: its transform is not finite", node);

    if (json_member(json, object, "matrix") != JSON_NONE) {
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++) at->m[r][c] = matrix[4 * c + r];
        return SINGE_OK;
    }

    Transform moved = {{{1, 0, 0, move[0]}, {0, 1, 0, move[1]}, {0, 0, 1, move[2]}}};
    float x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
    Transform turned = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
                         {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
                         {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
    Transform scaled = {{{scale[0], 0, 0, 0}, {0, scale[1], 0, 0}, {0, 0, scale[2], 0}}};

    *at = chain(&moved, &turned);
    *at = chain(at, &scaled);
    return SINGE_OK;
}

// ---- the walk

static SingeResult walk_nodes(Walk *walk, int64_t roots) {
    const Gltf *gltf = walk->gltf;
    walk->levels[0] = (Level){roots + 1, json_items(&gltf->json, roots), {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

    for (uint32_t depth = 1; depth > 0;) {
        Level *level = &walk->levels[depth - 1];
        if (level->left == 0) {
            depth--;
            continue;
        }

        const int64_t at = level->at;
        level->at = gltf->json.values[at].after;
        level->left--;

        uint64_t number;
        if (!json_count(&gltf->json, at, &number) || number >= gltf->node_count)
            return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "byte %u of its JSON: there are only %u nodes",
                               gltf->json.values[at].begin, gltf->node_count);

        const uint32_t node = (uint32_t)number;
        int64_t object = gltf->nodes[node], mesh, extensions = json_member(&gltf->json, object, "extensions");

        if (walk->seen[node])
            return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "nodes[%u]: it contains itself, or has two parents", node);
        if (depth > NODE_DEPTH)
            return gltf_refuse(gltf, SINGE_ERROR_LIMIT, "nodes[%u]: nodes are nested more than %d deep", node,
                               NODE_DEPTH);
        if (json_member(&gltf->json, extensions, "EXT_mesh_gpu_instancing") != JSON_NONE)
            return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "nodes[%u]: EXT_mesh_gpu_instancing is not supported", node);
        walk->seen[node] = 1;

        Transform own = {0}, here; // gcc 14 does not see that a refused transform ends the walk
        TRY(node_transform(gltf, node, &own));
        here = chain(&level->parent, &own);
        TRY(gltf_index(gltf, object, "mesh", gltf->mesh_count, &mesh));

        if (mesh >= 0) {
            const GltfMesh *range = &gltf->ranges[mesh];
            for (uint32_t k = 0; k < range->count; k++) {
                const GltfPrimitive *primitive = &gltf->primitives[range->first + k];
                uint64_t vertices = gltf->read[primitive->position].count, faces = 0;
                uint64_t corners = primitive->indices < 0 ? vertices : gltf->read[primitive->indices].count;
                if (primitive->mode == 4 && corners % 3)
                    return gltf_refuse(gltf, SINGE_ERROR_MESH, "meshes[%u]: primitive %u: triangles have %llu corners",
                                       primitive->mesh, primitive->number, (unsigned long long)corners);

                if (primitive->mode == 4) faces = corners / 3;
                else if (primitive->mode > 4) faces = corners > 2 ? corners - 2 : 0;
                walk->vertices += vertices;
                walk->faces += faces;
                walk->corners += 3 * faces;
                walk->uv = walk->uv || primitive->uv >= 0;
                walk->primitives++;

                if (12 * walk->vertices + 12 * walk->corners + 100 * walk->primitives > walk->max)
                    return gltf_refuse(gltf, SINGE_ERROR_LIMIT,
                                       "too large: its nodes repeat meshes, which come to more than %llu MB",
                                       (unsigned long long)walk->max / 1000000);
            }

            if (!store_grow(gltf->allocator, &walk->instances, &walk->capacity, walk->count + 1,
                            sizeof *walk->instances))
                return refuse_memory(gltf->error, "gltf", gltf->name);
            walk->instances[walk->count++] = (Instance){(uint32_t)mesh, here};
        }

        const int64_t children = json_member(&gltf->json, object, "children");
        walk->levels[depth++] = (Level){children + 1, json_items(&gltf->json, children), here};
    }

    return SINGE_OK;
}

// ---- values

static uint32_t load_index(const uint8_t *p, uint32_t type) {
    if (type == 5121) return *p;
    return type == 5123 ? (uint32_t)p[0] | (uint32_t)p[1] << 8 : load_u32_little(p);
}

static float load_value(const uint8_t *p, uint32_t type, bool normalized) {
    uint32_t bits = gltf_type_size(type) == 4 ? load_u32_little(p) : load_index(p, type < 5122 ? 5121 : 5123);
    float value, max;
    switch (type) {
    case 5120:
        value = (float)(int8_t)bits;
        max = 127;
        break;
    case 5121:
        value = (float)bits;
        max = 255;
        break;
    case 5122:
        value = (float)(int16_t)bits;
        max = 32767;
        break;
    case 5123:
        value = (float)bits;
        max = 65535;
        break;
    case 5125: return (float)bits;
    default: memcpy(&value, &bits, sizeof value); return value;
    }

    return normalized ? fmaxf(value / max, -1) : value;
}

/// All elements of an accessor.
static void load_elements(const GltfAccessor *a, uint32_t count, float *values) {
    uint32_t size = gltf_type_size(a->type);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < a->width; c++)
            values[i * a->width + c] = load_value(a->bytes + i * a->stride + c * size, a->type, a->normalized);
    for (size_t i = 0; i < a->sparse_count; i++) {
        size_t to = load_index(a->sparse_index + i * gltf_type_size(a->sparse_type), a->sparse_type);
        for (size_t c = 0; to < count && c < a->width; c++)
            values[to * a->width + c] = load_value(a->sparse_bytes + (i * a->width + c) * size, a->type, a->normalized);
    }
}

/// The polygons being filled; their counts increase.
typedef struct Fill {
    const Gltf *gltf;
    Polygons *mesh;
    float *uv; ///< of a primitive's vertices
} Fill;

static SingeResult fill_primitive(Fill *fill, const GltfPrimitive *primitive, const Transform *at) {
    const GltfAccessor *position = &fill->gltf->read[primitive->position];
    Polygons *mesh = fill->mesh;
    const float(*m)[4] = at->m;
    bool mirrored = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                        m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                        m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
                    0;
    const GltfAccessor *indices = primitive->indices < 0 ? NULL : &fill->gltf->read[primitive->indices];
    uint64_t corners = indices ? indices->count : position->count;
    uint64_t faces = primitive->mode < 4 ? 0 : primitive->mode == 4 ? corners / 3 : corners > 2 ? corners - 2 : 0;

    float *positions = fill->mesh->positions + 3 * (size_t)fill->mesh->vertex_count;
    load_elements(position, position->count, positions);

    for (uint32_t v = 0; v < position->count; v++, positions += 3) {
        float x = positions[0], y = positions[1], z = positions[2];
        for (int r = 0; r < 3; r++) positions[r] = at->m[r][0] * x + at->m[r][1] * y + at->m[r][2] * z + at->m[r][3];
    }

    if (primitive->uv >= 0) load_elements(&fill->gltf->read[primitive->uv], position->count, fill->uv);
    for (uint64_t f = 0; f < faces; f++) {
        uint64_t corner[3];

        // the three corners of the primitive's f-th triangle
        bool odd = primitive->mode == 5 && f % 2;
        corner[0] = primitive->mode == 4 ? 3 * f : primitive->mode == 6 ? 0 : f + odd;
        corner[1] = primitive->mode == 4 ? 3 * f + 1 : primitive->mode == 6 ? f + 1 : f + !odd;
        corner[2] = primitive->mode == 4 ? 3 * f + 2 : f + 2;

        for (int k = 0; k < 3; k++) {
            uint64_t at_corner = corner[mirrored ? 2 - k : k];
            uint32_t i = mesh->corner_count++, vertex = (uint32_t)at_corner;
            if (indices) vertex = load_index(indices->bytes + at_corner * indices->stride, indices->type);
            if (vertex >= position->count)
                return gltf_refuse(
                    fill->gltf, SINGE_ERROR_MESH,
                    "meshes[%u]: primitive %u: index %llu (from 0): vertex %u is out of range: there are %u",
                    primitive->mesh, primitive->number, (unsigned long long)at_corner, vertex, position->count);

            mesh->corners[i] = mesh->vertex_count + vertex;
            if (!mesh->uv) continue;

            const float none[2] = {0, 1}, *uv = primitive->uv < 0 ? none : fill->uv + 2 * (size_t)vertex;
            float *to = mesh->uv + 2 * (size_t)i;
            to[0] = uv[0], to[1] = 1 - uv[1]; // glTF's v runs down
            if (!isfinite(to[0]) || !isfinite(to[1])) to[0] = to[1] = 0;
        }

        mesh->first[++mesh->face_count] = mesh->corner_count;
    }

    mesh->vertex_count += position->count;
    return SINGE_OK;
}

static SingeResult make_polygons(const Walk *walk, Polygons *polygons) {
    const Gltf *gltf = walk->gltf;
    SingeAllocator a = gltf->allocator;
    if (walk->faces == 0) return gltf_refuse(gltf, SINGE_ERROR_MESH, "has no faces");
    if (walk->vertices > MESH_COUNT_LIMIT || walk->corners > MESH_COUNT_LIMIT)
        return gltf_refuse(gltf, SINGE_ERROR_LIMIT, "is too large");

    Polygons made = {.allocator = a};
    Fill fill = {.gltf = gltf, .mesh = &made};

    made.positions = store_new(a, walk->vertices, 3 * sizeof *made.positions);
    made.first = store_new(a, walk->faces + 1, sizeof *made.first);
    made.corners = store_new(a, walk->corners, sizeof *made.corners);
    if (walk->uv) made.uv = store_new(a, walk->corners, 2 * sizeof *made.uv);
    if (walk->uv) fill.uv = store_new(a, walk->vertices, 2 * sizeof *fill.uv);

    bool room = made.positions && made.first && made.corners && (!walk->uv || (made.uv && fill.uv));
    if (room) made.first[0] = 0;
    SingeResult result = room ? SINGE_OK : refuse_memory(gltf->error, "gltf", gltf->name);

    for (size_t n = 0; n < walk->count && !result; n++) {
        const GltfMesh *range = &gltf->ranges[walk->instances[n].mesh];
        for (uint32_t i = 0; i < range->count && !result; i++)
            result = fill_primitive(&fill, &gltf->primitives[range->first + i], &walk->instances[n].at);
    }

    for (size_t i = 0; i < 3 * (size_t)made.vertex_count && !result; i++)
        if (!isfinite(made.positions[i]))
            result = gltf_refuse(gltf, SINGE_ERROR_MESH, "vertex %llu (from 0) has a position that is not finite",
                                 (unsigned long long)(i / 3));
    store_free(a, fill.uv, walk->vertices, 2 * sizeof *fill.uv);

    // the allocated counts, for polygons_free
    made.vertex_count = (uint32_t)walk->vertices;
    made.face_count = (uint32_t)walk->faces;
    made.corner_count = (uint32_t)walk->corners;
    if (result) polygons_free(&made);
    else *polygons = made;
    return result;
}

SingeResult gltf_make(Gltf *gltf, uint64_t max, Polygons *polygons) {
    Walk walk = {.gltf = gltf, .max = max};
    int64_t scenes = json_member(&gltf->json, 0, "scenes"), wanted, at = scenes + 1;

    TRY(gltf_index(gltf, 0, "scene", json_items(&gltf->json, scenes), &wanted));
    if (!json_items(&gltf->json, scenes)) return gltf_refuse(gltf, SINGE_ERROR_FORMAT, "it has no scene");
    for (; wanted > 0; wanted--) at = gltf->json.values[at].after;
    walk.levels = store_new(gltf->allocator, NODE_DEPTH + 1, sizeof *walk.levels);
    walk.seen = store_new(gltf->allocator, gltf->node_count, 1);

    const bool room = walk.levels && walk.seen;
    if (room) memset(walk.seen, 0, gltf->node_count);

    SingeResult result = room ? walk_nodes(&walk, json_member(&gltf->json, at, "nodes"))
                              : refuse_memory(gltf->error, "gltf", gltf->name);
    if (!result) result = make_polygons(&walk, polygons);
    store_free(gltf->allocator, walk.levels, NODE_DEPTH + 1, sizeof *walk.levels);
    store_free(gltf->allocator, walk.seen, gltf->node_count, 1);
    store_free(gltf->allocator, walk.instances, walk.capacity, sizeof *walk.instances);
    return result;
}
