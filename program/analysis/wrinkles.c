// All measures use the unit normal N over the sheet at rest, on pixels that are independent of the mesh
// (rest_raster.h).
//
// Creases. N is smoothed by a Gaussian of 2 mm to hide facets. The matrix
//
//   J_ij = sum over k of dN_k/dx_i dN_k/dx_j
//
// has the squares of the two principal bends as eigenvalues, and the direction across a crease is that of the larger.
// The weight of a pixel is its area times the difference of the bends: round spots have no direction.
//
// Roughness. The band of wavelengths from 3 to 15 mm is the difference of N smoothed by Gaussians that halve waves of 3
// and of 15 mm: deviation = wavelength sqrt(2 ln 2)/(2 pi). Its square is the square of an angle.
//
// Zippers. A fold that is oblique to the rows of cells looks like a saw if cells are drawn with facets, in shading and
// in silhouette. Along a fold little should change within a few cells. So the change of N is
// measured there, with c the length of the mesh's cells:
//
//   folds   where N, smoothed by a Gaussian of one c, turns by more than 10 degrees in c; their direction is that
//           in which it turns least (the matrix J)
//   N'      N on a line of 6 c along the fold, 8 samples a cell, less its mean under a Hann window of 3 c
//
// The measure is the root mean square of |N'| over the middle 3 c of all lines that are on the sheet, at least 3 c from
// its border and from burnt parts.
#include "analysis/wrinkles.h"

#include <math.h>
#include <stdlib.h>

#include "analysis/rest_raster.h"
#include "common/float3.h"

/// m
static const double spacing = 0.75e-3, crease_deviation = 2e-3;
static const double band_short = 3e-3, band_long = 15e-3;
static const float around_burnt = 0.010f, far_from_burnt = 0.025f;

/// Burn progress above which a pixel counts as burnt: of roughness, and of folds.
static const float burnt_min = 0.05f, fold_burnt_min = 0.02f;

/// Min share of a Gaussian that must be covered: next to an edge, a Gaussian with less is not trusted.
static const float covered_min = 0.6f;

/// 1/m, of bends.
static const double gentle_max = 50, sharp_min = 130;

/// Of folds: rad in a cell; cells.
static const double turn_min = 0.1745, far_off = 3;

enum { SAMPLES_A_CELL = 8, WINDOW = 24, LINE = 48, MIDDLE = LINE - WINDOW, SHEETS_MAX = UINT16_MAX };

/// Room for the fields of one sheet; scratch is two.
typedef struct Fields {
    float *scratch, *weight, *smooth[3], *rough[3], *distance;
} Fields;

static bool fields_make(const RestRaster *raster, Fields *fields) {
    const size_t pixels = (size_t)raster->width * (size_t)raster->height;
    fields->scratch = calloc(10 * pixels, sizeof *fields->scratch);
    if (!fields->scratch) return false;

    fields->weight = fields->scratch + 2 * pixels;
    fields->distance = fields->scratch + 3 * pixels;
    for (size_t k = 0; k < 3; k++) {
        fields->smooth[k] = fields->scratch + (4 + k) * pixels;
        fields->rough[k] = fields->scratch + (7 + k) * pixels;
    }

    return true;
}

/// The matrix J at pixel p, from the smoothed normal.
static void bends_at(const RestRaster *raster, const Fields *fields, int p, double *xx, double *xy, double *yy) {
    const int w = raster->width;
    const double step = 2 * raster->spacing;

    *xx = *xy = *yy = 0;
    for (int k = 0; k < 3; k++) {
        const float *n = fields->smooth[k];
        double x = ((double)n[p + 1] - (double)n[p - 1]) / step, y = ((double)n[p + w] - (double)n[p - w]) / step;
        *xx += x * x;
        *xy += x * y;
        *yy += y * y;
    }
}

/// Calls `add` for each sheet that the surface shows. False when out of memory.
static bool each_sheet(const SingeSurface *surface, bool (*add)(const SingeSurface *, int32_t, void *), void *sums) {
    bool *there = calloc(SHEETS_MAX, sizeof *there), good = there != NULL;
    for (uint32_t v = 0; good && v < surface->vertex_count; v++)
        if (surface->sheet[v] >= 0 && surface->sheet[v] < SHEETS_MAX) there[surface->sheet[v]] = true;
    for (int32_t sheet = 0; good && sheet < SHEETS_MAX; sheet++)
        if (there[sheet]) good = add(surface, sheet, sums);
    free(there);
    return good;
}

// ---- creases and roughness

static void add_creases(const RestRaster *raster, Fields *fields, Wrinkles *wrinkles) {
    const int w = raster->width;
    const double area = raster->spacing * raster->spacing, pi = acos(-1), quarter = pi / 2;
    for (int k = 0; k < 3; k++)
        rest_raster_smooth(raster, raster->normal[k], crease_deviation, fields->scratch, fields->weight,
                           fields->smooth[k]);

    for (int j = 1; j + 1 < raster->height; j++)
        for (int i = 1; i + 1 < w; i++) {
            const int p = j * w + i;
            const float *cover = raster->cover;
            if (!(cover[p] * cover[p - 1] * cover[p + 1] * cover[p - w] * cover[p + w] > 0)) continue;
            if (fields->weight[p] < covered_min) continue;

            double xx, xy, yy;
            bends_at(raster, fields, p, &xx, &xy, &yy);
            const double half = hypot(0.5 * (xx - yy), xy), mean = 0.5 * (xx + yy);
            const double weight = area * (sqrt(mean + half) - sqrt(fmax(mean - half, 0)));

            // its direction, rad from that of growing u
            double along = 0.5 * atan2(2 * xy, xx - yy) + raster->turn + quarter;
            along -= pi * floor(along / pi);
            const int bin = (int)(along / pi * WRINKLE_BINS);
            wrinkles->crease[bin < WRINKLE_BINS ? bin : WRINKLE_BINS - 1] += weight;
            double off = fabs(along - quarter * round(along / quarter)); // from the nearest axis, at most pi/4
            const bool diagonal = off >= pi / 4 - pi / 16;
            if (off > pi / 16 && !diagonal) continue;
            *(diagonal ? &wrinkles->diagonal : &wrinkles->axis) += weight;
            const double bend = sqrt(mean + half);
            if (bend < gentle_max) wrinkles->gentle[diagonal] += weight;
            if (bend > sharp_min) wrinkles->sharp[diagonal] += weight;
        }
}

static void add_roughness(const RestRaster *raster, Fields *fields, Wrinkles *wrinkles) {
    const double share = sqrt(2 * log(2)) / (2 * acos(-1)), area = raster->spacing * raster->spacing;
    for (int k = 0; k < 3; k++)
        rest_raster_smooth(raster, raster->normal[k], share * band_short, fields->scratch, fields->weight,
                           fields->rough[k]);
    for (int k = 0; k < 3; k++)
        rest_raster_smooth(raster, raster->normal[k], share * band_long, fields->scratch, fields->weight,
                           fields->smooth[k]);

    rest_raster_distance(raster, burnt_min, fields->distance);
    for (int p = 0; p < raster->width * raster->height; p++) {
        if (!(raster->cover[p] > 0) || fields->weight[p] < covered_min) continue;

        double square = 0;
        for (int k = 0; k < 3; k++) square += pow((double)fields->rough[k][p] - (double)fields->smooth[k][p], 2);

        if (fields->distance[p] <= around_burnt) {
            wrinkles->burnt_power += square * area;
            wrinkles->burnt_area += area;
        } else if (fields->distance[p] >= far_from_burnt && raster->unlit[p] > 0) {
            wrinkles->unburnt_power += square * area;
            wrinkles->unburnt_area += area;
        }
    }
}

static bool wrinkles_add_sheet(const SingeSurface *surface, int32_t sheet, void *sums) {
    RestRaster raster;
    Fields fields = {0};
    if (!rest_raster_draw(surface, sheet, spacing, &raster)) return false;
    if (raster.width == 0) return true;

    const bool good = fields_make(&raster, &fields);
    if (good) {
        add_creases(&raster, &fields, sums);
        add_roughness(&raster, &fields, sums);
    }
    free(fields.scratch);
    rest_raster_free(&raster);
    return good;
}

bool wrinkles_add(const SingeSurface *surface, Wrinkles *wrinkles) {
    return each_sheet(surface, wrinkles_add_sheet, wrinkles);
}

static double over(double a, double b) { return b > 0 ? a / b : (double)NAN; }

double wrinkles_bias(const Wrinkles *wrinkles) { return over(wrinkles->axis, wrinkles->diagonal); }
double wrinkles_bias_gentle(const Wrinkles *wrinkles) { return over(wrinkles->gentle[0], wrinkles->gentle[1]); }
double wrinkles_bias_sharp(const Wrinkles *wrinkles) { return over(wrinkles->sharp[0], wrinkles->sharp[1]); }
double wrinkles_burnt(const Wrinkles *wrinkles) { return over(wrinkles->burnt_power, wrinkles->burnt_area); }
double wrinkles_unburnt(const Wrinkles *wrinkles) { return over(wrinkles->unburnt_power, wrinkles->unburnt_area); }

// ---- folds

/// N at a position between pixels. False if one of them does not count.
static bool normal_at(const RestRaster *raster, const Fields *fields, double x, double y, double normal[3]) {
    int i = (int)floor(x), j = (int)floor(y);
    if (i < 0 || j < 0 || i + 1 >= raster->width || j + 1 >= raster->height) return false;

    double u = x - i, v = y - j, weight[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    normal[0] = normal[1] = normal[2] = 0;
    for (int corner = 0; corner < 4; corner++) {
        int p = (j + corner / 2) * raster->width + i + corner % 2;
        if (!(fields->distance[p] > 0)) return false;
        for (int k = 0; k < 3; k++) normal[k] += weight[corner] * (double)raster->normal[k][p];
    }

    return true;
}

/// Adds the line through pixel (i, j), if all of it counts. `step` is between samples, in pixels.
static void add_line(const RestRaster *raster, const Fields *fields, int i, int j, const double along[2], double step,
                     Folds *folds) {
    double normal[LINE][3], power = 0;
    for (int n = 0; n < LINE; n++) {
        double s = (n - 0.5 * (LINE - 1)) * step;
        if (!normal_at(raster, fields, i + s * along[0], j + s * along[1], normal[n])) return;
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

static bool folds_add_sheet(const SingeSurface *surface, int32_t sheet, void *sums) {
    RestRaster raster;
    Fields fields = {0};

    // the length of the sheet's cells: its area at rest over the vertices of the input that are drawn
    double area = 0, vertices = 0;
    for (uint32_t v = 0; v < surface->vertex_count; v++)
        vertices += surface->sheet[v] == sheet && surface->source_vertex[v] >= 0;

    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *at = surface->triangles[t];
        double twice[3];
        if (surface->sheet[at[0]] != sheet) continue;
        area3(surface->rest_position[at[0]], surface->rest_position[at[1]], surface->rest_position[at[2]], twice);
        area += 0.5 * sqrt(dot3(twice, twice));
    }

    const double cell = vertices > 0 ? sqrt(area / vertices) : 0;
    if (!(cell > 0)) return true;

    if (!rest_raster_draw(surface, sheet, cell / SAMPLES_A_CELL, &raster)) return false;
    if (raster.width == 0) return true;

    const bool good = fields_make(&raster, &fields);
    for (int k = 0; k < 3 && good; k++)
        rest_raster_smooth(&raster, raster.normal[k], cell, fields.scratch, fields.weight, fields.smooth[k]);

    // distance to burnt pixels and to the border of the sheet, beyond which pixels count as burnt
    for (int p = 0; p < raster.width * raster.height && good; p++)
        if (!(raster.cover[p] > 0)) raster.cover[p] = raster.burn[p] = 1;
    if (good) rest_raster_distance(&raster, fold_burnt_min, fields.distance);
    for (int p = 0; p < raster.width * raster.height && good; p++) fields.distance[p] -= (float)(far_off * cell);

    const double step = cell / SAMPLES_A_CELL / raster.spacing;
    for (int j = SAMPLES_A_CELL; good && j + SAMPLES_A_CELL < raster.height; j += SAMPLES_A_CELL / 2)
        for (int i = SAMPLES_A_CELL; i + SAMPLES_A_CELL < raster.width; i += SAMPLES_A_CELL / 2) {
            const int p = j * raster.width + i;
            if (!(fields.distance[p] > 0)) continue;
            double xx, xy, yy;
            bends_at(&raster, &fields, p, &xx, &xy, &yy);
            const double across = 0.5 * atan2(2 * xy, xx - yy), along[2] = {-sin(across), cos(across)};
            const double bend = sqrt(0.5 * (xx + yy) + hypot(0.5 * (xx - yy), xy));
            if (bend * cell > turn_min) add_line(&raster, &fields, i, j, along, step, sums);
        }
    free(fields.scratch);
    rest_raster_free(&raster);

    return good;
}

bool folds_add(const SingeSurface *surface, Folds *folds) { return each_sheet(surface, folds_add_sheet, folds); }

double folds_angle(const Folds *folds) {
    return folds->count > 0 ? sqrt(folds->power / folds->count) * 180 / acos(-1) : (double)NAN;
}
