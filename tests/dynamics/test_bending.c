// Bending by compliance: a strip that is clamped at one end sags as a plate of the stiffness D = t^2/c_green does,
//
//   w = rho g l^4 / (8 D) + rho g l^2 / (2 S)
//
// for small w: rho the mass per area, l the free length, S = 1/c_red the stiffness of transverse shear, which no more
// than D may depend on cells and substeps.
#include "support/support.h"

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
    test_add_pin(sim, &pin);
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
    OwnSim *sim = test_sim(&def, test_grid(nx, ny, cell, cell), &material);
    clamp(sim, cell);
    test_steps(sim, 960);
    double z = (double)singe_sim_view(sim).position[ny / 2 * (nx + 1) + nx][2];
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

/// N m, of a strip of default paper whose mesh runs along it or turned by 45 degrees, from its sag at a hundredth of g.
static double strip_stiffness(bool diagonal, bool isotropic) {
    enum { ALONG = 32, ACROSS = 10 };
    const float s = 0.0025f, reach = diagonal ? s * 0.70710678f : s;
    SingeSimDef def = singe_default_sim();
    def.solver.substeps = 16;
    def.solver.isotropic = isotropic;
    def.gravity[2] = -0.2f;
    SingeMaterialDef material = singe_default_material();
    material.drag = singe_param(0), material.damping = singe_param(20);

    // the turned strip: cells (i, j) of a grid with i + j along it and i - j across
    TestMesh grid = diagonal ? test_grid(ALONG, ALONG, s, s) : test_grid(ALONG, ACROSS, s, s);
    const float middle = 0.5f * ACROSS * reach;
    uint32_t cells = 0;
    for (uint32_t v = 0; v < grid.vertex_count && diagonal; v++) {
        float *p = grid.positions + 3 * (size_t)v, x = p[0], y = p[1];
        p[0] = (x + y) * 0.70710678f, p[1] = (y - x) * 0.70710678f;
    }
    for (uint32_t c = 0; c < grid.cell_count; c++) {
        const uint32_t *corner = grid.cells + 4 * (size_t)c;
        const float *p = grid.positions + 3 * (size_t)corner[0], *q = grid.positions + 3 * (size_t)corner[2];
        const float x = 0.5f * (p[0] + q[0]), y = 0.5f * (p[1] + q[1]);
        if (diagonal && (fabsf(y) > 0.0131f || x > 0.06f)) continue;
        if (!diagonal && x > 0.06f) continue;
        memmove(grid.cells + 4 * (size_t)cells++, corner, 4 * sizeof *corner);
    }
    grid.cell_count = cells;

    OwnSim *sim = test_sim(&def, grid, &material);
    const SingeView view = singe_sim_view(sim);
    static float points[3 * 4096];
    SingePinDef pin = singe_default_pin();
    double longest = 0;
    for (uint32_t i = 0; i < view.particle_count; i++) {
        if (!(view.particle_flags[i] & SINGE_ALIVE)) continue;
        longest = fmax(longest, (double)view.rest_position[i][0]);
        if (view.rest_position[i][0] > 0.0126f) continue;
        memcpy(points + 3 * pin.point_count++, view.rest_position[i], 3 * sizeof(float));
    }
    pin.sheet = (SingeSheetId){0, 1}, pin.points = points, pin.radius = 1e-5f;
    test_add_pin(sim, &pin);
    test_steps(sim, 480);

    // the tip's sag, of a plate that begins to bend half a row of cells within the clamp
    double sag = 0, count = 0;
    for (uint32_t i = 0; i < view.vertex_count; i++)
        if ((view.particle_flags[i] & SINGE_ALIVE) && (double)view.rest_position[i][0] > longest - 1e-4 &&
            fabsf(view.rest_position[i][1] - (diagonal ? 0 : middle)) < 0.008f)
            sag -= (double)view.position[i][2], count++;
    const double l = longest - 0.0125 + 0.5 * (double)reach, load = 0.08 * 0.2;
    return load * pow(l, 4) / 8 / (sag / count - load * l * l / 2);
}

/// With `isotropic` a strip is as stiff along the mesh's diagonals as along its lines; without it is far softer.
TEST(isotropic_strips_are_equally_stiff) {
    double ratio[2];
    for (int isotropic = 0; isotropic < 2; isotropic++) {
        const double along = strip_stiffness(false, isotropic), diagonal = strip_stiffness(true, isotropic);
        ratio[isotropic] = diagonal / along;
        print_message("isotropic %d: %.3g N m along the mesh, %.3g N m along its diagonals, stated 1e-5\n", isotropic,
                      along, diagonal);
        assert_true(fabs(along / 1e-5 - 1) < 0.1);
    }
    assert_true(ratio[0] < 0.6);
    assert_true(fabs(ratio[1] - 1) < 0.1);
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
