// Zippers: a fold that is oblique to the rows of cells looks like a saw if cells are drawn with facets, in shading and
// in silhouette. Along a fold little should change within a few cells. So the change is measured there, of the unit
// normal N over the sheet at rest (rest_raster.h), with c the length of the mesh's cells:
//
//   folds   where N, smoothed by a Gaussian of one c, turns by more than 10 degrees in c; their direction is that
//           in which it turns least (the matrix J of wrinkles.c)
//   N'      N on a line of 6 c along the fold, 8 samples a cell, less its mean under a Hann window of 3 c
//
// The measure is the root mean square of |N'| over the middle 3 c of all lines that are on the sheet, at least 3 c from
// its border and from burnt parts.
#include "analysis/folds.h"

#include <math.h>
#include <stdlib.h>

#include "analysis/rest_raster.h"

enum { SAMPLES_A_CELL = 8, WINDOW = 24, LINE = 48, MIDDLE = LINE - WINDOW, SHEETS_MAX = UINT16_MAX };

static const double turn_min = 0.1745, far_off = 3; ///< rad in a cell; cells
static const float burnt_min = 0.02f;

/// Length of the sheet's cells, m: its area at rest over the vertices of the input that are drawn.
static double cell_length(const SingeSurface *surface, int32_t sheet) {
    double area = 0, vertices = 0;
    for (uint32_t v = 0; v < surface->vertex_count; v++)
        vertices += surface->sheet[v] == sheet && surface->source_vertex[v] >= 0;
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *at = surface->triangles[t];
        double a[3], b[3], square = 0;
        if (surface->sheet[at[0]] != sheet) continue;
        for (int k = 0; k < 3; k++) {
            a[k] = (double)surface->rest_position[at[1]][k] - (double)surface->rest_position[at[0]][k];
            b[k] = (double)surface->rest_position[at[2]][k] - (double)surface->rest_position[at[0]][k];
        }
        for (int k = 0; k < 3; k++) square += pow(a[k] * b[(k + 1) % 3] - a[(k + 1) % 3] * b[k], 2);
        area += 0.5 * sqrt(square);
    }
    return vertices > 0 ? sqrt(area / vertices) : 0;
}

typedef struct Work {
    const RestRaster *raster;
    float *scratch, *weight, *smooth[3], *distance; ///< scratch: two fields; distance: m, to pixels that do not count
} Work;

static bool work_make(const RestRaster *raster, Work *work) {
    size_t pixels = (size_t)raster->width * (size_t)raster->height;
    *work = (Work){.raster = raster, .scratch = calloc(7 * pixels, sizeof *work->scratch)};
    if (!work->scratch) return false;
    work->weight = work->scratch + 2 * pixels;
    work->distance = work->scratch + 3 * pixels;
    for (size_t k = 0; k < 3; k++) work->smooth[k] = work->scratch + (4 + k) * pixels;
    return true;
}

/// Whether the normal turns enough at pixel p, inside the raster. `along` gets the direction along the fold, in pixels.
static bool fold_at(const Work *work, int p, double cell, double along[2]) {
    const int w = work->raster->width;
    const double step = 2 * work->raster->spacing;
    double xx = 0, xy = 0, yy = 0;
    for (int k = 0; k < 3; k++) {
        const float *n = work->smooth[k];
        double x = ((double)n[p + 1] - (double)n[p - 1]) / step, y = ((double)n[p + w] - (double)n[p - w]) / step;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    double across = 0.5 * atan2(2 * xy, xx - yy), bend = sqrt(0.5 * (xx + yy) + hypot(0.5 * (xx - yy), xy));
    along[0] = -sin(across), along[1] = cos(across);
    return bend * cell > turn_min;
}

/// N at a position between pixels. False if one of them does not count.
static bool normal_at(const Work *work, double x, double y, double normal[3]) {
    const RestRaster *raster = work->raster;
    int i = (int)floor(x), j = (int)floor(y);
    if (i < 0 || j < 0 || i + 1 >= raster->width || j + 1 >= raster->height) return false;
    double u = x - i, v = y - j, weight[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    normal[0] = normal[1] = normal[2] = 0;
    for (int corner = 0; corner < 4; corner++) {
        int p = (j + corner / 2) * raster->width + i + corner % 2;
        if (!(work->distance[p] > 0)) return false;
        for (int k = 0; k < 3; k++) normal[k] += weight[corner] * (double)raster->normal[k][p];
    }
    return true;
}

/// Adds the line through pixel (i, j), if all of it counts. `step` is between samples, in pixels.
static void add_line(const Work *work, int i, int j, const double along[2], double step, Folds *folds) {
    double normal[LINE][3], power = 0;
    for (int n = 0; n < LINE; n++) {
        double s = (n - 0.5 * (LINE - 1)) * step;
        if (!normal_at(work, i + s * along[0], j + s * along[1], normal[n])) return;
    }
    for (int n = 0; n < MIDDLE; n++)
        for (int k = 0; k < 3; k++) {
            double mean = 0, total = 0;
            for (int m = 0; m <= WINDOW; m++) {
                double weight = 1 - cos(2 * acos(-1) * m / WINDOW);
                if (n + m < LINE) {
                    mean += weight * normal[n + m][k];
                    total += weight;
                }
            }
            power += pow(normal[n + WINDOW / 2][k] - mean / total, 2);
        }
    folds->power += power / MIDDLE;
    folds->count += 1;
}

/// Distance to burnt pixels and to the border of the sheet, minus `far_off` cells. From then on, pixels that are not
/// covered count as burnt.
static void find_distances(RestRaster *raster, float *distance, double cell) {
    const int pixels = raster->width * raster->height;
    for (int p = 0; p < pixels; p++)
        if (!(raster->cover[p] > 0)) raster->cover[p] = raster->burn[p] = 1;
    rest_raster_distance(raster, burnt_min, distance);
    for (int p = 0; p < pixels; p++) distance[p] -= (float)(far_off * cell);
}

static bool folds_add_sheet(const SingeSurface *surface, int32_t sheet, Folds *folds) {
    const double cell = cell_length(surface, sheet);
    RestRaster raster;
    Work work;
    if (!(cell > 0)) return true;
    if (!rest_raster_draw(surface, sheet, cell / SAMPLES_A_CELL, &raster)) return false;
    if (raster.width == 0) return true;
    bool good = work_make(&raster, &work);
    for (int k = 0; k < 3 && good; k++)
        rest_raster_smooth(&raster, raster.normal[k], cell, work.scratch, work.weight, work.smooth[k]);
    if (good) find_distances(&raster, work.distance, cell);
    const double step = cell / SAMPLES_A_CELL / raster.spacing;
    for (int j = SAMPLES_A_CELL; good && j + SAMPLES_A_CELL < raster.height; j += SAMPLES_A_CELL / 2)
        for (int i = SAMPLES_A_CELL; i + SAMPLES_A_CELL < raster.width; i += SAMPLES_A_CELL / 2) {
            double along[2];
            int p = j * raster.width + i;
            if (work.distance[p] > 0 && fold_at(&work, p, cell, along)) add_line(&work, i, j, along, step, folds);
        }
    free(work.scratch);
    rest_raster_free(&raster);
    return good;
}

bool folds_add(const SingeSurface *surface, Folds *folds) {
    bool *there = calloc(SHEETS_MAX, sizeof *there), good = there != NULL;
    for (uint32_t v = 0; good && v < surface->vertex_count; v++)
        if (surface->sheet[v] >= 0 && surface->sheet[v] < SHEETS_MAX) there[surface->sheet[v]] = true;
    for (int32_t sheet = 0; good && sheet < SHEETS_MAX; sheet++)
        if (there[sheet]) good = folds_add_sheet(surface, sheet, folds);
    free(there);
    return good;
}

double folds_angle(const Folds *folds) {
    return folds->count > 0 ? sqrt(folds->power / folds->count) * 180 / acos(-1) : (double)NAN;
}
