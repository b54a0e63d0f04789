// The dependence of the appearance on numerical settings: rest shape, sag and wrinkles at twice and half the time step,
// twice the substeps and half the cell size, relative to a base.
//
// Rest: a sheet hangs from two corner patches that move 10 cm closer, and comes to rest.
//   sag    m, height of the patches over the centre of the upper edge
//   drop   m, fall of the centre of mass
//   shape  mm, root mean square distance of points of the sheet to the same points of the base
// Wrinkles: a sheet that hangs from two corner patches shrinks uniformly to 0.8.
//   wavelength  mm, where the power spectrum of the displacement off its plane is highest: along level lines of
//               the sheet, mean and slope taken out, Hann window, power summed over the lines
//   mean        mm, one over the mean wave number weighted by power: more stable than the peak
//   height      mm, root mean square of that displacement
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"

/// Enough for the default stiffness at every setting (docs/equations/stiffness.md).
enum { SUBSTEPS = 16 };

enum { POINTS = 41, LINES = 24, SAMPLES = 128 };

typedef struct Look {
    double shape[POINTS * POINTS][3];
    double sag, drop, wavelength, mean_wave, height;
} Look;

typedef struct Setting {
    const char *name;
    double step, substeps, cells; ///< factors on the base's
} Setting;

static const Setting settings[] = {
    {"base", 1, 1, 1}, {"h x 2", 2, 1, 1}, {"h / 2", 0.5, 1, 1}, {"substeps x 2", 1, 2, 1}, {"s / 2", 1, 1, 2},
};

static SingeResult look_observe(const BenchOptions *options, BenchSetup setup, BenchState state, Look *look,
                                SingeError *error) {
    SingeSim *sim = NULL;
    double seconds = options->time > 0 ? options->time : options->quick ? 0.5 : 3;
    setup.state = state;
    setup.approach = state == BENCH_HANG ? 0.1f : 0;

    SingeResult result = sheet_build(&setup, &sim, error);
    for (double t = 0; !result && t < seconds; t += (double)setup.time_step) {
        result = singe_sim_step(sim);
        if (result) *error = *singe_sim_error(sim);
    }

    if (!result) {
        SingeView view = singe_sim_view(sim);
        if (state == BENCH_HANG) {
            // an upright sheet of 1 m
            const int cells = setup.cells;
            const double height_start = 0.5;
            double left[3], right[3], centre[3];
            for (int p = 0; p < POINTS * POINTS; p++)
                geometry_point(&view, cells, (p % POINTS) / (POINTS - 1.0), (p / POINTS) / (POINTS - 1.0),
                               look->shape[p]);
            geometry_point(&view, cells, 0, 1, left);
            geometry_point(&view, cells, 1, 1, right);
            geometry_point(&view, cells, 0.5, 1, centre);
            look->sag = 0.5 * (left[2] + right[2]) - centre[2];
            look->drop = height_start - geometry_height(&view);
        } else {
            const int cells = setup.cells;
            const double length = (double)setup.shrink;
            double power[SAMPLES / 4 + 2] = {0}, line[SAMPLES], square = 0, total = 0, moment = 0;
            for (int row = 0; row < LINES; row++) {
                for (int i = 0; i < SAMPLES; i++) {
                    double point[3];
                    geometry_point(&view, cells, (i + 0.5) / SAMPLES, 0.1 + 0.8 * row / (LINES - 1.0), point);
                    line[i] = point[1];
                }

                square += geometry_window(line, SAMPLES) / LINES;

                // adds a line's power at k = 1 to SAMPLES/4 waves over its length
                for (int k = 1; k <= SAMPLES / 4; k++) power[k] += geometry_power(line, SAMPLES, k);
            }

            for (int k = 2; k <= SAMPLES / 4; k++) total += power[k], moment += k * power[k];

            // waves over the length at the peak, between whole numbers by the parabola through it and its neighbours
            int best = 2;
            for (int k = 2; k < SAMPLES / 4; k++)
                if (power[k] > power[best]) best = k;
            double before = power[best - 1], at = power[best], after = power[best + 1], bend = before - 2 * at + after;
            double shift = bend < 0 ? 0.5 * (before - after) / bend : 0;
            const double waves = best + fmax(-0.5, fmin(0.5, shift));
            look->wavelength = length / waves;
            look->mean_wave = length * total / moment;
            look->height = sqrt(square);
        }
    }

    singe_sim_destroy(sim);
    return result;
}

static double change(double value, double base) { return 100 * (value / base - 1); }

SingeResult bench_look(const BenchOptions *options, BenchTable *table, SingeError *error) {
    enum { SETTINGS = sizeof settings / sizeof *settings };
    BenchList cells = bench_list(&options->cells, 1, (const double[]){options->quick ? 16 : 50});
    BenchList thickness = bench_list(&options->thickness, 1, (const double[]){2e-3});
    Look *looks = calloc(SETTINGS, sizeof *looks);
    SingeResult result = looks ? SINGE_OK : SINGE_ERROR_MEMORY;
    for (int i = 0; i < SETTINGS && !result; i++) {
        const Setting *setting = &settings[i];
        BenchSetup setup = sheet_setup(options, BENCH_HANG, 20);
        if (!options->substeps) setup.solver.substeps = SUBSTEPS;
        setup.cells = (int)(cells.values[0] * setting->cells);
        setup.thickness = (float)thickness.values[0];
        setup.damping = 3;
        setup.time_step *= (float)setting->step;
        setup.solver.substeps = (int)fmax(1, setup.solver.substeps * setting->substeps);
        result = look_observe(options, setup, BENCH_HANG, &looks[i], error);
        if (!result) result = look_observe(options, setup, BENCH_SHRINK, &looks[i], error);

        // differences from the base
        const Look *look = &looks[i], *base = &looks[0];
        double sum = 0;
        for (int p = 0; p < POINTS * POINTS; p++)
            for (int axis = 0; axis < 3; axis++) sum += pow(look->shape[p][axis] - base->shape[p][axis], 2);
        if (!result) {
            table_text(table, "setting", 12, setting->name);
            table_number(table, "sag_m", "%.4f", 7, look->sag);
            table_number(table, "change_pct", "%+.1f", 10, change(look->sag, base->sag));
            table_number(table, "drop_m", "%.4f", 7, look->drop);
            table_number(table, "drop_change_pct", "%+.1f", 15, change(look->drop, base->drop));
            table_number(table, "shape_mm", "%.1f", 8, 1e3 * sqrt(sum / (POINTS * POINTS)));
            table_number(table, "wavelength_mm", "%.0f", 13, 1e3 * look->wavelength);
            table_number(table, "wavelength_change_pct", "%+.1f", 21, change(look->wavelength, base->wavelength));
            table_number(table, "mean_wave_mm", "%.0f", 12, 1e3 * look->mean_wave);
            table_number(table, "mean_change_pct", "%+.1f", 15, change(look->mean_wave, base->mean_wave));
            table_number(table, "wrinkle_mm", "%.2f", 10, 1e3 * look->height);
            result = table_end_row(table);
        }
    }

    free(looks);
    return result;
}
