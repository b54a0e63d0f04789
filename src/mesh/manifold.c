// Makes a surface that the core accepts: an edge has one face, or two that run along it in opposite directions, and the
// faces at a vertex are one fan.
#include "mesh/work.h"

#include <math.h>
#include <string.h>

typedef struct Turn {
    uint8_t *flip, *seen; ///< [faces]
    uint32_t *queue;      ///< [faces] the faces of a component are contiguous
} Turn;

// ---- consistent winding

/// Gives the faces of a component the winding of its first one; they are `begin` to `end` in the queue. Where the
/// surface returns to itself with the opposite winding, as on a Moebius strip, it is cut.
static void manifold_spread(Work *work, Turn *turn, uint32_t begin, uint32_t *end) {
    const Faces *faces = &work->faces;
    for (uint32_t i = begin; i < *end; i++) {
        uint32_t f = turn->queue[i];
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) {
            uint32_t t = work->twin[h];
            if (t == MESH_NONE) continue;
            uint32_t g = work->face[t];
            uint8_t flip = turn->flip[f] ^ (faces->corner[h] == faces->corner[t]);
            if (!turn->seen[g]) {
                turn->seen[g] = 1;
                turn->flip[g] = flip;
                turn->queue[(*end)++] = g;
            } else if (turn->flip[g] != flip) {
                work->twin[h] = work->twin[t] = MESH_NONE;
                work_did(work, MESH_ONE_SIDED, 1, work_face_name(work, faces->origin[g]));
            }
        }
    }
}

/// Six times the signed volume between a face and `origin`.
static double volume_under(const Work *work, uint32_t face, const double *origin) {
    const Faces *faces = &work->faces;
    double a[3], b[3], c[3], n[3], volume = 0;
    sub3(work->position[faces->corner[faces->first[face]]], origin, a);
    for (uint32_t h = faces->first[face] + 1; h + 1 < faces->first[face + 1]; h++) {
        sub3(work->position[faces->corner[h]], origin, b);
        sub3(work->position[faces->corner[h + 1]], origin, c);
        cross3(b, c, n);
        volume += dot3(a, n);
    }
    return volume;
}

/// Keeps the winding of most of the area; a closed surface gets its front outside.
static void decide(Work *work, Turn *turn, uint32_t begin, uint32_t end) {
    const Faces *faces = &work->faces;
    const double *origin = work->position[faces->corner[faces->first[turn->queue[begin]]]];
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

/// The number of corner h after its face is flipped: side h runs backwards, from its old end.
static uint32_t turned_position(const Faces *faces, uint32_t face, uint32_t h) {
    uint32_t first = faces->first[face], n = faces->first[face + 1] - first;
    return first + (2 * n - 2 - (h - first)) % n;
}

static void turn_over(Work *work, const Turn *turn) {
    Faces *faces = &work->faces;
    uint32_t *corner = work_new(work, faces->corner_count, sizeof *corner);
    uint32_t *twin = work_new(work, faces->corner_count, sizeof *twin);
    int32_t *id = work_new(work, faces->corner_count, sizeof *id);
    float(*uv)[2] = faces->uv ? work_new(work, faces->corner_count, sizeof *uv) : NULL;
    if (work->no_memory) return;
    for (uint32_t f = 0; f < faces->count; f++)
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) {
            uint32_t side = turn->flip[f] ? turned_position(faces, f, h) : h;
            uint32_t from = turn->flip[f] ? faces_next(faces, work->face, h) : h, t = work->twin[h];
            corner[side] = faces->corner[from], id[side] = faces->id[from];
            if (uv) memcpy(uv[side], faces->uv[from], sizeof *uv);
            twin[side] = t == MESH_NONE ? t : turn->flip[work->face[t]] ? turned_position(faces, work->face[t], t) : t;
        }
    faces->corner = corner;
    faces->id = id;
    faces->uv = uv;
    work->twin = twin;
}

static void turn_faces(Work *work) {
    const uint32_t count = work->faces.count;
    Turn turn = {work_new(work, count, 1), work_new(work, count, 1), work_new(work, count, sizeof *turn.queue)};
    if (work->no_memory) return;
    uint32_t end = 0;
    for (uint32_t f = 0; f < count; f++) {
        if (turn.seen[f]) continue;
        uint32_t begin = end;
        turn.seen[f] = 1;
        turn.queue[end++] = f;
        manifold_spread(work, &turn, begin, &end);
        decide(work, &turn, begin, end);
        work->report->components++;
    }
    turn_over(work, &turn);
}

// ---- one fan per vertex

/// Share of the distance to the centroid of its faces by which a copy is moved back.
static const double PART_GAP = 0.03;

/// Moves the copies of vertices, those from `first` on, back into their own faces: parts in contact from the start
/// could not be told from parts that have crossed.
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
            for (int k = 0; k < 3; k++) to[k] += work->position[faces->corner[i]][k] / (end - begin);
        to[3]++;
    }
    for (uint32_t v = 0; v < copies; v++)
        for (int k = 0; sum[v][3] > 0 && k < 3; k++)
            work->position[first + v][k] += PART_GAP * (sum[v][k] / sum[v][3] - work->position[first + v][k]);
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
            if (vertex[h] != v && !work->report->count[MESH_CUT] && !work->report->count[MESH_ONE_SIDED])
                work_did(work, MESH_BOW_TIE, 1, work_face_name(work, faces->origin[work->face[h]]));
            owner[v] = h;
        }
    }
    for (uint32_t h = 0; h < faces->corner_count && !work->no_memory; h++) faces->corner[h] = vertex[sets_find(set, h)];
    draw_back(work, vertices);
}

void mesh_manifold(Work *work) {
    mesh_join_sides(work);
    if (!work->no_memory) turn_faces(work);
    if (!work->no_memory) part_fans(work);
    if (!work->no_memory) mesh_part_sides(work);
}
