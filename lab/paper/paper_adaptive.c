// Section 8.2, adaptivity: the possible savings of cells that are refined near the front, and their appearance,
// compared with uniform cells. A strip burns from its left end; one of its meshes is graded as refinement would grade
// it when the front is halfway.
#include <math.h>
#include <string.h>

#include "page/appearance.h"
#include "paper/paper.h"

enum { FINE, GRADED, EQUAL, COARSE, PLAIN, STRIPS }; ///< PLAIN: coarse, its front not thickened; not drawn

static const struct {
    const char *name, *scene, *sets[3]; ///< the sets end with NULL
} strips[STRIPS] = {
    [FINE] = {"uniform, 1.5 mm", "adaptive.yaml", {NULL}},
    [GRADED] = {"graded, 1.5 and 4.5 mm", "graded.yaml", {NULL}},
    [EQUAL] = {"uniform, 1.8 mm", "adaptive.yaml", {"sheets.0.grid.cells=[59, 20]"}},
    [COARSE] = {"uniform, 4.5 mm", "adaptive.yaml", {"sheets.0.grid.cells=[24, 8]"}},
    [PLAIN] = {"4.5 mm, not thickened",
               "adaptive.yaml",
               {"sheets.0.grid.cells=[24, 8]", "sheets.0.material.thickening=1"}},
};

typedef struct Strip {
    Look look;
    double springs, speed; ///< mm/s
    double cells, first;   ///< share of the fine cells that refinement needs: mean over the burn, and at its start
} Strip;

static SingeResult strip_run(Lab *lab, int i, Strip *strip, SingeError *error) {
    enum { LOOKS = 34 };
    Play play;
    SingeResult result = play_open(&play, lab, strips[i].scene, strips[i].sets, error);
    for (int k = 1; k <= LOOKS && !result; k++) {
        result = play_until(&play, 0.1 * k, error);
        if (result) break;
        const SingeView view = singe_sim_view(play.sim);

        // the share of the strip that needs refined cells: everything that has ignited, and 10 mm in front of it
        double front = -INFINITY, low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < view.vertex_count; v++) {
            const double x = (double)view.rest_position[v][0];
            low = fmin(low, x);
            high = fmax(high, x);
            if (view.time_ignited[v] >= 0) front = fmax(front, x);
        }

        const double share = front < low ? 0.01 / (high - low) : fmin(1, (front + 0.01 - low) / (high - low));
        const double cells = share + (1 - share) / 9; // elsewhere one in place of 3 x 3
        strip->cells += cells / LOOKS;
        if (k == 2) strip->first = cells;
        if (k == 10 || k == 13 || k == 16) result = look_take(&play, 0, &strip->look, error);

        if (k == 16) {
            for (int c = 0; c < SINGE_COLOUR_COUNT; c++) strip->springs += view.spring_count[c];
            strip->speed = 1e3 * singe_sim_stats(play.sim).front_speed;
            if (!result && i != PLAIN) result = play_shoot(&play, strips[i].name, error);
            if (i != FINE) break;
        }
    }

    play_close(&play);
    return result;
}

enum { IRREGULAR_STEPS = 96 };

/// The number of IRREGULAR_STEPS that the paper's solver completes on the graded strip with finite results.
static SingeResult steps_taken(Lab *lab, const char *solver, int *steps, SingeError *error) {
    Play play;
    const char *sets[] = {solver, "sheets.0.material.compliance={red: 0, green: 0, blue: 0, yellow: 0}", NULL};
    SingeResult result = play_open(&play, lab, "graded.yaml", sets, error);
    for (*steps = 0; !result && *steps < IRREGULAR_STEPS && !singe_sim_step(play.sim); ++*steps)
        if (!(singe_sim_stats(play.sim).strain_mean < 0.5)) break;
    play_close(&play);
    return result;
}

// ---- discs around a vertex of many cells

enum { FANS = 3, FAN_RINGS = 5, FAN_STEPS = 200 };
static const int fan_cells[FANS] = {8, 12, 16};

/// A disc of 5 cm of quads, of which `n` meet in its centre, held there; its rim falls. Vertex 0 is the centre.
static SingeResult fan_build(SingeSim *sim, int n) {
    const uint32_t around = 2 * (uint32_t)n, last = FAN_RINGS - 1;
    float positions[3 * (1 + 32 * FAN_RINGS)] = {0};
    uint32_t cells[4 * (16 + 32 * (FAN_RINGS - 1))], *c = cells;

    for (uint32_t ring = 0, v = 3; ring < FAN_RINGS; ring++)
        for (uint32_t i = 0; i < around; i++, v += 3) {
            const double angle = 2 * acos(-1) * i / around, radius = 0.05 * (ring + 1) / FAN_RINGS;
            positions[v] = (float)(radius * cos(angle));
            positions[v + 1] = (float)(radius * sin(angle));
        }

    for (uint32_t i = 0; i < around; i += 2, c += 4)
        memcpy(c, (uint32_t[4]){0, 1 + i, 2 + i, 1 + (i + 2) % around}, 4 * sizeof *c);

    for (uint32_t ring = 0; ring < last; ring++)
        for (uint32_t i = 0; i < around; i++, c += 4) {
            const uint32_t inner = 1 + ring * around, outer = inner + around, next = (i + 1) % around;
            memcpy(c, (uint32_t[4]){inner + i, outer + i, outer + next, inner + next}, 4 * sizeof *c);
        }

    SingeSheetDef def = singe_default_sheet();
    SingeSheetId sheet;

    def.vertex_count = 1 + around * FAN_RINGS;
    def.positions = positions;
    def.cell_count = (uint32_t)(c - cells) / 4;
    def.cells = cells;
    def.material.damping = singe_param(2);
    for (int k = 0; k < SINGE_COLOUR_COUNT; k++) def.material.compliance[k] = singe_param(0);

    SingeResult result = singe_sim_add_sheet(sim, &def, &sheet);
    if (!result) result = singe_sim_commit(sim);
    if (result) return result;

    SingePinDef pin = singe_default_pin();
    const uint32_t centre[] = {0};
    SingePinId id;

    pin.sheet = sheet;
    pin.vertex_count = 1;
    pin.vertices = centre;
    return singe_sim_add_pin(sim, &pin, &id);
}

/// Whether the paper's solver takes all steps, and the mean strain of its mesh edges after them. The floor is what is
/// added to the diagonal.
static SingeResult fan_run(const Lab *lab, int n, SingeSolverMethod method, float floor, bool *whole, double *strain,
                           SingeError *error) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    singe_init_solver_method(&def.solver, sizeof def.solver, method);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) def.solver.regularisation[c] = floor;
    def.time_step = 0.002f;
    def.thread_count = lab->threads;
    SingeResult result = singe_sim_create(&def, &sim, error);
    if (result) return result;

    if ((result = fan_build(sim, n))) *error = *singe_sim_error(sim);
    int steps = 0;
    while (!result && steps < FAN_STEPS && !singe_sim_step(sim)) steps++;
    *whole = steps == FAN_STEPS;
    *strain = *whole ? singe_sim_stats(sim).strain_mean : INFINITY;
    singe_sim_destroy(sim);
    return result;
}

static SingeResult fans_report(Lab *lab, SingeError *error) {
    double worst = 0, literal = 0, strain[3];
    report_heads(lab->report, "springs of a colour at a point|strain %, floor of 1e-4|of 1e-6|to the letter");

    for (int i = 0; i < FANS; i++) {
        bool whole[3];
        SingeResult result = fan_run(lab, fan_cells[i], SINGE_SOLVER_PAPER, 1e-4f, &whole[0], &strain[0], error);
        if (!result) result = fan_run(lab, fan_cells[i], SINGE_SOLVER_PAPER, 1e-6f, &whole[1], &strain[1], error);
        if (!result)
            result = fan_run(lab, fan_cells[i], SINGE_SOLVER_PAPER_LITERAL, 1e-4f, &whole[2], &strain[2], error);
        if (result) return result;

        report_row(lab->report, "%d|%.4f|%.4f|%.4f", fan_cells[i], 100 * strain[0], 100 * strain[1], 100 * strain[2]);
        worst = fmax(worst, fmax(strain[0], strain[1]));
        literal = fmax(literal, strain[2]);
    }

    report_text(lab->report, "Discs held in their centre, where 8, 12 and 16 springs of a colour meet, after 0.4 s.");
    report_bar(lab->report, "fans",
               "largest mean strain of a disc with 8, 12 or 16 springs of a colour at a "
               "point, by the paper's solver",
               worst, 0, 0.02, literal, "to its letter");
    return SINGE_OK;
}

SingeResult paper_adaptive(Lab *lab, SingeError *error) {
    Strip s[STRIPS] = {{.cells = 0}};
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, 2);
    for (int i = 0; i < STRIPS && !result; i++) result = strip_run(lab, i, &s[i], error);

    int steps[2] = {0};
    if (!result) result = steps_taken(lab, "solver=paper", &steps[0], error);
    if (!result) result = steps_taken(lab, "solver=paper-literal", &steps[1], error);
    if (result) return result;

    report_heads(lab->report, "cells|springs|front mm/s|ms a step|curl, median|90 of 100|slope, median|strain p99 %");
    for (int i = 0; i < PLAIN; i++)
        report_row(lab->report, "%s|%.0f|%.2f|%.2f|%.1f|%.1f|%.1f|%.1f", strips[i].name, s[i].springs, s[i].speed,
                   s[i].look.step_ms, look_curl(&s[i].look, 0.5), look_curl(&s[i].look, 0.9),
                   look_slope(&s[i].look, 0.5), 100 * s[i].look.strain_p99);

    const double saving = 1 / s[FINE].cells, cost = s[EQUAL].look.step_ms / s[GRADED].look.step_ms;
    const double speeds[3] = {s[FINE].speed, s[GRADED].speed, s[EQUAL].speed};
    const double low = fmin(s[COARSE].speed, fmin(speeds[0], fmin(speeds[1], speeds[2])));
    const double high = fmax(s[COARSE].speed, fmax(speeds[0], fmax(speeds[1], speeds[2])));

    report_text(
        lab->report,
        "Strands take a mesh of two sizes of cells as it is, with vertices of three and five edges between them: "
        "\"does not converge\" is not so here. But refining saves little. Fine cells are needed wherever it has "
        "burnt, since that is where it wrinkles, and before the front: over this burn cells three times as large "
        "elsewhere save a factor of %.2f at most, half way %.2f as measured, and strain at the seam is higher. "
        "Uniform cells of the same number as the graded ones are 1.2 times as large; their front is as fast, their "
        "edge is drawn as finely, and they curl as far where they curl most (the median curl is less, %.0f against "
        "%.0f degrees). That is not worth meshing again at every step, so cells are uniform.",
        saving, s[FINE].look.step_ms / s[GRADED].look.step_ms, look_curl(&s[EQUAL].look, 0.5),
        look_curl(&s[FINE].look, 0.5));
    report_bar(lab->report, "speed", "fastest front over slowest, over these cells", high / low, 1, 1.15,
               high / fmax(s[PLAIN].speed, 1e-3), "coarse cells whose front is not thickened");
    report_bar(lab->report, "cost", "ms a step, uniform cells of 1.8 mm over graded ones", cost, 0.5, 1.5,
               s[COARSE].look.step_ms / s[GRADED].look.step_ms, "uniform cells of 4.5 mm");

    const double fine = look_curl(&s[FINE].look, 0.9), coarse = look_curl(&s[COARSE].look, 0.9);
    report_bar(lab->report, "curl", "curl of the rim, 90 of 100 have less, uniform cells of 1.8 mm over 1.5 mm",
               look_curl(&s[EQUAL].look, 0.9) / fine, 0.8, 1.25, coarse / fine, "uniform cells of 4.5 mm");
    report_bar(lab->report, "graded", "the same, graded cells over 1.5 mm", look_curl(&s[GRADED].look, 0.9) / fine, 0.8,
               1.25, coarse / fine, "uniform cells of 4.5 mm");
    report_bar(lab->report, "saving", "the most that refining saves over this burn, a factor", saving, 1, 2.5,
               1 / s[FINE].first, "as it begins to burn");
    report_bar(lab->report, "irregular",
               "steps of 96 on the graded strip, whose springs have up to 8 "
               "neighbours, by the paper's solver",
               steps[0], IRREGULAR_STEPS, IRREGULAR_STEPS, steps[1], "to its letter");

    return fans_report(lab, error);
}
