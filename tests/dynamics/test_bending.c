// Bending by compliance: a strip that is clamped at one end sags as a plate of the stiffness D = t^2/c_green does,
//
//   w = rho g l^4 / (8 D) + rho g l^2 / (2 S)
//
// for small w: rho the mass per area, l the free length, S = 1/c_red the stiffness of transverse shear, which no more
// than D may depend on cells and substeps.
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const float length = 0.10f, width = 0.04f, clamped = 0.01f, thickness = 0.003f;

static void clamp(SingeSim *sim, float cell) {
    float points[3 * 512];
    SingePinDef pin = singe_default_pin();
    for (float x = 0; x <= clamped + 1e-4f; x += cell / 2) // vertices and what lies above and below cells' middles
        for (float y = 0; y <= width + 1e-4f; y += cell / 2) {
            float *p = points + 3 * pin.point_count++;
            p[0] = x, p[1] = y, p[2] = 0;
        }
    pin.sheet = (SingeSheetId){0, 1}, pin.points = points, pin.radius = 0.3f * cell;
    SingePinId id;
    test_ok(sim, singe_sim_add_pin(sim, &pin, &id));
}

/// m, of the middle of the free end after two seconds, of a strip of stiffness D in N m whose shear gives 1/S in m/N.
static double sag(float cell, double stiffness, double give, int substeps) {
    SingeSimDef def = singe_default_sim();
    def.solver.substeps = substeps;
    def.solver.smoothing = def.solver.height_min = 0;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) def.solver.regularisation[c] = 1e-3f; // a compliance of r h^2/m itself
    SingeMaterialDef material = singe_default_material();
    material.thickness = singe_param(thickness);
    material.grammage = singe_param(0.08f);
    material.drag = singe_param(0), material.damping = singe_param(5);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) material.compliance[c] = singe_param(0);
    material.compliance[SINGE_GREEN] = singe_param((float)((double)(thickness * thickness) / stiffness));
    material.compliance[SINGE_RED] = singe_param((float)give);
    uint32_t nx = (uint32_t)lroundf(length / cell), ny = (uint32_t)lroundf(width / cell);
    SingeSim *sim = test_sim(&def, test_grid(nx, ny, cell, cell), &material);
    clamp(sim, cell);
    test_steps(sim, 960);
    double z = (double)singe_sim_view(sim).position[ny / 2 * (nx + 1) + nx][2];
    singe_sim_destroy(sim);
    return -z;
}

static double plate(double stiffness, double give) {
    double l = (double)(length - clamped), weight = 0.08 * 9.81;
    return weight * pow(l, 4) / (8 * stiffness) + weight * l * l / 2 * give;
}

TEST(a_cantilever_sags_as_a_plate) {
    const double stiffness = 1e-3, expected = plate(stiffness, 0);
    for (float cell = 0.005f; cell > 0.002f; cell /= 2) {
        double w = sag(cell, stiffness, 0, 12);
        print_message("cells of %.1f mm: sags by %.2f mm, a plate by %.2f\n", 1e3 * (double)cell, 1e3 * w,
                      1e3 * expected);
        assert_true(fabs(w / expected - 1) < 0.15);
    }
}

/// Firm in bending and soft in shear, at the least number of substeps that the solver finds itself and at more.
TEST(soft_shear_sags_as_a_plate) {
    const double stiffness = 1e-3, give = 0.4;
    const double expected = plate(stiffness, give);
    for (float cell = 0.005f; cell > 0.002f; cell /= 2)
        for (int substeps = 0; substeps <= 24; substeps += 12) {
            double w = sag(cell, stiffness, give, substeps);
            print_message("cells of %.1f mm, %2d substeps: sags by %.2f mm, a plate by %.2f\n", 1e3 * (double)cell,
                          substeps, 1e3 * w, 1e3 * expected);
            assert_true(fabs(w / expected - 1) < 0.15);
        }
}

/// With an argument, prints the table of docs/equations/stiffness.md instead.
static void print_table(int argc, char **argv) {
    (void)argv;
    if (argc < 2) return;

    const double stiffnesses[] = {1e-3, 2.5e-4};
    const int substeps[] = {3, 4, 5, 6, 12, 24};
    for (int d = 0; d < 2; d++)
        for (int k = 0; k < 6; k++)
            printf("D %.2g N m, %2d substeps: %.1f mm, a plate by %.2f\n", stiffnesses[d], substeps[k],
                   1e3 * sag(0.005f, stiffnesses[d], 0, substeps[k]), 1e3 * plate(stiffnesses[d], 0));
    exit(0);
}

TEST_AROUND(print_table, NULL)
