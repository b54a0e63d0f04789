#include "formats/uv_raster.h"

#include <math.h>

/// Twice the area of a, b, c; positive where they turn one way.
static double uv_turn(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The first and the last pixel whose centre may lie between low and high.
static void uv_span(double low, double high, int size, int *first, int *last) {
    low = ceil(low - 0.5 - 1e-6);
    high = floor(high - 0.5 + 1e-6);
    *first = low > 0 ? (low < size ? (int)low : size) : 0;
    *last = high < size - 1 ? (high >= 0 ? (int)high : -1) : size - 1;
}

void uv_triangle(int size, const float uv[3][2], UvPixel *draw, void *context) {
    double p[3][2], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        p[i][0] = (double)uv[i][0] * size;
        p[i][1] = (1 - (double)uv[i][1]) * size;
        for (int k = 0; k < 2; k++) low[k] = fmin(low[k], p[i][k]), high[k] = fmax(high[k], p[i][k]);
    }

    const double area = uv_turn(p[0], p[1], p[2]);
    int x0, x1, y0, y1;
    if (!(fabs(area) > 0) || !isfinite(area)) return;
    uv_span(low[0], high[0], size, &x0, &x1), uv_span(low[1], high[1], size, &y0, &y1);

    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            const double c[2] = {x + 0.5, y + 0.5};
            const double w[3] = {uv_turn(c, p[1], p[2]) / area, uv_turn(p[0], c, p[2]) / area,
                                 uv_turn(p[0], p[1], c) / area};

            // a centre on a side, within rounding, is in both triangles rather than in none
            if (w[0] < -1e-3 || w[1] < -1e-3 || w[2] < -1e-3) continue;
            const float weight[3] = {(float)w[0], (float)w[1], (float)w[2]};
            draw(context, (size_t)y * (size_t)size + (size_t)x, weight);
        }
}

void uv_spread(int size, int reach, const uint8_t *covered, uint32_t *nearest, uint32_t *queue) {
    const size_t side = (size_t)size, count = side * side;
    size_t begin = 0, end = 0;

    for (size_t i = 0; i < count; i++) {
        nearest[i] = covered[i] ? (uint32_t)i : UV_NONE;
        if (covered[i]) queue[end++] = (uint32_t)i;
    }

    for (int ring = 0; ring < reach; ring++) {
        const size_t last = end;
        for (; begin < last; begin++) {
            const uint32_t at = queue[begin];
            const size_t x = at % side, y = at / side;
            const uint32_t next[4] = {at - 1, at + 1, at - (uint32_t)side, at + (uint32_t)side};
            const bool inside[4] = {x > 0, x + 1 < side, y > 0, y + 1 < side};
            for (int k = 0; k < 4; k++) {
                if (!inside[k] || nearest[next[k]] != UV_NONE) continue;
                nearest[next[k]] = nearest[at];
                queue[end++] = next[k];
            }
        }
    }
}
