// OBJ texts of meshes, what mesh_make makes of them, and looks at that.
#pragma once

#include "support/test.h"

#include "formats/formats.h"
#include "mesh/to_quads.h"

typedef struct Text {
    char bytes[200000];
    size_t size;
} Text;

static inline void text_add(Text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text->bytes + text->size, sizeof text->bytes - text->size, format, arguments);
    va_end(arguments);
    assert_true(length >= 0 && text->size + (size_t)length < sizeof text->bytes);
    text->size += (size_t)length;
}

/// Vertices of a grid of n x m cells of 1 cm; vertex (i, j) is j (n + 1) + i.
static inline void text_grid(Text *text, int n, int m) {
    for (int j = 0; j <= m; j++)
        for (int i = 0; i <= n; i++) text_add(text, "v %.6g %.6g 0\n", 0.01 * i, 0.01 * j);
}

typedef enum Diagonals { REGULAR, ALTERNATING, RANDOM, WHOLE } Diagonals;

/// Two triangles a cell, or a quad.
static inline void text_cells(Text *text, int n, int m, Diagonals diagonals) {
    uint32_t random = 12345;
    for (int j = 0; j < m; j++)
        for (int i = 0; i < n; i++) {
            int a = j * (n + 1) + i + 1, b = a + 1, c = b + n + 1, d = a + n + 1;
            random = random * 1664525u + 1013904223u;
            bool other = diagonals == ALTERNATING ? (i + j) & 1 : diagonals == RANDOM && random >> 31;
            if (diagonals == WHOLE) text_add(text, "f %d %d %d %d\n", a, b, c, d);
            else if (other) text_add(text, "f %d %d %d\nf %d %d %d\n", a, b, d, b, c, d);
            else text_add(text, "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d);
        }
}

typedef struct Made {
    Mesh mesh;
    MeshReport report;
    SingeError error;
    SingeResult result;
} Made;

static inline Made make_with(const Text *text, MeshOptions options) {
    Made made = {0};
    Polygons polygons;
    if (obj_read("a.obj", (const uint8_t *)text->bytes, text->size, (SingeAllocator){0}, &polygons, &made.error))
        fail_msg("%s", made.error.message);
    made.result = mesh_make("a.obj", &polygons, &options, (SingeAllocator){0}, &made.mesh, &made.report, &made.error);
    polygons_free(&polygons);
    return made;
}

static inline Made make(const Text *text) {
    Made made = make_with(text, mesh_default_options());
    if (made.result) fail_msg("%s", made.error.message);
    return made;
}

static inline uint32_t vertex_at(const Mesh *mesh, float x, float y, float z) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->positions + 3 * v;
        if (fabsf(p[0] - x) + fabsf(p[1] - y) + fabsf(p[2] - z) < 1e-6f) return v;
    }
    return UINT32_MAX;
}

/// Every cell is a square of the grid, front upwards.
static inline void assert_squares(const Mesh *mesh, float side) {
    for (uint32_t c = 0; c < mesh->cell_count; c++)
        for (int k = 0; k < 4; k++) {
            const float *p = mesh->positions + 3 * mesh->cells[4 * c + (uint32_t)k];
            const float *q = mesh->positions + 3 * mesh->cells[4 * c + (uint32_t)(k + 1) % 4];
            const float *r = mesh->positions + 3 * mesh->cells[4 * c + (uint32_t)(k + 2) % 4];
            float ax = q[0] - p[0], ay = q[1] - p[1], bx = r[0] - q[0], by = r[1] - q[1];
            assert_float_equal(hypotf(ax, ay), side, 1e-6f);
            assert_float_equal(ax * by - ay * bx, side * side, 1e-7f);
        }
}
