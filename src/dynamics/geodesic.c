// Geodesic distances from one vertex, by a front that moves outward over the cells as Dijkstra's algorithm does
// over edges. A corner u of a cell is reached from another corner v along the side or diagonal between them,
//
//   d(u) = d(v) + |vu|,
//
// or through the segment between two corners v and w whose distances are known: these and |vw| place a virtual source s
// in the plane of the triangle, beyond vw, and where the line from s to u crosses the segment,
//
//   d(u) = |s - u|.
//
// This is exact in the plane and on what unrolls to it (Novotni and Klein, Computing geodesic distances on
// triangular meshes, 2002). The metric is intrinsic: target lengths of blue and yellow springs, wherever the sheet is.
#include "dynamics/geodesic.h"

#include "common/float3.h"
#include "common/real.h"

#include <math.h>

enum { GEODESIC_FAR = UINT32_MAX, GEODESIC_DONE = UINT32_MAX - 1 };

bool geodesic_create(Memory *memory, uint32_t vertex_count, Geodesic *search) {
    *search = (Geodesic){0};
    return NEW(memory, search->heap, vertex_count) && NEW(memory, search->position, vertex_count);
}

void geodesic_free(Memory *memory, uint32_t vertex_count, Geodesic *search) {
    FREE(memory, search->heap, vertex_count);
    FREE(memory, search->position, vertex_count);
}

static void heap_put(Geodesic *search, uint32_t at, uint32_t vertex) {
    search->heap[at] = vertex;
    search->position[vertex] = at;
}

static uint32_t heap_pop(Geodesic *search, const float *distance) {
    uint32_t nearest = search->heap[0], last = search->heap[--search->waiting], at = 0;
    search->position[nearest] = GEODESIC_DONE;
    if (search->waiting == 0) return nearest;

    for (;;) {
        uint32_t below = 2 * at + 1;
        if (below >= search->waiting) break;
        if (below + 1 < search->waiting && distance[search->heap[below + 1]] < distance[search->heap[below]]) below++;
        if (distance[search->heap[below]] >= distance[last]) break;
        heap_put(search, at, search->heap[below]);
        at = below;
    }

    heap_put(search, at, last);
    return nearest;
}

/// The distance at u through the segment vw of length c, or INFINITY where the path does not cross it.
static float geodesic_through(float dv, float dw, float c, float vu, float wu) {
    if (c <= 0) return INFINITY;

    // v at the origin, w at (c, 0), u above, the virtual source below
    float ux = (vu * vu - wu * wu + c * c) / (2 * c), uy = sqrtf(float_max(0, vu * vu - ux * ux));
    float sx = (dv * dv - dw * dw + c * c) / (2 * c), sy = -sqrtf(float_max(0, dv * dv - sx * sx));
    if (uy - sy <= 0) return INFINITY;

    float cross = sx - (ux - sx) * sy / (uy - sy);
    if (!(cross >= 0 && cross <= c)) return INFINITY;

    double x = (double)(ux - sx), y = (double)(uy - sy); // exact squares: what hypotf gives, everywhere
    return (float)sqrt(x * x + y * y);
}

/// Length of the side or diagonal between corners i and j of a cell. A spring between held ends cannot shrink to its
/// target.
static float cell_length(const Shell *shell, const StateInput *state, uint32_t cell, int i, int j) {
    const CellSprings *springs = &shell->cell_springs[cell];
    const DynamicsState *dynamics = state->dynamics;
    int side = ((i + 1) & 3) == j ? i : j;
    float length = ((i ^ j) & 1) == 0 ? state->burn->spring_length[SINGE_YELLOW][springs->yellow[i & 1]]
                                      : state->burn->spring_length[SINGE_BLUE][springs->blue[side]];
    uint32_t a = shell->cells[cell][i], b = shell->cells[cell][j];
    if (!dynamics->pinned[a] || !dynamics->pinned[b]) return length;
    return float_max(length,
                     float3_length(float3_sub(float3_load(dynamics->position[a]), float3_load(dynamics->position[b]))));
}

void geodesic_from(Geodesic *search, const Shell *shell, const StateInput *state, uint32_t source, uint32_t first,
                   uint32_t last, float *distance) {
    for (uint32_t v = first; v < last; v++) {
        distance[v] = INFINITY;
        search->position[v] = GEODESIC_FAR;
    }

    distance[source] = 0;
    search->waiting = 1;
    heap_put(search, 0, source);

    while (search->waiting > 0) {
        uint32_t v = heap_pop(search, distance);
        for (uint32_t k = shell->fan_first[v]; k < shell->fan_first[v + 1]; k++) {
            uint32_t cell = shell->fan[k];
            if (!(state->ablate->cell_flags[cell] & SINGE_ALIVE)) continue;

            // lower the distances at the cell's other corners
            const uint32_t *corner = shell->cells[cell];
            const float dv = distance[v];
            int i = 0;
            while (corner[i] != v) i++;
            for (int turn = 1; turn < 4; turn++) {
                const int j = (i + turn) & 3;
                const uint32_t u = corner[j];
                if (search->position[u] == GEODESIC_DONE) continue;

                // along the side or diagonal, or through the segment to another corner
                float vu = cell_length(shell, state, cell, i, j), d = dv + vu;
                for (int other = 1; other < 4; other++) {
                    const int m = (i + other) & 3;
                    if (m == j || search->position[corner[m]] != GEODESIC_DONE) continue;
                    d = float_min(d, geodesic_through(dv, distance[corner[m]], cell_length(shell, state, cell, i, m),
                                                      vu, cell_length(shell, state, cell, m, j)));
                }

                // the vertex rises in the heap with a shorter distance
                if (d >= distance[u]) continue;
                distance[u] = d;
                if (search->position[u] == GEODESIC_FAR) heap_put(search, search->waiting++, u);
                uint32_t at = search->position[u];
                for (; at > 0 && distance[search->heap[(at - 1) / 2]] > d; at = (at - 1) / 2)
                    heap_put(search, at, search->heap[(at - 1) / 2]);
                heap_put(search, at, u);
            }
        }
    }
}
