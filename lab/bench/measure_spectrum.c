// The spectrum of the wrinkles of burning, and its dependence on numerical settings: it should not change at twice and
// half the time step and half the cell size, but should at twice the thickness.
//
// A sheet hangs from its upper edge and burns from its lower one, lit all along. At four later times, lines along the
// edge are measured, 2 mm apart, from the char to 12 mm above the start of burning, if they are whole: the angle of the
// line to the sheet's plane, without its mean and slope, under a Hann window. Its power is summed over lines, times and
// seeds of the noise, and given for bands of half an octave in rest wavelength: the mean of k times the power of k
// waves per line, so that a band's weight does not depend on the number of waves in it.
//   peak  mm, the centroid of the squares of the bands' power: near the strongest bands, without jumps if two are alike
//   mean  mm, the centroid of power, both over the logarithm of the wavelength
//   rms   degrees, of the angle
// The front is always thickened as the base's cells need, because the width of the char depends on it.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"

enum { ACROSS = 144, UP = 32 }; // cells of the base
enum { SAMPLES = 384, BANDS = 10, SETTINGS = 5, TIMES = 4 };

static const double width = 0.288, shortest = 0.003; // m: the sheet, the first band

static const struct {
    const char *name, *peak, *change, *mean, *rms;
    double step, cells, thickness; ///< factors on the base's
} settings[SETTINGS] = {
    {"base", "peak_mm_base", NULL, "mean_mm_base", "rms_deg_base", 1, 1, 1},
    {"h_x_2", "peak_mm_h_x_2", "peak_change_pct_h_x_2", "mean_mm_h_x_2", "rms_deg_h_x_2", 2, 1, 1},
    {"h_div_2", "peak_mm_h_div_2", "peak_change_pct_h_div_2", "mean_mm_h_div_2", "rms_deg_h_div_2", 0.5, 1, 1},
    {"s_div_2", "peak_mm_s_div_2", "peak_change_pct_s_div_2", "mean_mm_s_div_2", "rms_deg_s_div_2", 1, 2, 1},
    {"t_x_2", "peak_mm_t_x_2", "peak_change_pct_t_x_2", "mean_mm_t_x_2", "rms_deg_t_x_2", 1, 1, 2},
};

typedef struct Spectrum {
    double band[BANDS];
    double square, lines; ///< of the angle, summed over the lines
} Spectrum;

/// m, the centre of a band.
static double band_wave(int band) { return shortest * pow(2, (band + 0.5) / 2); }

static int wave_band(double wave) { return (int)floor(2 * log2(wave / shortest) + 1e-9); }

// ---- the sheet

typedef struct Strip {
    int across, up; ///< cells
    double cell;    ///< m
} Strip;

static SingeResult strip_hold(SingeSim *sim, const Strip *strip, SingeSheetId id) {
    const uint32_t row = (uint32_t)strip->across + 1;
    uint32_t *top = malloc(row * sizeof *top);
    if (!top) return SINGE_ERROR_MEMORY;
    for (uint32_t i = 0; i < row; i++) top[i] = row * (uint32_t)strip->up + i;

    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;

    pin.sheet = id;
    pin.vertex_count = row;
    pin.vertices = top;
    SingeResult result = singe_sim_add_pin(sim, &pin, &pin_id);
    free(top);
    return result;
}

static SingeResult strip_build(const BenchOptions *options, const Strip *strip, double thickness, double step,
                               uint32_t seed, SingeSim **sim, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;

    def.thread_count = options->threads;
    def.instructions = options->instructions;
    def.pace = 4;
    def.solver.substeps = options->substeps; // 0: as many as stiffness needs
    def.time_step *= (float)step;
    sheet.material.temperature =
        singe_param_field(293, 1100, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "hot"});
    sheet.material.thickening = 2.07f; // that of cells of 2 mm

    SingeField front = *sheet.material.shrink_front.field;
    front.noise.seed += 16 * seed;
    sheet.material.shrink_front.field = &front;
    sheet.material.damping = singe_param(3);
    if (thickness > 0) sheet.material.thickness = singe_param((float)thickness);

    TRY(singe_sim_create(&def, sim, error));

    const uint32_t row = (uint32_t)strip->across + 1, rows = (uint32_t)strip->up + 1;
    float *positions = malloc((size_t)3 * row * rows * sizeof *positions), *hot = malloc(row * rows * sizeof *hot);
    uint32_t *cells = malloc((size_t)4 * row * rows * sizeof *cells);

    SingeResult result = SINGE_ERROR_MEMORY;
    if (positions && hot && cells) {
        for (uint32_t v = 0; v < row * rows; v++) {
            double z = v / row * strip->cell;
            positions[3 * v] = (float)(v % row * strip->cell);
            positions[3 * v + 1] = 0;
            positions[3 * v + 2] = (float)z;
            hot[v] = (float)fmax(0, 1 - z / 0.004); // K above ignition at the edge, falling to 0 within 4 mm
        }

        geometry_grid(row - 1, rows - 1, cells);
        const SingeAttribute attribute = {"hot", hot};

        sheet.vertex_count = row * rows;
        sheet.positions = positions;
        sheet.cell_count = (row - 1) * (rows - 1);
        sheet.cells = cells;
        sheet.attribute_count = 1;
        sheet.attributes = &attribute;
        result = singe_sim_add_sheet(*sim, &sheet, &id);
    }

    free(positions);
    free(hot);
    free(cells);

    if (!result) result = singe_sim_commit(*sim);
    if (!result) result = strip_hold(*sim, strip, id);
    return result ? bench_give_up(sim, result, error) : SINGE_OK;
}

// ---- its shape

/// The line at the rest height z: the angle out of the plane at each sample. False where it is not whole.
static bool read_line(const SingeView *view, const Strip *strip, double z, double *angle) {
    const int row = strip->across + 1, j = (int)fmin(z / strip->cell, strip->up - 1);
    const double f = z / strip->cell - j;
    for (int c = 0; c < strip->across; c++)
        for (int k = 0; k < 4; k++)
            if (!(view->particle_flags[(j + k / 2) * row + c + k % 2] & SINGE_ALIVE)) return false;

    double before[3] = {0};
    for (int i = 0; i <= SAMPLES; i++) {
        double x = (double)i / SAMPLES * strip->across, point[3];
        int c = (int)fmin(x, strip->across - 1);
        double g = x - c;
        const float *p = view->position[j * row + c], *q = view->position[j * row + c + 1];
        const float *r = view->position[(j + 1) * row + c], *s = view->position[(j + 1) * row + c + 1];
        for (int a = 0; a < 3; a++)
            point[a] =
                (1 - f) * ((1 - g) * (double)p[a] + g * (double)q[a]) + f * ((1 - g) * (double)r[a] + g * (double)s[a]);

        double d[3] = {point[0] - before[0], point[1] - before[1], point[2] - before[2]};
        if (i > 0) angle[i - 1] = atan2(d[1], sqrt(d[0] * d[0] + d[2] * d[2]));
        for (int a = 0; a < 3; a++) before[a] = point[a];
    }

    return true;
}

static SingeResult spectrum_observe(const BenchOptions *options, int setting, uint32_t seed, Spectrum *spectrum,
                                    SingeError *error) {
    const double cells = settings[setting].cells, step = settings[setting].step;
    const Strip strip = {(int)(ACROSS * cells), (int)(UP * cells), width / (ACROSS * cells)};
    const double seconds = options->time > 0 ? options->time : options->quick ? 0.2 : 1.6;
    double thickness = options->thickness.count ? options->thickness.values[0] : 0;

    if (settings[setting].thickness != 1)
        thickness = settings[setting].thickness *
                    (thickness > 0 ? thickness : (double)singe_default_material().thickness.value);

    SingeSim *sim = NULL;
    SingeResult result = strip_build(options, &strip, thickness, step, seed, &sim, error);
    for (int look = 0; look < TIMES && !result; look++) {
        double until = seconds * (0.4 + 0.2 * look);
        while (!result && singe_sim_view(sim).time < until) result = singe_sim_step(sim);
        if (result) *error = *singe_sim_error(sim);

        SingeView view = singe_sim_view(sim);
        if (!result) {
            // the rest height up to which the sheet's centre line has lost mass
            const int row = strip.across + 1;
            int j = 0;
            while (j < strip.up && view.mass[j * row + strip.across / 2] < 0.99f) j++;

            const double height = j * strip.cell;
            double line[SAMPLES], top = fmin(height + 0.012, (strip.up - 2) * strip.cell);
            for (double z = 0.001; z < top; z += 0.002)
                if (read_line(&view, &strip, z, line)) {
                    // removes mean and slope of a line, applies a Hann window and adds its power to the bands
                    spectrum->square += geometry_window(line, SAMPLES);
                    spectrum->lines++;
                    for (int k = 1; k <= SAMPLES / 2; k++) {
                        int band = wave_band(width / k);
                        if (band < 0 || band >= BANDS) continue;

                        // the number of integer wave counts in a band
                        int count = 0;
                        for (int wave = 1; wave <= SAMPLES / 2; wave++) count += wave_band(width / wave) == band;
                        spectrum->band[band] += k * geometry_power(line, SAMPLES, k) / count;
                    }
                }
        }
    }

    singe_sim_destroy(sim);
    return result;
}

// ---- the numbers

/// Centroid of a power of the power, over the logarithm of the wavelength.
static double centre(const Spectrum *spectrum, double exponent) {
    double sum = 0, moment = 0;
    for (int b = 0; b < BANDS; b++) {
        double weight = pow(spectrum->band[b], exponent);
        sum += weight;
        moment += weight * log(band_wave(b));
    }

    return exp(moment / sum);
}

static double peak(const Spectrum *spectrum) { return centre(spectrum, 2); }

SingeResult bench_spectrum(const BenchOptions *options, BenchTable *table, SingeError *error) {
    Spectrum spectra[SETTINGS] = {0};
    const uint32_t seeds = options->quick ? 1 : 4;
    SingeResult result = SINGE_OK;
    for (int i = 0; i < SETTINGS && !result; i++)
        for (uint32_t seed = 0; seed < seeds && !result; seed++)
            result = spectrum_observe(options, i, seed, &spectra[i], error);
    if (result) return result;

    const double base = peak(&spectra[0]), degrees = 180 / acos(-1);
    for (int i = 0; i < SETTINGS; i++) {
        table_fact(table, settings[i].peak, 1e3 * peak(&spectra[i]));
        if (settings[i].change) table_fact(table, settings[i].change, 100 * (peak(&spectra[i]) / base - 1));
        table_fact(table, settings[i].mean, 1e3 * centre(&spectra[i], 1));
        table_fact(table, settings[i].rms, degrees * sqrt(spectra[i].square / spectra[i].lines));
    }

    for (int band = 0; band < BANDS; band++) {
        table_number(table, "wavelength_mm", "%.1f", 13, 1e3 * band_wave(band));
        for (int i = 0; i < SETTINGS; i++) {
            double sum = 0;
            for (int b = 0; b < BANDS; b++) sum += spectra[i].band[b];
            table_number(table, settings[i].name, "%.4f", 8, spectra[i].band[band] / sum);
        }

        if (table_end_row(table)) return SINGE_ERROR_MEMORY;
    }

    return SINGE_OK;
}
