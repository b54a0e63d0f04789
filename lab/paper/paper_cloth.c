// The paper's results without fire: figures 7 and 10 and the inhomogeneous weights of section 7.2.
#include <math.h>
#include <stdio.h>

#include "paper/paper.h"

// ---- Fig 7 a, b: a torus on a sphere

typedef struct Torus {
    const char *caption, *scene, *set;
    bool held; ///< what is expected
    const char *measure, *what;
} Torus;

static const Torus toruses[] = {
    {"strand", "fig7a.yaml", "solver={method: strand, substeps: 5}", true, "strand",
     "strand: lowest end of the torus, m above the ground"},
    {"the paper's solver", "fig7a.yaml", "", true, "paper", "the paper's solver: the same"},
    {"mass-spring, 1 N/m", "fig7b.yaml", "", false, "soft", "mass-spring of 1 N/m: the same"},
    {"mass-spring, 100 N/m", "fig7b.yaml", "solver={method: mass-spring, stiffness: 100, substeps: 60}", true, "stiff",
     "mass-spring of 100 N/m: the same"},
};

SingeResult paper_fig7ab(Lab *lab, SingeError *error) {
    static const double times[] = {0, 0.2, 0.4, 1.5};
    const int shots = 4;
    SingeResult result = SINGE_OK;
    double lowest[4];

    report_pictures(lab->report, shots);
    for (int i = 0; i < 4 && !result; i++) {
        Play play;
        const char *sets[] = {toruses[i].set, lab->quick ? "sheets.0.mesh=torus-small.obj" : "", NULL};
        result = play_open(&play, lab, toruses[i].scene, sets, error);
        for (int k = 0; k < shots && !result; k++) {
            char caption[80];
            snprintf(caption, sizeof caption, "%s, %g s", toruses[i].caption, times[k]);
            result = play_until(&play, lab->quick ? 0.55 * times[k] : times[k], error);
            if (!result) result = play_shoot(&play, caption, error);
        }

        if (!result) {
            SingeView view = singe_sim_view(play.sim);
            double low[3], high[3];
            shape_bounds(&view, low, high);
            lowest[i] = low[2];
        }

        play_close(&play);
    }

    for (int i = 0; i < 4 && !result; i++) // the cloth that stays up against the soft one, and vice versa
        report_bar(lab->report, toruses[i].measure, toruses[i].what, lowest[i], toruses[i].held ? 0.05 : -INFINITY,
                   toruses[i].held ? INFINITY : 0.02, lowest[toruses[i].held ? 2 : 0],
                   toruses[toruses[i].held ? 2 : 0].caption);
    report_text(lab->report,
                "The sphere stands free above the ground. What the mass-spring model does is a matter of its "
                "stiffness, of which the paper says nothing: springs of 1 N/m stretch under the torus' weight of 0.13 "
                "N, those of 100 N/m hold it, at the price of three times as many substeps.");
    return result;
}

// ---- Fig 7 c, d: the blue layer shrinks everywhere

enum { SHRINK_STRAND, SHRINK_PAPER, SHRINK_SOFT, SHRINK_STIFF, SHRINK_CASES, SHRINK_SCENE = SHRINK_CASES, SHRINK_ALL };
enum { MOMENTS = 20 };

/// A method over all moments; moment k is 0.1 (k + 1) s.
typedef struct Wrinkling {
    double height[MOMENTS]; ///< m, root mean square, of waves from four cells to 5 cm
    double bend[MOMENTS];   ///< degrees from cell to cell
} Wrinkling;

static const struct {
    const char *name, *scene, *set, *ink;
} shrink_cases[SHRINK_ALL] = {
    {"strand", "fig7c.yaml", "solver={method: strand, substeps: 10}", "#2166ac"},
    {"the paper's solver", "fig7c.yaml", "", "#5aae61"},
    {"mass-spring, 1 N/m", "fig7d.yaml", "solver={method: mass-spring, stiffness: 1, substeps: 20}", "#e08214"},
    {"mass-spring, 100 N/m", "fig7d.yaml", "solver={method: mass-spring, stiffness: 100, substeps: 60}", "#b2182b"},
    {"mass-spring, 0.04 N/m", "fig7d.yaml", "", NULL},
};

static SingeResult shrink_run(Lab *lab, int i, int n, bool drawn, Wrinkling *out, SingeError *error) {
    const double cell = 0.2 / n;
    char grid[60], usual[160] = "";
    snprintf(grid, sizeof grid, "sheets.0.grid.cells=[%d, %d]", n, n);
    if (i == SHRINK_STRAND) lab_usual_compliance(usual, sizeof usual);

    const char *sets[] = {shrink_cases[i].set, grid, usual, NULL};
    Play play;
    SingeResult result = play_open(&play, lab, shrink_cases[i].scene, sets, error);
    for (int k = 0; k < MOMENTS && !result; k++) {
        result = play_until(&play, 0.1 * (k + 1), error);
        if (result) break;

        const SingeView view = singe_sim_view(play.sim);
        ShapeSpectrum spectrum;
        result = shape_spectrum(&view, n, n, cell, &spectrum);

        double power = 0;
        for (int b = 0; b < SHAPE_BANDS; b++)
            if (!isnan(spectrum.height[b]) && spectrum.wave[b] >= 4 * cell && spectrum.wave[b] <= 0.05)
                power += spectrum.height[b] * spectrum.height[b];
        out->height[k] = sqrt(power);
        out->bend[k] = shape_bend(&view);
        if (result || !drawn || (k != 3 && k != 6 && k != 9 && k != MOMENTS - 1)) continue;

        char caption[80];
        snprintf(caption, sizeof caption, "%s, %.1f s, blue %.0f %% shorter", shrink_cases[i].name, 0.1 * (k + 1),
                 fmin(30, 2 * (k + 1)));
        result = play_shoot(&play, caption, error);
    }

    play_close(&play);
    return result;
}

/// The share of the moments from `from` on in which a has higher wrinkles than b.
static double shrink_share(const Wrinkling *a, const Wrinkling *b, int from) {
    int count = 0;
    for (int k = from; k < MOMENTS; k++) count += a->height[k] > b->height[k];
    return (double)count / (MOMENTS - from);
}

/// m, from 0.2 s on.
static double least_height(const Wrinkling *wrinkling) {
    double least = INFINITY;
    for (int k = 1; k < MOMENTS; k++) least = fmin(least, wrinkling->height[k]);
    return least;
}

SingeResult paper_fig7cd(Lab *lab, SingeError *error) {
    enum { FINER = 60 };
    Wrinkling w[SHRINK_CASES], finer, pressed;
    double percent[MOMENTS];
    const int n = lab->quick ? 24 : 32;
    SingeResult result = SINGE_OK;

    report_pictures(lab->report, 4);
    for (int i = 0; i < SHRINK_CASES && !result; i++) result = shrink_run(lab, i, n, true, &w[i], error);
    if (!result) result = shrink_run(lab, SHRINK_SOFT, FINER, false, &finer, error);
    if (!result) result = shrink_run(lab, SHRINK_SCENE, FINER, false, &pressed, error);
    if (result) return result;

    Plot plot = {.title = "Wrinkles while the blue layer shrinks by 30 % in 1.5 s",
                 .x_label = "s",
                 .y_label = "rms height, m",
                 .log_y = true};

    for (int k = 0; k < MOMENTS; k++) percent[k] = 0.1 * (k + 1);
    for (int i = 0; i < SHRINK_CASES; i++)
        plot_add(&plot,
                 (PlotLine){shrink_cases[i].name, shrink_cases[i].ink, percent, w[i].height, MOMENTS, false, false});
    report_plot(lab->report, &plot);
    report_heads(lab->report, "s|strand, mm|degrees|paper's solver|degrees|1 N/m|degrees|100 N/m|degrees");

    for (int k = 0; k < MOMENTS; k++)
        report_row(lab->report, "%.1f|%.3f|%.1f|%.3f|%.1f|%.3f|%.1f|%.3f|%.1f", percent[k], 1e3 * w[0].height[k],
                   w[0].bend[k], 1e3 * w[1].height[k], w[1].bend[k], 1e3 * w[2].height[k], w[2].bend[k],
                   1e3 * w[3].height[k], w[3].bend[k]);
    report_text(
        lab->report,
        "Root mean square height of waves from four cells to 5 cm along the grid's lines, and the angle from cell "
        "to cell, at all moments.");

    const double soft = shrink_share(&w[SHRINK_PAPER], &w[SHRINK_SOFT], 0);
    const double firm = shrink_share(&w[SHRINK_STIFF], &w[SHRINK_PAPER], 0);
    const int last = MOMENTS - 1;
    report_text(
        lab->report,
        "The outcome is one of the springs' stiffness and the cells' size, and not of the method. Springs of 1 N/m are "
        "pressed together and lose all detail in cells as large as these, as in the paper's figure; in %d cells a side "
        "they have %.2f mm of it at the end. Springs of 100 N/m give so much in their plane that the sheet buckles as "
        "a whole and rolls up, with longer and fewer waves, higher than the paper's in %.0f %% of the moments.",
        FINER, 1e3 * finer.height[last], 100 * firm);

    // how far its weight bends a cell of springs of 1 N/m, rho g s^4/(k t^2), over the thickness: 80 g/m2, 1 mm
    const double weight = 0.08 * 9.81 / 1 / pow(1e-3, 3);
    report_text(lab->report,
                "Its weight is what holds a soft sheet flat on the ground: it stays flat where a cell bends under its "
                "weight by more than half of the thickness t, by rho g s&#8308;/(k t²). That is %.2g t in these cells "
                "of springs of 1 N/m; %.2g t in %d cells a side, where they wrinkle; and %.2g t of springs of 0.04 N/m "
                "in those, which stay flat. What wrinkles is higher than by the paper's method, because it gives in "
                "its plane, too.",
                weight * pow(0.2 / n, 4), weight * pow(0.2 / FINER, 4), FINER, weight * pow(0.2 / FINER, 4) / 0.04);

    report_bar(lab->report, "soft",
               "share of the moments in which the paper's method has higher wrinkles than "
               "springs of 1 N/m",
               soft, 0.9, 1, 1 - firm, "than springs of 100 N/m");
    report_bar(lab->report, "wrinkles",
               "m, height of the wrinkles by the paper's method at the end, of a sheet of 200 mm",
               w[SHRINK_PAPER].height[last], 2e-4, INFINITY, w[SHRINK_SOFT].height[last], "springs of 1 N/m");
    report_bar(lab->report, "soft_finer", "m, the same of springs of 1 N/m, in 60 cells a side", finer.height[last],
               2e-4, INFINITY, w[SHRINK_SOFT].height[last], "in the cells of the others");
    report_bar(lab->report, "pressed", "m, the same of springs of 0.04 N/m in these finer cells: they lie flat",
               pressed.height[last], 0, 1e-5, finer.height[last], "of 1 N/m");
    report_bar(lab->report, "strand", "the same of our strands", shrink_share(&w[SHRINK_STRAND], &w[SHRINK_SOFT], 0),
               0.9, 1, shrink_share(&w[SHRINK_STRAND], &w[SHRINK_STIFF], 0), "than springs of 100 N/m");
    report_bar(lab->report, "stiff", "m, the least height from 0.2 s on of springs of 100 N/m: they do not lose them",
               least_height(&w[SHRINK_STIFF]), 1e-4, INFINITY, least_height(&w[SHRINK_SOFT]), "springs of 1 N/m");

    return SINGE_OK;
}

// ---- Fig 10: thickness and weights

enum { SHELLS = 4 };

typedef struct Shell10 {
    const char *name, *scene;
    const char *weight; ///< in place of the scene's; NULL: its own
} Shell10;

enum { SHELL_A, SHELL_B, SHELL_C, SHELL_D, SHELL_B_NEAR, SHELL_C_NEAR, SHELL_RUNS };

static const Shell10 shells[SHELL_RUNS] = {{"(a) 1:20, 1.0", "fig10a.yaml", NULL},
                                           {"(b) 1:80, 1.0", "fig10b.yaml", NULL},
                                           {"(c) 1:400, 1.0", "fig10c.yaml", NULL},
                                           {"(d) 1:400, 0.1", "fig10d.yaml", NULL},
                                           // almost no change: the bars must not accept it as a difference
                                           {"1:80, 0.9", "fig10b.yaml", "0.9"},
                                           {"1:400, 0.9", "fig10c.yaml", "0.9"}};

/// The folds over the sphere depend on the mesh: for strands the measures are means over these.
enum { FIG10_MESHES = 4, FIG10_DRAWN = 32, FIG10_PAPERS = 16 };
static const int fig10_meshes[FIG10_MESHES] = {24, 28, FIG10_DRAWN, 36};

/// Adds a share of the run's measures.
static SingeResult shell_run(Lab *lab, const Shell10 *shell, int n, bool papers, double *sag, double *bend,
                             SingeError *error) {
    char weight[80] = "", grid[60], caption[80], usual[160];
    lab_usual_compliance(usual, sizeof usual);
    snprintf(grid, sizeof grid, "sheets.0.grid.cells=[%d, %d]", n, n);
    if (shell->weight)
        snprintf(weight, sizeof weight, "sheets.0.material.weight={blue: %s, yellow: %s}", shell->weight,
                 shell->weight);

    Play play;
    const char *sets[] = {weight, grid, papers ? "" : "solver={method: strand, substeps: 10}", papers ? "" : usual,
                          NULL};
    SingeResult result = play_open(&play, lab, shell->scene, sets, error);
    if (!result) result = play_until(&play, 1.5, error);
    snprintf(caption, sizeof caption, "%s%s", shell->name, papers ? ", the paper's solver" : "");
    if (!result && shell < &shells[SHELL_B_NEAR] && (papers || n == FIG10_DRAWN))
        result = play_shoot(&play, caption, error);

    const SingeView view = play.sim ? singe_sim_view(play.sim) : (SingeView){0};
    double down = 0, slope = 0;
    if (!result) {
        // m, height of the sheet's centre above the mean of its border; degrees, bending of the sheet from there: the
        // mean slope of the border's cells, across the border
        const uint32_t row = (uint32_t)n + 1, last = (uint32_t)n;
        double border = 0, border_slope = 0, count = 0;
        for (uint32_t i = 1; i < last; i++) {
            const uint32_t pairs[4][2] = {{i, i + row},
                                          {i + row * last, i + row * (last - 1)},
                                          {i * row, i * row + 1},
                                          {i * row + last, i * row + last - 1}};
            for (int k = 0; k < 4; k++, count++) {
                const float *p = view.position[pairs[k][0]], *q = view.position[pairs[k][1]];
                double across = hypot((double)p[0] - (double)q[0], (double)p[1] - (double)q[1]);
                border += (double)p[2];
                border_slope += atan2((double)q[2] - (double)p[2], across) * 180 / acos(-1);
            }
        }

        down = (double)view.position[row * (last / 2) + last / 2][2] - border / count;
        slope = border_slope / count;
    }

    *sag += papers ? down : down / FIG10_MESHES;
    *bend += papers ? slope : slope / FIG10_MESHES;
    play_close(&play);
    return result;
}

static SingeResult shell_runs(Lab *lab, const Shell10 *shell, double *sag, double *bend, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int k = 0; k < FIG10_MESHES && !result; k++)
        result = shell_run(lab, shell, fig10_meshes[k], false, sag, bend, error);
    return result;
}

SingeResult paper_fig10(Lab *lab, SingeError *error) {
    double sag[2][SHELLS] = {{0}}, bend[2][SHELLS] = {{0}}, more[2] = {0}, unused = 0;
    SingeResult result = SINGE_OK;

    report_pictures(lab->report, SHELLS);
    for (int i = 0; i < SHELLS && !result; i++) result = shell_runs(lab, &shells[i], &sag[0][i], &bend[0][i], error);
    for (int i = 0; i < SHELLS && !result; i++)
        result = shell_run(lab, &shells[i], FIG10_PAPERS, true, &sag[1][i], &bend[1][i], error);
    for (int i = 0; i < 2 && !result; i++)
        result = shell_runs(lab, &shells[SHELL_B_NEAR + i], &unused, &more[i], error);

    if (!result) {
        report_heads(lab->report, "thickness, weight|sag, mm|bend, degrees|paper's solver, mm|degrees");
        for (int i = 0; i < SHELLS; i++)
            report_row(lab->report, "%s|%.1f|%.2f|%.1f|%.2f", shells[i].name, 1e3 * sag[0][i], bend[0][i],
                       1e3 * sag[1][i], bend[1][i]);
        report_text(
            lab->report,
            "Sag: height of the centre over the mean of the border. Bend: the mean slope of the border's cells, "
            "across the border. By strands both are means over sheets of 24, 28, 32 and 36 cells a side, which fold "
            "in different ways; by the paper's solver the sheet has 16.");

        const double near = more[0] / bend[0][SHELL_B], weak = more[1] / bend[0][SHELL_C];
        report_bar(lab->report, "sag_b_a", "sag, (b) over (a)", sag[0][SHELL_B] / sag[0][SHELL_A], 1.5, INFINITY,
                   sag[0][SHELL_C] / sag[0][SHELL_B], "(c) over (b)");
        report_bar(lab->report, "bend_b_a", "bend, (b) over (a)", bend[0][SHELL_B] / bend[0][SHELL_A], 1.5, INFINITY,
                   bend[0][SHELL_C] / bend[0][SHELL_B], "(c) over (b)");
        report_bar(lab->report, "bend_c_b", "bend, (c) over (b)", bend[0][SHELL_C] / bend[0][SHELL_B], 1.05, INFINITY,
                   near, "(b) with weights of 0.9 over (b)");
        report_bar(lab->report, "bend_d_c", "bend, (d) over (c)", bend[0][SHELL_D] / bend[0][SHELL_C], 1.1, INFINITY,
                   weak, "(c) with weights of 0.9 over (c)");
    }

    return result;
}

// ---- section 7.2: weights that vary over one sheet

SingeResult paper_weights(Lab *lab, SingeError *error) {
    double fall[2][2] = {{0}}; // of the scene, and with the soft weight everywhere
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, 3);

    for (int even = 0; even < 2 && !result; even++) {
        static const char *const soft = "sheets.0.material.weight={green: 0.02, blue: 0.1, yellow: 0.1}";
        Play play;
        const char *sets[] = {lab->quick ? "sheets.0.grid.cells=[32, 16]" : "", even ? soft : "", NULL};
        result = play_open(&play, lab, "weights.yaml", sets, error);
        if (!result && !even) result = play_shoot(&play, "at the start", error);
        if (!result && !even) result = play_until(&play, 0.5, error);
        if (!result && !even) result = play_shoot(&play, "0.5 s", error);
        if (!result) result = play_until(&play, 2, error);
        if (!result && !even) result = play_shoot(&play, "2 s", error);

        SingeView view = play.sim ? singe_sim_view(play.sim) : (SingeView){0};
        if (!result) {
            // m, sag of the outer 2 cm, of the stiff half and of the soft one
            double count[2] = {0};
            fall[even][0] = fall[even][1] = 0;
            for (uint32_t v = 0; v < view.vertex_count; v++) {
                double x = (double)view.rest_position[v][0];
                if (fabs(x) < 0.1) continue;
                fall[even][x < 0] += 0.12 - (double)view.position[v][2], count[x < 0]++;
            }

            for (int k = 0; k < 2; k++) fall[even][k] /= count[k];
        }

        play_close(&play);
    }

    if (result) return result;
    report_text(lab->report, "The outer 2 cm hang %.1f mm on the soft side and %.1f mm on the stiff one.",
                1e3 * fall[0][1], 1e3 * fall[0][0]);
    report_bar(lab->report, "ratio", "fall of the soft end over that of the stiff one", fall[0][1] / fall[0][0], 1.5,
               INFINITY, fall[1][1] / fall[1][0], "with one weight all over");
    return SINGE_OK;
}
