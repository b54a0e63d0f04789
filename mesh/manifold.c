// A surface that the core takes: an edge has one face or two, which run along it in opposite ways, and the faces at a
// vertex are one fan.
#include "mesh/work.h"

#include <math.h>
#include <string.h>

typedef struct Turn {
    uint8_t *flip, *seen; ///< [faces]
    uint32_t *queue;      ///< [faces] a component's faces lie in a row
} Turn;

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
    const double *a = work->place[faces->corner[half]];
    const double *b = work->place[faces->corner[faces_next(faces, work->face, half)]];
    double middle[3] = {0}, side[3];
    for (uint32_t h = first; h < end; h++)
        for (int k = 0; k < 3; k++) middle[k] += work->place[faces->corner[h]][k] / (end - first);
    sub3(b, a, side), sub3(middle, a, out);
    double along = dot3(out, side) / dot3(side, side);
    for (int k = 0; k < 3; k++) out[k] -= along * side[k];
    double length = sqrt(dot3(out, out));
    for (int k = 0; k < 3; k++) out[k] /= length > 0 ? length : 1;
}

/// Joins the two faces that have no mate at an edge and go on into each other most nearly, if they are flat enough.
static void join_flattest(Work *work, const uint32_t *halves, uint32_t size) {
    double flattest = -0.5; // cosine: within 60 degrees of flat
    uint32_t a = MESH_NONE, b = MESH_NONE;
    for (uint32_t i = 0; i < size; i++)
        for (uint32_t k = 0; k < i; k++) {
            double p[3], q[3];
            if (work->twin[halves[i]] != MESH_NONE || work->twin[halves[k]] != MESH_NONE) continue;
            away_from(work, halves[i], p), away_from(work, halves[k], q);
            if (dot3(p, q) < flattest) flattest = dot3(p, q), a = halves[k], b = halves[i];
        }
    if (a != MESH_NONE) work->twin[a] = b, work->twin[b] = a;
}

/// Parts the faces at an edge of more than two: two that hang together elsewhere stay together, and of the others those
/// that go on into each other.
static SingeResult cut_edge(Work *work, const uint32_t *halves, uint32_t size, uint32_t *set) {
    for (uint32_t i = 0; i < size; i++) {
        uint32_t mate = MESH_NONE, mates = 0, own = sets_find(set, work->face[halves[i]]);
        for (uint32_t k = 0; k < size; k++)
            if (k != i && sets_find(set, work->face[halves[k]]) == own) mate = halves[k], mates++;
        if (mates > 1)
            return work_refuse(work, work->faces.origin[work->face[halves[i]]],
                               "has a side that is a side of two other faces of the same sheet, too");
        work->twin[halves[i]] = mate;
    }
    join_flattest(work, halves, size);
    work_did(work, MESH_CUT, 1, work_face_name(work, work->faces.origin[work->face[halves[0]]]));
    return SINGE_OK;
}

static SingeResult join_edges(Work *work) {
    const uint32_t count = work->faces.corner_count;
    uint32_t *order = work_sorted_edges(work);
    work->twin = work_new(work, count, sizeof *work->twin);
    uint32_t *set = work->no_memory ? NULL : plain_components(work, order);
    SingeResult result = SINGE_OK;
    for (uint32_t k = 0, size; set && k < count && !result; k += size) {
        size = work_edge_size(work, order, k);
        work->twin[order[k]] = size == 2 ? order[k + 1] : MESH_NONE;
        if (size == 2) work->twin[order[k + 1]] = order[k];
        if (size > 2) result = cut_edge(work, order + k, size, set);
    }
    return result;
}

// ---- the same way round

/// Turns the faces of a component as its first one is. Returns how many there are, from `begin` in the queue.
static SingeResult spread(Work *work, Turn *turn, uint32_t begin, uint32_t *end) {
    const Faces *faces = &work->faces;
    for (uint32_t i = begin; i < *end; i++) {
        uint32_t f = turn->queue[i];
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) {
            uint32_t t = work->twin[h];
            if (t == MESH_NONE) continue;
            uint32_t g = work->face[t];
            uint8_t flip = turn->flip[f] ^ (faces->corner[h] == faces->corner[t]);
            if (!turn->seen[g]) turn->seen[g] = 1, turn->flip[g] = flip, turn->queue[(*end)++] = g;
            else if (turn->flip[g] != flip)
                return work_refuse(work, faces->origin[g],
                                   "closes a surface that has only one side, as a Moebius strip; cut it there");
        }
    }
    return SINGE_OK;
}

/// Six times the volume under the faces, as they are turned.
static double volume_under(const Work *work, uint32_t face, const double *origin) {
    const Faces *faces = &work->faces;
    double a[3], b[3], c[3], n[3], volume = 0;
    sub3(work->place[faces->corner[faces->first[face]]], origin, a);
    for (uint32_t h = faces->first[face] + 1; h + 1 < faces->first[face + 1]; h++) {
        sub3(work->place[faces->corner[h]], origin, b);
        sub3(work->place[faces->corner[h + 1]], origin, c);
        cross3(b, c, n);
        volume += dot3(a, n);
    }
    return volume;
}

/// Most of the area stays as it was; a closed surface has its front outside.
static void decide(Work *work, Turn *turn, uint32_t begin, uint32_t end) {
    const Faces *faces = &work->faces;
    const double *origin = work->place[faces->corner[faces->first[turn->queue[begin]]]];
    double area[2] = {0, 0}, volume = 0;
    bool closed = true;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t f = turn->queue[i];
        double normal[3];
        face_area(work, f, normal);
        area[turn->flip[f]] += sqrt(dot3(normal, normal));
        volume += (turn->flip[f] ? -1 : 1) * volume_under(work, f, origin);
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

/// Where corner h of a face lies once the face is turned over: side h runs backwards, from its old end.
static uint32_t turned_place(const Faces *faces, uint32_t face, uint32_t h) {
    uint32_t first = faces->first[face], n = faces->first[face + 1] - first;
    return first + (2 * n - 2 - (h - first)) % n;
}

static void turn_over(Work *work, const Turn *turn) {
    Faces *faces = &work->faces;
    uint32_t *corner = work_new(work, faces->corner_count, sizeof *corner);
    uint32_t *twin = work_new(work, faces->corner_count, sizeof *twin);
    int32_t *id = work_new(work, faces->corner_count, sizeof *id);
    float (*uv)[2] = faces->uv ? work_new(work, faces->corner_count, sizeof *uv) : NULL;
    if (work->no_memory) return;
    for (uint32_t f = 0; f < faces->count; f++)
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) {
            uint32_t side = turn->flip[f] ? turned_place(faces, f, h) : h;
            uint32_t from = turn->flip[f] ? faces_next(faces, work->face, h) : h, t = work->twin[h];
            corner[side] = faces->corner[from], id[side] = faces->id[from];
            if (uv) memcpy(uv[side], faces->uv[from], sizeof *uv);
            twin[side] = t == MESH_NONE ? t : turn->flip[work->face[t]] ? turned_place(faces, work->face[t], t) : t;
        }
    faces->corner = corner, faces->id = id, faces->uv = uv, work->twin = twin;
}

static SingeResult turn_faces(Work *work) {
    const uint32_t count = work->faces.count;
    Turn turn = {work_new(work, count, 1), work_new(work, count, 1), work_new(work, count, sizeof *turn.queue)};
    if (work->no_memory) return SINGE_OK;
    uint32_t end = 0;
    for (uint32_t f = 0; f < count; f++) {
        if (turn.seen[f]) continue;
        uint32_t begin = end;
        turn.seen[f] = 1;
        turn.queue[end++] = f;
        SingeResult result = spread(work, &turn, begin, &end);
        if (result) return result;
        decide(work, &turn, begin, end);
        work->report->components++;
    }
    turn_over(work, &turn);
    return SINGE_OK;
}

// ---- one fan a vertex

/// Of the way to the middle of its faces, what a copy is drawn back by.
static const double PART_GAP = 0.03;

/// Draws the copies of vertices, those from `first` on, back into their own faces: what lies on each other from the
/// start could not be told from what has crossed.
static void draw_back(Work *work, uint32_t first) {
    const Faces *faces = &work->faces;
    const uint32_t copies = work->vertex_count - first;
    double(*sum)[4] = work_new(work, copies ? copies : 1, sizeof *sum);
    if (work->no_memory) return;
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        if (faces->corner[h] < first) continue;
        double *to = sum[faces->corner[h] - first];
        const uint32_t face = work->face[h], begin = faces->first[face], end = faces->first[face + 1];
        for (uint32_t i = begin; i < end; i++)
            for (int k = 0; k < 3; k++) to[k] += work->place[faces->corner[i]][k] / (end - begin);
        to[3]++;
    }
    for (uint32_t v = 0; v < copies; v++)
        for (int k = 0; sum[v][3] > 0 && k < 3; k++)
            work->place[first + v][k] += PART_GAP * (sum[v][k] / sum[v][3] - work->place[first + v][k]);
}

static void part_fans(Work *work) {
    Faces *faces = &work->faces;
    const uint32_t vertices = work->vertex_count;
    uint32_t *set = work_sets(work, faces->corner_count);
    uint32_t *owner = work_new(work, work->vertex_count, sizeof *owner);
    uint32_t *vertex = work_new(work, faces->corner_count, sizeof *vertex);
    if (work->no_memory) return;
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t t = work->twin[h];
        if (t == MESH_NONE || t < h) continue;
        sets_join(set, h, faces_next(faces, work->face, t));
        sets_join(set, t, faces_next(faces, work->face, h));
    }
    memset(owner, 0xff, work->vertex_count * sizeof *owner);
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t v = faces->corner[h], root = sets_find(set, h);
        if (root == h) {
            vertex[h] = owner[v] == MESH_NONE ? v : work_copy(work, v);
            if (vertex[h] != v && !work->report->count[MESH_CUT])
                work_did(work, MESH_BOW_TIE, 1, work_face_name(work, faces->origin[work->face[h]]));
            owner[v] = h;
        }
    }
    for (uint32_t h = 0; h < faces->corner_count && !work->no_memory; h++)
        faces->corner[h] = vertex[sets_find(set, h)];
    draw_back(work, vertices);
}

/// Whether parting has left an edge with more than two faces, or faces along it the same way.
static SingeResult check_edges(Work *work) {
    const Faces *faces = &work->faces;
    uint32_t *order = work_sorted_edges(work);
    for (uint32_t k = 0, size; order && k < faces->corner_count; k += size) {
        size = work_edge_size(work, order, k);
        bool same = size == 2 && faces->corner[order[k]] == faces->corner[order[k + 1]];
        if (size > 2 || same)
            return work_refuse(work, faces->origin[work->face[order[k]]], "has a side that too many faces have");
    }
    return SINGE_OK;
}

SingeResult mesh_manifold(Work *work) {
    SingeResult result = join_edges(work);
    if (!result && !work->no_memory) result = turn_faces(work);
    if (!result && !work->no_memory) part_fans(work);
    if (!result && !work->no_memory) result = check_edges(work);
    return result;
}
