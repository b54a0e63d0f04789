// Draws a render mesh: its triangles, cut by the level of the sheet and by its tears.
//
// Every vertex has the level of the sheet at its foot (fine_level.c), below 0 where the cell is gone. A triangle's
// vertices with L >= 0 stay; on an edge to one that goes, the last position with L >= 0 is found by halving, along the
// way on the sheet from foot to foot. Vertices at a cut are between those of the edge by the share t of this way, and
// lie at their own foot, so that the edge of the mesh follows the edge of the sheet.
//
// An edge is parted if the sheet has come apart between its feet: their cells belong to different pieces, or share
// fewer vertices than at rest. A parted edge is cut from both ends, each up to the tear, as the way on the sheet ends
// there. So a triangle across a tear becomes a part on either side, and none is stretched over the gap.
#include <float.h>

#include "common/assertion.h"
#include "common/real.h"
#include "surface/render_parts.h"

/// Cuts nearer to the staying vertex than this share of the edge are that vertex; each halving resolves half.
#define NEAREST 0.03125f
enum { HALVINGS = 6 };

/// The level of cells that have burnt away is at most this.
#define LEVEL_GONE -1e-3f

/// Offsets along the normal are at most this share of the distance to another surface. With what the surface beneath
/// leaves of it (fine_position.c) less than half of it is taken from either side, so that nothing crosses.
#define ROOM_SHARE 0.25f
/// On the inner side of a bend, also this share of the radius of curvature: at a share of 1 a parallel surface folds over.
#define BEND_SHARE 0.5f

/// A mesh that is being drawn.
typedef struct RenderDrawing {
    const RenderMesh *mesh;
    FineValue *values;   ///< [vertices]
    uint8_t *parted;     ///< [edges]
    uint32_t *drawn;     ///< [vertices] 1 + index of the vertex drawn there, 0 for none
    uint32_t (*cuts)[2]; ///< [edges] the same of the cuts from either end
    RenderVertex *made;  ///< [made_capacity] cuts
    uint32_t made_count, made_capacity;
} RenderDrawing;

/// A drawing of all vertices of a mesh, in ranges.
typedef struct Levels {
    const Fine *fine;
    RenderDrawing *drawing;
} Levels;

/// Level and mass where the sheet is still there, and a level below 0 elsewhere.
static FineValue value_at(const Fine *fine, const FineLocation *foot) {
    const uint32_t cell = foot->cell, centre = shell_centre(fine->shell, cell);
    FineValue value = {fine->raw_level[centre], fine->state->burn.mass[centre]};
    if (!(fine->flags[cell] & FINE_EVEN)) value = fine_value(fine, foot);
    if (!(fine->state->ablate.cell_flags[cell] & SINGE_ALIVE) ||
        (!fine->sound[cell] && fine_is_torn(fine, cell, foot->side)))
        value.level = float_min(value.level, LEVEL_GONE);
    return value;
}

static void find_levels(void *context, int begin, int end) {
    const Levels *levels = context;
    for (int v = begin; v < end; v++)
        levels->drawing->values[v] = value_at(levels->fine, &levels->drawing->mesh->vertices[v].foot);
}

static bool is_parted(const Fine *fine, uint32_t a, uint32_t b) {
    const Shell *shell = fine->shell;
    const int32_t *piece = fine->state->ablate.piece;
    if (a == b) return false;
    if (piece[shell_centre(shell, a)] != piece[shell_centre(shell, b)]) return true;
    if (shell->edge_spare_used == 0) return false;

    int rest = 0, now = 0;
    for (int k = 0; k < 16; k++) {
        const uint32_t i = shell->cells[a][k / 4], j = shell->cells[b][k % 4];
        const float *p = shell->rest_position[i], *q = shell->rest_position[j];
        rest += p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
        now += i == j;
    }

    return now < rest;
}

void render_bends(Fine *fine) {
    const float(*position)[4] = (const float(*)[4])fine->corner;
    for (uint32_t c = 0; c < fine->shell->cell_count; c++) {
        if (!(fine->state->ablate.cell_flags[c] & SINGE_ALIVE)) continue;

        // between all corners and the middle, over which the normal turns by
        const uint32_t *at = fine->shell->cells[c];
        Float3 points[5] = {{0, 0, 0}}, normals[5] = {float3_load(fine->normal[shell_centre(fine->shell, c)])};
        for (int i = 0; i < 4; i++) {
            points[1 + i] = float3_load(position[at[i]]);
            normals[1 + i] = float3_load(fine->normal[at[i]]);
            points[0] = float3_mad(points[0], points[1 + i], 0.25f);
        }

        float most[2] = {0, 0};
        for (int i = 1; i < 5; i++)
            for (int k = 0; k < i; k++) {
                const Float3 side = float3_sub(points[i], points[k]), turn = float3_sub(normals[i], normals[k]);
                const float curvature = float3_dot(turn, side) / float_max(float3_dot(side, side), FLT_MIN);
                most[curvature > 0] = float_max(most[curvature > 0], fabsf(curvature));
            }

        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 2; k++) fine->bend[at[i]][k] = float_max(fine->bend[at[i]][k], most[k]);
    }
}

float render_bend_room(const Fine *fine, const FineLocation *foot, float offset) {
    const Float3 bend = fine_blend(fine->shell->cells[foot->cell], foot, (const float(*)[4])fine->bend);
    return BEND_SHARE / float_max(offset > 0 ? bend.x : bend.y, FLT_MIN);
}

SingeResult render_levels(Fine *fine, SingeError *error) {
    Memory *memory = fine->memory;
    bool ok = NEW(memory, fine->renders, fine->mesh_count) != NULL;
    float thickest = 0;
    for (uint32_t m = 0; m < fine->mesh_count; m++)
        for (uint32_t v = 0; v < fine->meshes[m]->vertex_count; v++) {
            const RenderVertex *vertex = &fine->meshes[m]->vertices[v];
            if (!vertex->rigid) thickest = float_max(thickest, fabsf(vertex->offset[2]));
        }

    if (fine->mesh_count) {
        render_bends(fine);
        TRY(render_rooms(fine, 2 / ROOM_SHARE * thickest, error)); // nearer ones press it
    }

    for (uint32_t m = 0; m < fine->mesh_count && ok; m++) {
        RenderDrawing *drawing = &fine->renders[m];
        const RenderMesh *mesh = fine->meshes[m];
        drawing->mesh = mesh;
        ok = NEW(memory, drawing->values, mesh->vertex_count) && NEW(memory, drawing->parted, mesh->edge_count) &&
             NEW(memory, drawing->drawn, mesh->vertex_count) && NEW(memory, drawing->cuts, mesh->edge_count);
        if (!ok) break;

        Levels levels = {fine, drawing};
        pool_for(fine->pool, (int)mesh->vertex_count, 64, find_levels, &levels);

        // what may be drawn: a cut from each staying end, at most three triangles of one that is parted
        uint64_t made = 0;
        for (uint32_t e = 0; e < mesh->edge_count; e++) {
            const uint32_t *end = mesh->edges[e];
            const bool in[2] = {drawing->values[end[0]].level >= 0, drawing->values[end[1]].level >= 0};
            const uint32_t cell[2] = {mesh->vertices[end[0]].foot.cell, mesh->vertices[end[1]].foot.cell};
            drawing->parted[e] = in[0] && in[1] && is_parted(fine, cell[0], cell[1]);
            if (drawing->parted[e]) made += 2;
            else made += in[0] != in[1];
        }

        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            int in = 0, parted = 0;
            for (int k = 0; k < 3; k++) {
                in += drawing->values[mesh->triangles[t][k]].level >= 0;
                parted += drawing->parted[mesh->triangle_edges[t][k]];
            }
            fine->extra_triangles += parted ? 3 : in == 2 ? 2 : in > 0;
        }

        for (uint32_t v = 0; v < mesh->vertex_count; v++) fine->extra_vertices += drawing->values[v].level >= 0;
        fine->extra_vertices += made;
        if (made > INT32_MAX) return error_set(error, SINGE_ERROR_LIMIT, "surface", -1, "too many vertices");
        drawing->made_capacity = (uint32_t)made;
        ok = NEW(memory, drawing->made, drawing->made_capacity);
    }

    if (ok) return SINGE_OK;
    return error_set(error, SINGE_ERROR_MEMORY, "surface", -1, "out of memory for the render mesh");
}

void render_release(Fine *fine) {
    for (uint32_t m = 0; m < fine->mesh_count && fine->renders; m++) {
        RenderDrawing *drawing = &fine->renders[m];
        FREE(fine->memory, drawing->values, fine->meshes[m]->vertex_count);
        FREE(fine->memory, drawing->parted, fine->meshes[m]->edge_count);
        FREE(fine->memory, drawing->drawn, fine->meshes[m]->vertex_count);
        FREE(fine->memory, drawing->cuts, fine->meshes[m]->edge_count);
        FREE(fine->memory, drawing->made, drawing->made_capacity);
    }
    FREE(fine->memory, fine->renders, fine->mesh_count);
}

// ---- triangles

/// The entry of a vertex that is drawn, listed if it is new.
static uint32_t list_vertex(Fine *fine, uint32_t *entry, const RenderVertex *vertex, float mass) {
    if (!*entry) {
        fine->vertices[fine->vertex_count] = (FineVertex){vertex->foot, mass, SHELL_NONE, vertex};
        *entry = ++fine->vertex_count;
    }
    return *entry;
}

static float mix(float a, float b, float t) { return a + t * (b - a); }

/// The foot at share t of the way from one vertex to another.
static FineLocation along(const Fine *fine, const RenderVertex *a, const RenderVertex *b, float t) {
    FineLocation foot = a->foot;
    if (foot.cell == b->foot.cell && foot.side == b->foot.side) {
        for (int k = 0; k < 3; k++) foot.weight[k] = mix(foot.weight[k], b->foot.weight[k], t);
        return foot;
    }

    const float(*rest)[4] = (const float(*)[4])fine->shell->rest_position;
    const Float3 way = float3_sub(fine_blend(fine->shell->cells[b->foot.cell], &b->foot, rest),
                                  fine_blend(fine->shell->cells[foot.cell], &foot, rest));
    return fine_move(fine->shell, &foot, float3_scale(way, t));
}

/// Where an edge is cut, from one of its ends: the vertex there, or the end itself.
static uint32_t cut_vertex(Fine *fine, RenderDrawing *drawing, uint32_t edge, int end) {
    const RenderMesh *mesh = drawing->mesh;
    uint32_t *entry = &drawing->cuts[edge][end];
    if (*entry) return *entry;

    const uint32_t from = mesh->edges[edge][end];
    const RenderVertex *a = &mesh->vertices[from], *b = &mesh->vertices[mesh->edges[edge][1 - end]];
    float in = 0, out = 1;
    for (int i = 0; i < HALVINGS; i++) {
        const float t = 0.5f * (in + out);
        const FineLocation foot = along(fine, a, b, t);
        if (value_at(fine, &foot).level >= 0) in = t;
        else out = t;
    }
    if (in < NEAREST) return *entry = list_vertex(fine, &drawing->drawn[from], a, drawing->values[from].mass);

    RenderVertex *made = &drawing->made[drawing->made_count++];
    *made = (RenderVertex){.foot = along(fine, a, b, in), .source = -1, .has_uv = a->has_uv, .rigid = a->rigid};
    made->slack = mix(a->slack, b->slack, in);
    for (int k = 0; k < 3; k++) {
        made->offset[k] = mix(a->offset[k], b->offset[k], in);
        made->normal[k] = mix(a->normal[k], b->normal[k], in);
        made->rest[k] = mix(a->rest[k], b->rest[k], in);
    }

    for (int k = 0; k < 2; k++) made->uv[k] = mix(a->uv[k], b->uv[k], in);
    float3_store(made->normal, float3_unit(float3_load(made->normal)));
    return list_vertex(fine, entry, made, value_at(fine, &made->foot).mass);
}

/// Draws the part of a triangle at its vertices `stays` that hang together.
static void draw_part(Fine *fine, RenderDrawing *drawing, uint32_t t, const bool stays[3]) {
    const RenderMesh *mesh = drawing->mesh;
    uint32_t polygon[4];
    int count = 0;

    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3;
        const uint32_t at = mesh->triangles[t][a], edge = mesh->triangle_edges[t][a];
        uint32_t corner[2];
        int made = 0;
        if (stays[a])
            corner[made++] = list_vertex(fine, &drawing->drawn[at], &mesh->vertices[at], drawing->values[at].mass);

        if (stays[a] != stays[b]) {
            const uint32_t from = stays[a] ? at : mesh->triangles[t][b];
            corner[made++] = cut_vertex(fine, drawing, edge, mesh->edges[edge][0] == from ? 0 : 1);
        }
        for (int m = 0; m < made; m++)
            if (!count || polygon[count - 1] != corner[m]) polygon[count++] = corner[m];
    }
    fine_fan(fine, polygon, count);
}

void render_march(Fine *fine) {
    for (uint32_t m = 0; m < fine->mesh_count; m++) {
        RenderDrawing *drawing = &fine->renders[m];
        const RenderMesh *mesh = drawing->mesh;
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            bool left[3], joined[3];
            for (int k = 0; k < 3; k++) left[k] = drawing->values[mesh->triangles[t][k]].level >= 0;
            for (int k = 0; k < 3; k++)
                joined[k] = left[k] && left[(k + 1) % 3] && !drawing->parted[mesh->triangle_edges[t][k]];

            // those that hang together, from each that has not been drawn
            for (int k = 0; k < 3; k++) {
                if (!left[k]) continue;
                bool stays[3] = {k == 0, k == 1, k == 2};
                for (int turn = 0; turn < 2; turn++)
                    for (int i = 0; i < 3; i++)
                        if (joined[i] && (stays[i] || stays[(i + 1) % 3])) stays[i] = stays[(i + 1) % 3] = true;
                draw_part(fine, drawing, t, stays);
                for (int i = 0; i < 3; i++) left[i] &= !stays[i];
            }
        }
    }
    SINGE_ASSERT(fine->vertex_count <= fine->vertex_capacity);
}

// ---- vertices

void render_place(const Fine *fine, const FineVertex *vertex, uint32_t v) {
    const RenderVertex *render = vertex->render;
    SingeSurface *surface = fine->surface;
    const uint32_t *at = fine->shell->cells[render->foot.cell];
    const FineFrame frame = fine_frame(fine, render->foot.cell, float3_load(surface->normal[v]));
    float room = INFINITY, height = render->offset[2];
    for (int i = 0; i < 4 && !render->rigid; i++) room = float_min(room, ROOM_SHARE * fine->mesh_room[at[i]]);
    if (!render->rigid) room = float_min(room, render->slack * render_bend_room(fine, &render->foot, height));

    // pressed beyond half of the room, what was higher more, so that faces keep their areas
    const float half = 0.5f * room, beyond = fabsf(height) - half;
    if (beyond > 0) height = copysignf(half + half * beyond / (half + beyond), height);

    const float offset[3] = {render->offset[0], render->offset[1], height};
    Float3 position = float3_load(surface->position[v]), normal = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        position = float3_mad(position, frame.axis[k], offset[k]);
        normal = float3_mad(normal, frame.axis[k], render->normal[k]);
    }

    normal = float3_unit(normal);
    float3_store(surface->position[v], position);
    float3_store(surface->normal[v], float3_dot(normal, normal) > 0.5f ? normal : frame.axis[2]);
    for (int k = 0; k < 3; k++) surface->rest_position[v][k] = render->rest[k];
    for (int k = 0; k < 2 && render->has_uv; k++) surface->uv[v][k] = render->uv[k];
    surface->source_vertex[v] = render->source;
}
