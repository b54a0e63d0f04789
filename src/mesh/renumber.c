// Numbers vertices and faces for locality. Lanes take adjacent strands that run through consecutive numbers
// (src/dynamics/strand/strand_lay.c), as the strands of a mesh that is numbered row by row do. Rows of quads are walked
// across opposite sides, one after the other from the lowest: a row's lower vertices are numbered as it is walked, and
// the row above, which begins at the opposite side of its first quad, comes next.
#include "mesh/work.h"

#include <string.h>

typedef struct Order {
    Work *work;
    uint32_t *vertex, *face; ///< new number, MESH_NONE before
    uint32_t vertices, faces;
    uint32_t *row; ///< quads of the current row, as the half-edges of their lower sides
} Order;

static uint32_t next4(uint32_t half) { return (half & ~3u) | ((half + 1) & 3); }
static uint32_t across4(uint32_t half) { return half ^ 2u; } // the opposite side: 0 and 2, 1 and 3

/// The lower side of the quad to the right of this one's, or to its left; MESH_NONE at the end of the row.
static uint32_t step(const Order *order, uint32_t lower, bool right) {
    uint32_t side = right ? next4(lower) : next4(across4(lower)), twin = order->work->twin[side];
    if (twin == MESH_NONE || order->face[twin / 4] != MESH_NONE) return MESH_NONE;
    return right ? next4(twin) : next4(across4(twin));
}

static void renumber_number(Order *order, uint32_t vertex) {
    if (order->vertex[vertex] == MESH_NONE) order->vertex[vertex] = order->vertices++;
}

/// Numbers the row through a quad and returns the lower side from which the next one begins, or MESH_NONE.
static uint32_t renumber_walk(Order *order, uint32_t lower) {
    const Faces *faces = &order->work->faces;
    uint32_t start = lower, count = 0, above = MESH_NONE;
    for (uint32_t at = lower, steps = 0; at != MESH_NONE && steps < faces->count; steps++) {
        start = at;
        at = step(order, at, false);
        if (at != MESH_NONE && at / 4 == lower / 4) break; // a ring
    }

    for (uint32_t at = start; at != MESH_NONE; at = step(order, at, true)) {
        order->face[at / 4] = order->faces++;
        order->row[count++] = at;
        renumber_number(order, faces->corner[at]);
    }

    renumber_number(order, faces->corner[next4(order->row[count - 1])]);

    for (uint32_t i = 0; i < count; i++) {
        uint32_t twin = order->work->twin[across4(order->row[i])];
        if (twin != MESH_NONE && order->face[twin / 4] == MESH_NONE && above == MESH_NONE) above = twin;
    }

    if (above == MESH_NONE) // the top: no row above numbers it
        for (uint32_t i = 0; i < count; i++) {
            uint32_t top = across4(order->row[i]);
            renumber_number(order, faces->corner[next4(top)]);
            if (i + 1 == count) renumber_number(order, faces->corner[top]);
        }

    return above;
}

/// Gives vertices and quads their new numbers.
static void apply(Order *order) {
    Work *work = order->work;
    const Faces *old = &work->faces;
    const size_t attributes = work->attribute_count;
    double(*position)[3] = work_new(work, work->vertex_count, sizeof *position);
    int32_t *source = work_new(work, work->vertex_count, sizeof *source);
    float *values = work_new(work, work->vertex_count * attributes, sizeof *values);
    Faces out = work_faces(work, old->count, old->corner_count);
    if (work->no_memory) return;

    for (uint32_t v = 0; v < work->vertex_count; v++) {
        uint32_t to = order->vertex[v];
        memcpy(position[to], work->position[v], sizeof *position);
        source[to] = work->source[v];
        if (!attributes) continue;
        memcpy(values + to * attributes, work->attributes + v * attributes, attributes * sizeof *values);
    }

    for (uint32_t f = 0; f < old->count; f++) {
        uint32_t to = order->face[f];
        out.origin[to] = old->origin[f];
        for (uint32_t i = 0; i < 4; i++) {
            out.corner[4 * to + i] = order->vertex[old->corner[4 * f + i]];
            out.id[4 * to + i] = old->id[4 * f + i];
            if (out.uv) memcpy(out.uv[4 * to + i], old->uv[4 * f + i], sizeof *out.uv);
        }
        out.first[to + 1] = 4 * (to + 1);
    }

    out.count = old->count;
    out.corner_count = old->corner_count;
    for (uint32_t v = 0; v < work->file->vertex_count; v++) work->became[v] = order->vertex[work->became[v]];
    work->position = position;
    work->source = source;
    work->attributes = values;
    work->faces = out;
    work->vertex_capacity = work->vertex_count;
}

void mesh_order(Work *work) {
    const uint32_t count = work->faces.count;
    work_edges(work);
    if (work->no_memory || count < MESH_ORDER_MIN) return;

    // the share of the sides whose ends have consecutive numbers: one half if rows are numbered one after the other
    const Faces *faces = &work->faces;
    uint32_t beside = 0;
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t a = faces->corner[h], b = faces->corner[next4(h)];
        beside += a + 1 == b || b + 1 == a;
    }

    if ((double)beside / faces->corner_count >= MESH_IN_ORDER) return;

    Order order = {.work = work,
                   .vertex = work_new(work, work->vertex_count, sizeof *order.vertex),
                   .face = work_new(work, count, sizeof *order.face),
                   .row = work_new(work, count, sizeof *order.row)};
    if (work->no_memory) return;

    memset(order.vertex, 0xff, work->vertex_count * sizeof *order.vertex);
    memset(order.face, 0xff, count * sizeof *order.face);

    int searches = 64; // for good starts; later rows start anywhere, so that meshes of short rows take no longer
    for (uint32_t f = 0; f < count; f++) {
        if (order.face[f] != MESH_NONE) continue;

        // begins at a corner of the mesh if it has one, else at an open side
        uint32_t side = 4 * f, open = MESH_NONE, corner = MESH_NONE;
        for (uint32_t h = 4 * f; searches > 0 && corner == MESH_NONE && h < faces->corner_count; h++) {
            if (order.face[h / 4] != MESH_NONE || work->twin[h] != MESH_NONE) continue;
            if (work->twin[next4(across4(h))] == MESH_NONE) corner = h; // open below and to the left
            else if (open == MESH_NONE) open = h;
        }

        searches--;
        if (corner != MESH_NONE) side = corner;
        else if (open != MESH_NONE) side = open;
        while (side != MESH_NONE) side = renumber_walk(&order, side);
        if (order.face[f] == MESH_NONE) f--; // not reached yet
    }

    for (uint32_t v = 0; v < work->vertex_count; v++) renumber_number(&order, v); // of no face
    apply(&order);
}
