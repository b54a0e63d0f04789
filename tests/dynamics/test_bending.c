// Bending by compliance: a strip that is clamped at one end sags as a plate of the stiffness D = t^2/c_green does,
//
//   w = rho g l^4 / (8 D)
//
// for small w: rho the mass per area, l the free length.
#include "support/support.h"

#include <math.h>
#include <stdio.h>

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

/// m, of the middle of the free end after two seconds, of a strip of stiffness D in N m.
static double sag(float cell, double stiffness, int substeps) {
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
    uint32_t nx = (uint32_t)lroundf(length / cell), ny = (uint32_t)lroundf(width / cell);
    SingeSim *sim = test_sim(&def, test_grid(nx, ny, cell, cell), &material);
    clamp(sim, cell);
    test_steps(sim, 960);
    double z = (double)singe_sim_view(sim).position[ny / 2 * (nx + 1) + nx][2];
    singe_sim_destroy(sim);
    return -z;
}

static double plate(double stiffness) { return 0.08 * 9.81 * pow((double)(length - clamped), 4) / (8 * stiffness); }

static void cantilever(void **unused) {
    (void)unused;
    const double stiffness = 1e-3, expected = plate(stiffness);
    for (float cell = 0.005f; cell > 0.002f; cell /= 2) {
        double w = sag(cell, stiffness, 12);
        print_message("cells of %.1f mm: sags by %.2f mm, a plate by %.2f\n", 1e3 * (double)cell, 1e3 * w,
                      1e3 * expected);
        assert_true(fabs(w / expected - 1) < 0.15);
    }
}

/// The table of docs/equations.md, Firmness.
static int print_table(void) {
    const double stiffnesses[] = {1e-3, 2.5e-4};
    const int substeps[] = {3, 4, 5, 6, 12, 24};
    for (int d = 0; d < 2; d++)
        for (int k = 0; k < 6; k++)
            printf("D %.2g N m, %2d substeps: %.1f mm, a plate by %.2f\n", stiffnesses[d], substeps[k],
                   1e3 * sag(0.005f, stiffnesses[d], substeps[k]), 1e3 * plate(stiffnesses[d]));
    return 0;
}

/// With an argument it prints the table instead.
int main(int argc, char **argv) {
    (void)argv;
    if (argc > 1) return print_table();
    const struct CMUnitTest tests[] = {cmocka_unit_test(cantilever)};
    return cmocka_run_group_tests_name("bending", tests, NULL, NULL);
}
