#include "analysis/rest_raster.h"

#include "common/float3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// The raster is rotated by a sixteenth of a turn from the mesh's sides and diagonals, and so favours neither.
static const double turned = 0.39269908169872414;

/// Max pixels per side; they are made larger to stay below it.
enum { SIDE_MAX = 4096 };

/// The plane of the raster: pixel (x, y) is origin + spacing (x e1 + y e2).
typedef struct Plane {
    double origin[3], e1[3], e2[3];
} Plane;

/// Finds the rotated axes of the sheet's plane; the origin is some point of the sheet.
static bool find_plane(const SingeSurface *surface, int32_t sheet, Plane *plane) {
    double normal[3] = {0}, along[3] = {0}, across[3]; // sums of twice the areas; `along` in the direction of growing u
    for (uint32_t f = 0; f < surface->triangle_count; f++) {
        const uint32_t *t = surface->triangles[f];
        double a[3], b[3], own[3], d[3], u[2], v[2];
        if (surface->sheet[t[0]] != sheet) continue;

        for (int k = 0; k < 3; k++) {
            plane->origin[k] = (double)surface->rest_position[t[0]][k];
            a[k] = (double)surface->rest_position[t[1]][k] - plane->origin[k];
            b[k] = (double)surface->rest_position[t[2]][k] - plane->origin[k];
        }

        cross3(a, b, own);
        for (int k = 0; k < 3; k++) normal[k] += own[k];

        for (int i = 0; i < 2; i++) {
            u[i] = (double)surface->uv[t[i + 1]][0] - (double)surface->uv[t[0]][0];
            v[i] = (double)surface->uv[t[i + 1]][1] - (double)surface->uv[t[0]][1];
        }

        const double turn = u[0] * v[1] - u[1] * v[0];
        for (int k = 0; k < 3; k++) d[k] = (v[1] * a[k] - v[0] * b[k]) * (turn < 0 ? -1 : 1);
        if (turn == 0 || !unit3(d)) continue;
        for (int k = 0; k < 3; k++) along[k] += d[k] * sqrt(dot3(own, own));
    }

    if (!unit3(normal)) return false;

    double lift = dot3(along, normal);
    for (int k = 0; k < 3; k++) along[k] -= lift * normal[k];

    if (!unit3(along)) { // no uv: x, or y if x is too close to the normal
        int axis = fabs(normal[0]) < 0.9 ? 0 : 1;
        for (int k = 0; k < 3; k++) along[k] = (k == axis) - normal[axis] * normal[k];
        unit3(along);
    }

    cross3(normal, along, across);
    for (int k = 0; k < 3; k++) {
        plane->e1[k] = cos(turned) * along[k] + sin(turned) * across[k];
        plane->e2[k] = cos(turned) * across[k] - sin(turned) * along[k];
    }

    return true;
}

static void project(const SingeSurface *surface, const Plane *plane, uint32_t v, double *x, double *y) {
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = (double)surface->rest_position[v][k] - plane->origin[k];
    *x = dot3(d, plane->e1);
    *y = dot3(d, plane->e2);
}

/// Sets the pixels whose centres a triangle covers.
static void fill_triangle(const SingeSurface *surface, const Plane *plane, const uint32_t *t, RestRaster *raster) {
    double x[3], y[3];
    for (int i = 0; i < 3; i++) {
        project(surface, plane, t[i], &x[i], &y[i]);
        x[i] /= raster->spacing;
        y[i] /= raster->spacing;
    }

    double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area == 0) return;

    int left = (int)ceil(fmin(fmin(x[0], x[1]), x[2])), right = (int)floor(fmax(fmax(x[0], x[1]), x[2]));
    int low = (int)ceil(fmin(fmin(y[0], y[1]), y[2])), high = (int)floor(fmax(fmax(y[0], y[1]), y[2]));
    for (int j = low < 0 ? 0 : low; j <= high && j < raster->height; j++)
        for (int i = left < 0 ? 0 : left; i <= right && i < raster->width; i++) {
            double weight[3];
            weight[1] = ((i - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (j - y[0])) / area;
            weight[2] = ((x[1] - x[0]) * (j - y[0]) - (i - x[0]) * (y[1] - y[0])) / area;
            weight[0] = 1 - weight[1] - weight[2];
            if (weight[0] < -1e-9 || weight[1] < -1e-9 || weight[2] < -1e-9) continue;

            double normal[3] = {0}, burn = 0, unlit = 0;
            for (int c = 0; c < 3; c++) {
                for (int k = 0; k < 3; k++) normal[k] += weight[c] * (double)surface->normal[t[c]][k];
                burn += weight[c] * (double)surface->burn[t[c]];
                unlit += weight[c] * (surface->time_ignited[t[c]] < 0);
            }

            if (!unit3(normal)) continue;
            const int p = j * raster->width + i;
            for (int k = 0; k < 3; k++) raster->normal[k][p] = (float)normal[k];
            raster->cover[p] = 1;
            raster->burn[p] = (float)burn;
            raster->unlit[p] = unlit > 0.99;
        }
}

bool rest_raster_draw(const SingeSurface *surface, int32_t sheet, double spacing, RestRaster *raster) {
    Plane plane;
    *raster = (RestRaster){.spacing = spacing, .turn = turned};
    if (!find_plane(surface, sheet, &plane)) return true;

    // the origin moves to the lower corner of the area that the sheet covers
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, at[2];
    for (uint32_t v = 0; v < surface->vertex_count; v++) {
        if (surface->sheet[v] != sheet) continue;
        project(surface, &plane, v, &at[0], &at[1]);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }

    raster->spacing = fmax(spacing, fmax(high[0] - low[0], high[1] - low[1]) / (SIDE_MAX - 2));
    raster->width = (int)((high[0] - low[0]) / raster->spacing) + 2;
    raster->height = (int)((high[1] - low[1]) / raster->spacing) + 2;
    for (int k = 0; k < 3; k++) plane.origin[k] += low[0] * plane.e1[k] + low[1] * plane.e2[k];

    size_t pixels = (size_t)raster->width * (size_t)raster->height;
    raster->cover = calloc(6 * pixels, sizeof *raster->cover); // all fields in one block
    if (!raster->cover) return false;

    for (int k = 0; k < 3; k++) raster->normal[k] = raster->cover + (size_t)(k + 1) * pixels;
    raster->burn = raster->cover + 4 * pixels;
    raster->unlit = raster->cover + 5 * pixels;

    for (uint32_t f = 0; f < surface->triangle_count; f++)
        if (surface->sheet[surface->triangles[f][0]] == sheet)
            fill_triangle(surface, &plane, surface->triangles[f], raster);
    return true;
}

void rest_raster_free(RestRaster *raster) {
    free(raster->cover);
    *raster = (RestRaster){0};
}

// ---- filters

enum { REACH_MAX = 64 };

/// Adds another line, times `share`, to a line.
static void line_add(float *restrict to, const float *restrict from, float share, int count) {
    for (int i = 0; i < count; i++) to[i] += share * from[i];
}

/// The part of a line that is not zero. A strip that lies across its raster covers little of each line.
static void line_part(const float *line, int width, int part[2]) {
    part[0] = 0;
    part[1] = width;
    while (part[0] < width && line[part[0]] == 0) part[0]++;
    while (part[1] > part[0] && line[part[1] - 1] == 0) part[1]--;
}

static void blur_rows(const float *from, float *to, int width, int height, const float *kernel, int reach) {
    for (int j = 0; j < height; j++) {
        const float *line = from + (size_t)j * (size_t)width;
        float *sum = to + (size_t)j * (size_t)width;
        int part[2];
        line_part(line, width, part);
        memset(sum, 0, (size_t)width * sizeof *sum);

        for (int k = -reach; k <= reach; k++) {
            const int begin = part[0] + k < 0 ? -k : part[0], end = part[1] + k > width ? width - k : part[1];
            if (begin < end) line_add(sum + begin + k, line + begin, kernel[abs(k)], end - begin);
        }
    }
}

/// Also row by row, to read memory in its order.
static void blur_columns(const float *from, float *to, int width, int height, const float *kernel, int reach) {
    memset(to, 0, (size_t)width * (size_t)height * sizeof *to);
    for (int j = 0; j < height; j++) {
        const float *line = from + (size_t)j * (size_t)width;
        int part[2];
        line_part(line, width, part);
        for (int k = j < reach ? -j : -reach; k <= reach && j + k < height; k++)
            line_add(to + (size_t)(j + k) * (size_t)width + part[0], line + part[0], kernel[abs(k)], part[1] - part[0]);
    }
}

void rest_raster_smooth(const RestRaster *raster, const float *field, double deviation, float *scratch, float *weight,
                        float *smooth) {
    const int width = raster->width, height = raster->height;
    const size_t pixels = (size_t)width * (size_t)height;
    float kernel[REACH_MAX + 1], *covered = scratch + pixels;
    const double pixel = deviation / raster->spacing;
    int reach = (int)ceil(3 * pixel);
    reach = reach < REACH_MAX ? reach : REACH_MAX;

    double total = 1;
    for (int k = 1; k <= reach; k++) total += 2 * exp(-0.5 * k * k / (pixel * pixel));
    for (int k = 0; k <= reach; k++) kernel[k] = (float)(exp(-0.5 * k * k / (pixel * pixel)) / total);

    for (size_t p = 0; p < pixels; p++) covered[p] = field[p] * raster->cover[p];
    blur_rows(covered, scratch, width, height, kernel, reach);
    blur_columns(scratch, smooth, width, height, kernel, reach);
    blur_rows(raster->cover, scratch, width, height, kernel, reach);
    blur_columns(scratch, weight, width, height, kernel, reach);
    for (size_t p = 0; p < pixels; p++) smooth[p] = weight[p] > 0 ? smooth[p] / weight[p] : 0;
}

/// Chamfer distances: Borgefors, Distance transformations in digital images, 1986.
static void nearer(float *distance, size_t p, size_t other, float step) {
    if (distance[other] + step < distance[p]) distance[p] = distance[other] + step;
}

void rest_raster_distance(const RestRaster *raster, float min, float *distance) {
    const int width = raster->width, height = raster->height;
    const float side = (float)raster->spacing, across = 1.4142135f * side;
    const size_t w = (size_t)width;

    for (size_t p = 0; p < w * (size_t)height; p++)
        distance[p] = raster->cover[p] > 0 && raster->burn[p] > min ? 0 : INFINITY;

    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            size_t p = (size_t)j * w + (size_t)i;
            if (i > 0) nearer(distance, p, p - 1, side);
            if (j > 0) nearer(distance, p, p - w, side);
            if (j > 0 && i > 0) nearer(distance, p, p - w - 1, across);
            if (j > 0 && i + 1 < width) nearer(distance, p, p - w + 1, across);
        }

    for (int j = height; j-- > 0;)
        for (int i = width; i-- > 0;) {
            size_t p = (size_t)j * w + (size_t)i;
            if (i + 1 < width) nearer(distance, p, p + 1, side);
            if (j + 1 < height) nearer(distance, p, p + w, side);
            if (j + 1 < height && i + 1 < width) nearer(distance, p, p + w + 1, across);
            if (j + 1 < height && i > 0) nearer(distance, p, p + w - 1, across);
        }
}
