// Figures 2, 3 and 5: the shell as it is built, the curl of one shrunk layer and the states of a spring, all read from
// what the simulation holds.
#include <math.h>
#include <stdio.h>

#include "paper/paper.h"

static const char *const inks[SINGE_COLOUR_COUNT] = {
    [SINGE_RED] = "#d62728", [SINGE_GREEN] = "#2ca02c", [SINGE_BLUE] = "#1f77b4", [SINGE_YELLOW] = "#e0b000"};

// ---- drawing springs

/// A parallel view: turned about z, then tilted; pixels a metre.
typedef struct Sight {
    double turn, tilt, scale, x, y;
    int width, height;
} Sight;

static void sight_position(const Sight *sight, const float *p, double out[2]) {
    double c = cos(sight->turn), s = sin(sight->turn), x = (double)p[0] * c - (double)p[1] * s;
    double y = (double)p[0] * s + (double)p[1] * c;
    out[0] = sight->width / 2.0 + sight->scale * (x - sight->x);
    out[1] = sight->height / 2.0 - sight->scale * (y * sin(sight->tilt) + (double)p[2] * cos(sight->tilt) - sight->y);
}

/// Looks at the centroid of what is left, so closely that it fills the drawing.
static Sight sight_fit(const SingeView *view, double turn, double tilt, int width, int height) {
    Sight sight = {.turn = turn, .tilt = tilt, .scale = 1, .width = width, .height = height};
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, p[2];
    for (uint32_t i = 0; i < view->particle_count; i++) {
        sight_position(&sight, view->position[i], p);
        for (int k = 0; k < 2; k++) low[k] = fmin(low[k], p[k]), high[k] = fmax(high[k], p[k]);
    }

    sight.x = (low[0] + high[0] - width) / 2;
    sight.y = -(low[1] + high[1] - height) / 2;
    sight.scale = fmin((width - 24) / (high[0] - low[0] + 1e-9), (height - 24) / (high[1] - low[1] + 1e-9));
    return sight;
}

/// The springs of some colours, the ones behind first by colour, and the particles of both layers.
static void draw_springs(FILE *file, const SingeView *view, const Sight *sight, const char *colours) {
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\">\n", sight->width,
            sight->height);

    static const char letters[] = "rgby";
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        const char *at = colours;
        while (*at && *at != letters[c]) at++;

        for (uint32_t s = 0; *at && s < view->spring_count[c]; s++) {
            double a[2], b[2];
            sight_position(sight, view->position[view->springs[c][s][0]], a);
            sight_position(sight, view->position[view->springs[c][s][1]], b);
            fprintf(file, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-width=\"%s\"/>\n",
                    a[0], a[1], b[0], b[1], inks[c], c == SINGE_RED || c == SINGE_YELLOW ? "1.1" : "2.2");
        }
    }

    for (uint32_t i = 0; i < view->particle_count; i++) {
        double p[2];
        sight_position(sight, view->position[i], p);
        fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", p[0], p[1],
                inks[i < view->vertex_count ? SINGE_BLUE : SINGE_GREEN]);
    }

    fprintf(file, "</svg>\n");
}

/// The largest difference of the springs per cell from those of an endless sheet; writes a table if there is a report.
static double spring_counts(Report *report, const SingeView *view) {
    static const char *const names[] = {"red", "green", "blue", "yellow"};
    static const double expected[] = {4, 2, 2, 2};
    double worst = 0;
    if (report) report_heads(report, "springs|a cell, 60 x 60 cells|without end");

    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        const double count = (double)view->spring_count[c] / view->cell_count;
        if (report) report_row(report, "%s|%.3f|%.0f", names[c], count, expected[c]);
        worst = fmax(worst, fabs(count - expected[c]));
    }

    return worst;
}

SingeResult paper_fig3(Lab *lab, SingeError *error) {
    LabGrid grid = lab_grid(4, 3, 0.01f);
    grid.material.thickness = singe_param(0.006f);
    SingeSim *sim;
    SingeResult result = lab_build(lab, &grid, &sim, error);
    if (result) return result;

    SingeView view = singe_sim_view(sim);
    Sight above = sight_fit(&view, 0, acos(-1) / 2, 330, 260), aside = sight_fit(&view, 0.5, 0.45, 460, 260);
    draw_springs(report_drawing(lab->report), &view, &above, "rgby");
    draw_springs(report_drawing(lab->report), &view, &aside, "rgby");
    report_text(lab->report,
                "4 x 3 cells, from above and from the side: <b style=\"color:#1f77b4\">blue</b> mesh edges, <b "
                "style=\"color:#2ca02c\">green</b> between the centres of neighbouring cells, <b "
                "style=\"color:#d62728\">red</b> from centre to corners, <b style=\"color:#e0b000\">yellow</b> across "
                "a cell. Centres lie one thickness above the corners' plane.");

    const double few = spring_counts(NULL, &view);
    singe_sim_destroy(sim);

    // counts a cell on a large grid; the border's share falls with its size
    enum { LARGE = 60 };
    grid = lab_grid(LARGE, LARGE, 0.01f);
    if ((result = lab_build(lab, &grid, &sim, error))) return result;

    view = singe_sim_view(sim);
    const double worst = spring_counts(lab->report, &view);
    singe_sim_destroy(sim);
    report_bar(lab->report, "counts", "largest difference of the springs a cell from 4, 2, 2, 2", worst, 0,
               2.0 / LARGE + 1e-6, few, "4 x 3 cells, which are half border");
    return SINGE_OK;
}

// ---- Fig 2: the curl of one shrunk layer

enum { CURL_CASES = 4 };
static const double curl_shrink[CURL_CASES] = {0.01, 0.02, 0.05, 0.1};
static const double curl_cell = 2e-3, curl_thickness = 1e-3; // of the scene, m

/// 1/m along the strip: the mean angle from cell to cell over the cells' length now, its ends left out.
static double curl_measure(const SingeView *view) {
    double sum = 0, length = 0, count = 0;
    for (uint32_t c = 2; c + 3 < view->cell_count; c++) {
        const float *p = view->position[c], *q = view->position[c + 1], *r = view->position[c + 2];
        double a[2] = {(double)q[0] - (double)p[0], (double)q[2] - (double)p[2]};
        double b[2] = {(double)r[0] - (double)q[0], (double)r[2] - (double)q[2]};
        sum += fabs(atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]));
        length += hypot(a[0], a[1]), count++;
    }

    return sum / count / (length / count);
}

/// Blue edges are a, green springs g and centres stand t above their cells: g = a cos(alpha/2) + 2 t sin(alpha/2). A
/// red spring has the mean of its ends, so `red_share` is 1/2.
static double curl_exact(double shrink, double red_share) {
    double a = curl_cell * (1 - shrink), g = curl_cell, red = 1 - shrink * red_share;
    double diagonal = (curl_cell * curl_cell / 2 + curl_thickness * curl_thickness) * red * red;
    double t = sqrt(diagonal - a * a / 2), r = sqrt(a * a + 4 * t * t), beta = atan2(2 * t, a);
    return 2 * (beta - acos(fmin(1, g / r))) / a;
}

/// The beam of Fig 2: layers of lengths 1 - e and 1 on circles a thickness apart.
static double curl_beam(double shrink) { return shrink / ((1 - shrink) * curl_thickness); }

SingeResult paper_fig2(Lab *lab, SingeError *error) {
    double measured[CURL_CASES], exact[CURL_CASES], beam[CURL_CASES], percent[CURL_CASES], worst = 0, off = 0;
    double apart = 0, flat = 0; // of a shell whose red springs stay; of a strip that has not curled
    SingeResult result = SINGE_OK;

    for (int i = 0; i < CURL_CASES && !result; i++) {
        char set[60];
        Play play;
        snprintf(set, sizeof set, "sheets.0.material.mass_min=%g", 1 - curl_shrink[i]);
        result = play_open(&play, lab, "fig2.yaml", (const char *const[]){set, NULL}, error);

        SingeView view = {0};
        if (!result) view = singe_sim_view(play.sim);
        if (!result && i == 0) {
            Sight sight = sight_fit(&view, 0, 0, 460, 60);
            draw_springs(report_drawing(lab->report), &view, &sight, "rgb");
        }

        if (!result) flat = fmax(flat, fabs(curl_measure(&view) / curl_beam(curl_shrink[i]) - 1));
        if (!result) result = play_until(&play, 4, error);

        if (!result && curl_shrink[i] > 0.04) {
            view = singe_sim_view(play.sim);
            Sight sight = sight_fit(&view, 0, 0, 400, 200);
            draw_springs(report_drawing(lab->report), &view, &sight, "rgb");
        }

        if (!result) {
            view = singe_sim_view(play.sim);
            measured[i] = curl_measure(&view);
            exact[i] = curl_exact(curl_shrink[i], 0.5);
            beam[i] = curl_beam(curl_shrink[i]);
            percent[i] = 100 * curl_shrink[i];
            worst = fmax(worst, fabs(measured[i] / exact[i] - 1));
            off = fmax(off, fabs(measured[i] / beam[i] - 1));
            apart = fmax(apart, fabs(curl_exact(curl_shrink[i], 0) / exact[i] - 1));
        }

        play_close(&play);
    }

    if (result) return result;
    report_text(lab->report,
                "A strip of %g mm thickness in cells of %g mm, seen from the side: at rest, and with its blue layer 5 "
                "and 10 %% shorter. Red springs take half of it, the mean of their ends, which makes the layers part a "
                "little; the shell's value knows that, the beam's does not.",
                1e3 * curl_thickness, 1e3 * curl_cell);
    report_heads(lab->report, "shrunk by %|curvature 1/m|shell, exact|beam, e/((1-e)t)");
    for (int i = 0; i < CURL_CASES; i++)
        report_row(lab->report, "%.0f|%.2f|%.2f|%.2f", percent[i], measured[i], exact[i], beam[i]);

    Plot plot = {.title = "Curvature by shrinkage of one layer", .x_label = "shrunk by, %", .y_label = "1/m"};
    plot_add(&plot, (PlotLine){"two-layer beam", "#999", percent, beam, CURL_CASES, false, true});
    plot_add(&plot, (PlotLine){"shell, exact", "#2166ac", percent, exact, CURL_CASES, false, false});
    plot_add(&plot, (PlotLine){"simulated", "#b2182b", percent, measured, CURL_CASES, true, false});
    report_plot(lab->report, &plot);

    report_bar(lab->report, "exact", "largest difference from the shell's exact curvature", worst, 0, 0.02, apart,
               "that of a shell whose red springs keep their length");
    report_bar(lab->report, "beam", "largest difference from the two-layer beam", off, 0, 0.15, flat,
               "a strip that stays flat");
    return SINGE_OK;
}

// ---- Fig 5 and 6: grids burnt down to given masses

SingeResult paper_burn_to(Lab *lab, LabGrid *grid, const float *mass, double mass_loss, SingeSim **sim,
                          SingeSurface *surface, SingeError *error) {
    grid->mass = mass;
    grid->material.mass_loss = singe_param((float)mass_loss);
    grid->material.ablate = true;
    *sim = NULL;
    SingeResult result = lab_build(lab, grid, sim, error);
    if (!result) result = lab_steps(*sim, 200, error);
    if (!result && (result = singe_sim_surface(*sim, surface))) *error = *singe_sim_error(*sim);
    return result;
}

// ---- Fig 5: the states of a spring

enum { STATES = 5, STATE_COLUMNS = STATES + 2 };
static const double state_mass[STATES][2] = {{1, .75}, {.75, .5}, {.95, .2}, {.8, .2}, {.1, .05}};
static const double state_loss = 0.3, state_beside = 0.1;

/// The column of a case. The last one has a burnt column on either side: springs go with their cells.
static int state_column(int i) { return i < STATES - 1 ? i : i + 1; }

/// An end's mass above m_loss.
static double state_left(int i, int end) { return state_mass[i][end] - state_loss; }
/// Whether exactly one end is left.
static bool state_is_cut(int i) { return state_left(i, 0) * state_left(i, 1) < 0; }

/// The target length of column i's blue spring over its rest length; -1 if it is gone.
static double state_ratio(const SingeView *view, uint32_t i) {
    for (uint32_t s = 0; s < view->spring_count[SINGE_BLUE]; s++) {
        const uint32_t *end = view->springs[SINGE_BLUE][s];
        if ((end[0] != i || end[1] != i + STATE_COLUMNS) && (end[1] != i || end[0] != i + STATE_COLUMNS)) continue;
        if (!(view->spring_flags[SINGE_BLUE][s] & SINGE_ALIVE)) return -1;
        return (double)(view->spring_length[SINGE_BLUE][s] / view->spring_rest[SINGE_BLUE][s]);
    }

    return -1;
}

static const double state_length[STATES] = {0.875, 0.625, 0.575, 0.5, -1}; ///< the paper's

/// A row of the table for each spring. *worst and *worst_cut are the largest differences from the paper.
static void state_table(Lab *lab, const double *ratio, const double *cut, double *worst, double *worst_cut) {
    static const char *const states[] = {"shrunk", "shrunk", "partly burnt", "partly burnt", "burnt"};
    *worst = *worst_cut = 0;
    report_heads(lab->report, "case|m_0|m_1|state|length|paper|cut at t|eq 7");

    for (int i = 0; i < STATES; i++) {
        char length[40] = "removed|removed", cuts[40] = "-|-";
        if (ratio[i] >= 0) snprintf(length, sizeof length, "%.2f %%|%.1f %%", 100 * ratio[i], 100 * state_length[i]);

        if (state_is_cut(i)) {
            const double t = state_left(i, 0) / (state_left(i, 0) - state_left(i, 1));
            if (ratio[i] >= 0) snprintf(cuts, sizeof cuts, "%.4f|%.4f", cut[i], t);
            *worst_cut = fmax(*worst_cut, fabs(cut[i] - t));
        }

        report_row(lab->report, "%c|%g|%g|%s|%s|%s", 'a' + i, state_mass[i][0], state_mass[i][1], states[i], length,
                   cuts);
        *worst = fmax(*worst, fabs(ratio[i] - state_length[i]));
    }
}

SingeResult paper_fig5(Lab *lab, SingeError *error) {
    const double cell = 0.01;
    float mass[2 * STATE_COLUMNS];
    LabGrid grid = lab_grid(STATE_COLUMNS - 1, 1, (float)cell);

    for (int i = 0; i < 2 * STATE_COLUMNS; i++) mass[i] = (float)state_beside;
    for (int i = 0; i < STATES; i++)
        for (int k = 0; k < 2; k++) mass[state_column(i) + k * STATE_COLUMNS] = (float)fmin(state_mass[i][k], 0.999999);
    lab_sets_mass(&grid.material);

    SingeSim *sim;
    SingeSurface surface = {0};
    SingeResult result = paper_burn_to(lab, &grid, mass, state_loss, &sim, &surface, error);
    if (!result) {
        SingeView view = singe_sim_view(sim);
        double worst, worst_cut, ratio[STATES], cut[STATES], worst_centre = 0, one_end = 0;
        for (int i = 0; i < STATES; i++) {
            ratio[i] = state_ratio(&view, (uint32_t)state_column(i));
            cut[i] = -1; // or the end of the drawn surface on the column, as a share of its height
            for (uint32_t v = 0; v < surface.vertex_count && state_is_cut(i) && cut[i] < 0; v++) {
                double x = (double)surface.rest_position[v][0], y = (double)surface.rest_position[v][1];
                if (fabs(x - i * cell) < 1e-6 && y > 1e-4 * cell && y < (1 - 1e-4) * cell) cut[i] = y / cell;
            }

            if (ratio[i] >= 0) one_end = fmax(one_end, fabs(state_mass[i][0] - state_length[i]));
            if (state_is_cut(i)) worst_centre = fmax(worst_centre, fabs(0.5 - cut[i]));
        }

        state_table(lab, ratio, cut, &worst, &worst_cut);

        FILE *file = report_drawing(lab->report);
        fprintf(file,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"560\" height=\"150\" font-family=\"sans-serif\" "
                "font-size=\"12\">\n");

        for (int i = 0; i < STATES; i++) {
            double x = 60 + 110 * i, length = ratio[i] < 0 ? 0 : 100 * ratio[i], end = cut[i] < 0 ? 1 : cut[i];
            fprintf(file, "<line x1=\"%g\" x2=\"%g\" y1=\"120\" y2=\"20\" stroke=\"#ddd\" stroke-width=\"6\"/>\n", x,
                    x);
            if (ratio[i] >= 0)
                fprintf(file,
                        "<line x1=\"%g\" x2=\"%g\" y1=\"120\" y2=\"%.1f\" stroke=\"#bbb\" stroke-width=\"2\" "
                        "stroke-dasharray=\"3 3\"/><line x1=\"%g\" x2=\"%g\" y1=\"120\" y2=\"%.1f\" stroke=\"#1f77b4\" "
                        "stroke-width=\"4\"/>\n",
                        x, x, 120 - length, x, x, 120 - length * end);

            for (int k = 0; k < 2; k++)
                fprintf(file,
                        "<circle cx=\"%g\" cy=\"%.1f\" r=\"6\" fill=\"%s\" stroke=\"#333\"/><text x=\"%g\" "
                        "y=\"%.1f\">"
                        "%.2f</text>\n",
                        x, 120 - k * (ratio[i] < 0 ? 100 : length), state_mass[i][k] >= state_loss ? "#d8a05a" : "#fff",
                        x + 11, 124 - k * (ratio[i] < 0 ? 100 : length), state_mass[i][k]);
            fprintf(file, "<text x=\"%g\" y=\"146\" text-anchor=\"middle\">(%c)</text>\n", x, 'a' + i);
        }

        fprintf(file, "</svg>\n");

        report_bar(lab->report, "lengths", "largest difference of the lengths, removed counting as -1", worst, 0, 1e-4,
                   one_end, "v of the first end alone in eq 6");
        report_bar(lab->report, "cuts", "largest difference of the cuts of c and d from eq 7", worst_cut, 0, 1e-3,
                   worst_centre, "cuts in the middle");
    }

    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}
