// Which faces stay joined at a side: its two, or if it has more, some pairs of them (Gueziec, Taubin, Lazarus and Horn,
// Cutting and stitching, 2001). The remaining faces get an open edge.
#include "mesh/work.h"

#include <math.h>
#include <stdlib.h>

/// Faces joined by edges that only they have.
static uint32_t *plain_components(Work *work, const uint32_t *order) {
    uint32_t *set = work_sets(work, work->faces.count);
    for (uint32_t k = 0, size; set && k < work->faces.corner_count; k += size) {
        size = work_edge_size(work, order, k);
        if (size == 2) sets_join(set, work->face[order[k]], work->face[order[k + 1]]);
    }
    return set;
}

/// The unit direction in a face away from a side of it.
static void away_from(const Work *work, uint32_t half, double out[3]) {
    const Faces *faces = &work->faces;
    const uint32_t face = work->face[half], first = faces->first[face], end = faces->first[face + 1];
    const double *a = work->position[faces->corner[half]];
    const double *b = work->position[faces->corner[faces_next(faces, work->face, half)]];
    double centroid[3] = {0}, side[3];
    for (uint32_t h = first; h < end; h++)
        for (int k = 0; k < 3; k++) centroid[k] += work->position[faces->corner[h]][k] / (end - first);
    sub3(b, a, side), sub3(centroid, a, out);
    double along = dot3(out, side) / dot3(side, side);
    for (int k = 0; k < 3; k++) out[k] -= along * side[k];
    double length = sqrt(dot3(out, out));
    for (int k = 0; k < 3; k++) out[k] /= length > 0 ? length : 1;
}

/// Joins the flattest two faces that have no mate at an edge, if they are flat enough.
static void join_flattest(Work *work, const uint32_t *halves, uint32_t size) {
    double flattest = -0.5; // cosine: within 60 degrees of flat
    uint32_t a = MESH_NONE, b = MESH_NONE;
    for (uint32_t i = 0; i < size; i++)
        for (uint32_t k = 0; k < i; k++) {
            double p[3], q[3];
            if (work->twin[halves[i]] != MESH_NONE || work->twin[halves[k]] != MESH_NONE) continue;
            away_from(work, halves[i], p), away_from(work, halves[k], q);
            if (dot3(p, q) < flattest) {
                flattest = dot3(p, q);
                a = halves[k];
                b = halves[i];
            }
        }
    if (a != MESH_NONE) {
        work->twin[a] = b;
        work->twin[b] = a;
    }
}

// ---- faces of one sheet that meet at a side

typedef struct Around {
    double angle; ///< around the side
    uint32_t half;
    bool forwards; ///< runs along the side in the direction of the first one
} Around;

enum { AROUND_MAX = 64 }; ///< max faces at a side; if there are more, none are joined
/// Max fold, in radians, between two faces of one sheet.
static const double fold_max = 2.6;

static int by_angle(const void *a, const void *b) {
    const Around *x = a, *y = b;
    if (x->angle != y->angle) return x->angle < y->angle ? -1 : 1;
    return (x->half > y->half) - (x->half < y->half);
}

/// The faces at a side in their order around it.
static void sort_around(const Work *work, const uint32_t *halves, uint32_t size, Around *around) {
    const Faces *faces = &work->faces;
    const double *a = work->position[faces->corner[halves[0]]];
    const double *b = work->position[faces->corner[faces_next(faces, work->face, halves[0])]];
    double first[3], across[3], side[3], away[3];
    sub3(b, a, side);
    away_from(work, halves[0], first);
    cross3(side, first, across);
    const double length = sqrt(dot3(across, across));
    for (uint32_t i = 0; i < size; i++) {
        away_from(work, halves[i], away);
        double angle = length > 0 ? atan2(dot3(away, across) / length, dot3(away, first)) : 0;
        around[i] = (Around){angle, halves[i], faces->corner[halves[i]] == faces->corner[halves[0]]};
    }
    qsort(around, size, sizeof *around, by_angle);
}

/// Joins faces that are consecutive around a side and have the same winding, the flattest first, so that no two sheets
/// cross there.
static void join_around(Work *work, const uint32_t *halves, uint32_t size) {
    const double turn = 6.283185307179586;
    Around around[AROUND_MAX];
    if (size > AROUND_MAX) return;
    sort_around(work, halves, size, around);
    while (size >= 2) {
        double min = fold_max;
        uint32_t best = size;
        for (uint32_t i = 0; i < size; i++) {
            const Around *p = &around[i], *q = &around[(i + 1) % size];
            double angle = q->angle - p->angle + (i + 1 == size ? turn : 0), fold = fabs(angle - turn / 2);
            if (p->forwards != q->forwards && fold < min) {
                min = fold;
                best = i;
            }
        }
        if (best == size) return;
        const uint32_t next = (best + 1) % size, p = around[best].half, q = around[next].half;
        work->twin[p] = q;
        work->twin[q] = p;
        uint32_t kept = 0;
        for (uint32_t i = 0; i < size; i++)
            if (i != best && i != next) around[kept++] = around[i];
        size = kept;
    }
}

/// Splits an edge of more than two faces: two that are connected elsewhere stay joined, and of the others those that
/// continue each other.
static void cut_edge(Work *work, const uint32_t *halves, uint32_t size, uint32_t *set) {
    bool same_sheet = false;
    for (uint32_t i = 0; i < size; i++) {
        uint32_t mate = MESH_NONE, mates = 0, own = sets_find(set, work->face[halves[i]]);
        for (uint32_t k = 0; k < size && mates < 2; k++)
            if (k != i && sets_find(set, work->face[halves[k]]) == own) mate = halves[k], mates++;
        same_sheet = same_sheet || mates > 1;
        work->twin[halves[i]] = mate;
    }
    for (uint32_t i = 0; i < size && same_sheet; i++) work->twin[halves[i]] = MESH_NONE;
    if (same_sheet) join_around(work, halves, size);
    else join_flattest(work, halves, size);
    work_did(work, MESH_CUT, 1, work_face_name(work, work->faces.origin[work->face[halves[0]]]));
}

void mesh_join_sides(Work *work) {
    const uint32_t count = work->faces.corner_count;
    uint32_t *order = work_sorted_edges(work);
    work->twin = work_new(work, count, sizeof *work->twin);
    uint32_t *set = work->no_memory ? NULL : plain_components(work, order);
    for (uint32_t k = 0, size; set && k < count; k += size) {
        size = work_edge_size(work, order, k);
        work->twin[order[k]] = size == 2 ? order[k + 1] : MESH_NONE;
        if (size == 2) work->twin[order[k + 1]] = order[k];
        if (size > 2) cut_edge(work, order + k, size, set);
    }
}

// ---- distinct sides with the same ends

/// Whether the twin of half-edge `at` comes before it, so that it already has its corner.
static bool is_second(const Work *work, const uint32_t *halves, uint32_t at) {
    for (uint32_t i = 0; i < at; i++)
        if (halves[i] == work->twin[halves[at]]) return true;
    return false;
}

/// Gives all but the first of the sheets at a side a vertex at its midpoint. Returns the number of vertices.
static uint32_t part_side(Work *work, const uint32_t *halves, uint32_t size, uint32_t *midpoint) {
    const Faces *faces = &work->faces;
    uint32_t sheets = 0;
    for (uint32_t i = 0; i < size; i++) {
        const uint32_t half = halves[i], twin = work->twin[half];
        if (is_second(work, halves, i) || sheets++ == 0) continue;
        const uint32_t ends[2] = {faces->corner[half], faces->corner[faces_next(faces, work->face, half)]};
        midpoint[half] = work_vertex(work, ends, 2);
        if (twin != MESH_NONE) midpoint[twin] = midpoint[half];
    }
    return sheets - 1;
}

/// The faces with the new corners.
static void add_corners(Work *work, const uint32_t *midpoint, uint32_t added) {
    const Faces *old = &work->faces;
    Faces out = work_faces(work, old->count, old->corner_count + 2 * added);
    for (uint32_t f = 0; f < old->count && !work->no_memory; f++) {
        for (uint32_t h = old->first[f]; h < old->first[f + 1]; h++) {
            faces_push(&out, old->corner[h], old, h);
            if (midpoint[h] != MESH_NONE) faces_push_between(&out, midpoint[h], old, h, faces_next(old, work->face, h));
        }
        faces_end(&out, old->origin[f]);
    }
    work->faces = out;
}

void mesh_part_sides(Work *work) {
    const Faces *faces = &work->faces;
    uint32_t *order = work_sorted_edges(work), added = 0;
    uint32_t *midpoint = work_new(work, faces->corner_count, sizeof *midpoint);
    for (uint32_t h = 0; h < faces->corner_count && !work->no_memory; h++) midpoint[h] = MESH_NONE;
    for (uint32_t k = 0, size; !work->no_memory && k < faces->corner_count; k += size) {
        size = work_edge_size(work, order, k);
        const bool two = size == 2 && faces->corner[order[k]] != faces->corner[order[k + 1]]; // joined faces
        if (size > 1 && !two) added += part_side(work, order + k, size, midpoint);
    }
    if (added && !work->no_memory) add_corners(work, midpoint, added);
}
