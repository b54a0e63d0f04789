// The dependence of the rest shape on numerical settings: at twice and half the time step, twice the substeps and half the
// cell size, relative to a base. (That of wrinkles: measure_spectrum.c.)
//
// A sheet hangs from two corner patches that move 10 cm closer, and comes to rest.
//   sag    m, height of the patches over the centre of the upper edge
//   drop   m, fall of the centre of mass
//   shape  mm, root mean square distance of points of the sheet to the same points of the base
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"

/// Enough for the default stiffness at every setting (docs/equations/stiffness.md).
enum { SUBSTEPS = 16 };

enum { POINTS = 41 };

typedef struct Look {
    double shape[POINTS * POINTS][3];
    double sag, drop;
} Look;

typedef struct Setting {
    const char *name;
    double step, substeps, cells; ///< factors on the base's
} Setting;

static const Setting settings[] = {
    {"base", 1, 1, 1}, {"h x 2", 2, 1, 1}, {"h / 2", 0.5, 1, 1}, {"substeps x 2", 1, 2, 1}, {"s / 2", 1, 1, 2},
};

static double change(double value, double base) { return 100 * (value / base - 1); }

SingeResult bench_look(const BenchOptions *options, BenchTable *table, SingeError *error) {
    enum { SETTINGS = sizeof settings / sizeof *settings };
    BenchList cells = bench_list(&options->cells, 1, (const double[]){options->quick ? 16 : 50});
    BenchList thickness = bench_list(&options->thickness, 1, (const double[]){2e-3});
    const double seconds = options->time > 0 ? options->time : options->quick ? 0.5 : 3;
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
        setup.approach = 0.1f;

        Look *look = &looks[i];
        const Look *base = &looks[0];
        SingeSim *sim = NULL;
        result = sheet_build(&setup, &sim, error);
        for (double t = 0; !result && t < seconds; t += (double)setup.time_step) {
            result = singe_sim_step(sim);
            if (result) *error = *singe_sim_error(sim);
        }

        if (!result) {
            SingeView view = singe_sim_view(sim);
            const double height_start = 0.5; // of an upright sheet of 1 m
            double left[3], right[3], centre[3];
            for (int p = 0; p < POINTS * POINTS; p++)
                geometry_point(&view, setup.cells, (p % POINTS) / (POINTS - 1.0), (p / POINTS) / (POINTS - 1.0),
                               look->shape[p]);
            geometry_point(&view, setup.cells, 0, 1, left);
            geometry_point(&view, setup.cells, 1, 1, right);
            geometry_point(&view, setup.cells, 0.5, 1, centre);
            look->sag = 0.5 * (left[2] + right[2]) - centre[2];
            look->drop = height_start - geometry_height(&view);
        }

        singe_sim_destroy(sim);

        // differences from the base
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
            result = table_end_row(table);
        }
    }

    free(looks);
    return result;
}
