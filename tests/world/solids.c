#include "solids.h"

#include <math.h>
#include <stdlib.h>

static const float TAU = 6.2831853f;

static Triangles triangles_new(uint32_t vertices, uint32_t triangles) {
    Triangles mesh = {.vertices = calloc(3 * (size_t)vertices, sizeof(float)),
                      .triangles = calloc(3 * (size_t)triangles, sizeof(uint32_t))};
    return mesh;
}

void triangles_free(Triangles *mesh) {
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (Triangles){0};
}

static uint32_t put_vertex(Triangles *mesh, float x, float y, float z) {
    float *v = mesh->vertices + 3 * (size_t)mesh->vertex_count;
    v[0] = x, v[1] = y, v[2] = z;
    return mesh->vertex_count++;
}

static void put_triangle(Triangles *mesh, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *t = mesh->triangles + 3 * (size_t)mesh->triangle_count++;
    t[0] = a, t[1] = b, t[2] = c;
}

static float random_between(uint32_t *state, float low, float high) {
    *state = *state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(*state >> 8) / 16777216.0f;
}

Triangles triangles_sphere(uint32_t around, float radius, float rough) {
    uint32_t rings = around / 2, state = 7;
    Triangles mesh = triangles_new(around * rings + 2, 2 * around * rings);
    for (uint32_t j = 1; j < rings; j++)
        for (uint32_t i = 0; i < around; i++) {
            float polar = TAU / 2 * (float)j / (float)rings, turn = TAU * (float)i / (float)around;
            float r = radius * (1 + random_between(&state, -rough, rough));
            put_vertex(&mesh, r * sinf(polar) * cosf(turn), r * sinf(polar) * sinf(turn), r * cosf(polar));
        }

    uint32_t top = put_vertex(&mesh, 0, 0, radius), low = put_vertex(&mesh, 0, 0, -radius);
    for (uint32_t i = 0; i < around; i++) {
        uint32_t next = (i + 1) % around, last = (rings - 2) * around;
        put_triangle(&mesh, top, i, next);
        put_triangle(&mesh, low, last + next, last + i);
        for (uint32_t j = 0; j + 2 < rings; j++) {
            uint32_t a = j * around + i, b = j * around + next;
            put_triangle(&mesh, a, a + around, b + around);
            put_triangle(&mesh, a, b + around, b);
        }
    }

    return mesh;
}

Triangles triangles_torus(uint32_t around, uint32_t tube, float radius, float tube_radius) {
    Triangles mesh = triangles_new(around * tube, 2 * around * tube);
    for (uint32_t j = 0; j < around; j++)
        for (uint32_t i = 0; i < tube; i++) {
            float turn = TAU * (float)j / (float)around, angle = TAU * (float)i / (float)tube;
            float r = radius + tube_radius * cosf(angle);
            put_vertex(&mesh, r * cosf(turn), r * sinf(turn), tube_radius * sinf(angle));
        }

    for (uint32_t j = 0; j < around; j++)
        for (uint32_t i = 0; i < tube; i++) {
            uint32_t a = j * tube + i, b = (j + 1) % around * tube + i;
            uint32_t c = (j + 1) % around * tube + (i + 1) % tube, d = j * tube + (i + 1) % tube;
            put_triangle(&mesh, a, b, c);
            put_triangle(&mesh, a, c, d);
        }

    return mesh;
}

Triangles triangles_box(uint32_t n, float x, float y, float z) {
    // faces have vertices of their own at the same positions: what a collider joins
    Triangles mesh = triangles_new(6 * (n + 1) * (n + 1), 12 * n * n);
    const float half[3] = {x / 2, y / 2, z / 2};
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, e = (axis + 1) % 3, f = (axis + 2) % 3;
        float side = face & 1 ? 1 : -1;
        uint32_t first = mesh.vertex_count;

        for (uint32_t j = 0; j <= n; j++)
            for (uint32_t i = 0; i <= n; i++) {
                float p[3];
                p[axis] = side * half[axis];
                p[e] = half[e] * (2 * (float)i / (float)n - 1), p[f] = half[f] * (2 * (float)j / (float)n - 1);
                put_vertex(&mesh, p[0], p[1], p[2]);
            }

        for (uint32_t j = 0; j < n; j++)
            for (uint32_t i = 0; i < n; i++) {
                uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
                put_triangle(&mesh, a, side > 0 ? b : c, side > 0 ? c : b);
                put_triangle(&mesh, a, side > 0 ? c : d, side > 0 ? d : c);
            }
    }

    return mesh;
}

void triangles_turn(Triangles *mesh, float angle, float x, float y, float z) {
    const float k[3] = {0.48f, 0.6f, 0.64f};
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *p = mesh->vertices + 3 * (size_t)v, along = p[0] * k[0] + p[1] * k[1] + p[2] * k[2];
        float cross[3] = {k[1] * p[2] - k[2] * p[1], k[2] * p[0] - k[0] * p[2], k[0] * p[1] - k[1] * p[0]};
        for (int i = 0; i < 3; i++)
            p[i] = p[i] * cosf(angle) + cross[i] * sinf(angle) + k[i] * along * (1 - cosf(angle));
        p[0] += x, p[1] += y, p[2] += z;
    }
}

SingeColliderDef triangles_def(const Triangles *mesh) {
    SingeColliderDef def = singe_default_collider();
    def.kind = SINGE_COLLIDER_MESH;
    def.vertex_count = mesh->vertex_count, def.vertices = mesh->vertices;
    def.triangle_count = mesh->triangle_count, def.triangles = mesh->triangles;
    return def;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Square of the distance from the origin to the segment from a to b.
static double segment(const double a[3], const double b[3]) {
    double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, square = dot(along, along);
    double t = square > 0 ? fmin(fmax(-dot(a, along) / square, 0), 1) : 0, p[3];
    for (int i = 0; i < 3; i++) p[i] = a[i] + t * along[i];
    return dot(p, p);
}

double triangles_distance(const Triangles *mesh, const float at[3]) {
    double min = INFINITY, angle = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double p[3][3], n[3], length[3];
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < 3; i++)
                p[c][i] = (double)mesh->vertices[3 * (size_t)mesh->triangles[3 * t + (uint32_t)c] + (size_t)i] -
                          (double)at[i];

        double u[3], v[3];
        for (int i = 0; i < 3; i++) u[i] = p[1][i] - p[0][i], v[i] = p[2][i] - p[0][i];
        for (int i = 0; i < 3; i++) n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];

        double height = dot(p[0], n), triple;
        bool over = true;
        for (int c = 0; c < 3; c++) {
            const double *a = p[c], *b = p[(c + 1) % 3];
            double cross[3];
            for (int i = 0; i < 3; i++) cross[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
            over = over && dot(cross, n) >= 0;
            min = fmin(min, segment(a, b));
            length[c] = sqrt(dot(a, a));
        }

        if (over) min = fmin(min, height * height / dot(n, n));
        triple = height;

        // Van Oosterom and Strackee 1983
        angle += 2 * atan2(triple, length[0] * length[1] * length[2] + dot(p[0], p[1]) * length[2] +
                                       dot(p[1], p[2]) * length[0] + dot(p[2], p[0]) * length[1]);
    }

    return angle > 6.2831853 ? -sqrt(min) : sqrt(min);
}
