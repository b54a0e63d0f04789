// A render mesh: checked, its parts found, its long edges divided, and bound.
//
// A vertex p is bound to the position S of the sheet at rest that is nearest to it (render_bind.c), and keeps its
// distance from there in the frame F of the drawn surface, whose axes are the cell's first side and the normal n:
//
//   d = F0^T (p - S0),   drawn at S + F d
//
// So at rest it is drawn where it was given, whatever the shape at rest, and thickness stays along the normal when the
// sheet bends. The vertices of a rigid part, such as a button, are all bound to one position, that nearest to the part's
// middle.
//
// By uv, S is where the sheet has the vertex's uv, and d is 0: the mesh lies on the sheet, wherever it was given.
//
// Edges are halved until none is longer than `edge_max`, at most half a cell's side: long triangles would neither follow
// the sheet's folds nor notice its holes. A triangle becomes two, three or four, as one, two or all of its edges are long,
// so neighbours meet without cracks.
#include "common/def_table.h"
#include "common/real.h"
#include "surface/render_parts.h"

#include <string.h>

enum { VERTICES_MAX = 1 << 24 };

/// Numbers keys of three words in the order in which they first come.
typedef struct KeyTable {
    uint32_t (*keys)[3];
    uint32_t *slots; ///< [mask + 1] 1 + number of a key, or 0
    uint32_t count, capacity, mask;
} KeyTable;

static bool table_open(Memory *memory, uint32_t capacity, KeyTable *table) {
    *table = (KeyTable){.capacity = capacity, .mask = 7};
    while (table->mask < 2 * (uint64_t)capacity) table->mask = 2 * table->mask + 1;
    return NEW(memory, table->keys, capacity) && NEW(memory, table->slots, (size_t)table->mask + 1);
}

static void table_close(Memory *memory, KeyTable *table) {
    FREE(memory, table->keys, table->capacity);
    FREE(memory, table->slots, (size_t)table->mask + 1);
}

static uint32_t table_number(KeyTable *table, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t key[3] = {a, b, c};
    uint32_t hash = (a * 0x9e3779b1u) ^ (b * 0x85ebca77u) ^ (c * 0xc2b2ae3du);
    hash = (hash ^ hash >> 15) * 0x2c1b3c6du;
    for (uint32_t slot = hash ^ hash >> 13;; slot++) {
        uint32_t *held = &table->slots[slot & table->mask];
        if (*held && memcmp(table->keys[*held - 1], key, sizeof key) != 0) continue;
        if (*held) return *held - 1;
        memcpy(table->keys[table->count], key, sizeof key);
        *held = ++table->count;
        return table->count - 1;
    }
}

static SingeResult no_memory(SingeError *error) {
    return error_set(error, SINGE_ERROR_MEMORY, "render mesh", -1, "out of memory for the render mesh");
}

static SingeResult too_fine(float max, SingeError *error) {
    return error_set(error, SINGE_ERROR_LIMIT, "render mesh", -1,
                     "edges of at most %g m would make more than %d triangles", (double)max, VERTICES_MAX);
}

static Float3 doubled_area(const RenderMesh *mesh, const uint32_t *at) {
    const Float3 p = float3_load(mesh->vertices[at[0]].rest);
    return float3_cross(float3_sub(float3_load(mesh->vertices[at[1]].rest), p),
                        float3_sub(float3_load(mesh->vertices[at[2]].rest), p));
}

// ---- in

/// Copies the triangles that have an area and are the first with their corners.
static SingeResult take_triangles(Memory *memory, const SingeRenderMeshDef *def, RenderMesh *mesh, SingeError *error) {
    KeyTable known;
    bool ok = table_open(memory, def->triangle_count, &known);
    for (uint32_t t = 0; t < def->triangle_count && ok; t++) {
        const uint32_t *at = &def->triangles[3 * (size_t)t];
        const uint32_t least = at[0] < at[1] ? 0 : 1, first = at[least] < at[2] ? least : 2;
        const uint32_t a = at[first], b = at[(first + 1) % 3], c = at[(first + 2) % 3], before = known.count;
        table_number(&known, a, b < c ? b : c, b < c ? c : b);
        if (known.count > before && float3_length(doubled_area(mesh, at)) > 0)
            memcpy(mesh->triangles[mesh->triangle_count++], at, sizeof *mesh->triangles);
    }

    mesh->left_out = def->triangle_count - mesh->triangle_count;
    table_close(memory, &known);
    if (!ok) return no_memory(error);
    if (mesh->triangle_count) return SINGE_OK;

    return error_set(error, SINGE_ERROR_MESH, "render mesh", -1, "the mesh has no triangles");
}

/// Checks the mesh and copies it.
static SingeResult take(Memory *memory, const RenderSheet *sheet, const SingeRenderMeshDef *def, RenderMesh *mesh,
                        SingeError *error) {
    if (!def->positions || !def->triangles)
        return error_set(error, SINGE_ERROR_ARGUMENT, "render mesh", -1, "positions or triangles are NULL");

    SingeResult checked = def_check(&render_mesh_table, def, error);
    if (checked) return checked;
    if (def->vertex_count > VERTICES_MAX || def->triangle_count > VERTICES_MAX)
        return error_set(error, SINGE_ERROR_LIMIT, "render mesh", -1, "more than %d vertices or triangles",
                         VERTICES_MAX);

    if (def->by_uv && !def->uv)
        return error_set(error, SINGE_ERROR_ARGUMENT, "render mesh", -1, "by_uv needs a mesh with uv");

    bool mapped = false;
    for (uint32_t v = 0; v < sheet->source->sheet.vertex_count && sheet->source->uv && !mapped; v++)
        mapped = sheet->source->uv[v][0] != 0 || sheet->source->uv[v][1] != 0;
    if (def->by_uv && !mapped)
        return error_set(error, SINGE_ERROR_ARGUMENT, "render mesh", -1, "by_uv needs a sheet with uv");

    for (uint32_t v = 0; v < def->vertex_count; v++) {
        bool finite = true;
        for (size_t k = 0; k < 3; k++) finite &= fabsf(def->positions[3 * (size_t)v + k]) < 1e4f;
        for (size_t k = 0; k < 2 && def->uv; k++) finite &= fabsf(def->uv[2 * (size_t)v + k]) < INFINITY;
        if (!finite)
            return error_set(error, SINGE_ERROR_MESH, "render mesh", v,
                             "vertex %u: its position must be finite and within 10 km, and its uv finite", v);
    }

    for (size_t k = 0; k < 3 * (size_t)def->triangle_count; k++)
        if (def->triangles[k] >= def->vertex_count)
            return error_set(error, SINGE_ERROR_MESH, "render mesh", (int64_t)(k / 3),
                             "triangle %u has the corner %u, but there are %u vertices", (uint32_t)(k / 3),
                             def->triangles[k], def->vertex_count);

    mesh->beside = def->beside;
    mesh->vertex_count = mesh->vertex_capacity = def->vertex_count;
    mesh->triangle_capacity = def->triangle_count;
    if (!NEW(memory, mesh->vertices, mesh->vertex_capacity) || !NEW(memory, mesh->triangles, mesh->triangle_capacity))
        return no_memory(error);

    for (uint32_t v = 0; v < def->vertex_count; v++) {
        RenderVertex *vertex = &mesh->vertices[v];
        vertex->source = sheet->number_first + (int32_t)v;
        memcpy(vertex->rest, &def->positions[3 * (size_t)v], sizeof vertex->rest);
        vertex->has_uv = def->uv != NULL;
        if (def->uv) memcpy(vertex->uv, &def->uv[2 * (size_t)v], sizeof vertex->uv);
    }

    return take_triangles(memory, def, mesh, error);
}

// ---- normals and parts

/// The middle and the extent of what hangs together.
typedef struct Part {
    double sum[3];
    uint32_t count;
    float extent; ///< m, twice the largest distance from the middle
} Part;

static uint32_t root_of(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static Float3 middle_of(const Part *part) {
    const double n = (double)part->count;
    return float3((float)(part->sum[0] / n), (float)(part->sum[1] / n), (float)(part->sum[2] / n));
}

/// Normals: area-weighted means of the triangles around a position, also where a seam of the uv gives it several
/// vertices. Then what each vertex is bound by: its own position, or the middle of its part if that is rigid.
static SingeResult find_parts(Memory *memory, float rigid, RenderMesh *mesh, SingeError *error) {
    KeyTable places = {0};
    uint32_t *place = NULL, *parent = NULL;
    Part *parts = NULL;
    float(*sums)[3] = NULL;
    const uint32_t count = mesh->vertex_count;
    bool ok = table_open(memory, count, &places) && NEW(memory, place, count) && NEW(memory, parent, count) &&
              NEW(memory, parts, count) && NEW(memory, sums, count);

    for (uint32_t v = 0; v < count && ok; v++) {
        uint32_t bits[3];
        float at[3];
        for (int k = 0; k < 3; k++) at[k] = mesh->vertices[v].rest[k] + 0.0f; // -0 is 0
        memcpy(bits, at, sizeof bits);
        place[v] = table_number(&places, bits[0], bits[1], bits[2]);
    }

    if (ok) {
        for (uint32_t i = 0; i < places.count; i++) parent[i] = i;
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            const uint32_t *at = mesh->triangles[t];
            const Float3 doubled = doubled_area(mesh, at);
            for (int k = 0; k < 3; k++) {
                float *sum = sums[place[at[k]]];
                float3_store(sum, float3_add(float3_load(sum), doubled));
                parent[root_of(parent, place[at[k]])] = root_of(parent, place[at[0]]);
            }
        }

        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            Part *part = &parts[root_of(parent, place[v])];
            part->count++;
            for (int k = 0; k < 3; k++) part->sum[k] += (double)mesh->vertices[v].rest[k];
        }

        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            Part *part = &parts[root_of(parent, place[v])];
            const Float3 from = float3_sub(float3_load(mesh->vertices[v].rest), middle_of(part));
            part->extent = float_max(part->extent, 2 * float3_length(from));
        }

        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            RenderVertex *vertex = &mesh->vertices[v];
            const Part *part = &parts[root_of(parent, place[v])];
            vertex->rigid = part->extent <= rigid;
            float3_store(vertex->normal, float3_unit(float3_load(sums[place[v]])));
            float3_store(vertex->offset, vertex->rigid ? middle_of(part) : float3_load(vertex->rest));
        }
    }

    table_close(memory, &places);
    FREE(memory, place, count);
    FREE(memory, parent, count);
    FREE(memory, parts, count);
    FREE(memory, sums, count);
    return ok ? SINGE_OK : no_memory(error);
}

// ---- edges

/// Numbers the edges.
static SingeResult list_edges(Memory *memory, RenderMesh *mesh, SingeError *error) {
    KeyTable table;
    FREE(memory, mesh->triangle_edges, mesh->triangle_capacity);
    FREE(memory, mesh->edges, mesh->edge_capacity);
    bool ok = table_open(memory, 3 * mesh->triangle_count, &table) &&
              NEW(memory, mesh->triangle_edges, mesh->triangle_capacity);

    for (uint32_t t = 0; t < mesh->triangle_count && ok; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t a = mesh->triangles[t][k], b = mesh->triangles[t][(k + 1) % 3];
            mesh->triangle_edges[t][k] = table_number(&table, a < b ? a : b, a < b ? b : a, 0);
        }

    mesh->edge_count = mesh->edge_capacity = ok ? table.count : 0;
    ok = ok && NEW(memory, mesh->edges, mesh->edge_capacity);
    for (uint32_t e = 0; e < mesh->edge_count && ok; e++) memcpy(mesh->edges[e], table.keys[e], sizeof *mesh->edges);
    table_close(memory, &table);
    return ok ? SINGE_OK : no_memory(error);
}

/// Appends the parts of a triangle. halves: the vertex in the middle of each edge, or SHELL_NONE.
static void divide(const uint32_t at[3], const uint32_t halves[3], uint32_t (*out)[3], uint32_t *count) {
    int long_count = 0, first = 0;
    for (int k = 0; k < 3; k++) long_count += halves[k] != SHELL_NONE;
    while (long_count == 1 && halves[first] == SHELL_NONE) first++;
    while (long_count == 2 && halves[(first + 2) % 3] != SHELL_NONE) first++; // the first two are long

    const uint32_t a = at[first], b = at[(first + 1) % 3], c = at[(first + 2) % 3];
    const uint32_t ab = halves[first], bc = halves[(first + 1) % 3], ca = halves[(first + 2) % 3];
    const uint32_t divided[4][4][3] = {
        {{a, b, c}},
        {{a, ab, c}, {ab, b, c}},
        {{ab, b, bc}, {a, ab, bc}, {a, bc, c}},
        {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}},
    };
    for (int i = 0; i <= long_count; i++) memcpy(out[(*count)++], divided[long_count][i], sizeof *out);
}

/// Halves the edges that are longer than `max`, once. *halved: how many. edges are listed.
static SingeResult halve(Memory *memory, float max, RenderMesh *mesh, uint32_t *halved, SingeError *error) {
    uint32_t *half = NULL, count = 0, vertices = mesh->vertex_count;
    uint32_t(*triangles)[3] = NULL;
    const uint32_t edges = mesh->edge_count, triangle_max = 4 * mesh->triangle_count;
    if (!NEW(memory, half, edges)) return no_memory(error);

    *halved = 0;
    for (uint32_t e = 0; e < edges; e++) {
        const RenderVertex *a = &mesh->vertices[mesh->edges[e][0]], *b = &mesh->vertices[mesh->edges[e][1]];
        const float length = float3_length(float3_sub(float3_load(a->rest), float3_load(b->rest)));
        half[e] = length > max && !a->rigid ? vertices + (*halved)++ : SHELL_NONE;
    }

    // in place of the present triangles
    SingeResult result = SINGE_OK;
    if ((uint64_t)vertices + *halved > VERTICES_MAX || mesh->triangle_count > VERTICES_MAX / 4)
        result = too_fine(max, error);
    else if (*halved && !(NEW(memory, triangles, triangle_max) &&
                          memory_grow(memory, &mesh->vertices, vertices, vertices + *halved, sizeof *mesh->vertices)))
        result = no_memory(error);

    if (!result && *halved) {
        mesh->vertex_count = mesh->vertex_capacity = vertices + *halved;
        for (uint32_t e = 0; e < edges; e++) {
            if (half[e] == SHELL_NONE) continue;
            const RenderVertex *a = &mesh->vertices[mesh->edges[e][0]], *b = &mesh->vertices[mesh->edges[e][1]];
            RenderVertex *made = &mesh->vertices[half[e]];
            *made = (RenderVertex){.source = -1, .has_uv = a->has_uv};
            for (int k = 0; k < 3; k++) made->rest[k] = made->offset[k] = 0.5f * a->rest[k] + 0.5f * b->rest[k];
            for (int k = 0; k < 2; k++) made->uv[k] = 0.5f * a->uv[k] + 0.5f * b->uv[k];
            float3_store(made->normal, float3_unit(float3_add(float3_load(a->normal), float3_load(b->normal))));
        }

        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            uint32_t halves[3];
            for (int k = 0; k < 3; k++) halves[k] = half[mesh->triangle_edges[t][k]];
            divide(mesh->triangles[t], halves, triangles, &count);
        }

        FREE(memory, mesh->triangle_edges, mesh->triangle_capacity);
        FREE(memory, mesh->triangles, mesh->triangle_capacity);
        mesh->triangles = triangles;
        mesh->triangle_count = count;
        mesh->triangle_capacity = triangle_max;
        triangles = NULL;
    }

    FREE(memory, triangles, triangle_max);
    FREE(memory, half, edges);
    return result;
}

// ---- the mesh

/// Feet of what was given, then edges, then the feet of their middles. `fine` has the sheet at rest.
static SingeResult bind(const Fine *fine, float cell, const SingeRenderMeshDef *def, RenderMesh *mesh,
                        SingeError *error) {
    const float max = def->edge_max > 0 ? float_min(def->edge_max, 0.5f * cell) : 0.5f * cell;
    const float reach = def->reach > 0 ? def->reach : cell;
    const uint32_t given = mesh->vertex_count;

    if (def->by_uv) { // first, as its edges are as long as they are on the sheet
        TRY(render_find_feet(fine, true, reach, 0, mesh, error));
        render_bind(fine, true, mesh);
    }

    // triangles whose edges are no longer have at most the area of one whose edges all are as long
    double area = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *at = mesh->triangles[t];
        const Float3 doubled = doubled_area(mesh, at);
        if (!mesh->vertices[at[0]].rigid) area += 0.5 * (double)float3_length(doubled);
    }
    if (area > 0.4331 * (double)max * (double)max * VERTICES_MAX) return too_fine(max, error);

    if (!def->by_uv) TRY(render_find_feet(fine, false, reach, 0, mesh, error));
    for (uint32_t halved = 1; halved;) {
        TRY(list_edges(fine->memory, mesh, error));
        TRY(halve(fine->memory, max, mesh, &halved, error));
    }

    if (mesh->vertex_count > given) TRY(render_find_feet(fine, def->by_uv, reach, given, mesh, error));
    render_bind(fine, def->by_uv, mesh);
    return SINGE_OK;
}

static SingeResult make(Memory *memory, Pool *pool, const RenderSheet *sheet, const SingeRenderMeshDef *def,
                        RenderMesh *mesh, SingeError *error) {
    TRY(take(memory, sheet, def, mesh, error));

    // edges of more than two triangles, and of two that run the same way along it
    uint32_t(*ways)[2] = NULL;
    TRY(list_edges(memory, mesh, error));
    const uint32_t count = mesh->edge_count;
    if (!NEW(memory, ways, count)) return no_memory(error);

    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t edge = mesh->triangle_edges[t][k];
            ways[edge][mesh->triangles[t][k] == mesh->edges[edge][0]]++;
        }

    for (uint32_t e = 0; e < count; e++) mesh->odd_edges += ways[e][0] > 1 || ways[e][1] > 1;
    FREE(memory, ways, count);

    TRY(find_parts(memory, def->by_uv ? 0 : def->rigid, mesh, error));

    // the surface of the sheet at rest, before any tear
    SheetSource source = *sheet->source;
    Shell shell = {0};
    State state = {0};

    source.sheet.spare_count = 0;
    SingeResult result = shell_create(memory, &source, 1, &shell, error);
    if (!result && (result = state_create(memory, &shell, &state))) no_memory(error);

    if (!result) {
        const SurfaceDetail detail = {.size = shell.sheets[0].cell_size};
        Fine fine = {.shell = &shell, .state = &state, .memory = memory, .pool = pool, .bulge_max = INFINITY};
        if (sheet->bulge_max > 0) fine.bulge_max = sheet->bulge_max;
        result = fine_open(&fine, &detail, error);
        if (!result) render_bends(&fine);
        if (!result) result = bind(&fine, sheet->cell_size, def, mesh, error);
        fine_close(&fine);
    }

    mesh->cell_first = sheet->cell_first;
    mesh->cell_count = shell.cell_count;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) mesh->vertices[v].foot.cell += sheet->cell_first;
    if (state.arena) state_free(memory, &state);
    shell_free(memory, &shell);
    return result;
}

SingeResult render_mesh_create(Memory *memory, Pool *pool, const RenderSheet *sheet, const SingeRenderMeshDef *def,
                               RenderMesh **mesh, SingeError *error) {
    *mesh = memory_new(memory, 1, sizeof **mesh);
    if (!*mesh) return no_memory(error);
    SingeResult result = make(memory, pool, sheet, def, *mesh, error);
    if (!result) return SINGE_OK;
    render_mesh_free(memory, *mesh);
    *mesh = NULL;
    return result;
}

void render_mesh_free(Memory *memory, RenderMesh *mesh) {
    if (!mesh) return;
    FREE(memory, mesh->vertices, mesh->vertex_capacity);
    FREE(memory, mesh->triangles, mesh->triangle_capacity);
    FREE(memory, mesh->triangle_edges, mesh->triangle_capacity);
    FREE(memory, mesh->edges, mesh->edge_capacity);
    FREE(memory, mesh, 1);
}

RenderFlaws render_mesh_flaws(const RenderMesh *mesh) { return (RenderFlaws){mesh->left_out, mesh->odd_edges}; }

bool render_hides(const RenderMesh *mesh, uint32_t cell) {
    return !mesh->beside && cell - mesh->cell_first < mesh->cell_count; // wraps around below the first
}
