// T-junctions: a vertex of an open edge that lies on another open edge becomes a corner of that edge's face, too, if
// that closes the gap.
#include "common/real.h"
#include "common/order.h"
#include "mesh/loops.h"

#include <math.h>
#include <stdlib.h>

/// Max distance of a vertex from a side that it lies on, as a share of the side's length.
static const double beside = 1e-5;

typedef struct OnSide {
    double t; ///< along the side, 0 to 1
    uint32_t vertex;
} OnSide;

enum { ON_SIDE_MAX = 256 };

typedef struct Junctions {
    Work *work;
    Positions positions;
    uint32_t *open_first, *open_to; ///< open edges by their ends
    uint32_t face;                  ///< whose side is searched
    OnSide found[ON_SIDE_MAX + 2];
    int count;
} Junctions;

/// Finds the vertices on the side from a to b, in their order along it.
static void look_along(Junctions *j, uint32_t a, uint32_t b) {
    const Work *work = j->work;
    const double length = distance3(work->position[a], work->position[b]);
    const int steps = (int)double_min(1e4, ceil(length / j->positions.size));
    double d[3];
    sub3(work->position[b], work->position[a], d);

    const double square = dot3(d, d), max = double_max(work->weld, beside * sqrt(square));
    j->count = 0;

    for (int s = 0; s <= steps && length > 0; s++) {
        double at[3];
        int64_t own[3];

        for (int k = 0; k < 3; k++)
            at[k] = work->position[a][k] + (work->position[b][k] - work->position[a][k]) * s / steps;

        positions_box(&j->positions, at, own);
        for (int i = 0; i < 27; i++) {
            const int64_t box[3] = {own[0] + i % 3 - 1, own[1] + i / 3 % 3 - 1, own[2] + i / 9 - 1};
            const uint32_t slot = positions_slot(&j->positions, box);
            for (uint32_t v = j->positions.head[slot]; v != MESH_NONE; v = j->positions.next[v]) {
                bool known = false; // found before, or a corner of the face itself
                for (uint32_t h = work->faces.first[j->face]; h < work->faces.first[j->face + 1]; h++)
                    known = known || work->faces.corner[h] == v;
                for (int n = 0; n < j->count && !known; n++) known = j->found[n].vertex == v;
                if (known || j->count == ON_SIDE_MAX) continue;

                double e[3], off[3];
                sub3(work->position[v], work->position[a], e);
                const double t = dot3(e, d) / square;
                for (int k = 0; k < 3; k++) off[k] = e[k] - t * d[k];
                if (t * sqrt(square) <= max || (1 - t) * sqrt(square) <= max || dot3(off, off) > max * max) continue;
                j->found[j->count++] = (OnSide){t, v};
            }
        }
    }

    qsort(j->found, (size_t)j->count, sizeof *j->found, order_by_double);
}

static bool open_edge(const Junctions *j, uint32_t a, uint32_t b) {
    for (uint32_t i = j->open_first[a]; i < j->open_first[a + 1]; i++)
        if (j->open_to[i] == b) return true;
    return false;
}

/// Lists the open edges by their ends, and their vertices by position. False if there are none or memory is out.
static bool list_open(Junctions *j) {
    Work *work = j->work;
    const Faces *faces = &work->faces;
    uint8_t *open = work_new(work, work->vertex_count, 1);
    j->open_first = work_new(work, (size_t)work->vertex_count + 2, sizeof *j->open_first);
    j->open_to = work_new(work, (size_t)2 * faces->corner_count, sizeof *j->open_to);
    if (work->no_memory) return false;

    double total = 0;
    uint32_t count = 0;
    for (int fill = 0; fill < 2; fill++) {
        for (uint32_t h = 0; h < faces->corner_count; h++) {
            if (work->twin[h] != MESH_NONE) continue;

            uint32_t a = faces->corner[h], b = faces->corner[faces_next(faces, work->face, h)];
            if (fill) {
                j->open_to[j->open_first[a + 1]++] = b;
                j->open_to[j->open_first[b + 1]++] = a;
                continue;
            }

            j->open_first[a + 2]++;
            j->open_first[b + 2]++;
            total += distance3(work->position[a], work->position[b]);
            count++;
        }
        for (uint32_t v = 0; !fill && v < work->vertex_count; v++) j->open_first[v + 2] += j->open_first[v + 1];
    }

    if (!count) return false;

    work_mark_open(work, open);
    j->positions = positions_make(work, double_max(total / count, 1e-12));
    if (work->no_memory) return false;

    for (uint32_t v = 0; v < work->vertex_count; v++)
        if (open[v]) positions_add(work, &j->positions, v);
    return true;
}

/// Inserts vertices into the sides of all faces except those marked in `left`, and writes the faces unless `out` is
/// NULL. Returns the number of vertices inserted.
static uint32_t put_all(Junctions *j, const uint8_t *left, Faces *out) {
    const Work *work = j->work;
    const Faces *old = &work->faces;
    uint32_t added = 0;
    for (uint32_t f = 0; f < old->count; f++) {
        for (uint32_t h = old->first[f]; h < old->first[f + 1]; h++) {
            const uint32_t next = faces_next(old, work->face, h);
            if (out) faces_push(out, old->corner[h], old, h);
            if (left[f] || work->twin[h] != MESH_NONE) continue;
            j->face = f;
            look_along(j, old->corner[h], old->corner[next]);

            // only vertices that an open edge joins to the previous or the next one: the others close no gap
            uint32_t before = old->corner[h];
            for (int i = 0; i < j->count; i++) {
                const OnSide *on = &j->found[i];
                const uint32_t after = i + 1 < j->count ? on[1].vertex : old->corner[next];
                const bool joined = open_edge(j, before, on->vertex) || open_edge(j, on->vertex, after);
                before = on->vertex;
                if (!joined) continue;

                added++;
                if (!out) continue;

                const uint32_t at = out->corner_count;
                faces_push(out, on->vertex, old, h);
                out->id[at] = work->source[on->vertex];
                for (int k = 0; out->uv && k < 2; k++)
                    out->uv[at][k] += (float)on->t * (old->uv[next][k] - old->uv[h][k]);
            }
        }
        if (out) faces_end(out, old->origin[f]);
    }

    return added;
}

SingeResult mesh_junctions(Work *work) {
    work_edges(work);
    Junctions *j = work_new(work, 1, sizeof *j);
    uint8_t *left = work_new(work, work->faces.count, 1);
    if (work->no_memory) return SINGE_OK;
    j->work = work;
    if (!list_open(j)) return SINGE_OK;

    const Faces before = work->faces;
    const uint32_t added = put_all(j, left, NULL), corners = before.corner_count + added;
    if (!added) return SINGE_OK;

    Faces after = work_faces(work, before.count, corners);
    if (work->no_memory) return SINGE_OK;
    (void)put_all(j, left, &after);
    work->faces = after;

    // once more, without the faces that cross themselves because of their new corners: faces narrower than `weld` may
    Loops loops = {0};
    bool crossed = false;
    if (loops_begin(&loops, work, &work->faces))
        for (uint32_t f = 0; f < before.count; f++) {
            const bool same = after.first[f + 1] - after.first[f] == before.first[f + 1] - before.first[f];
            left[f] = !same && loops_find(&loops, f) == FACE_CROSSED;
            crossed = crossed || left[f];
        }

    if (crossed) {
        work->faces = before;
        work_edges(work);
        after = work_faces(work, before.count, corners);
        if (work->no_memory) return SINGE_OK;
        (void)put_all(j, left, &after);
        work->faces = after;
    }

    for (uint32_t f = 0; f < before.count; f++)
        work_did(work, MESH_JUNCTION, after.first[f + 1] - after.first[f] - (before.first[f + 1] - before.first[f]),
                 work_face_name(work, before.origin[f]));
    return work->no_memory ? SINGE_OK : mesh_clean(work); // a vertex may lie on two sides of one face
}
