// Faces that are none: without area, there twice, or touching themselves.
#include "mesh/work.h"

#include <math.h>
#include <string.h>

/// The corners of a face while it falls apart.
typedef struct Loop {
    uint32_t *corner;
    uint32_t count;
} Loop;

/// Writes the loop from `from` on as a face unless it has no area. Returns whether it had.
static bool loop_end(Work *work, const Loop *loop, uint32_t from, uint32_t origin, Faces *out) {
    const Faces *old = &work->faces;
    const uint32_t count = loop->count - from;
    double longest = 0, normal[3] = {0};
    if (count < 3) return false;
    const double *o = work->place[old->corner[loop->corner[from]]];
    for (uint32_t i = 0; i < count; i++) {
        const double *a = work->place[old->corner[loop->corner[from + i]]];
        const double *b = work->place[old->corner[loop->corner[from + (i + 1) % count]]];
        double p[3], q[3], n[3];
        longest = fmax(longest, distance3(a, b));
        sub3(a, o, p), sub3(b, o, q);
        cross3(p, q, n);
        for (int k = 0; k < 3; k++) normal[k] += n[k];
    }
    if (!(sqrt(dot3(normal, normal)) > FACE_THIN * longest * longest)) return false;
    for (uint32_t i = from; i < loop->count; i++) faces_push(out, old->corner[loop->corner[i]], old, loop->corner[i]);
    faces_end(out, origin);
    return true;
}

/// Cuts a face at vertices that it names twice.
static void clean_face(Work *work, uint32_t face, Loop *loop, Faces *out) {
    const Faces *old = &work->faces;
    bool whole = true;
    loop->count = 0;
    for (uint32_t h = old->first[face]; h < old->first[face + 1]; h++) {
        uint32_t at = 0;
        while (at < loop->count && old->corner[loop->corner[at]] != old->corner[h]) at++;
        if (at < loop->count) {
            if (loop->count - at >= 3 && !loop_end(work, loop, at, old->origin[face], out)) whole = false;
            loop->count = at;
        }
        loop->corner[loop->count++] = h;
    }
    bool repeated = loop->count < old->first[face + 1] - old->first[face];
    whole = loop_end(work, loop, 0, old->origin[face], out) && whole;
    if (repeated && whole && !work->shrunk) work_did(work, MESH_REPEATED, 1, work_face_name(work, old->origin[face]));
    if (!whole && !work->shrunk) work_did(work, MESH_DEGENERATE, 1, work_face_name(work, old->origin[face]));
}

static uint32_t least_corner(const Faces *faces, uint32_t face) {
    uint32_t least = MESH_NONE;
    for (uint32_t h = faces->first[face]; h < faces->first[face + 1]; h++)
        if (faces->corner[h] < least) least = faces->corner[h];
    return least;
}

static bool has_corner(const Faces *faces, uint32_t face, uint32_t vertex) {
    for (uint32_t h = faces->first[face]; h < faces->first[face + 1]; h++)
        if (faces->corner[h] == vertex) return true;
    return false;
}

static bool same_corners(const Faces *faces, uint32_t a, uint32_t b) {
    if (faces->first[a + 1] - faces->first[a] != faces->first[b + 1] - faces->first[b]) return false;
    for (uint32_t h = faces->first[a]; h < faces->first[a + 1]; h++)
        if (!has_corner(faces, b, faces->corner[h])) return false;
    return true;
}

/// Marks faces whose corners an earlier one has. They are looked for among those with the same least vertex.
static void find_duplicates(Work *work, uint8_t *gone) {
    const Faces *faces = &work->faces;
    uint32_t *head = work_new(work, work->vertex_count, sizeof *head);
    uint32_t *next = work_new(work, faces->count, sizeof *next);
    if (work->no_memory) return;
    memset(head, 0xff, work->vertex_count * sizeof *head);
    for (uint32_t f = 0; f < faces->count; f++) {
        uint32_t least = least_corner(faces, f), g = head[least];
        while (g != MESH_NONE && !same_corners(faces, f, g)) g = next[g];
        if (g != MESH_NONE) {
            gone[f] = 1;
            work_did(work, MESH_DUPLICATE, 1, work_face_name(work, faces->origin[f]));
            continue;
        }
        next[f] = head[least];
        head[least] = f;
    }
}

void mesh_clean(Work *work) {
    const Faces *old = &work->faces;
    Faces out = work_faces(work, old->corner_count / 3 + old->count, old->corner_count);
    Loop loop = {.corner = work_new(work, old->corner_count, sizeof *loop.corner)};
    if (work->no_memory) return;
    for (uint32_t f = 0; f < old->count; f++) clean_face(work, f, &loop, &out);
    work->faces = out;
    uint8_t *gone = work_new(work, out.count, 1);
    Faces last = work_faces(work, out.count, out.corner_count);
    if (work->no_memory) return;
    find_duplicates(work, gone);
    if (work->no_memory) return;
    for (uint32_t f = 0; f < out.count; f++) {
        if (gone[f]) continue;
        for (uint32_t h = out.first[f]; h < out.first[f + 1]; h++) faces_push(&last, out.corner[h], &out, h);
        faces_end(&last, out.origin[f]);
    }
    work->faces = last;
}
