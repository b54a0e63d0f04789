#include "shell/cross.h"

bool cross_pierces(Float4 p, Float4 q, Float4 a, Float4 b, Float4 c) {
    Float4 normal = float4_cross(b - a, c - a);
    float above = float4_dot(p - a, normal), below = float4_dot(q - a, normal);
    if ((above > 0) == (below > 0) || above == below) return false;
    Float4 x = p + above / (above - below) * (q - p);
    float ab = float4_dot(float4_cross(b - a, x - a), normal), bc = float4_dot(float4_cross(c - b, x - b), normal);
    float ca = float4_dot(float4_cross(a - c, x - c), normal);
    return ab >= 0 && bc >= 0 && ca >= 0;
}

/// Corners, then the virtual centre, about an origin.
static void cross_nodes(const uint32_t corner[4], const float (*x)[4], Float4 origin, Float4 node[5]) {
    for (int i = 0; i < 4; i++) node[i] = float4_flat(float4_load(x[corner[i]]) - origin);
    node[4] = 0.25f * ((node[0] + node[1]) + (node[2] + node[3]));
}

/// Number of a node, the same in all cells that have it.
static uint32_t cross_id(const Shell *shell, uint32_t cell, int node) {
    return node < 4 ? shell->cells[cell][node] : shell_centre(shell, cell);
}

/// Edges of a through triangles of b.
static bool cross_edges(const Shell *shell, uint32_t a, uint32_t b, const Float4 p[5], const Float4 q[5]) {
    static const int edge[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
    static const int triangle[4][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

    for (int e = 0; e < 8; e++) {
        const int *k = edge[e];
        uint32_t first = cross_id(shell, a, k[0]), second = cross_id(shell, a, k[1]);
        for (int t = 0; t < 4; t++) {
            const int *l = triangle[t];
            bool joined = false;
            for (int i = 0; i < 3; i++) {
                uint32_t node = cross_id(shell, b, l[i]);
                joined |= node == first || node == second;
            }
            if (!joined && cross_pierces(p[k[0]], p[k[1]], q[l[0]], q[l[1]], q[l[2]])) return true;
        }
    }

    return false;
}

bool cross_cells(const Shell *shell, const float (*x)[4], uint32_t a, uint32_t b) {
    Float4 origin = float4_load(x[shell->cells[a][0]]), p[5], q[5];
    cross_nodes(shell->cells[a], x, origin, p);
    cross_nodes(shell->cells[b], x, origin, q);
    return cross_edges(shell, a, b, p, q) || cross_edges(shell, b, a, q, p);
}
