// Vertices that are one. Only those on open edges are joined: there a file has cut what belongs together, along the
// seams of its uv. Layers that touch have their vertices inside, and stay apart.
#include "mesh/work.h"

#include <math.h>
#include <string.h>

uint32_t places_slot(const Places *places, const int64_t box[3]) {
    uint64_t hash = (uint64_t)box[0] * 0x9E3779B97F4A7C15u ^ (uint64_t)box[1] * 0xC2B2AE3D27D4EB4Fu ^
                    (uint64_t)box[2] * 0x165667B19E3779F9u;
    return (uint32_t)((hash ^ hash >> 29) % places->slots);
}

void places_box(const Places *places, const double *place, int64_t box[3]) {
    const double far = 0x1p62; // a place may be more boxes away than a number counts; those out there share the last
    for (int k = 0; k < 3; k++) box[k] = (int64_t)fmin(fmax(floor(place[k] / places->size), -far), far);
}

Places places_make(Work *work, double size) {
    Places places = {.size = size, .slots = work->vertex_count + work->vertex_count / 2 + 1};
    places.head = work_new(work, places.slots, sizeof *places.head);
    places.next = work_new(work, work->vertex_count, sizeof *places.next);
    if (!work->no_memory) memset(places.head, 0xff, places.slots * sizeof *places.head);
    return places;
}

void places_add(const Work *work, Places *places, uint32_t v) {
    int64_t box[3];
    places_box(places, work->place[v], box);
    uint32_t slot = places_slot(places, box);
    places->next[v] = places->head[slot];
    places->head[slot] = v;
}

/// The vertex that `v` is joined to: the first in its box and those around it that is near enough.
static uint32_t weld_find(const Work *work, const Places *places, uint32_t v) {
    int64_t middle[3], box[3];
    uint32_t found = MESH_NONE;
    places_box(places, work->place[v], middle);
    for (int i = 0; i < 27; i++) {
        box[0] = middle[0] + i % 3 - 1, box[1] = middle[1] + i / 3 % 3 - 1, box[2] = middle[2] + i / 9 - 1;
        for (uint32_t u = places->head[places_slot(places, box)]; u != MESH_NONE; u = places->next[u])
            if (u < found && distance3(work->place[u], work->place[v]) <= work->weld) found = u;
    }
    return found;
}

void work_mark_open(const Work *work, uint8_t *open) {
    const Faces *faces = &work->faces;
    for (uint32_t h = 0; h < faces->corner_count; h++)
        if (work->twin[h] == MESH_NONE)
            open[faces->corner[h]] = open[faces->corner[faces_next(faces, work->face, h)]] = 1;
}

void work_rename(Work *work, const uint32_t *to) {
    for (uint32_t h = 0; h < work->faces.corner_count; h++) work->faces.corner[h] = to[work->faces.corner[h]];
    for (uint32_t v = 0; v < work->file->vertex_count; v++) work->became[v] = to[work->became[v]];
}

void mesh_weld(Work *work) {
    work_edges(work);
    Places places = places_make(work, fmax(2 * work->weld, 1e-12));
    uint8_t *open = work_new(work, work->vertex_count, 1);
    uint32_t *to = work_sets(work, work->vertex_count);
    if (work->no_memory) return;
    work_mark_open(work, open);
    for (uint32_t v = 0; v < work->vertex_count; v++) {
        if (!open[v]) continue;
        uint32_t found = weld_find(work, &places, v);
        if (found == MESH_NONE) {
            places_add(work, &places, v);
            continue;
        }
        to[v] = found;
        work_did(work, MESH_WELDED, 1, v);
    }
    work_rename(work, to);
}
