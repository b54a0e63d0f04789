// The heat equation compared with its solutions, and the effect of the umbrella of eq 3.
#include <math.h>

#include "page/lab.h"
#include "validate/validate.h"

static const double slab = 0.08; // m

// ---- a slab: cos(pi x/L) decays as exp(-alpha (pi/L)^2 t)

static double slab_mode(const void *context, double x, double y) {
    (void)context, (void)y;
    return cos(acos(-1) * x / slab);
}

/// The relative error of the amplitude after 4 s.
static SingeResult slab_error(Lab *lab, int cells, int steps, double *off, SingeError *error) {
    const double seconds = 4, k = acos(-1) / slab;
    LabGrid grid = warm_grid(cells, 3, (float)slab / (float)cells, SINGE_HEAT_SURFACE);
    grid.field = slab_mode;
    grid.time_step = (float)(seconds / steps);

    SingeSim *sim;
    TRY(lab_build(lab, &grid, &sim, error));
    SingeResult result = lab_steps(sim, steps, error);
    SingeView view = singe_sim_view(sim);

    // K, the mode's amplitude in the layer of corners
    double sum = 0, norm = 0;
    for (uint32_t v = 0; v < view.vertex_count; v++) {
        double c = cos(acos(-1) * (double)view.rest_position[v][0] / slab), area = (double)view.area[v];
        sum += area * c * ((double)view.temperature[v] - WARM_MEAN);
        norm += area * c * c;
    }

    *off = fabs(sum / norm / (WARM_AMPLITUDE * exp(-WARM_DIFFUSIVITY * k * k * seconds)) - 1);
    singe_sim_destroy(sim);
    return result;
}

SingeResult validate_heat(Lab *lab, SingeError *error) {
    enum { CASES = 4 };
    double off[2][CASES], size[2][CASES];
    SingeResult result = SINGE_OK;
    const int count = lab->quick ? 3 : CASES;
    for (int i = 0; i < count && !result; i++) {
        int cells = 8 << i, steps = 8 << i;
        result = slab_error(lab, cells, 2 * cells * cells, &off[0][i], error); // steps go with the square of cells
        if (!result) result = slab_error(lab, 64, steps, &off[1][i], error);
        size[0][i] = 1e3 * slab / cells;
        size[1][i] = 4e3 / steps;
    }

    if (result) return result;
    report_heads(lab->report, "cells mm|error|order|step ms|error|order");

    double order[2][CASES] = {{NAN, NAN, NAN, NAN}, {NAN, NAN, NAN, NAN}}, min[2] = {INFINITY, INFINITY};
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 2 && i > 0; k++) {
            order[k][i] = log2(off[k][i - 1] / off[k][i]);
            min[k] = fmin(min[k], order[k][i]);
        }

        report_row(lab->report, "%.2f|%.2e|%.2f|%.0f|%.2e|%.2f", size[0][i], off[0][i], order[0][i], size[1][i],
                   off[1][i], order[1][i]);
    }

    Plot plot = {.title = "Error of the mode's amplitude after 4 s",
                 .x_label = "cells, mm",
                 .y_label = "relative "
                            "error",
                 .log_x = true,
                 .log_y = true};
    double second[CASES];
    for (int i = 0; i < count; i++) second[i] = off[0][0] * pow(size[0][i] / size[0][0], 2);

    plot_add(&plot, (PlotLine){"second order", "#999", size[0], second, count, false, true});
    plot_add(&plot, (PlotLine){"surface", "#2166ac", size[0], off[0], count, true, false});
    report_plot(lab->report, &plot);
    report_measure(lab->report, "order_space", "lowest order in the cell size, with steps in proportion to its square",
                   min[0], 1.9, 2.2);
    report_measure(lab->report, "order_time", "lowest order in steps too long for the second, on cells of 1.25 mm",
                   min[1], 0.9, 1.2);
    report_measure(lab->report, "error", "error on the finest cells", off[0][count - 1], 0, 5e-3);
    return SINGE_OK;
}

/// docs/equations/heat.md: the umbrella's effective alpha along x on cells dx by dy without thickness.
static double umbrella_factor(double dx, double dy) {
    double q = hypot(dx, dy), r = q / 2;
    return (2 * dx + 2 * dx * dx / q + dx * dx / r) / (2 * dx + 2 * dy + 2 * q + 4 * r);
}

static const SpotMesh meshes[] = {{"squares", {60, 60}, {.12f, .12f}, 0},
                                  {"2 : 1", {36, 72}, {.144f, .144f}, 0},
                                  {"squares, jitter 0.3", {60, 60}, {.12f, .12f}, 0.3f}};

SingeResult validate_umbrella(Lab *lab, SingeError *error) {

    enum { CASES = sizeof meshes / sizeof *meshes };
    double surface[CASES][2], umbrella[CASES][2], off = 0;
    SingeResult result = SINGE_OK;
    report_heads(lab->report, "mesh|surface, x|y|umbrella, x|y|umbrella by formula, x|y");

    for (int i = 0; i < CASES && !result; i++) {
        result = spot_spread(lab, &meshes[i], SINGE_HEAT_SURFACE, surface[i], error);
        if (!result) result = spot_spread(lab, &meshes[i], SINGE_HEAT_UMBRELLA, umbrella[i], error);
        double dx = (double)meshes[i].sides[0] / meshes[i].cells[0];
        double dy = (double)meshes[i].sides[1] / meshes[i].cells[1];
        if (!result)
            report_row(lab->report, "%s|%.3f|%.3f|%.3f|%.3f|%.3f|%.3f", meshes[i].name, surface[i][0], surface[i][1],
                       umbrella[i][0], umbrella[i][1], umbrella_factor(dx, dy), umbrella_factor(dy, dx));
        for (int k = 0; k < 2; k++) off = fmax(off, fabs(surface[i][k] - 1));
    }

    if (result) return result;
    report_text(lab->report,
                "The diffusivity at which a hot spot spreads, over the specified alpha. On squares the umbrella has "
                "half of it, and on long cells it differs along x and y.");
    report_measure(lab->report, "surface", "surface operator: largest error of the diffusivity on these meshes", off, 0,
                   0.02);
    report_measure(lab->report, "umbrella_squares", "umbrella on squares", umbrella[0][0], 0.47, 0.53);
    report_measure(lab->report, "umbrella_long", "umbrella on cells of 2 : 1, along x over along y",
                   umbrella[1][0] / umbrella[1][1], 1.2, INFINITY);

    return SINGE_OK;
}
