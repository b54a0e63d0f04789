// Heat on a still sheet: the grid on which it is measured, and how fast a hot spot spreads.
#include "page/hot_spot.h"

#include <math.h>

LabGrid warm_grid(int across, int along, float cell, SingeHeatOperator operator) {
    LabGrid grid = lab_grid(across, along, cell);
    grid.material.heat_operator = operator;
    grid.material.diffusivity = singe_param((float)WARM_DIFFUSIVITY);
    grid.material.ignition_temperature = singe_param(5000);
    static const SingeField field = {.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "field"};
    grid.material.temperature = singe_param_field((float)WARM_MEAN, (float)(WARM_MEAN + WARM_AMPLITUDE), &field);
    grid.solver.substeps = 1; // nothing moves
    return grid;
}

// ---- a hot spot: its variance grows by 2 alpha t

static double spot(const void *context, double x, double y) {
    const double *centre = context;
    return 2 * exp(-(pow(x - centre[0], 2) + pow(y - centre[1], 2)) / (2 * centre[2] * centre[2]));
}

/// Variances along x and y of both layers' temperature rise, weighted by area.
static void variances(const SingeView *view, double out[2]) {
    double sum = 0, mean[2] = {0}, square[2] = {0};
    for (uint32_t i = 0; i < view->particle_count; i++) {
        double w = (double)view->area[i] * ((double)view->temperature[i] - WARM_MEAN);
        sum += w;
        for (int k = 0; k < 2; k++) {
            double x = (double)view->rest_position[i][k];
            mean[k] += w * x;
            square[k] += w * x * x;
        }
    }

    for (int k = 0; k < 2; k++) out[k] = square[k] / sum - pow(mean[k] / sum, 2);
}

SingeResult spot_spread(Lab *lab, const SpotMesh *mesh, SingeHeatOperator operator, double ratio[2],
                        SingeError *error) {
    const double centre[3] = {(double)mesh->sides[0] / 2, (double)mesh->sides[1] / 2, 0.008}, seconds = 0.4;
    LabGrid grid = warm_grid(mesh->cells[0], mesh->cells[1], 1, operator);
    grid.sides[0] = mesh->sides[0];
    grid.sides[1] = mesh->sides[1];
    grid.jitter = mesh->jitter;
    grid.field = spot;
    grid.context = centre;
    grid.time_step = 0.004f;
    grid.material.thickness = singe_param(1e-4f);
    SingeSim *sim;
    SingeResult result = lab_build(lab, &grid, &sim, error);
    if (result) return result;
    SingeView view = singe_sim_view(sim);
    double before[2], after[2];
    variances(&view, before);
    result = lab_steps(sim, (int)lround(seconds / 0.004), error);
    variances(&view, after);
    for (int k = 0; k < 2; k++) ratio[k] = (after[k] - before[k]) / (2 * WARM_DIFFUSIVITY * seconds);
    singe_sim_destroy(sim);
    return result;
}
