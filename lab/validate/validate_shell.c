// The shell's elasticity compared with theory: a clamped strip that sags, and a disc of two layers that shrink
// differently.
#include <math.h>

#include "bench/geometry.h"
#include "validate/validate.h"

// ---- a clamped strip: w = rho g l^4/(8 D) + rho g l^2/(2 S)

static const double rho = 0.08, gravity = 9.81; // kg/m2, m/s2
static const float beam_length = 0.10f, beam_width = 0.04f, beam_clamped = 0.01f;

typedef struct Beam {
    double thickness, compliance, shear; ///< m, m/N of green and of red
    float cell;
} Beam;

/// Holds both layers over a rectangle of the grid.
static SingeResult hold(SingeSim *sim, const double from[2], const double to[2], double cell, uint32_t keys,
                        const SingePoseKey *path, SingeError *error) {
    float points[3 * 1024];
    SingePinDef pin = singe_default_pin();
    SingePinId id;

    for (double x = from[0]; x <= to[0] + 1e-6; x += cell / 2)
        for (double y = from[1]; y <= to[1] + 1e-6 && pin.point_count < 1024; y += cell / 2) {
            float *p = points + 3 * pin.point_count++;
            p[0] = (float)x;
            p[1] = (float)y;
            p[2] = 0;
        }

    pin.sheet = (SingeSheetId){0, 1};
    pin.points = points;
    pin.radius = 0.3f * (float)cell;
    pin.path_count = keys;
    pin.path = path;
    SingeResult result = singe_sim_add_pin(sim, &pin, &id);
    if (result) *error = *singe_sim_error(sim);
    return result;
}

static void soften(LabGrid *grid) {
    grid->solver.substeps = 12;
    grid->solver.smoothing = grid->solver.height_min = 0;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        grid->solver.regularisation[c] = 1e-3f; // a compliance of r h^2/m itself
        grid->material.compliance[c] = singe_param(0);
    }
    grid->material.grammage = singe_param((float)rho);
    grid->material.damping = singe_param(5);
}

static SingeResult beam_sag(Lab *lab, const Beam *beam, double *sag, SingeError *error) {
    const int nx = (int)lroundf(beam_length / beam->cell), ny = (int)lroundf(beam_width / beam->cell);
    const double from[2] = {0, 0}, to[2] = {(double)beam_clamped, (double)beam_width};
    LabGrid grid = lab_grid(nx, ny, beam->cell);

    soften(&grid);
    grid.gravity = (float)gravity;
    grid.solver.substeps = beam->cell < 0.004f ? 24 : 12;
    grid.material.thickness = singe_param((float)beam->thickness);
    grid.material.compliance[SINGE_GREEN] = singe_param((float)beam->compliance);
    grid.material.compliance[SINGE_RED] = singe_param((float)beam->shear);

    SingeSim *sim;
    TRY(lab_build(lab, &grid, &sim, error));

    SingeResult result = hold(sim, from, to, (double)beam->cell, 0, NULL, error);
    if (!result) result = lab_steps(sim, 960, error);
    *sag = -(double)singe_sim_view(sim).position[ny / 2 * (nx + 1) + nx][2];
    singe_sim_destroy(sim);
    return result;
}

SingeResult validate_beam(Lab *lab, SingeError *error) {
    static const Beam beams[] = {{2e-3, 4e-3, 0, 5e-3f}, {3e-3, 9e-3, 0, 5e-3f},   {4e-3, 16e-3, 0, 5e-3f},
                                 {4e-3, 8e-3, 0, 5e-3f}, {3e-3, 9e-3, 0.4, 5e-3f}, {3e-3, 9e-3, 0, 2.5e-3f}};
    enum { CASES = sizeof beams / sizeof *beams };
    double worst = 0;
    report_heads(lab->report, "t mm|green mm/N|red m/N|cells mm|D N m|sag mm|plate mm|over plate");

    for (int i = 0; i < CASES - (lab->quick ? 1 : 0); i++) {
        const Beam *b = &beams[i];
        double l = (double)(beam_length - beam_clamped), d = b->thickness * b->thickness / b->compliance, sag;
        double plate = rho * gravity * (pow(l, 4) / (8 * d) + l * l / 2 * b->shear);
        TRY(beam_sag(lab, b, &sag, error));
        report_row(lab->report, "%.0f|%.0f|%g|%.1f|%.2g|%.2f|%.2f|%.3f", 1e3 * b->thickness, 1e3 * b->compliance,
                   b->shear, 1e3 * (double)b->cell, d, 1e3 * sag, 1e3 * plate, sag / plate);
        worst = fmax(worst, fabs(sag / plate - 1));
    }

    report_text(lab->report,
                "A strip of 10 by 4 cm, 80 g/m2, clamped over 1 cm. The first three have one stiffness, D = t²/c, by "
                "three thicknesses; the fifth is soft in transverse shear.");
    report_measure(lab->report, "sag", "largest relative difference of the sag from plate theory", worst, 0, 0.15);
    return SINGE_OK;
}

// ---- a bilayer disc: it bends to a cylinder of curvature (1 + nu) k, k the natural one; mean curvature (1 + nu) k/2

static const double disc_radius = 0.03, disc_thickness = 1e-3;

static bool in_disc(double x, double y) { return hypot(x - disc_radius, y - disc_radius) < disc_radius; }

static SingeResult disc_bend(Lab *lab, double shrink, int cells, bool isotropic, double principal[2], double *angle,
                             SingeError *error) {
    LabGrid grid = lab_grid(cells, cells, 2 * (float)disc_radius / (float)cells);
    grid.inside = in_disc;
    lab_sets_mass(&grid.material);
    grid.material.mass_min = singe_param((float)(1 - shrink));
    grid.material.mass_rate = singe_param(2e-4f);
    grid.material.shrink_front = singe_param(0);
    grid.material.thickness = singe_param((float)disc_thickness);
    grid.material.damping = singe_param(4);
    grid.solver.substeps = 0; // full stiffness
    grid.solver.isotropic = isotropic;

    SingeSim *sim;
    TRY(lab_build(lab, &grid, &sim, error));

    SingeResult result = lab_steps(sim, lab->quick ? 960 : 1920, error);
    if (!result) {
        SingeView view = singe_sim_view(sim);
        const double rolls = geometry_curvatures(&view, disc_radius, disc_radius, 0.6 * disc_radius, principal);
        *angle = fmod(rolls * 180 / acos(-1), 90); // which layer is inside does not matter
        if (*angle > 45) *angle = 90 - *angle;
    }

    singe_sim_destroy(sim);
    return result;
}

/// The stiffness of a layer, N/m: along the grid, across to it, in shear.
typedef struct Stiffness {
    double along, coupled, shear;
} Stiffness;

/// Pulls a strip by its ends, or shears it. Only its layer of centres has stiffness, as only that layer is strained
/// when the sheet bends. Reads strain and line force in the centre.
static SingeResult pull_test(Lab *lab, bool shear, Stiffness *out, SingeError *error) {
    enum { ALONG = 30, ACROSS = 10, REACH = 2 };
    const double cell = 2e-3, length = ALONG * cell, width = ACROSS * cell;
    LabGrid grid = lab_grid(ALONG, ACROSS, (float)cell);
    soften(&grid);
    grid.solver.tearing = true; // for the line force
    grid.material.strength = singe_param(INFINITY);
    grid.material.thickness = singe_param((float)disc_thickness);

    SingeMaterialDef usual = singe_default_material();
    grid.material.compliance[SINGE_GREEN] = usual.compliance[SINGE_GREEN];
    grid.material.compliance[SINGE_RED] = usual.compliance[SINGE_RED];
    grid.material.compliance[SINGE_BLUE] = grid.material.compliance[SINGE_YELLOW] = singe_param(1e3f);

    SingeSim *sim;
    TRY(lab_build(lab, &grid, &sim, error));

    const float displacement = (float)(0.02 * length);
    const SingePoseKey path[2] = {{0, {0, 0, 0}, {0, 0, 0, 1}},
                                  {0.5f, {shear ? 0 : displacement, shear ? displacement : 0, 0}, {0, 0, 0, 1}}};
    const double left[2][2] = {{0, 0}, {cell, width}}, right[2][2] = {{length - cell, 0}, {length, width}};
    SingeResult result = hold(sim, left[0], left[1], cell, 0, NULL, error);
    if (!result) result = hold(sim, right[0], right[1], cell, 2, path, error);
    if (!result) result = lab_steps(sim, 960, error);

    if (!result) {
        SingeView view = singe_sim_view(sim);
        const int mid = ACROSS / 2 * ALONG + ALONG / 2;
        const float(*x)[4] = view.position + view.vertex_count, (*r)[4] = view.rest_position + view.vertex_count;
        double g[2][2]; // of the centres' displacement
        for (int k = 0; k < 2; k++)
            for (int d = 0; d < 2; d++) {
                int step = d ? REACH * ALONG : REACH;
                double ahead = (double)(x[mid + step][k] - r[mid + step][k]);
                g[k][d] = (ahead - (double)(x[mid - step][k] - r[mid - step][k])) / (2 * REACH * cell);
            }

        const float *n = view.line_force[mid];
        if (shear) out->shear = fabs((double)n[5]) / fabs(g[0][1] + g[1][0]);
        else {
            out->along = (double)n[0] / g[0][0];
            out->coupled = -g[1][1] / g[0][0] * out->along;
        }
    }

    singe_sim_destroy(sim);
    return result;
}

SingeResult validate_disc(Lab *lab, SingeError *error) {
    enum { CASES = 3 };
    static const double shrinks[CASES] = {0.002, 0.005, 0.01};
    const int cells = lab->quick ? 24 : 32;
    double ratio[CASES], angle = 0;
    Stiffness c;
    SingeResult result = pull_test(lab, false, &c, error);
    if (!result) result = pull_test(lab, true, &c, error);
    if (result) return result;

    // nu of a pull along the diagonal of a square lattice
    const double diagonal = (c.along + c.coupled - 2 * c.shear) / (c.along + c.coupled + 2 * c.shear);

    report_heads(lab->report, "shrunk by %|natural k 1/m|k R²/t|largest 1/m|least 1/m|mean over k|bends at");
    for (int i = 0; i < CASES && !result; i++) {
        double p[2], natural = shrinks[i] / (1 - shrinks[i]) / disc_thickness;
        result = disc_bend(lab, shrinks[i], cells, false, p, &angle, error);
        if (result) return result;
        ratio[i] = (p[0] + p[1]) / 2 / natural;
        report_row(lab->report, "%.1f|%.2f|%.1f|%.2f|%.2f|%.3f|%.0f°", 100 * shrinks[i], natural,
                   natural * disc_radius * disc_radius / disc_thickness, p[0], p[1], ratio[i], angle);
    }

    // a fifth of that bends to a bowl, if nothing prefers a direction
    double bowl[2] = {0, 0}, roll[2] = {0, 0};
    if (!result) result = disc_bend(lab, shrinks[0], cells, true, bowl, &angle, error);
    report_row(lab->report, "%.1f, isotropic||%.1f|%.2f|%.2f||", 100 * shrinks[0],
               shrinks[0] / (1 - shrinks[0]) / disc_thickness * disc_radius * disc_radius / disc_thickness, bowl[0],
               bowl[1]);
    if (!result) result = disc_bend(lab, shrinks[0], cells, false, roll, &angle, error);
    if (result) return result;

    report_text(
        lab->report,
        "A disc of 6 cm whose corner layer shrinks. Bent far it cannot be a bowl (Gauss) and becomes a "
        "cylinder of mean curvature (1 + nu)/2 times the natural one; 3/4 is that of nu = 1/2. This shell is "
        "no isotropic plate: when it bends only the springs of the layer of centres give, which run along the "
        "grid and do not resist shear. Pulled along the grid that layer has %.2f N/m (1/c is %.2f) and nu = "
        "%.3f; sheared, %.3f N/m; so pulled along its diagonal, nu = %.3f. The disc rolls up where that costs "
        "least, at 45° to the grid, and has (1 + nu)/2 = %.3f to show. With the solver's `isotropic` it has no such "
        "direction (`singe bench plate`).",
        c.along, 1 / (double)singe_default_material().compliance[SINGE_GREEN].value, c.coupled / c.along, c.shear,
        diagonal, (1 + diagonal) / 2);

    report_measure(lab->report, "stiffness", "stiffness along the grid times the compliance",
                   c.along * (double)singe_default_material().compliance[SINGE_GREEN].value, 0.9, 1.1);
    report_measure(lab->report, "poisson_grid", "nu along the grid, by a pull test", c.coupled / c.along, -0.1, 0.1);
    report_measure(lab->report, "poisson_diagonal", "nu along the diagonal, by pull and shear tests", diagonal, 0.5, 1);
    report_measure(lab->report, "bowl", "least over largest curvature of the disc of 0.2 %, isotropic: 1 is a bowl",
                   bowl[1] / bowl[0], 0.9, 1);
    report_measure(lab->report, "rolls", "the same by default: rolled up along the mesh's diagonal", roll[1] / roll[0],
                   -0.1, 0.2);
    report_measure(lab->report, "cylinder", "mean curvature over the natural one of the most bent, less (1 + nu)/2",
                   ratio[CASES - 1] - (1 + diagonal) / 2, -0.1, 0.1);

    return SINGE_OK;
}
