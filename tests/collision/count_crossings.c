#include "count_crossings.h"

#include <stdlib.h>

typedef struct Point {
    double x[3];
} Point;

static Point minus(Point a, Point b) {
    for (int i = 0; i < 3; i++) a.x[i] -= b.x[i];
    return a;
}

static double dot(Point a, Point b) { return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2]; }

static Point cross(Point a, Point b) {
    return (Point){
        {a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2], a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

/// Six times the volume of a tetrahedron.
static double volume(Point a, Point b, Point c, Point d) { return dot(cross(minus(b, a), minus(c, a)), minus(d, a)); }

static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }

/// Segment p-q strictly through triangle t. In a plane the volumes are rounding errors; the boxes tell what is apart.
static bool pierces(Point p, Point q, const Point t[3]) {
    for (int k = 0; k < 3; k++) {
        const double low = least(least(t[0].x[k], t[1].x[k]), t[2].x[k]);
        const double high = most(most(t[0].x[k], t[1].x[k]), t[2].x[k]);
        if (most(p.x[k], q.x[k]) < low || least(p.x[k], q.x[k]) > high) return false;
    }

    if ((volume(t[0], t[1], t[2], p) > 0) == (volume(t[0], t[1], t[2], q) > 0)) return false;
    const bool first = volume(p, q, t[0], t[1]) > 0;
    return first == (volume(p, q, t[1], t[2]) > 0) && first == (volume(p, q, t[2], t[0]) > 0);
}

static bool has(const uint32_t t[3], uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

static bool triangles_cross(const SingeSurface *s, const uint32_t a[3], const uint32_t b[3]) {
    Point p[3], q[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) p[i].x[k] = (double)s->position[a[i]][k], q[i].x[k] = (double)s->position[b[i]][k];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if (!has(b, a[i]) && !has(b, a[j]) && pierces(p[i], p[j], q)) return true;
        if (!has(a, b[i]) && !has(a, b[j]) && pierces(q[i], q[j], p)) return true;
    }

    return false;
}

typedef struct Box {
    float low[3], high[3];
    uint32_t triangle;
} Box;

static int by_x(const void *a, const void *b) {
    float x = ((const Box *)a)->low[0], y = ((const Box *)b)->low[0];
    return (x > y) - (x < y);
}

long crossings_count(const SingeSurface *s) {
    Box *boxes = malloc((s->triangle_count + 1) * sizeof *boxes);
    long found = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        Box *box = &boxes[t];
        box->triangle = t;
        for (int k = 0; k < 3; k++) {
            box->low[k] = box->high[k] = s->position[s->triangles[t][0]][k];
            for (int i = 1; i < 3; i++) {
                float x = s->position[s->triangles[t][i]][k];
                if (x < box->low[k]) box->low[k] = x;
                if (x > box->high[k]) box->high[k] = x;
            }
        }
    }

    qsort(boxes, s->triangle_count, sizeof *boxes, by_x);
    for (uint32_t i = 0; i < s->triangle_count; i++)
        for (uint32_t j = i + 1; j < s->triangle_count && boxes[j].low[0] <= boxes[i].high[0]; j++) {
            const Box *a = &boxes[i], *b = &boxes[j];
            bool apart =
                a->low[1] > b->high[1] || b->low[1] > a->high[1] || a->low[2] > b->high[2] || b->low[2] > a->high[2];
            if (!apart) found += triangles_cross(s, s->triangles[a->triangle], s->triangles[b->triangle]);
        }
    free(boxes);
    return found;
}
