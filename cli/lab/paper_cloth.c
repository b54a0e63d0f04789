// What the paper shows without fire: figures 7 and 10 and the inhomogeneous weights of section 7.2.
#include <math.h>
#include <stdio.h>

#include "cli/lab/paper.h"

// ---- Fig 7 a, b: a torus on a sphere

typedef struct Torus {
    const char *caption, *set;
    bool held; ///< what is expected
    const char *measure, *what;
} Torus;

static const Torus toruses[] = {
    {"strand", "", true, "strand", "strand: lowest end of the torus, m above the ground"},
    {"the paper's solver", "solver=paper", true, "paper", "the paper's solver: the same"},
    {"mass-spring, 1 N/m", "solver={method: mass-spring, stiffness: 1, substeps: 20}", false, "soft",
     "mass-spring of 1 N/m: the same"},
    {"mass-spring, 100 N/m", "solver={method: mass-spring, stiffness: 100, substeps: 60}", true, "stiff",
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
        result = play_open(&play, lab, "fig7ab.yaml", sets, error);
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
    for (int i = 0; i < 4 && !result; i++)
        report_measure(lab->report, toruses[i].measure, toruses[i].what, lowest[i], toruses[i].held ? 0.05 : -INFINITY,
                       toruses[i].held ? INFINITY : 0.02);
    report_text(lab->report,
                "The sphere stands free above the ground. What the mass-spring model does is a matter of its "
                "stiffness, of which the paper says nothing: springs of 1 N/m stretch under the torus' weight of 0.13 "
                "N, those of 100 N/m hold it, at the price of three times as many substeps.");
    return result;
}

// ---- Fig 7 c, d: the blue layer shrinks all over

enum { SHRINK_CASES = 2 };

SingeResult paper_fig7cd(Lab *lab, SingeError *error) {
    static const char *const names[SHRINK_CASES] = {"strand", "mass-spring, 1 N/m"};
    static const char *const sets[SHRINK_CASES] = {"", "solver={method: mass-spring, stiffness: 1, substeps: 20}"};
    static const char *const inks[SHRINK_CASES] = {"#2166ac", "#b2182b"};
    static const double times[] = {0.4, 0.7, 1, 1.5};
    const int n = lab->quick ? 32 : 50;
    const double cell = 0.2 / n;
    ShapeSpectrum spectra[SHRINK_CASES];
    double bend[SHRINK_CASES];
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, 4);
    for (int i = 0; i < SHRINK_CASES && !result; i++) {
        Play play;
        const char *laid[] = {sets[i], lab->quick ? "sheets.0.grid.cells=[32, 32]" : "", NULL};
        result = play_open(&play, lab, "fig7cd.yaml", laid, error);
        play.plain = true;
        for (int k = 0; k < 4 && !result; k++) {
            char caption[80];
            snprintf(caption, sizeof caption, "%s, blue %.0f %% shorter", names[i], 10 * fmin(1, times[k]));
            result = play_until(&play, times[k], error);
            if (!result) result = play_shoot(&play, caption, error);
            SingeView view = singe_sim_view(play.sim);
            if (!result && k == 1) { // before it has rolled up
                result = shape_spectrum(&view, n, n, cell, &spectra[i]);
                bend[i] = shape_bend(&view);
            }
        }
        play_close(&play);
    }
    if (result) return result;
    Plot plot = {.title = "Wrinkles at 7 %", .x_label = "wavelength, m", .y_label = "height in the band, m",
                 .log_x = true, .log_y = true};
    double least = INFINITY, power[SHRINK_CASES] = {0};
    for (int i = 0; i < SHRINK_CASES; i++)
        plot_add(&plot, (PlotLine){names[i], inks[i], spectra[i].wave, spectra[i].height, SHAPE_BANDS, false, false});
    for (int b = 0; b < SHAPE_BANDS; b++) {
        if (isnan(spectra[0].height[b])) continue;
        for (int i = 0; i < SHRINK_CASES; i++)
            spectra[i].height[b] = fmax(spectra[i].height[b], 1e-7); // no less counts
        if (spectra[0].wave[b] < 4 * cell || spectra[0].wave[b] > 0.05) continue;
        least = fmin(least, spectra[0].height[b] / spectra[1].height[b]);
        for (int i = 0; i < SHRINK_CASES; i++) power[i] += pow(spectra[i].height[b], 2);
    }
    report_plot(lab->report, &plot);
    report_text(lab->report,
                "The spectrum is that of the height over the sheet's rest plane, along all of its grid lines; what is "
                "below 0.1 um counts as that. Angles from cell to cell: %.2f degrees with strands, %.2f with soft "
                "springs.", bend[0], bend[1]);
    report_measure(lab->report, "power", "power of wrinkles from four cells to 5 cm, over that of mass-spring",
                   power[0] / power[1], 10, INFINITY);
    report_measure(lab->report, "bands", "the smallest ratio of heights in any of these bands", least, 1, INFINITY);
    return SINGE_OK;
}

// ---- Fig 10: thickness and weights

enum { SHELLS = 4 };

/// m, how far the middle of the sheet is above the mean of its border; degrees, by how much the sheet has bent from
/// there: the mean slope of the border's cells, across the border.
static void shell_measure(const SingeView *view, int n, double *sag, double *bend) {
    const uint32_t row = (uint32_t)n + 1, last = (uint32_t)n;
    double border = 0, slope = 0, count = 0;
    for (uint32_t i = 1; i < last; i++) {
        const uint32_t pairs[4][2] = {{i, i + row}, {i + row * last, i + row * (last - 1)}, {i * row, i * row + 1},
                                      {i * row + last, i * row + last - 1}};
        for (int k = 0; k < 4; k++, count++) {
            const float *p = view->position[pairs[k][0]], *q = view->position[pairs[k][1]];
            double across = hypot((double)p[0] - (double)q[0], (double)p[1] - (double)q[1]);
            border += (double)p[2], slope += atan2((double)q[2] - (double)p[2], across) * 180 / acos(-1);
        }
    }
    *sag = (double)view->position[row * (last / 2) + last / 2][2] - border / count;
    *bend = slope / count;
}

SingeResult paper_fig10(Lab *lab, SingeError *error) {
    static const char *const names[SHELLS] = {"(a) 1:20, 1.0", "(b) 1:80, 1.0", "(c) 1:400, 1.0", "(d) 1:400, 0.1"};
    static const char *const thickness[SHELLS] = {"10 mm", "2.5 mm", "0.5 mm", "0.5 mm"};
    const int n = lab->quick ? 32 : 50;
    double sag[SHELLS], bend[SHELLS];
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, SHELLS);
    for (int i = 0; i < SHELLS && !result; i++) {
        Play play;
        char thick[80];
        snprintf(thick, sizeof thick, "sheets.0.material.thickness=%s", thickness[i]);
        const char *sets[] = {thick, i == 3 ? "sheets.0.material.weight.blue=0.1" : "",
                              i == 3 ? "sheets.0.material.weight.yellow=0.1" : "",
                              lab->quick ? "sheets.0.grid.cells=[32, 32]" : "", NULL};
        result = play_open(&play, lab, "fig10.yaml", sets, error);
        if (!result) result = play_until(&play, 1.5, error);
        if (!result) result = play_shoot(&play, names[i], error);
        SingeView view = play.sim ? singe_sim_view(play.sim) : (SingeView){0};
        if (!result) shell_measure(&view, n, &sag[i], &bend[i]);
        play_close(&play);
    }
    if (result) return result;
    report_heads(lab->report, "thickness, weight|sag mm|bend degrees");
    for (int i = 0; i < SHELLS; i++) report_row(lab->report, "%s|%.1f|%.2f", names[i], 1e3 * sag[i], bend[i]);
    report_text(lab->report,
                "Sag: height of the middle over the mean of the border. Bend: the mean slope of the border's cells, "
                "across the border.");
    report_measure(lab->report, "sag_b_a", "sag, (b) over (a)", sag[1] / sag[0], 1.1, INFINITY);
    report_measure(lab->report, "sag_c_b", "sag, (c) over (b)", sag[2] / sag[1], 1.02, INFINITY);
    report_measure(lab->report, "sag_d_c", "sag, (d) over (c)", sag[3] / sag[2], 1.0, INFINITY);
    report_measure(lab->report, "bend_b_a", "bend, (b) over (a)", bend[1] / bend[0], 1.1, INFINITY);
    report_measure(lab->report, "bend_c_b", "bend, (c) over (b)", bend[2] / bend[1], 1.02, INFINITY);
    report_measure(lab->report, "bend_d_c", "bend, (d) over (c)", bend[3] / bend[2], 1, INFINITY);
    return SINGE_OK;
}

// ---- section 7.2: weights that vary over one sheet

SingeResult paper_weights(Lab *lab, SingeError *error) {
    Play play;
    const char *sets[] = {lab->quick ? "sheets.0.grid.cells=[32, 16]" : "", NULL};
    SingeResult result = play_open(&play, lab, "weights.yaml", sets, error);
    report_pictures(lab->report, 3);
    if (!result) result = play_shoot(&play, "at the start", error);
    if (!result) result = play_until(&play, 0.5, error);
    if (!result) result = play_shoot(&play, "0.5 s", error);
    if (!result) result = play_until(&play, 2, error);
    if (!result) result = play_shoot(&play, "2 s", error);
    if (!result) {
        SingeView view = singe_sim_view(play.sim);
        double drop[2] = {0}, count[2] = {0};
        for (uint32_t v = 0; v < view.vertex_count; v++) {
            double x = (double)view.rest_position[v][0];
            if (fabs(x) < 0.1) continue;
            drop[x > 0] += 0.12 - (double)view.position[v][2], count[x > 0]++;
        }
        for (int k = 0; k < 2; k++) drop[k] /= count[k];
        report_text(lab->report, "The outer 2 cm hang %.1f mm on the soft side and %.1f mm on the firm one.",
                    1e3 * drop[0], 1e3 * drop[1]);
        report_measure(lab->report, "ratio", "fall of the soft end over that of the firm one", drop[0] / drop[1], 1.5,
                       INFINITY);
    }
    play_close(&play);
    return result;
}
