// Every face of n corners becomes n quads: from a corner to the midpoint of its side, the face's centroid and the
// midpoint of the side before (Catmull and Clark, 1978, without their smoothing). Strands still run straight through
// what was a quad.
#include "mesh/work.h"

/// Makes the vertex at the midpoint of each half-edge's side.
static uint32_t *split_sides(Work *work) {
    const Faces *faces = &work->faces;
    uint32_t *midpoint = work_new(work, faces->corner_count, sizeof *midpoint);
    for (uint32_t h = 0; h < faces->corner_count && !work->no_memory; h++) {
        if (work->twin[h] != MESH_NONE && work->twin[h] < h) {
            midpoint[h] = midpoint[work->twin[h]];
            continue;
        }
        const uint32_t ends[2] = {faces->corner[h], faces->corner[faces_next(faces, work->face, h)]};
        midpoint[h] = work_vertex(work, ends, 2);
    }
    return midpoint;
}

static void push_centre(const Work *work, Faces *out, uint32_t face, uint32_t centre) {
    const Faces *old = &work->faces;
    const uint32_t first = old->first[face], end = old->first[face + 1];
    if (out->uv) {
        float *uv = out->uv[out->corner_count];
        for (uint32_t h = first; h < end; h++)
            for (int k = 0; k < 2; k++) uv[k] += old->uv[h][k] / (float)(end - first);
    }
    out->id[out->corner_count] = -1;
    out->corner[out->corner_count++] = centre;
}

void mesh_split(Work *work) {
    work_edges(work);
    if (work->no_memory) return;
    const Faces *old = &work->faces;
    uint32_t *midpoint = split_sides(work);
    Faces out = work_faces(work, old->corner_count, 4 * old->corner_count);
    for (uint32_t f = 0; f < old->count && !work->no_memory; f++) {
        const uint32_t first = old->first[f], end = old->first[f + 1];
        uint32_t centre = work_vertex(work, old->corner + first, end - first);
        for (uint32_t h = first; h < end; h++) {
            uint32_t before = faces_previous(old, work->face, h), next = faces_next(old, work->face, h);
            faces_push(&out, old->corner[h], old, h);
            faces_push_between(&out, midpoint[h], old, h, next);
            push_centre(work, &out, f, centre);
            faces_push_between(&out, midpoint[before], old, before, h);
            faces_end(&out, old->origin[f]);
        }
    }
    work_did(work, MESH_SPLIT, old->count, work_face_name(work, 0));
    work->faces = out;
}
