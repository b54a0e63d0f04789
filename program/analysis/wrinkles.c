// Both measures use the unit normal N over the sheet at rest, on pixels that are independent of the mesh
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
#include "analysis/wrinkles.h"

#include <math.h>
#include <stdlib.h>

#include "analysis/rest_raster.h"

/// m
static const double spacing = 0.75e-3, crease_deviation = 2e-3;
static const double band_short = 3e-3, band_long = 15e-3;
static const float around_burnt = 0.010f, far_from_burnt = 0.025f;

/// Burn progress above which a pixel counts as burnt.
static const float burnt_min = 0.05f;

/// Min share of a Gaussian that must be covered: next to an edge, a Gaussian with less is not trusted.
static const float covered_min = 0.6f;

enum { SHEETS_MAX = UINT16_MAX };

/// Room for the fields of one sheet.
typedef struct Work {
    float *scratch, *weight, *smooth[3], *rough[3], *distance;
} Work;

static bool work_make(size_t pixels, Work *work) {
    work->scratch = calloc(10 * pixels, sizeof *work->scratch); // scratch is two fields
    if (!work->scratch) return false;
    work->weight = work->scratch + 2 * pixels;
    work->distance = work->scratch + 3 * pixels;
    for (size_t k = 0; k < 3; k++)
        work->smooth[k] = work->scratch + (4 + k) * pixels, work->rough[k] = work->scratch + (7 + k) * pixels;
    return true;
}

/// Adds a crease of this weight and this direction across it, rad from that of growing u.
static void add_crease(Wrinkles *wrinkles, double weight, double across) {
    const double pi = acos(-1), quarter = pi / 2;
    double along = across + quarter;
    along -= pi * floor(along / pi);
    int bin = (int)(along / pi * WRINKLE_BINS);
    wrinkles->crease[bin < WRINKLE_BINS ? bin : WRINKLE_BINS - 1] += weight;
    double off = fabs(along - quarter * round(along / quarter)); // from the nearest axis, up to an eighth of a turn
    if (off <= pi / 16) wrinkles->axis += weight;
    if (off >= pi / 4 - pi / 16) wrinkles->diagonal += weight;
}

static void add_creases(const RestRaster *raster, Work *work, Wrinkles *wrinkles) {
    const int w = raster->width;
    const double area = raster->spacing * raster->spacing, step = 2 * raster->spacing;
    for (int k = 0; k < 3; k++)
        rest_raster_smooth(raster, raster->normal[k], crease_deviation, work->scratch, work->weight, work->smooth[k]);
    for (int j = 1; j + 1 < raster->height; j++)
        for (int i = 1; i + 1 < w; i++) {
            int p = j * w + i;
            const float *cover = raster->cover;
            if (!(cover[p] * cover[p - 1] * cover[p + 1] * cover[p - w] * cover[p + w] > 0)) continue;
            if (work->weight[p] < covered_min) continue;
            double xx = 0, xy = 0, yy = 0;
            for (int k = 0; k < 3; k++) {
                const float *n = work->smooth[k];
                double x = ((double)n[p + 1] - (double)n[p - 1]) / step;
                double y = ((double)n[p + w] - (double)n[p - w]) / step;
                xx += x * x;
                xy += x * y;
                yy += y * y;
            }
            double half = hypot(0.5 * (xx - yy), xy), mean = 0.5 * (xx + yy);
            double bend = sqrt(mean + half) - sqrt(fmax(mean - half, 0));
            add_crease(wrinkles, area * bend, 0.5 * atan2(2 * xy, xx - yy) + raster->turn);
        }
}

static void add_roughness(const RestRaster *raster, Work *work, Wrinkles *wrinkles) {
    const double share = sqrt(2 * log(2)) / (2 * acos(-1)), area = raster->spacing * raster->spacing;
    for (int k = 0; k < 3; k++)
        rest_raster_smooth(raster, raster->normal[k], share * band_short, work->scratch, work->weight, work->rough[k]);
    for (int k = 0; k < 3; k++)
        rest_raster_smooth(raster, raster->normal[k], share * band_long, work->scratch, work->weight, work->smooth[k]);
    rest_raster_distance(raster, burnt_min, work->distance);
    for (int p = 0; p < raster->width * raster->height; p++) {
        if (!(raster->cover[p] > 0) || work->weight[p] < covered_min) continue;
        double square = 0;
        for (int k = 0; k < 3; k++) square += pow((double)work->rough[k][p] - (double)work->smooth[k][p], 2);
        if (work->distance[p] <= around_burnt) {
            wrinkles->burnt_power += square * area;
            wrinkles->burnt_area += area;
        } else if (work->distance[p] >= far_from_burnt && raster->unlit[p] > 0) {
            wrinkles->unburnt_power += square * area;
            wrinkles->unburnt_area += area;
        }
    }
}

static bool wrinkles_add_sheet(const SingeSurface *surface, int32_t sheet, Wrinkles *wrinkles) {
    RestRaster raster;
    Work work = {0};
    if (!rest_raster_draw(surface, sheet, spacing, &raster)) return false;
    bool good = raster.width == 0 || work_make((size_t)raster.width * (size_t)raster.height, &work);
    if (good && raster.width) {
        add_creases(&raster, &work, wrinkles);
        add_roughness(&raster, &work, wrinkles);
    }
    free(work.scratch);
    rest_raster_free(&raster);
    return good;
}

bool wrinkles_add(const SingeSurface *surface, Wrinkles *wrinkles) {
    bool *there = calloc(SHEETS_MAX, sizeof *there), good = there != NULL;
    for (uint32_t v = 0; good && v < surface->vertex_count; v++)
        if (surface->sheet[v] >= 0 && surface->sheet[v] < SHEETS_MAX) there[surface->sheet[v]] = true;
    for (int32_t sheet = 0; good && sheet < SHEETS_MAX; sheet++)
        if (there[sheet]) good = wrinkles_add_sheet(surface, sheet, wrinkles);
    free(there);
    return good;
}

static double over(double a, double b) { return b > 0 ? a / b : (double)NAN; }

double wrinkles_bias(const Wrinkles *wrinkles) { return over(wrinkles->axis, wrinkles->diagonal); }
double wrinkles_burnt(const Wrinkles *wrinkles) { return over(wrinkles->burnt_power, wrinkles->burnt_area); }
double wrinkles_unburnt(const Wrinkles *wrinkles) { return over(wrinkles->unburnt_power, wrinkles->unburnt_area); }
