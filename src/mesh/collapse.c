// Collapses short sides: springs that are far shorter than the rest cannot be held (docs/meshes.md), and the detail
// they show is smaller than a cell. The ends of short sides are merged, the shortest side first, as long as the set
// that becomes one vertex is no larger than the limit for sides. Of two vertices one of which is on an open edge, that
// one stays; two on open edges are merged only along such an edge, so that nothing is pinched off.
#include "common/real.h"
#include "common/order.h"
#include "mesh/work.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Short {
    double length;
    uint32_t half;
} Short;

typedef struct Shrink {
    Work *work;
    double min;                   ///< sides shorter than this
    uint32_t *set, *stays;        ///< [vertices] sets to merge; of a root, the vertex that stays
    uint8_t *open;                ///< [vertices] of a root: its set has a vertex on an open edge
    double (*low)[3], (*high)[3]; ///< [vertices] of a root: the box around its set
} Shrink;

static double side_length(const Work *work, uint32_t half) {
    const Faces *faces = &work->faces;
    return distance3(work->position[faces->corner[half]],
                     work->position[faces->corner[faces_next(faces, work->face, half)]]);
}

/// Merges the sets of a side's ends, if the result is small enough.
static bool join_ends(Shrink *shrink, uint32_t half) {
    const Work *work = shrink->work;
    const Faces *faces = &work->faces;
    uint32_t a = sets_find(shrink->set, faces->corner[half]);
    uint32_t b = sets_find(shrink->set, faces->corner[faces_next(faces, work->face, half)]);
    if (a == b || (shrink->open[a] && shrink->open[b] && work->twin[half] != MESH_NONE)) return false;

    double low[3], high[3], size[3];
    for (int k = 0; k < 3; k++) {
        low[k] = double_min(shrink->low[a][k], shrink->low[b][k]);
        high[k] = double_max(shrink->high[a][k], shrink->high[b][k]);
        size[k] = high[k] - low[k];
    }

    if (sqrt(dot3(size, size)) > shrink->min) return false;

    bool first = shrink->open[a] != shrink->open[b] ? shrink->open[a] : shrink->stays[a] < shrink->stays[b];
    uint32_t stays = first ? shrink->stays[a] : shrink->stays[b], root;
    uint8_t open = shrink->open[a] | shrink->open[b];

    sets_join(shrink->set, a, b);
    root = sets_find(shrink->set, a);
    shrink->stays[root] = stays;
    shrink->open[root] = open;
    memcpy(shrink->low[root], low, sizeof low);
    memcpy(shrink->high[root], high, sizeof high);
    return true;
}

/// The uv at a merged vertex differ slightly: those within about the size of a merged set of the first's become equal.
static void join_uv(Shrink *shrink, const uint8_t *several) {
    Work *work = shrink->work;
    const Faces *faces = &work->faces;
    uint32_t *head = work_new(work, work->vertex_count, sizeof *head);
    uint32_t *next = work_new(work, faces->corner_count, sizeof *next);
    if (work->no_memory) return;

    memset(head, 0xff, work->vertex_count * sizeof *head);

    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t v = faces->corner[h], to = faces_next(faces, work->face, h), g;
        if (!several[v]) continue;

        double length = double_max(side_length(work, h), shrink->min), same = 0;
        for (int k = 0; k < 2; k++) same = double_max(same, fabs((double)faces->uv[to][k] - (double)faces->uv[h][k]));
        same *= 4 * shrink->min / length;

        for (g = head[v]; g != MESH_NONE; g = next[g])
            if (fabs((double)faces->uv[g][0] - (double)faces->uv[h][0]) <= same &&
                fabs((double)faces->uv[g][1] - (double)faces->uv[h][1]) <= same)
                break;

        if (g != MESH_NONE) memcpy(faces->uv[h], faces->uv[g], sizeof *faces->uv);
        else {
            next[h] = head[v];
            head[v] = h;
        }
    }
}

SingeResult mesh_shrink(Work *work) {
    work_edges(work);
    if (work->no_memory || !(work->smallest > 0) || !work->faces.corner_count) return SINGE_OK;

    const Faces *faces = &work->faces;
    const uint32_t vertices = work->vertex_count;

    // sides shorter than a share of the median
    double *lengths = work_new(work, faces->corner_count, sizeof *lengths);
    Short *list = work_new(work, faces->corner_count, sizeof *list);
    if (work->no_memory) return SINGE_OK;

    for (uint32_t h = 0; h < faces->corner_count; h++) lengths[h] = side_length(work, h);
    qsort(lengths, faces->corner_count, sizeof *lengths, order_by_double);

    const double min = work->smallest * lengths[faces->corner_count / 2];
    uint32_t count = 0, joined = 0;
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        double length = side_length(work, h);
        if (length < min) list[count++] = (Short){length, h};
    }

    if (!count) return SINGE_OK;

    qsort(list, count, sizeof *list, order_by_double_and_number);

    // their ends are merged, the shortest first
    Shrink shrink = {.work = work,
                     .min = min,
                     .set = work_sets(work, vertices),
                     .stays = work_sets(work, vertices),
                     .open = work_new(work, vertices, 1),
                     .low = work_new(work, vertices, sizeof *shrink.low),
                     .high = work_new(work, vertices, sizeof *shrink.high)};
    uint8_t *several = work_new(work, vertices, 1);
    uint32_t *to = work_new(work, vertices, sizeof *to);
    if (work->no_memory) return SINGE_OK;

    work_mark_open(work, shrink.open);
    memcpy(shrink.low, work->position, vertices * sizeof *shrink.low);
    memcpy(shrink.high, work->position, vertices * sizeof *shrink.high);

    for (uint32_t i = 0; i < count; i++) {
        if (!join_ends(&shrink, list[i].half)) continue;
        uint32_t face = work->face[list[i].half];
        if (!joined++) work_did(work, MESH_SHRUNK, 1, work_face_name(work, faces->origin[face]));
    }

    if (!joined) return SINGE_OK;

    work_did(work, MESH_SHRUNK, joined - 1, 0);

    for (uint32_t v = 0; v < vertices; v++) {
        to[v] = shrink.stays[sets_find(shrink.set, v)];
        if (to[v] != v) several[to[v]] = 1;
    }

    work_rename(work, to);
    for (uint32_t h = 0; h < faces->corner_count; h++)
        if (several[faces->corner[h]]) faces->id[h] = work->source[faces->corner[h]];
    if (faces->uv) join_uv(&shrink, several);

    work->shrunk = true;
    SingeResult result = mesh_clean(work);
    work->shrunk = false;
    return result;
}
