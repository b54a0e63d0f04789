// Makes a surface that the core accepts: an edge has one face, or two that run along it in opposite directions, and the
// faces at a vertex are one fan.
//
// An edge of more than two faces keeps some pairs of them joined (Gueziec, Taubin, Lazarus and Horn, Cutting and
// stitching, 2001). The remaining faces get an open edge.
#include "mesh/work.h"
#include "common/order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- the faces that stay joined at a side

/// The unit direction in a face away from a side of it.
static void away_from(const Work *work, uint32_t half, double out[3]) {
    const Faces *faces = &work->faces;
    const uint32_t face = work->face[half], first = faces->first[face], end = faces->first[face + 1];
    const double *a = work->position[faces->corner[half]];
    const double *b = work->position[faces->corner[faces_next(faces, work->face, half)]];
    double centroid[3] = {0}, side[3];
    for (uint32_t h = first; h < end; h++)
        for (int k = 0; k < 3; k++) centroid[k] += work->position[faces->corner[h]][k] / (end - first);
    sub3(b, a, side);
    sub3(centroid, a, out);

    double along = dot3(out, side) / dot3(side, side);
    for (int k = 0; k < 3; k++) out[k] -= along * side[k];
    double length = sqrt(dot3(out, out));
    for (int k = 0; k < 3; k++) out[k] /= length > 0 ? length : 1;
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

/// Joins faces that are consecutive around a side and have the same winding, the flattest first, so that no two sheets
/// cross there.
static void join_around(Work *work, const uint32_t *halves, uint32_t size) {
    const double turn = 6.283185307179586;
    const Faces *faces = &work->faces;
    const double *a = work->position[faces->corner[halves[0]]];
    const double *b = work->position[faces->corner[faces_next(faces, work->face, halves[0])]];
    double first[3], across[3], side[3], away[3];
    Around around[AROUND_MAX];
    if (size > AROUND_MAX) return;

    // the faces in their order around the side
    sub3(b, a, side);
    away_from(work, halves[0], first);
    cross3(side, first, across);

    const double length = sqrt(dot3(across, across));
    for (uint32_t i = 0; i < size; i++) {
        away_from(work, halves[i], away);
        double angle = length > 0 ? atan2(dot3(away, across) / length, dot3(away, first)) : 0;
        around[i] = (Around){angle, halves[i], faces->corner[halves[i]] == faces->corner[halves[0]]};
    }

    qsort(around, size, sizeof *around, order_by_double_and_number);

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
    uint32_t *twin = work->twin;
    bool same_sheet = false;
    for (uint32_t i = 0; i < size; i++) {
        uint32_t mate = MESH_NONE, mates = 0, own = sets_find(set, work->face[halves[i]]);
        for (uint32_t k = 0; k < size && mates < 2; k++)
            if (k != i && sets_find(set, work->face[halves[k]]) == own) {
                mate = halves[k];
                mates++;
            }
        same_sheet = same_sheet || mates > 1;
        twin[halves[i]] = mate;
    }

    work_did(work, MESH_CUT, 1, work_face_name(work, work->faces.origin[work->face[halves[0]]]));
    if (same_sheet) {
        for (uint32_t i = 0; i < size; i++) twin[halves[i]] = MESH_NONE;
        join_around(work, halves, size);
        return;
    }

    // the flattest two faces without a mate, if they are flat enough
    double flattest = -0.5; // cosine: within 60 degrees of flat
    uint32_t a = MESH_NONE, b = MESH_NONE;
    for (uint32_t i = 0; i < size; i++)
        for (uint32_t k = 0; k < i; k++) {
            double p[3], q[3];
            if (twin[halves[i]] != MESH_NONE || twin[halves[k]] != MESH_NONE) continue;
            away_from(work, halves[i], p);
            away_from(work, halves[k], q);
            if (dot3(p, q) < flattest) {
                flattest = dot3(p, q);
                a = halves[k];
                b = halves[i];
            }
        }

    if (a == MESH_NONE) return;
    twin[a] = b;
    twin[b] = a;
}

// ---- consistent winding

typedef struct Turn {
    uint8_t *flip, *seen; ///< [faces]
    uint32_t *queue;      ///< [faces] the faces of a component are contiguous
} Turn;

/// Keeps the winding of most of the area; a closed surface gets its front outside.
static void decide(Work *work, Turn *turn, uint32_t begin, uint32_t end) {
    const Faces *faces = &work->faces;
    const double *origin = work->position[faces->corner[faces->first[turn->queue[begin]]]];
    double area[2] = {0, 0}, volume = 0;
    bool closed = true;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t f = turn->queue[i];
        double normal[3], a[3], b[3], c[3], n[3], under = 0; // six times the volume between the face and the origin
        face_area(work, f, normal);
        area[turn->flip[f]] += sqrt(dot3(normal, normal));
        sub3(work->position[faces->corner[faces->first[f]]], origin, a);

        for (uint32_t h = faces->first[f] + 1; h + 1 < faces->first[f + 1]; h++) {
            sub3(work->position[faces->corner[h]], origin, b);
            sub3(work->position[faces->corner[h + 1]], origin, c);
            cross3(b, c, n);
            under += dot3(a, n);
        }

        volume += (turn->flip[f] ? -1 : 1) * under;
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) closed = closed && work->twin[h] != MESH_NONE;
    }

    uint8_t keep = area[1] > area[0];
    bool inside_out = closed && (keep ? -volume : volume) < 0;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t f = turn->queue[i];
        if (turn->flip[f] != keep) work_did(work, MESH_TURNED, 1, work_face_name(work, faces->origin[f]));
        turn->flip[f] ^= keep ^ inside_out;
    }

    if (inside_out) work_did(work, MESH_INSIDE_OUT, 1, work_face_name(work, faces->origin[turn->queue[begin]]));
}

/// The number of corner h after its face is flipped: side h runs backwards, from its old end.
static uint32_t turned_position(const Faces *faces, uint32_t face, uint32_t h) {
    uint32_t first = faces->first[face], n = faces->first[face + 1] - first;
    return first + (2 * n - 2 - (h - first)) % n;
}

/// Gives neighbours the same winding. Where the surface returns to itself with the opposite one, as on a Moebius strip, it
/// is cut.
static void turn_faces(Work *work) {
    Faces *faces = &work->faces;
    const uint32_t count = faces->count, corners = faces->corner_count;
    Turn turn = {work_new(work, count, 1), work_new(work, count, 1), work_new(work, count, sizeof *turn.queue)};
    uint32_t *corner = work_new(work, corners, sizeof *corner), *twin = work_new(work, corners, sizeof *twin), end = 0;
    int32_t *id = work_new(work, corners, sizeof *id);
    float(*uv)[2] = faces->uv ? work_new(work, corners, sizeof *uv) : NULL;
    if (work->no_memory) return;

    for (uint32_t f = 0; f < count; f++) {
        if (turn.seen[f]) continue;

        uint32_t begin = end;
        turn.seen[f] = 1;
        turn.queue[end++] = f;
        for (uint32_t i = begin; i < end; i++) { // to the faces of the component
            const uint32_t from = turn.queue[i];
            for (uint32_t h = faces->first[from]; h < faces->first[from + 1]; h++) {
                const uint32_t t = work->twin[h];
                if (t == MESH_NONE) continue;
                const uint32_t to = work->face[t];
                const uint8_t flip = turn.flip[from] ^ (faces->corner[h] == faces->corner[t]);
                if (!turn.seen[to]) {
                    turn.seen[to] = 1;
                    turn.flip[to] = flip;
                    turn.queue[end++] = to;
                } else if (turn.flip[to] != flip) {
                    work->twin[h] = work->twin[t] = MESH_NONE;
                    work_did(work, MESH_ONE_SIDED, 1, work_face_name(work, faces->origin[to]));
                }
            }
        }

        decide(work, &turn, begin, end);
        work->report->components++;
    }

    for (uint32_t f = 0; f < count; f++)
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) {
            uint32_t side = turn.flip[f] ? turned_position(faces, f, h) : h;
            uint32_t from = turn.flip[f] ? faces_next(faces, work->face, h) : h, t = work->twin[h];
            corner[side] = faces->corner[from];
            id[side] = faces->id[from];
            if (uv) memcpy(uv[side], faces->uv[from], sizeof *uv);
            twin[side] = t == MESH_NONE ? t : turn.flip[work->face[t]] ? turned_position(faces, work->face[t], t) : t;
        }

    faces->corner = corner;
    faces->id = id;
    faces->uv = uv;
    work->twin = twin;
}

// ---- one fan per vertex

/// Share of the distance to the centroid of its faces by which a copy is moved back.
static const double PART_GAP = 0.03;

static void part_fans(Work *work) {
    Faces *faces = &work->faces;
    const uint32_t vertices = work->vertex_count;
    uint32_t *set = work_sets(work, faces->corner_count);
    uint32_t *owner = work_new(work, work->vertex_count, sizeof *owner);
    uint32_t *vertex = work_new(work, faces->corner_count, sizeof *vertex);
    if (work->no_memory) return;

    // corners joined by sides are one fan, and the first keeps the vertex
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t t = work->twin[h];
        if (t == MESH_NONE || t < h) continue;
        sets_join(set, h, faces_next(faces, work->face, t));
        sets_join(set, t, faces_next(faces, work->face, h));
    }

    memset(owner, 0xff, work->vertex_count * sizeof *owner);
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t v = faces->corner[h];
        if (sets_find(set, h) != h) continue;
        vertex[h] = owner[v] == MESH_NONE ? v : work_copy(work, v);
        if (vertex[h] != v && !work->report->count[MESH_CUT] && !work->report->count[MESH_ONE_SIDED])
            work_did(work, MESH_BOW_TIE, 1, work_face_name(work, faces->origin[work->face[h]]));
        owner[v] = h;
    }

    for (uint32_t h = 0; h < faces->corner_count && !work->no_memory; h++) faces->corner[h] = vertex[sets_find(set, h)];

    // copies move back into their own faces: parts in contact from the start could not be told from crossed ones
    const uint32_t copies = work->vertex_count - vertices;
    double(*sum)[4] = work_new(work, copies ? copies : 1, sizeof *sum);
    if (work->no_memory) return;

    for (uint32_t h = 0; h < faces->corner_count; h++) {
        if (faces->corner[h] < vertices) continue;
        double *to = sum[faces->corner[h] - vertices];
        const uint32_t face = work->face[h], begin = faces->first[face], end = faces->first[face + 1];
        for (uint32_t i = begin; i < end; i++)
            for (int k = 0; k < 3; k++) to[k] += work->position[faces->corner[i]][k] / (end - begin);
        to[3]++;
    }

    for (uint32_t v = 0; v < copies; v++)
        for (int k = 0; sum[v][3] > 0 && k < 3; k++)
            work->position[vertices + v][k] += PART_GAP * (sum[v][k] / sum[v][3] - work->position[vertices + v][k]);
}

// ---- distinct sides with the same ends

/// Gives distinct sides between the same two vertices corners of their own: all but the first of the sheets at a side get
/// a vertex at its midpoint.
static void part_sides(Work *work) {
    const Faces *old = &work->faces;
    uint32_t *order = work_sorted_edges(work), added = 0;
    uint32_t *midpoint = work_new(work, old->corner_count, sizeof *midpoint);
    if (work->no_memory) return;

    for (uint32_t h = 0; h < old->corner_count; h++) midpoint[h] = MESH_NONE;
    for (uint32_t k = 0, size; k < old->corner_count && !work->no_memory; k += size) {
        size = work_edge_size(work, order, k);
        const bool two = size == 2 && old->corner[order[k]] != old->corner[order[k + 1]]; // joined faces
        if (size == 1 || two) continue;

        for (uint32_t i = 0, sheets = 0; i < size; i++) {
            const uint32_t half = order[k + i], twin = work->twin[half];
            bool second = false; // the twin came before, so it has its corner
            for (uint32_t n = 0; n < i; n++) second = second || order[k + n] == twin;
            if (second || sheets++ == 0) continue;
            const uint32_t ends[2] = {old->corner[half], old->corner[faces_next(old, work->face, half)]};
            midpoint[half] = work_vertex(work, ends, 2);
            if (twin != MESH_NONE) midpoint[twin] = midpoint[half];
            added++;
        }
    }

    if (!added || work->no_memory) return;

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

void mesh_manifold(Work *work) {
    const uint32_t count = work->faces.corner_count;
    uint32_t *order = work_sorted_edges(work);
    uint32_t *set = work_sets(work, work->faces.count); // faces joined by edges that only they have
    work->twin = work_new(work, count, sizeof *work->twin);
    if (work->no_memory) return;

    for (uint32_t k = 0, size; k < count; k += size) {
        size = work_edge_size(work, order, k);
        if (size == 2) sets_join(set, work->face[order[k]], work->face[order[k + 1]]);
    }

    for (uint32_t k = 0, size; k < count; k += size) {
        size = work_edge_size(work, order, k);
        work->twin[order[k]] = size == 2 ? order[k + 1] : MESH_NONE;
        if (size == 2) work->twin[order[k + 1]] = order[k];
        if (size > 2) cut_edge(work, order + k, size, set);
    }

    turn_faces(work);
    if (!work->no_memory) part_fans(work);
    if (!work->no_memory) part_sides(work);
}
