// Cleans up faces that have no area, are duplicates, touch themselves, or are not visible from their centroid.
#include "mesh/loops.h"

#include <string.h>

static void push_ring(Work *work, const uint32_t *ring, uint32_t n, uint32_t origin, Faces *out) {
    if (!work_faces_room(work, out, 1, n)) return;
    for (uint32_t i = 0; i < n; i++) faces_push(out, work->faces.corner[ring[i]], &work->faces, ring[i]);
    faces_end(out, origin);
}

static void push_loop(Work *work, const Loops *loops, uint32_t loop, uint32_t origin, Faces *out) {
    push_ring(work, loops->corner + loops->end[loop], loops->end[loop + 1] - loops->end[loop], origin, out);
}

void mesh_leave_out_copies(Work *work) {
    const Faces *old = &work->faces;
    uint8_t *gone = work_new(work, old->count, 1);
    uint32_t *head = work_new(work, work->vertex_count, sizeof *head); // faces by their lowest vertex
    uint32_t *next = work_new(work, old->count, sizeof *next);
    uint32_t found = 0;
    if (work->no_memory) return;

    // only faces with the same lowest vertex are compared
    memset(head, 0xff, work->vertex_count * sizeof *head);
    for (uint32_t f = 0; f < old->count; f++) {
        uint32_t min = MESH_NONE;
        for (uint32_t h = old->first[f]; h < old->first[f + 1]; h++)
            if (old->corner[h] < min) min = old->corner[h];

        uint32_t g = head[min];
        for (; g != MESH_NONE; g = next[g]) {
            bool same = old->first[g + 1] - old->first[g] == old->first[f + 1] - old->first[f];
            for (uint32_t h = old->first[f]; same && h < old->first[f + 1]; h++) {
                uint32_t k = old->first[g];
                while (k < old->first[g + 1] && old->corner[k] != old->corner[h]) k++;
                same = k < old->first[g + 1];
            }
            if (same) break;
        }

        if (g != MESH_NONE) {
            gone[f] = 1;
            found++;
            work_did(work, MESH_DUPLICATE, 1, work_face_name(work, old->origin[f]));
            continue;
        }

        next[f] = head[min];
        head[min] = f;
    }

    if (!found) return;

    Faces out = work_faces(work, old->count, old->corner_count);
    if (work->no_memory) return;

    for (uint32_t f = 0; f < old->count; f++) {
        if (gone[f]) continue;
        for (uint32_t h = old->first[f]; h < old->first[f + 1]; h++) faces_push(&out, old->corner[h], old, h);
        faces_end(&out, old->origin[f]);
    }

    work->faces = out;
}

SingeResult mesh_clean(Work *work) {
    const Faces *old = &work->faces;
    Faces out = work_faces(work, old->count, old->corner_count);
    Loops loops = {0};
    if (work->no_memory || !loops_begin(&loops, work, old)) return SINGE_OK;

    for (uint32_t f = 0; f < old->count && !work->no_memory; f++) {
        const uint32_t origin = old->origin[f], name = work_face_name(work, origin);
        const FaceKind kind = loops_find(&loops, f);
        if (kind == FACE_CROSSED)
            return work_refuse(work, origin, "crosses or overlaps itself: no quads cover it once");
        if (kind == FACE_WHOLE) push_loop(work, &loops, 0, origin, &out);

        // loops that are visible from their centroid stay as they are, others become triangles
        for (uint32_t k = 0; kind == FACE_CUT && k < loops.count; k++) {
            const uint32_t first = loops.triangles[k], end = loops.triangles[k + 1];
            const bool whole = first < end && loops_is_star(&loops, k);
            if (whole) push_loop(work, &loops, k, origin, &out);
            for (uint32_t t = first; t < end && !whole; t++) {
                const uint32_t *triangle = loops.cut.triangle[t];
                if (!loops_is_flat(&loops, triangle, 3)) push_ring(work, triangle, 3, origin, &out);
            }
        }

        if (work->shrunk) continue;
        if (kind == FACE_IDLE) work_did(work, MESH_DEGENERATE, 1, name);
        else if (loops.repeats) work_did(work, MESH_REPEATED, 1, name);
        else if (loops.spikes) work_did(work, MESH_SPIKE, 1, name);
        if (kind == FACE_CUT) work_did(work, MESH_CONCAVE, 1, name);
    }

    if (work->no_memory) return SINGE_OK;

    work->faces = out;
    mesh_leave_out_copies(work);
    return SINGE_OK;
}
