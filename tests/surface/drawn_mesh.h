// Checks of a drawn mesh that lies in the plane z = 0.
#pragma once

#include "ablate/burning_sheet.h"
#include "common/order.h"

/// Twice the area along z.
static inline double doubled_area(const SingeSurface *s, uint32_t t) {
    const uint32_t *corners = s->triangles[t];
    const float *a = s->position[corners[0]], *b = s->position[corners[1]], *c = s->position[corners[2]];
    double bx = (double)b[0] - (double)a[0], by = (double)b[1] - (double)a[1];
    double cx = (double)c[0] - (double)a[0], cy = (double)c[1] - (double)a[1];
    return bx * cy - by * cx;
}

/// The area; every triangle turned as its cell and not empty.
static inline double area_of(const SingeSurface *s) {
    double area = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        assert_true(doubled_area(s, t) > 0);
        area += doubled_area(s, t) / 2;
    }
    return area;
}

typedef struct Edge {
    uint32_t a, b;
} Edge;

/// The edges of all triangles as they are walked, sorted; 3 a triangle. To be freed.
static inline Edge *drawn_edges(const SingeSurface *s) {
    size_t count = 3 * (size_t)s->triangle_count;
    Edge *edges = calloc(count + 1, sizeof *edges);
    for (uint32_t t = 0; t < s->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            edges[3 * t + i] = (Edge){s->triangles[t][i], s->triangles[t][(i + 1) % 3]};
            assert_true(edges[3 * t + i].a != edges[3 * t + i].b && edges[3 * t + i].a < s->vertex_count);
        }

    qsort(edges, count, sizeof *edges, order_by_two);
    return edges;
}
