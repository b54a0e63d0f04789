// Merges vertices at the same position. Only those on open edges are merged: there files cut connected surfaces, along
// the seams of their uv. The vertices of layers that touch are interior, and stay separate.
#include "common/real.h"
#include "mesh/work.h"

#include <math.h>
#include <string.h>

uint32_t positions_slot(const Positions *positions, const int64_t box[3]) {
    uint64_t hash = (uint64_t)box[0] * 0x9E3779B97F4A7C15u ^ (uint64_t)box[1] * 0xC2B2AE3D27D4EB4Fu ^
                    (uint64_t)box[2] * 0x165667B19E3779F9u;
    return (uint32_t)((hash ^ hash >> 29) % positions->slots);
}

void positions_box(const Positions *positions, const double *position, int64_t box[3]) {
    const double far = 0x1p62; // the number of a far box may overflow; all beyond share the last
    for (int k = 0; k < 3; k++)
        box[k] = (int64_t)double_min(double_max(floor(position[k] / positions->size), -far), far);
}

Positions positions_make(Work *work, double size) {
    Positions positions = {.size = size, .slots = work->vertex_count + work->vertex_count / 2 + 1};
    positions.head = work_new(work, positions.slots, sizeof *positions.head);
    positions.next = work_new(work, work->vertex_count, sizeof *positions.next);
    if (!work->no_memory) memset(positions.head, 0xff, positions.slots * sizeof *positions.head);
    return positions;
}

void positions_add(const Work *work, Positions *positions, uint32_t v) {
    int64_t box[3];
    positions_box(positions, work->position[v], box);
    uint32_t slot = positions_slot(positions, box);
    positions->next[v] = positions->head[slot];
    positions->head[slot] = v;
}

void mesh_weld(Work *work) {
    work_edges(work);
    Positions positions = positions_make(work, double_max(2 * work->weld, 1e-12));
    uint8_t *open = work_new(work, work->vertex_count, 1);
    uint32_t *to = work_sets(work, work->vertex_count);
    if (work->no_memory) return;

    work_mark_open(work, open);

    for (uint32_t v = 0; v < work->vertex_count; v++) {
        if (!open[v]) continue;

        // the first vertex in its box and those around it that is close enough
        int64_t own[3];
        uint32_t found = MESH_NONE;
        positions_box(&positions, work->position[v], own);
        for (int i = 0; i < 27; i++) {
            const int64_t box[3] = {own[0] + i % 3 - 1, own[1] + i / 3 % 3 - 1, own[2] + i / 9 - 1};
            uint32_t u = positions.head[positions_slot(&positions, box)];
            for (; u != MESH_NONE; u = positions.next[u])
                if (u < found && distance3(work->position[u], work->position[v]) <= work->weld) found = u;
        }

        if (found == MESH_NONE) {
            positions_add(work, &positions, v);
            continue;
        }

        to[v] = found;
        work_did(work, MESH_WELDED, 1, v);
    }

    work_rename(work, to);
}
