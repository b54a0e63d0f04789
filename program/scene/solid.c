// Colliders from files: faces of a mesh become triangles, pixels of a picture become heights.
//
// A face is triangulated by clipping ears in the plane across its mean normal (Newell's): the ear with the shortest new
// edge first, so that a quad is cut along its shorter diagonal if both are inside.
#include "scene/assets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/store.h"

static SingeResult solid_fail(SingeError *error, SingeResult code, int64_t element, const char *text) {
    return refuse(error, code, "scene", element, "%s", text);
}

static SingeResult solid_no_memory(SingeError *error) {
    return solid_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a collider");
}

void solid_free(SceneSolid *solid) {
    free(solid->surface.vertices);
    free(solid->surface.triangles);
    free(solid->heights);
    *solid = (SceneSolid){0};
}

// ---- faces

/// Twice the area of the triangle as seen along the normal; negative if it turns the other way.
static double solid_turn(const float *vertices, uint32_t a, uint32_t b, uint32_t c, const double normal[3]) {
    const float *p = vertices + 3 * (size_t)a, *q = vertices + 3 * (size_t)b, *r = vertices + 3 * (size_t)c;
    double u[3], v[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = (double)q[k] - (double)p[k];
        v[k] = (double)r[k] - (double)p[k];
    }

    for (int k = 0; k < 3; k++) {
        int e = (k + 1) % 3, f = (k + 2) % 3;
        sum += normal[k] * (u[e] * v[f] - u[f] * v[e]);
    }

    return sum;
}

/// Corner i of the remaining ones: whether it is an ear, or which of them lies in its triangle. Those before `from` do not.
static void look_at_ear(const float *vertices, const uint32_t *left, uint32_t count, uint32_t i, uint32_t from,
                        const double normal[3], SolidEar *ear) {
    const uint32_t a = left[(i + count - 1) % count], b = left[i], c = left[(i + 1) % count];
    *ear = (SolidEar){INFINITY, UINT32_MAX};
    if (!(solid_turn(vertices, a, b, c, normal) > 0)) return;

    for (uint32_t k = from; k < count; k++) {
        const uint32_t p = left[k];
        if (p == a || p == b || p == c) continue;
        if (solid_turn(vertices, a, b, p, normal) >= 0 && solid_turn(vertices, b, c, p, normal) >= 0 &&
            solid_turn(vertices, c, a, p, normal) >= 0) {
            ear->blocker = k;
            return;
        }
    }

    ear->square = 0;
    for (size_t k = 0; k < 3; k++) {
        const double d = (double)vertices[3 * (size_t)a + k] - (double)vertices[3 * (size_t)c + k];
        ear->square += d * d;
    }
}

/// Takes a corner away. What lay in no triangle lies in none now, so only its neighbours, and the corners in whose
/// triangles it lay, are looked at again, the latter from there on: the work is that of looking at each corner a few
/// times.
static void clip_ear(const float *vertices, uint32_t *left, SolidEar *ears, uint32_t count, uint32_t clipped,
                     const double normal[3]) {
    memmove(left + clipped, left + clipped + 1, (count - clipped - 1) * sizeof *left);
    memmove(ears + clipped, ears + clipped + 1, (count - clipped - 1) * sizeof *ears);
    count--;

    for (uint32_t i = 0; i < count; i++) {
        const uint32_t blocker = ears[i].blocker;
        const bool beside = i == clipped % count || i == (clipped + count - 1) % count;
        if (beside || blocker == clipped) look_at_ear(vertices, left, count, i, beside ? 0 : clipped, normal, &ears[i]);
        else if (blocker != UINT32_MAX && blocker > clipped) ears[i].blocker--;
    }
}

void solid_cut_face(const float *vertices, uint32_t *left, SolidEar *ears, uint32_t count, uint32_t *triangles) {
    double normal[3] = {0, 0, 0}; // twice the area by components
    for (uint32_t i = 0; i < count; i++) {
        const float *a = vertices + 3 * (size_t)left[i], *b = vertices + 3 * (size_t)left[(i + 1) % count];
        for (int k = 0; k < 3; k++) {
            int e = (k + 1) % 3, f = (k + 2) % 3;
            normal[k] += ((double)a[e] - (double)b[e]) * ((double)a[f] + (double)b[f]);
        }
    }

    for (uint32_t i = 0; i < count; i++) look_at_ear(vertices, left, count, i, 0, normal, &ears[i]);
    for (; count >= 3; count--, triangles += 3) {
        uint32_t best = 1; // if the face crosses itself: any
        double min = INFINITY;
        for (uint32_t i = 0; i < count && count > 3; i++)
            if (ears[i].square < min) {
                min = ears[i].square;
                best = i;
            }

        triangles[0] = left[(best + count - 1) % count];
        triangles[1] = left[best];
        triangles[2] = left[(best + 1) % count];
        clip_ear(vertices, left, ears, count, best, normal);
    }
}

SingeResult solid_read_mesh(const char *name, const uint8_t *bytes, size_t size, double scale, SceneSolid *solid,
                            SingeError *error) {
    Polygons polygons;
    SingeResult result = polygons_read(name, bytes, size, (SingeAllocator){0}, &polygons, error);
    if (result) return result;

    uint32_t max = 0;
    for (uint32_t f = 0; f < polygons.face_count; f++) {
        uint32_t corners = polygons.first[f + 1] - polygons.first[f];
        max = corners > max ? corners : max;
    }

    PreviewSolid *surface = &solid->surface;
    size_t count = (size_t)polygons.corner_count - 2 * (size_t)polygons.face_count;
    surface->vertices = malloc(3 * (size_t)polygons.vertex_count * sizeof *surface->vertices);
    surface->triangles = malloc(3 * count * sizeof *surface->triangles);
    surface->vertex_count = polygons.vertex_count;

    uint32_t *left = malloc((max + 1) * sizeof *left); // corners of a face
    SolidEar *ears = malloc((max + 1) * sizeof *ears);
    if (count > INT32_MAX / 4) result = solid_fail(error, SINGE_ERROR_LIMIT, -1, "the collider's mesh is too large");
    else if (!surface->vertices || !surface->triangles || !left || !ears) result = solid_no_memory(error);

    for (size_t k = 0; !result && k < 3 * (size_t)polygons.vertex_count; k++)
        surface->vertices[k] = (float)((double)polygons.positions[k] * scale);

    // a corner named twice in a row gives triangles without area, which the library leaves out
    for (uint32_t f = 0; !result && f < polygons.face_count; f++) {
        uint32_t first = polygons.first[f], corners = polygons.first[f + 1] - first;
        memcpy(left, polygons.corners + first, corners * sizeof *left);
        solid_cut_face(surface->vertices, left, ears, corners,
                       surface->triangles + 3 * (size_t)surface->triangle_count);
        surface->triangle_count += corners - 2;
    }

    free(left);
    free(ears);
    polygons_free(&polygons);
    return result;
}

// ---- heights

static void put_triangle(PreviewSolid *surface, size_t a, size_t b, size_t c) {
    uint32_t *triangle = surface->triangles + 3 * (size_t)surface->triangle_count++;
    triangle[0] = (uint32_t)a;
    triangle[1] = (uint32_t)b;
    triangle[2] = (uint32_t)c;
}

static void put_vertex(PreviewSolid *surface, float x, float y, float z) {
    float *vertex = surface->vertices + 3 * (size_t)surface->vertex_count++;
    vertex[0] = x;
    vertex[1] = y;
    vertex[2] = z;
}

/// Walls along the border, whose k-th node, counter-clockwise from the min corner, is `node`.
static size_t border_node(const SceneSolid *solid, size_t k) {
    size_t columns = solid->columns, rows = solid->rows;
    if (k < columns - 1) return k;
    if ((k -= columns - 1) < rows - 1) return (k + 1) * columns - 1;
    if ((k -= rows - 1) < columns - 1) return rows * columns - 1 - k;
    return (rows - 1 - (k - (columns - 1))) * columns;
}

SingeResult solid_make_heights(const SingeTexture *picture, const float size[2], const float heights[2],
                               SceneSolid *solid, SingeError *error) {
    size_t columns = (size_t)picture->width, rows = (size_t)picture->height, nodes = columns * rows;
    if (columns < 2 || rows < 2)
        return solid_fail(error, SINGE_ERROR_FORMAT, -1, "a heightfield's picture needs 2 pixels along each side");
    if (nodes > INT32_MAX / 8)
        return solid_fail(error, SINGE_ERROR_LIMIT, -1, "a heightfield's picture has at most 268 million pixels");

    size_t border = 2 * (columns + rows) - 4;
    solid->columns = (uint32_t)columns;
    solid->rows = (uint32_t)rows;
    solid->heights = malloc(nodes * sizeof *solid->heights);
    solid->surface.vertices = malloc(3 * (nodes + border) * sizeof *solid->surface.vertices);
    solid->surface.triangles = malloc(3 * (2 * (columns - 1) * (rows - 1) + 2 * border) * sizeof(uint32_t));
    if (!solid->heights || !solid->surface.vertices || !solid->surface.triangles) return solid_no_memory(error);

    for (size_t j = 0; j < rows; j++) // the picture's rows run from the top
        for (size_t i = 0; i < columns; i++)
            solid->heights[j * columns + i] =
                heights[0] + (heights[1] - heights[0]) * picture->values[(rows - 1 - j) * columns + i];

    // the library's surface, and walls down to the lowest height
    PreviewSolid *surface = &solid->surface;
    float low = INFINITY;
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < columns; i++) {
            float h = solid->heights[j * columns + i];
            low = fminf(low, h);
            put_vertex(surface, size[0] * ((float)i / (float)(columns - 1) - 0.5f),
                       size[1] * ((float)j / (float)(rows - 1) - 0.5f), h);
        }

    for (size_t j = 0; j + 1 < rows; j++)
        for (size_t i = 0; i + 1 < columns; i++) {
            size_t a = j * columns + i, c = a + columns + 1;
            put_triangle(surface, a, a + 1, c);
            put_triangle(surface, a, c, a + columns);
        }

    low -= 1e-3f * (size[0] + size[1]);
    for (size_t k = 0; k < border; k++) {
        const float *top = surface->vertices + 3 * border_node(solid, k);
        put_vertex(surface, top[0], top[1], low);
    }

    for (size_t k = 0; k < border; k++) {
        size_t a = border_node(solid, k), b = border_node(solid, (k + 1) % border), below = columns * rows;
        put_triangle(surface, a, below + k, below + (k + 1) % border);
        put_triangle(surface, a, below + (k + 1) % border, b);
    }

    return SINGE_OK;
}
