// Cuts faces into triangles, which pair.c joins to quads.
#include "mesh/pair.h"
#include "mesh/polygon.h"

#include <math.h>
#include <string.h>

#define DEGREES (180 / 3.14159265358979323846)

/// Cosine of the angle at b.
static double cosine_at(const Work *work, uint32_t a, uint32_t b, uint32_t c) {
    double p[3], q[3];
    sub3(work->position[a], work->position[b], p), sub3(work->position[c], work->position[b], q);
    double square = dot3(p, p) * dot3(q, q);
    return square > 0 ? fmax(-1, fmin(1, dot3(p, q) / sqrt(square))) : 1;
}

double pair_angle(const Work *work, uint32_t a, uint32_t b, uint32_t c) {
    return DEGREES * acos(cosine_at(work, a, b, c));
}

/// The smallest angle of a triangle, in degrees; negative if it is flipped against the normal.
static double worth_of(const Pairs *pairs, const uint32_t half[3], const double normal[3]) {
    const Work *work = pairs->work;
    const uint32_t a = work->faces.corner[half[0]], b = work->faces.corner[half[1]], c = work->faces.corner[half[2]];
    double p[3], q[3], m[3];
    sub3(work->position[b], work->position[a], p), sub3(work->position[c], work->position[b], q);
    cross3(p, q, m);
    double min = fmin(pair_angle(work, a, b, c), fmin(pair_angle(work, b, c, a), pair_angle(work, c, a, b)));
    return dot3(m, normal) > 0 ? min : -1 - min;
}

/// Pushes a triangle of corners of `before`.
static void push_triangle(Pairs *pairs, Faces *out, uint32_t a, uint32_t b, uint32_t c, uint32_t origin) {
    const Faces *old = &pairs->before;
    uint32_t *from = pairs->from + out->corner_count;
    from[0] = a;
    from[1] = b;
    from[2] = c;
    faces_push(out, old->corner[a], old, a);
    faces_push(out, old->corner[b], old, b);
    faces_push(out, old->corner[c], old, c);
    faces_end(out, origin);
}

/// Cuts a quad along the diagonal that gives the better triangles, and pairs them.
static void cut_quad(Pairs *pairs, uint32_t face, Faces *out) {
    const Faces *old = &pairs->work->faces;
    const uint32_t h = old->first[face], ring[4] = {h, h + 1, h + 2, h + 3};
    double normal[3], value[2];
    face_area(pairs->work, face, normal);
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t last = ring[(k + 3) % 4], ear[3] = {last, ring[k], ring[k + 1]};
        const uint32_t other[3] = {ring[k + 1], ring[k + 2], last};
        value[k] = fmin(worth_of(pairs, ear, normal), worth_of(pairs, other, normal));
    }
    uint32_t s = value[1] >= value[0] ? 0 : 1, t = out->count; // the ears are at s + 1 and s + 3
    push_triangle(pairs, out, h + s, h + s + 1, h + s + 2, old->origin[face]);
    push_triangle(pairs, out, h + s, h + s + 2, h + (s + 3) % 4, old->origin[face]);
    pairs->mate[t] = t + 1;
    pairs->mate[t + 1] = t;
    pairs->whole[t] = pairs->whole[t + 1] = h;
}

/// Cuts a triangle, or a polygon of more than four corners. False if that is not possible.
static bool cut_polygon(Pairs *pairs, PolygonCut *cut, uint32_t face, uint32_t *ring, Faces *out) {
    const Faces *old = &pairs->work->faces;
    const uint32_t first = old->first[face], n = old->first[face + 1] - first;
    for (uint32_t i = 0; i < n; i++) ring[i] = first + i;
    cut->count = 0;
    if (n == 3) push_triangle(pairs, out, ring[0], ring[1], ring[2], old->origin[face]);
    else if (!polygon_cut(cut, ring, n)) return false;
    for (uint32_t t = 0; t < cut->count; t++) {
        const uint32_t *half = cut->triangle[t];
        push_triangle(pairs, out, half[0], half[1], half[2], old->origin[face]);
    }
    return true;
}

bool pair_cut_faces(Pairs *pairs) {
    Work *work = pairs->work;
    const Faces *old = &work->faces;
    const uint32_t triangles = old->corner_count - 2 * old->count;
    Faces out = work_faces(work, triangles, 3 * triangles);
    uint32_t *ring = work_new(work, old->corner_count, sizeof *ring);
    PolygonCut cut;
    work_edges(work);
    pairs->before = *old;
    pairs->before_face = work->face;
    pairs->before_twin = work->twin;
    pairs->from = work_new(work, 3 * (size_t)triangles, sizeof *pairs->from);
    pairs->mate = work_new(work, triangles, sizeof *pairs->mate);
    pairs->whole = work_new(work, triangles, sizeof *pairs->whole);
    if (work->no_memory || !polygon_begin(&cut, work, old)) return true;
    memset(pairs->mate, 0xff, triangles * sizeof *pairs->mate);
    memset(pairs->whole, 0xff, triangles * sizeof *pairs->whole);
    for (uint32_t f = 0; f < old->count; f++) {
        if (old->first[f + 1] - old->first[f] == 4) cut_quad(pairs, f, &out);
        else if (!cut_polygon(pairs, &cut, f, ring, &out)) return false;
    }
    work->faces = out;
    return true;
}

/// The half-edge of the same diagonal in the other triangle of its face.
static uint32_t other_side(const Pairs *pairs, uint32_t half) {
    const uint32_t *from = pairs->from, face = pairs->before_face[from[half]], count = pairs->work->faces.corner_count;
    uint32_t a = from[half], b = from[half - half % 3 + (half + 1) % 3], low = half - half % 3, high = low + 3;
    while (low > 0 && pairs->before_face[from[low - 1]] == face) low -= 3;
    while (high < count && pairs->before_face[from[high]] == face) high += 3;
    for (uint32_t h = low; h < high; h++)
        if (from[h] == b && from[h - h % 3 + (h + 1) % 3] == a) return h;
    return MESH_NONE;
}

// By half-edges and not by vertices, since a diagonal may have the same ends as another side.
void pair_find_twins(Pairs *pairs) {
    Work *work = pairs->work;
    const uint32_t count = work->faces.corner_count, *from = pairs->from;
    uint32_t *side = work_new(work, pairs->before.corner_count, sizeof *side);
    work->face = work_new(work, count, sizeof *work->face);
    work->twin = work_new(work, count, sizeof *work->twin);
    if (work->no_memory) return;
    for (int fill = 0; fill < 2; fill++)
        for (uint32_t h = 0; h < count; h++) {
            uint32_t a = from[h], b = from[h - h % 3 + (h + 1) % 3];
            bool outer = faces_next(&pairs->before, pairs->before_face, a) == b;
            work->face[h] = h / 3;
            if (!fill && outer) side[a] = h;
            else if (fill && outer && pairs->before_twin[a] == MESH_NONE) work->twin[h] = MESH_NONE;
            else if (fill && outer) work->twin[h] = side[pairs->before_twin[a]];
            else if (fill) work->twin[h] = other_side(pairs, h);
        }
}
