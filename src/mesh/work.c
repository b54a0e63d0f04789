// Memory, faces and edges of a mesh while it is repaired.
#include "mesh/work.h"

#include "common/store.h"

#include <stdlib.h>
#include <string.h>

void *work_new(Work *work, size_t count, size_t size) {
    const size_t head = 16;
    WorkBlock *block = count < SIZE_MAX / 2 / size ? calloc(1, head + (count ? count : 1) * size) : NULL;
    work->no_memory = work->no_memory || !block;
    if (!block) return NULL;
    block->next = work->blocks;
    work->blocks = block;
    return (char *)block + head;
}

void work_free(Work *work) {
    while (work->blocks) {
        WorkBlock *next = work->blocks->next;
        free(work->blocks);
        work->blocks = next;
    }
}

uint32_t *work_sets(Work *work, uint32_t count) {
    uint32_t *set = work_new(work, count, sizeof *set);
    for (uint32_t i = 0; set && i < count; i++) set[i] = i;
    return set;
}

// ---- faces

Faces work_faces(Work *work, uint32_t count, uint32_t corners) {
    Faces faces = {.capacity = count,
                   .corner_capacity = corners,
                   .first = work_new(work, (size_t)count + 1, sizeof *faces.first),
                   .corner = work_new(work, corners, sizeof *faces.corner),
                   .id = work_new(work, corners, sizeof *faces.id),
                   .origin = work_new(work, count, sizeof *faces.origin)};
    if (work->file->uv) faces.uv = work_new(work, corners, sizeof *faces.uv);
    return faces;
}

bool work_faces_room(Work *work, Faces *faces, uint32_t more_faces, uint32_t more_corners) {
    const uint32_t count = faces->count + more_faces, corners = faces->corner_count + more_corners;
    if (count <= faces->capacity && corners <= faces->corner_capacity) return true;

    Faces larger = work_faces(work, count + count / 2, corners + corners / 2);
    if (work->no_memory) return false;

    larger.count = faces->count;
    larger.corner_count = faces->corner_count;
    memcpy(larger.first, faces->first, ((size_t)faces->count + 1) * sizeof *faces->first);
    memcpy(larger.origin, faces->origin, faces->count * sizeof *faces->origin);
    memcpy(larger.corner, faces->corner, faces->corner_count * sizeof *faces->corner);
    memcpy(larger.id, faces->id, faces->corner_count * sizeof *faces->id);
    if (faces->uv) memcpy(larger.uv, faces->uv, faces->corner_count * sizeof *faces->uv);
    *faces = larger;
    return true;
}

void faces_push_between(Faces *faces, uint32_t vertex, const Faces *old, uint32_t a, uint32_t b) {
    if (faces->uv)
        for (int k = 0; k < 2; k++) faces->uv[faces->corner_count][k] = 0.5f * (old->uv[a][k] + old->uv[b][k]);
    faces->id[faces->corner_count] = -1;
    faces->corner[faces->corner_count++] = vertex;
}

void faces_push(Faces *faces, uint32_t vertex, const Faces *old, uint32_t from) {
    faces_push_between(faces, vertex, old, from, from);
    faces->id[faces->corner_count - 1] = old->id[from];
}

void faces_end(Faces *faces, uint32_t origin) {
    faces->origin[faces->count++] = origin;
    faces->first[faces->count] = faces->corner_count;
}

uint32_t work_vertex(Work *work, const uint32_t *of, uint32_t count) {
    const size_t attributes = work->attribute_count;
    if (work->no_memory) return MESH_NONE;

    if (work->vertex_count == work->vertex_capacity) {
        const uint32_t capacity = work->vertex_capacity + work->vertex_capacity / 2 + 16;
        double(*position)[3] = work_new(work, capacity, sizeof *position);
        int32_t *source = work_new(work, capacity, sizeof *source);
        float *values = work_new(work, capacity * attributes, sizeof *values);
        if (work->no_memory) return MESH_NONE;

        memcpy(position, work->position, work->vertex_count * sizeof *position);
        memcpy(source, work->source, work->vertex_count * sizeof *source);
        memcpy(values, work->attributes, work->vertex_count * attributes * sizeof *values);
        work->position = position;
        work->source = source;
        work->attributes = values;
        work->vertex_capacity = capacity;
    }

    const uint32_t v = work->vertex_count++;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) work->position[v][k] += work->position[of[i]][k] / count;
        for (size_t k = 0; k < attributes; k++)
            work->attributes[v * attributes + k] += work->attributes[of[i] * attributes + k] / (float)count;
    }

    work->source[v] = -1;
    return v;
}

uint32_t work_copy(Work *work, uint32_t vertex) {
    uint32_t copy = work_vertex(work, &vertex, 1);
    if (copy != MESH_NONE) work->source[copy] = work->source[vertex];
    return copy;
}

void work_rename(Work *work, const uint32_t *to) {
    for (uint32_t h = 0; h < work->faces.corner_count; h++) work->faces.corner[h] = to[work->faces.corner[h]];
    for (uint32_t v = 0; v < work->file->vertex_count; v++) work->became[v] = to[work->became[v]];
}

// ---- edges

static void edge_ends(const Work *work, uint32_t half, uint32_t *low, uint32_t *high) {
    const Faces *faces = &work->faces;
    uint32_t a = faces->corner[half], b = faces->corner[faces_next(faces, work->face, half)];
    *low = a < b ? a : b;
    *high = a < b ? b : a;
}

/// A stable counting sort by one end.
static void edges_sort(const Work *work, bool high, const uint32_t *from, uint32_t *to, uint32_t *slot) {
    const uint32_t count = work->faces.corner_count;
    memset(slot, 0, ((size_t)work->vertex_count + 1) * sizeof *slot);

    uint32_t end[2];
    for (uint32_t h = 0; h < count; h++) {
        edge_ends(work, h, &end[0], &end[1]);
        slot[end[high] + 1]++;
    }

    for (uint32_t v = 0; v < work->vertex_count; v++) slot[v + 1] += slot[v];
    for (uint32_t k = 0; k < count; k++) {
        uint32_t half = from ? from[k] : k;
        edge_ends(work, half, &end[0], &end[1]);
        to[slot[end[high]]++] = half;
    }
}

uint32_t *work_sorted_edges(Work *work) {
    const Faces *faces = &work->faces;
    work->face = work_new(work, faces->corner_count, sizeof *work->face);
    uint32_t *by_high = work_new(work, faces->corner_count, sizeof *by_high);
    uint32_t *order = work_new(work, faces->corner_count, sizeof *order);
    uint32_t *slot = work_new(work, (size_t)work->vertex_count + 1, sizeof *slot);
    if (work->no_memory) return NULL;

    for (uint32_t f = 0; f < faces->count; f++)
        for (uint32_t h = faces->first[f]; h < faces->first[f + 1]; h++) work->face[h] = f;
    edges_sort(work, true, NULL, by_high, slot);
    edges_sort(work, false, by_high, order, slot);
    return order;
}

uint32_t work_edge_size(const Work *work, const uint32_t *order, uint32_t at) {
    uint32_t low, high, other_low, other_high, size = 1;
    edge_ends(work, order[at], &low, &high);
    for (; at + size < work->faces.corner_count; size++) {
        edge_ends(work, order[at + size], &other_low, &other_high);
        if (low != other_low || high != other_high) break;
    }
    return size;
}

void work_edges(Work *work) {
    const uint32_t count = work->faces.corner_count;
    uint32_t *order = work_sorted_edges(work);
    work->twin = work_new(work, count, sizeof *work->twin);
    if (work->no_memory) return;

    for (uint32_t k = 0, size; k < count; k += size) {
        size = work_edge_size(work, order, k);
        for (uint32_t i = 0; i < size; i++) work->twin[order[k + i]] = MESH_NONE;
        if (size != 2) continue;
        work->twin[order[k]] = order[k + 1];
        work->twin[order[k + 1]] = order[k];
    }
}

void work_mark_open(const Work *work, uint8_t *open) {
    const Faces *faces = &work->faces;
    for (uint32_t h = 0; h < faces->corner_count; h++)
        if (work->twin[h] == MESH_NONE)
            open[faces->corner[h]] = open[faces->corner[faces_next(faces, work->face, h)]] = 1;
}

// ---- geometry

double distance3(const double *a, const double *b) {
    double d[3];
    sub3(a, b, d);
    return sqrt(dot3(d, d));
}

void face_area(const Work *work, uint32_t face, double normal[3]) {
    const Faces *faces = &work->faces;
    const double *o = work->position[faces->corner[faces->first[face]]];

    normal[0] = normal[1] = normal[2] = 0;
    for (uint32_t h = faces->first[face] + 1; h + 1 < faces->first[face + 1]; h++) {
        double a[3], b[3], n[3];
        sub3(work->position[faces->corner[h]], o, a);
        sub3(work->position[faces->corner[h + 1]], o, b);
        cross3(a, b, n);
        for (int k = 0; k < 3; k++) normal[k] += n[k];
    }
}

// ---- reports

void work_did(Work *work, MeshRepair repair, uint32_t count, uint32_t first) {
    if (count && !work->report->count[repair]) work->report->first[repair] = first;
    work->report->count[repair] += count;
}

uint32_t work_face_name(const Work *work, uint32_t origin) {
    return work->file->lines ? work->file->lines[origin] : origin;
}

SingeResult work_refuse(const Work *work, uint32_t origin, const char *what) {
    uint32_t name = work_face_name(work, origin);
    const char *format = work->file->lines ? "%s:%u: %s" : "%s: face %u (from 0) %s";
    return refuse(work->error, SINGE_ERROR_MESH, "mesh", name, format, short_name(work->name), name, what);
}
