// Whether the sheet bends as an isotropic plate, whatever the direction of its mesh, its cells and its substeps.
//
// Strips. A strip of 6 cm by 2 cm, cut from a grid whose lines are at an angle to it, is clamped over 1 cm and sags by
// little. Its stiffness follows from the sag at the middle of the free end,
//
//   w = rho g l^4/(8 D) + rho g l^2/(2 S),   l the free length, S = 1/c_red
//
// and is compared with the D of the material. (A narrow strip is meant: D (1 - nu^2) of a plate.) A row of edges bends by
// what the half cells on both its sides do: l begins half a cell within the clamp.
//
// Discs. The corner layer of a disc of 6 cm shrinks by 1 %, by up to 30 % more or less here and there, as a seeded noise has
// it. The disc rolls up. The noise is fixed in space and the mesh is turned: the disc should roll the same way. k1 and
// k2 are the curvatures of the quadric that fits its inner part, `rolls` the direction of k1 in space.
//
// Each without and with the solver's `isotropic`. The drawing has those with as many substeps as the red springs need, as
// seen from one side and above; strips sag four times as far in it.
#include <math.h>
#include <stdlib.h>

#include "analysis/turned_grid.h"
#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"

static const double pi = 3.14159265358979323846;

typedef struct Plate {
    const BenchOptions *options;
    bool isotropic;
    double angle; ///< rad
    int cells;    ///< along the strip or across the disc
    int substeps; ///< 0: as many as the red springs need
    uint32_t seed;
    bool drawn;
} Plate;

static const double strip_length = 0.06, strip_width = 0.02, clamped = 0.01, disc_diameter = 0.06;
static const double grammage = 0.08, gravity = 0.4; // kg/m2, m/s2

static SingeResult plate_open(const Plate *plate, bool disc, SingeSim **sim, Mesh *mesh, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = plate->options->threads;
    def.instructions = plate->options->instructions;
    def.solver.substeps = plate->substeps;
    def.solver.isotropic = plate->isotropic;
    def.gravity[2] = disc ? 0 : (float)-gravity;
    TRY(singe_sim_create(&def, sim, error));

    SingeSheetDef sheet = singe_default_sheet();
    SingeMaterialDef *material = &sheet.material;
    const SingeField noise = {.kind = SINGE_FIELD_NOISE, .noise = {0.03f, 2, plate->seed}};
    SingeSheetId id;
    const TurnedGrid cut = {.size = disc ? disc_diameter : strip_length,
                            .across = disc ? 0 : strip_width,
                            .cells = plate->cells,
                            .disc = disc,
                            .angle = plate->angle};
    TRY(turned_grid(&cut, mesh, error));

    sheet.vertex_count = mesh->vertex_count;
    sheet.positions = mesh->positions;
    sheet.uv = mesh->uv;
    sheet.cell_count = mesh->cell_count;
    sheet.cells = mesh->cells;
    sheet_inert(material);

    material->grammage = singe_param((float)grammage);
    material->damping = singe_param(disc ? 4 : 20);
    if (disc) {
        // hot from the start: a hundredth of the mass goes within a second, and by eq 5 and 6 the length with it
        const float min = 0.99f, excess = 100;
        material->ignition_temperature = singe_param(500);
        material->temperature = singe_param(500 + excess);
        material->rate_ceiling = singe_param(excess);
        material->mass_rate = singe_param((1 - min) / excess);
        material->ash_exponent = singe_param(0);
        material->mass_min = singe_param(min);
        material->mass_loss = material->char_yield = singe_param(0);
        material->ash_density = singe_param(1);
        material->fibre_shrink = singe_param(1);
        material->shrink_front = singe_param(0);
        material->shrink_back = singe_param_field(0.7f, 1.3f, &noise);
    }

    SingeResult result = singe_sim_add_sheet(*sim, &sheet, &id);
    if (!result) result = singe_sim_commit(*sim);
    return result;
}

static SingeResult plate_run(SingeSim *sim, double seconds) {
    SingeResult result = SINGE_OK;
    while (!result && singe_sim_view(sim).time < seconds - 1e-6) result = singe_sim_step(sim);
    return result;
}

static SingeResult fail(SingeSim *sim, Mesh *mesh, SingeResult result, SingeError *error) {
    if (result && sim && error->code != result) {
        *error = *singe_sim_error(sim);
        error->code = result;
    }
    singe_sim_destroy(sim);
    mesh_free(mesh);
    return result;
}

// ---- the drawing

enum { DRAW_WIDE = 200, DRAW_HIGH = 115, DRAW_TOP = 30, DRAW_LEFT = 110 };

/// The lines of its mesh, in the place of its kind and angle.
static void draw_plate(const Plate *plate, bool disc, const SingeView *view) {
    FILE *svg = plate->options->drawing;
    const double scale = 2.3e3, az = 25 * pi / 180, sine = sin(35 * pi / 180), cosine = cos(35 * pi / 180);
    const double x0 = DRAW_LEFT + DRAW_WIDE * (0.5 + round(plate->angle * 12 / pi));
    const double y0 = DRAW_TOP + DRAW_HIGH * (0.5 + 2 * disc + plate->isotropic);
    fprintf(svg, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.6\" d=\"",
            plate->isotropic ? "#b2182b" : "#2166ac");

    for (uint32_t s = 0; s < view->spring_count[SINGE_BLUE]; s++)
        for (int end = 0; end < 2; end++) {
            const float *p = view->position[view->springs[SINGE_BLUE][s][end]];
            const double x = (double)p[0], y = (double)p[1], z = (double)p[2] * (disc ? 1 : 4);
            fprintf(svg, "%c%.1f %.1f", end ? 'L' : 'M', x0 + scale * (cos(az) * x - sin(az) * y),
                    y0 - scale * (cosine * z + sine * (sin(az) * x + cos(az) * y)));
        }
    fprintf(svg, "\"/>\n");
}

/// Stiffness over that of the material.
static SingeResult strip_bend(const Plate *plate, double *ratio, SingeError *error) {
    SingeSim *sim = NULL;
    Mesh mesh = {0};
    SingeResult result = plate_open(plate, false, &sim, &mesh, error);
    if (result) return fail(sim, &mesh, result, error);

    // both layers of the clamped end
    SingeView view = singe_sim_view(sim);
    SingePinDef pin = singe_default_pin();
    SingePinId id;
    float *points = malloc(3 * (size_t)view.particle_count * sizeof *points);
    if (!points) return fail(sim, &mesh, SINGE_ERROR_MEMORY, error);

    for (uint32_t i = 0; i < view.particle_count; i++)
        if ((double)view.rest_position[i][0] < clamped - strip_length / 2 + 1e-5) {
            float *point = points + 3 * (size_t)pin.point_count++;
            for (int k = 0; k < 3; k++) point[k] = view.rest_position[i][k];
        }

    pin.points = points;
    pin.radius = 1e-5f;
    pin.sheet = (SingeSheetId){0, 1};
    result = singe_sim_add_pin(sim, &pin, &id);
    free(points);
    if (!result) result = plate_run(sim, 1.5);
    view = singe_sim_view(sim);
    if (!result && plate->drawn) draw_plate(plate, false, &view);

    // mean sag of the middle of the free end
    double sag = 0, count = 0;
    for (uint32_t v = 0; v < view.vertex_count; v++) {
        const double x = (double)view.rest_position[v][0], y = (double)view.rest_position[v][1];
        if (x < strip_length / 2 - 1e-5 || fabs(y) > strip_width / 4) continue;
        sag -= (double)view.position[v][2];
        count++;
    }

    const SingeMaterialDef usual = singe_default_material();
    const double l = strip_length - clamped + 0.5 * strip_length / plate->cells, load = grammage * gravity,
                 t = (double)usual.thickness.value;
    const double stated = t * t / (double)usual.compliance[SINGE_GREEN].value;
    const double bends = sag / count - load * l * l / 2 * (double)usual.compliance[SINGE_RED].value;
    *ratio = load * pow(l, 4) / (8 * bends) / stated;
    return fail(sim, &mesh, result, error);
}

static SingeResult disc_roll(const Plate *plate, double curvature[2], double *rolls, SingeError *error) {
    SingeSim *sim = NULL;
    Mesh mesh = {0};
    SingeResult result = plate_open(plate, true, &sim, &mesh, error);
    if (!result) result = plate_run(sim, 2);
    if (result) return fail(sim, &mesh, result, error);

    const SingeView view = singe_sim_view(sim);
    if (plate->drawn) draw_plate(plate, true, &view);
    *rolls = geometry_curvatures(&view, 0, 0, 0.3 * disc_diameter, curvature) * 180 / pi;
    return fail(sim, &mesh, result, error);
}

static SingeResult plate_row(const Plate *plate, bool disc, BenchTable *table, SingeError *error) {
    double ratio = NAN, curvature[2] = {NAN, NAN}, rolls = NAN;
    TRY(disc ? disc_roll(plate, curvature, &rolls, error) : strip_bend(plate, &ratio, error));

    table_text(table, "part", 6, disc ? "disc" : "strip");
    table_text(table, "isotropic", 10, plate->isotropic ? "yes" : "no");
    table_number(table, "mesh_deg", "%.0f", 9, plate->angle * 180 / pi);
    table_number(table, "cell_mm", "%.3g", 8, 1e3 * (disc ? disc_diameter : strip_length) / plate->cells);
    table_number(table, "substeps", "%.0f", 9, plate->substeps);
    table_number(table, "over_D", "%.3f", 7, ratio);
    table_number(table, "k1_per_m", "%.2f", 9, curvature[0]);
    table_number(table, "k2_per_m", "%.2f", 9, curvature[1]);
    table_number(table, "rolls_deg", "%.0f", 10, rolls);

    return table_end_row(table);
}

SingeResult bench_plate(const BenchOptions *options, BenchTable *table, SingeError *error) {
    static const double angles[] = {0, 15, 30, 45}, few_angles[] = {0, 45};
    static const int substeps[] = {3, 8, 24, 0};
    const int angle_count = options->quick ? 2 : 4, usual = options->cells.count ? (int)options->cells.values[0] : 24;
    SingeResult result = SINGE_OK;
    FILE *svg = options->drawing;
    if (svg) {
        static const char *const rows[4] = {"strips", "strips, isotropic", "discs", "discs, isotropic"};
        fprintf(svg,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
                "font-family=\"sans-serif\" font-size=\"13\"><rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                DRAW_LEFT + 4 * DRAW_WIDE, DRAW_TOP + 4 * DRAW_HIGH, DRAW_LEFT + 4 * DRAW_WIDE,
                DRAW_TOP + 4 * DRAW_HIGH);

        for (int k = 0; k < 4; k++) {
            fprintf(svg, "<text x=\"%d\" y=\"20\" text-anchor=\"middle\">mesh at %d°</text>\n",
                    DRAW_LEFT + DRAW_WIDE * k + DRAW_WIDE / 2, 15 * k);
            fprintf(svg, "<text x=\"8\" y=\"%d\">%s</text>\n", DRAW_TOP + DRAW_HIGH * k + DRAW_HIGH / 2, rows[k]);
        }
    }

    for (int isotropic = 0; isotropic < 2; isotropic++) {
        Plate plate = {.options = options, .isotropic = isotropic, .seed = 1};
        plate.cells = usual;

        // strips by angle and substeps
        for (int s = options->quick ? 2 : 0; s < (options->quick ? 3 : 4); s++)
            for (int a = 0; a < angle_count && !result; a++) {
                plate.substeps = options->substeps ? options->substeps : substeps[s];
                plate.angle = (options->quick ? few_angles : angles)[a] * pi / 180;
                plate.drawn = options->drawing && s == (options->quick ? 2 : 3);
                result = plate_row(&plate, false, table, error);
            }

        // by cells, at as many substeps as they need
        for (int cells = 12; cells <= 48 && !result && !options->quick; cells *= 2) {
            plate.cells = cells;
            plate.substeps = 0;
            plate.angle = 0;
            plate.drawn = false;
            result = plate_row(&plate, false, table, error);
        }

        // discs, whose noise stays while the mesh turns
        for (int a = 0; a < 4 && !result; a++) {
            plate.cells = usual;
            plate.substeps = 0;
            plate.drawn = options->drawing;
            plate.angle = angles[a] * pi / 180;
            result = plate_row(&plate, true, table, error);
        }
    }

    if (options->drawing) fprintf(options->drawing, "</svg>\n");
    return result;
}
