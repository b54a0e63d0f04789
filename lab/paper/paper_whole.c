// The paper as one system in its scenes of fire, Figs 1, 4 and 11: scenes/whole-fig1.yaml, -fig4 and -fig11. Ours runs
// on the same sheets. Both are compared at equal burnt mass, as their fires are not equally fast.
#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "common/float3.h"
#include "page/appearance.h"
#include "paper/paper.h"

enum { FIGURES = 3, SYSTEMS = 2, MARKS = 3 };
enum { PAPERS, OURS };

/// A figure's scenes: whole-fig1.yaml is the paper's system, and fig1.yaml ours. Ours gets the paper's cells.
typedef struct Figure {
    const char *name, *scenes[SYSTEMS], *size, *small;
    double marks[MARKS];  ///< burnt share
    double ends[SYSTEMS]; ///< s, time limit for all marks
} Figure;

static const Figure figures[FIGURES] = {
    {"Fig 1",
     {"whole-fig1.yaml", "fig1.yaml"},
     "sheets.0.grid.cells=[30, 42]",
     "sheets.0.grid.cells=[20, 28]",
     {0.08, 0.2, 0.35},
     {2, 3.4}},
    {"Fig 4",
     {"whole-fig4.yaml", "fig4c.yaml"},
     "sheets.0.grid.cells=[30, 42]",
     "sheets.0.grid.cells=[20, 28]",
     {0.04, 0.09, 0.14},
     {3.5, 3.5}},
    {"Fig 11",
     {"whole-fig11.yaml", "fig11.yaml"},
     "sheets.0.mesh=torus-small.obj",
     "sheets.0.mesh=torus-small.obj",
     {0.04, 0.1, 0.2},
     {4, 6}},
};

typedef struct Run {
    Look look;
    double strain[SINGE_COLOUR_COUNT]; ///< mean of each colour, the largest over the marks
    int reached;                       ///< marks
    double times[MARKS];
} Run;

/// `more` (ends with NULL; NULL for none) overrides settings of a system. Such runs are not drawn.
static SingeResult whole_run(Lab *lab, const Figure *figure, int system, const char *const *more, Run *run,
                             SingeError *error) {
    static const char *const names[SYSTEMS] = {"the paper's system", "ours"};
    const char *sets[8] = {lab->quick || more ? figure->small : figure->size};
    for (int i = 0; more && more[i]; i++) sets[1 + i] = more[i];
    const bool drawn = !more;
    Play play;
    SingeResult result = play_open(&play, lab, figure->scenes[system], sets, error);

    // runs until the marks are reached; the failure of a system is a result, not an error
    for (double time = 0; run->reached < MARKS && time < figure->ends[system] && !result;) {
        if (play_until(&play, time += 0.05, error)) break;

        const SingeStats stats = singe_sim_stats(play.sim);
        if (!(stats.burnt_fraction >= figure->marks[run->reached])) continue;
        run->times[run->reached++] = time;

        const SingeView view = singe_sim_view(play.sim);
        for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
            // the mean over the springs that are left, against their targets
            double sum = 0, count = 0;
            for (uint32_t i = 0; i < view.spring_count[c]; i++) {
                if (!(view.spring_flags[c][i] & SINGE_ALIVE)) continue;
                const uint32_t *ends = view.springs[c][i];
                const double length = distance_of(view.position[ends[0]], view.position[ends[1]]);
                sum += fabs(length / (double)view.spring_length[c][i] - 1);
                count++;
            }

            if (count > 0) run->strain[c] = fmax(run->strain[c], sum / count);
        }

        result = look_take(&play, 0, &run->look, error);
        if (result || !drawn || run->reached == 1) continue;

        char caption[100];
        snprintf(caption, sizeof caption, "%s, %s, %.0f %% burnt, %.1f s", figure->name, names[system],
                 100 * stats.burnt_fraction, time);
        result = play_shoot(&play, caption, error);
    }

    play_close(&play);
    return result;
}

/// The smallest of a system's numbers, a double of Look, over the figures, or the largest.
static double over_figures(Run (*runs)[SYSTEMS], int system, size_t number, bool largest) {
    double out = NAN;
    for (int f = 0; f < FIGURES; f++) {
        const double value = *(const double *)(const void *)((const char *)&runs[f][system].look + number);
        out = largest ? fmax(out, value) : fmin(out, value); // NaN is no number to them
    }
    return out;
}

#define OF(member) offsetof(Look, member)

enum { ORDERS = 3, LAST_BLUE = 1 };
static const char *const order_names[ORDERS] = {"red, green, blue, yellow: the paper's", "red, green, yellow, blue",
                                                "yellow, blue, red, green"};
static const char *const order_sets[ORDERS][2] = {{"solver.order=[red, green, blue, yellow]"},
                                                  {"solver.order=[red, green, yellow, blue]"},
                                                  {"solver.order=[yellow, blue, red, green]"}};

SingeResult paper_whole(Lab *lab, SingeError *error) {
    Run runs[FIGURES][SYSTEMS] = {{{.reached = 0}}}, literal = {.reached = 0}, plain = {.reached = 0};
    Run orders[ORDERS] = {{.reached = 0}};
    static const char *const to_the_letter[] = {"solver=paper-literal", NULL};
    static const char *const no_shrinkage[] = {"sheets.0.material.shrink_front=0", "sheets.0.material.shrink_back=0",
                                               NULL};
    SingeResult result = SINGE_OK;

    report_pictures(lab->report, 4);
    for (int f = 0; f < FIGURES && !result; f++)
        for (int s = 0; s < SYSTEMS && !result; s++) result = whole_run(lab, &figures[f], s, NULL, &runs[f][s], error);
    if (!result) result = whole_run(lab, &figures[1], PAPERS, to_the_letter, &literal, error);
    if (!result) result = whole_run(lab, &figures[0], PAPERS, no_shrinkage, &plain, error);
    for (int i = 0; i < ORDERS && !result; i++)
        result = whole_run(lab, &figures[0], PAPERS, order_sets[i], &orders[i], error);
    if (result) return result;

    report_heads(lab->report,
                 "|marks|s at the last|hottest K|curl, median|90 of 100|slope, median|area|strain, mean %|p99 "
                 "%|cells turned over %|ms a step");

    for (int f = 0; f < FIGURES; f++)
        for (int s = 0; s < SYSTEMS; s++) {
            const Run *run = &runs[f][s];
            const Look *look = &run->look;
            report_row(lab->report, "%s, %s|%d of %d|%.2f|%.0f|%.1f|%.1f|%.1f|%.2f|%.2f|%.1f|%.1f|%.2f",
                       figures[f].name, s ? "ours" : "the paper", run->reached, MARKS,
                       run->reached ? run->times[run->reached - 1] : NAN, look->hottest, look_curl(look, 0.5),
                       look_curl(look, 0.9), look_slope(look, 0.5), look_area(look), 100 * look->strain_mean,
                       100 * look->strain_p99, 100 * look->inverted, look->step_ms);
        }

    report_heads(lab->report, "Fig 1 by the order of colours|red, mean strain %|green|blue|yellow|all four");
    double mean[ORDERS];
    for (int i = 0; i < ORDERS; i++) {
        const double *s = orders[i].strain;
        mean[i] = (s[SINGE_RED] + s[SINGE_GREEN] + s[SINGE_BLUE] + s[SINGE_YELLOW]) / 4;
        report_row(lab->report, "%s|%.2f|%.2f|%.2f|%.2f|%.2f", order_names[i], 100 * s[SINGE_RED], 100 * s[SINGE_GREEN],
                   100 * s[SINGE_BLUE], 100 * s[SINGE_YELLOW], 100 * mean[i]);
    }

    int reached = 0;
    for (int f = 0; f < FIGURES; f++) reached += runs[f][PAPERS].reached;
    report_text(
        lab->report,
        "Numbers are over the moments at which the shares of the marks have burnt; curl, slope and area (over that "
        "at rest) are of the largest piece's rim. As one system the paper runs, stays finite, and crumples as its "
        "figures do. It does not keep lengths: seven projections of colours that contradict each other leave the "
        "mean strain as shown, and much of the sheet has its layers on the wrong sides, as section 8.2 says. "
        "Without losses the sheet gets hotter than any fire of paper.");

    report_bar(lab->report, "reached", "share of the marks that the paper's system reaches",
               (double)reached / (FIGURES * MARKS), 1, 1, (double)literal.reached / MARKS, "to its letter, Fig 4");
    report_bar(lab->report, "strain_all", "Fig 1, mean strain of all four colours, the least of the orders of colours",
               fmin(mean[0], fmin(mean[1], mean[2])), 0.04, 1, orders[LAST_BLUE].strain[SINGE_BLUE],
               "of blue alone, where it is the last");
    report_bar(lab->report, "curl", "Fig 1, the paper's system: curl of the rim, 90 of 100 have less, degrees",
               look_curl(&runs[0][PAPERS].look, 0.9), 40, 180, look_curl(&plain.look, 0.9),
               "the same without shrinkage");
    report_bar(lab->report, "strain_paper", "mean strain of the paper's system, the least of the figures",
               over_figures(runs, PAPERS, OF(strain_mean), false), 0.005, 1,
               over_figures(runs, OURS, OF(strain_mean), false), "ours");
    report_bar(lab->report, "strain_ours", "mean strain of ours, the largest of the figures",
               over_figures(runs, OURS, OF(strain_mean), true), 0, 0.02,
               over_figures(runs, PAPERS, OF(strain_mean), true), "the paper's system");
    report_bar(lab->report, "inverted", "share of cells turned over, the paper's system, the largest",
               over_figures(runs, PAPERS, OF(inverted), true), 0.05, 1, over_figures(runs, OURS, OF(inverted), true),
               "ours");
    report_bar(lab->report, "hottest", "K of the hottest, ours, the largest",
               over_figures(runs, OURS, OF(hottest), true), 900, 1600, over_figures(runs, PAPERS, OF(hottest), true),
               "the paper's system");
    report_bar(lab->report, "dynamics", "share of a step's time in dynamics, the paper's system, the least",
               over_figures(runs, PAPERS, OF(dynamics), false), 0.5, 1, over_figures(runs, PAPERS, OF(heat), true),
               "in heat, the most");

    return SINGE_OK;
}
