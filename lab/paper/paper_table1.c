// Table 1 and Fig 9: a particle between two fixed points, tied to the left one by a green and to the right one by a
// blue spring. Their target lengths change from 1 to 1.65 and 0.55, which are incompatible. The paper's digits are
// reproduced if the system treats the fixed points as free and they are reset after each projection.
#include <math.h>
#include <stdio.h>

#include "paper/paper.h"

enum { STEPS = 5 };

static const double table1[STEPS][2] = {
    {0.4306, 0.4401}, {0.5527, 0.4954}, {0.5767, 0.5038}, {0.5804, 0.5050}, {0.5810, 0.5052}};

/// Five projection steps; the positions after each set in *ours, and their largest difference from the paper's.
static SingeResult table1_run(bool swapped, double ours[2][STEPS + 1], double *end, double *worst, SingeError *error) {
    SingeNetwork *network;

    // `swapped`: blue before green
    SingeNetworkDef def = singe_default_network();
    def.particle_count = 3;
    def.positions = (const double[]){-1, 0, 0, 0, 0, 0, 1, 0, 0};
    def.held = (const uint8_t[]){1, 0, 1};
    def.spring_count = 2;
    def.ends = (const uint32_t[]){0, 1, 1, 2};
    def.lengths = (const double[]){1.65, 0.55};
    def.set_count = 2;
    def.sets = swapped ? (const uint32_t[]){1, 0} : (const uint32_t[]){0, 1};
    def.regularisation = 0;
    SingeResult result = singe_network_create(&def, &network, error);

    if (result) return result;
    const double *x = singe_network_positions(network) + 3;

    *worst = 0;
    for (int step = 0; step < STEPS && !result; step++)
        for (uint32_t set = 0; set < 2 && !result; set++) {
            result = singe_network_project(network, set, NULL);
            ours[set][step + 1] = floor(1e4 * x[0] + 1e-9) / 1e4;
            *worst = fmax(*worst, fabs(ours[set][step + 1] - table1[step][set]));
        }

    *end = x[0];
    singe_network_destroy(network);
    return result;
}

SingeResult paper_table1(Lab *lab, SingeError *error) {
    double worst, other, end, ours[2][STEPS + 1] = {{0}}, unused[2][STEPS + 1], paper[2][STEPS + 1] = {{0}};
    SingeResult result = table1_run(true, unused, &end, &other, error);
    if (!result) result = table1_run(false, ours, &end, &worst, error);
    if (result) return result;

    for (int step = 0; step < STEPS; step++)
        for (int set = 0; set < 2; set++) paper[set][step + 1] = table1[step][set];
    report_heads(lab->report, "step|S_G here|S_G paper|S_B here|S_B paper");
    for (int step = 0; step <= STEPS; step++)
        report_row(lab->report, "%d|%.4f|%.4f|%.4f|%.4f", step, ours[0][step], paper[0][step], ours[1][step],
                   paper[1][step]);

    // fig 9: the two springs before and after
    FILE *file = report_drawing(lab->report);
    const double x = end;
    const double at[2] = {0, x};
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"420\" height=\"90\" font-size=\"12\" "
                  "font-family=\"sans-serif\">\n");

    for (int k = 0; k < 2; k++) {
        double y = 25 + 40 * k, p = 210 + 150 * at[k];
        fprintf(file,
                "<line x1=\"60\" x2=\"%.1f\" y1=\"%g\" y2=\"%g\" stroke=\"#2ca02c\" stroke-width=\"3\"/>"
                "<line x1=\"%.1f\" x2=\"360\" y1=\"%g\" y2=\"%g\" stroke=\"#1f77b4\" stroke-width=\"3\"/>"
                "<circle cx=\"%.1f\" cy=\"%g\" r=\"5\"/><text x=\"372\" y=\"%g\">%s</text>\n",
                p, y, y, p, y, y, p, y, y + 4, k ? "after" : "before");
    }

    fprintf(file, "</svg>\n");

    Plot plot = {.title = "Position of the free particle", .x_label = "projection step", .y_label = "x"};
    plot_add(&plot, (PlotLine){"after green", "#2ca02c", NULL, ours[0], STEPS + 1, false, false});
    plot_add(&plot, (PlotLine){"after blue", "#1f77b4", NULL, ours[1], STEPS + 1, false, false});
    plot_add(&plot, (PlotLine){"paper's digits", "#111", NULL, paper[0], STEPS + 1, true, false});
    plot_add(&plot, (PlotLine){"", "#111", NULL, paper[1], STEPS + 1, true, false});
    report_plot(lab->report, &plot);

    report_text(lab->report,
                "The paper's digits are cut, not rounded, and come out when the system takes the two fixed points for "
                "free and they are put back after each projection.");
    report_bar(lab->report, "largest_difference", "largest difference of the ten positions", worst, 0, 5e-5, other,
               "blue projected before green");
    return result;
}
