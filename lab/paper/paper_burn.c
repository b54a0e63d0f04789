// The paper's burning sheets: figures 1, 4, 11 and 12, section 6's claims, and the alternative of sections 2 and 3.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "page/appearance.h"
#include "paper/paper.h"
#include "page/lab.h"

static const char *const small_grid = "sheets.0.grid.cells=[30, 42]";

// ---- Fig 1, 12: hot from the start, a texture for the rate

enum { FIG1_SHOTS = 6, FIG1_RUNS = 2 };

/// The results of a run of Fig 1; `plain`: without shrinkage.
typedef struct Fig1 {
    double correlation, mirrored; ///< of the texture with the burnt share after 0.1 s
    double inner;                 ///< max degrees from cell to cell where most of the mass remains
    double gone;                  ///< share of the cells after 0.1 s
    Look look;                    ///< from 2.2 s on
} Fig1;

SingeResult paper_fig1(Lab *lab, SingeError *error) {
    Fig1 runs[FIG1_RUNS] = {{0}};
    SingeResult result = SINGE_OK;
    for (int i = 0; i < FIG1_RUNS && !result; i++) {
        const bool plain = i == 1; // without shrinkage
        static const double times[FIG1_SHOTS] = {0.1, 0.5, 1, 1.6, 2.2, 3};
        Play play;
        const char *sets[] = {plain ? "sheets.0.material.shrink_front=0" : "",
                              plain ? "sheets.0.material.shrink_back=0" : "", lab->quick ? small_grid : "", NULL};
        result = play_open(&play, lab, "fig1.yaml", sets, error);
        const SingeTexture *picture = &play.job.assets.fields[0][SCENE_PARAM_SLOT(mass_rate)].texture;
        if (!result && !plain) report_pictures(lab->report, 4), texture_show(lab, picture);

        for (int shot = 0; shot < FIG1_SHOTS && !result; shot++) {
            result = plain ? play_until(&play, times[shot], error) : play_shoot_at(&play, times[shot], error);
            if (result) break;

            SingeView view = singe_sim_view(play.sim);
            if (shot == 0) {
                runs[i].correlation = -texture_correlation(&view, picture, false, view.mass);
                runs[i].mirrored = -texture_correlation(&view, picture, true, view.mass);
                runs[i].gone = 1 - shape_left(&view);
            }

            // bends between neighbouring cells that have most of their mass: hardly burnt parts bend, too
            double sum = 0, count = 0;
            for (uint32_t s = 0; s < view.spring_count[SINGE_GREEN]; s++) {
                uint32_t a = view.springs[SINGE_GREEN][s][0], b = view.springs[SINGE_GREEN][s][1];
                const bool alive = view.spring_flags[SINGE_GREEN][s] & SINGE_ALIVE;
                if (!alive || view.mass[a] < 0.7f || view.mass[b] < 0.7f) continue;
                double angle = shape_angle(&view, a - view.vertex_count, b - view.vertex_count);
                sum += angle * angle;
                count++;
            }

            runs[i].inner = fmax(runs[i].inner, count > 0 ? sqrt(sum / count) * 180 / acos(-1) : 0);
            if (times[shot] > 2) result = look_take(&play, 0, &runs[i].look, error);
        }

        play_close(&play);
    }
    if (result) return result;

    const Fig1 *fig = &runs[0], *flat = &runs[1];
    static const char *const without = "the same sheet without shrinkage";

    report_bar(lab->report, "correlation", "correlation of the texture with the mass lost after 0.1 s",
               fig->correlation, 0.9, 1, fig->mirrored, "with its mirror image");
    report_bar(lab->report, "curl", "curl of the rim over 10 mm, 90 of 100 have less, degrees",
               look_curl(&fig->look, 0.9), 25, 180, look_curl(&flat->look, 0.9), without);
    report_bar(lab->report, "slope", "slope of the last 4 mm, median, degrees", look_slope(&fig->look, 0.5), 15, 90,
               look_slope(&flat->look, 0.5), without);
    report_bar(lab->report, "bend", "degrees from cell to cell, at most", fig->look.bend, 8, INFINITY, flat->look.bend,
               without);
    report_bar(lab->report, "inner",
               "the same of cells that have most of their mass: \"interior regions "
               "... also wrinkle\"",
               fig->inner, 3, INFINITY, flat->inner, without);
    report_bar(lab->report, "burnt", "share of cells gone after 3 s", 1 - fig->look.left, 0.3, 1, fig->gone,
               "after 0.1 s");

    return SINGE_OK;
}

// ---- Fig 4: four columns

enum { COLUMNS = 4, ROWS = 4 };

enum { FIG4_MEAN = COLUMNS }; ///< a fifth run, not drawn: the mean of (d)'s texture everywhere

/// What fire adds to the border of a whole sheet, over the share of cells that it takes.
static double fire_border(const Look *look, const Look *whole) {
    return (look->border - whole->border) / (1 - look->left);
}

static void fig4_report(Report *report, const Look *look) {
    static const char *const same = "(a) over itself", *const whole = "(b), which stays whole";
    static const char *const short_names[COLUMNS] = {"(a)", "(b)", "(c)", "(d)"};
    const Look *a = &look[0], *b = &look[1], *c = &look[2], *d = &look[3], *mean = &look[FIG4_MEAN];

    report_heads(report, "|cells left %|pieces over 5 %|bend, degrees|curl, median|90 of 100|slope, median|border");
    for (int i = 0; i < COLUMNS; i++)
        report_row(report, "%s|%.1f|%d|%.2f|%.1f|%.1f|%.1f|%.2f", short_names[i], 100 * look[i].left, look[i].pieces,
                   look[i].bend, look_curl(&look[i], 0.5), look_curl(&look[i], 0.9), look_slope(&look[i], 0.5),
                   look[i].border);
    report_text(report, "Curl: of the rim over 10 mm, degrees; slope: of the last 4 mm, from the plane of the sheet, "
                        "degrees; both over 2.3, 2.7 and 3.6 s. (b) loses nothing: its rim is where that of (c) would "
                        "be, at m_loss. Border: over the root of the area, at rest.");

    report_bar(report, "b_whole", "(b) share of cells left", b->left, 1, 1, c->left, "(c)");
    report_bar(report, "a_parts", "(a) pieces of more than 5 %: the shell separates into two parts", a->pieces, 2,
               INFINITY, b->pieces, whole);
    report_bar(report, "c_parts", "(c) the same", c->pieces, 2, INFINITY, b->pieces, whole);
    report_bar(report, "b_curl", "curl of the rim, median, (b) over (a)", look_curl(b, 0.5) / look_curl(a, 0.5), 2,
               INFINITY, 1, same);
    report_bar(report, "c_curl", "the same, (c) over (a): more detail with shrinkage",
               look_curl(c, 0.5) / look_curl(a, 0.5), 2, INFINITY, 1, same);
    report_bar(report, "b_slope", "slope of the last 4 mm, median, (b) over (a)",
               look_slope(b, 0.5) / look_slope(a, 0.5), 1.5, INFINITY, 1, same);
    report_bar(report, "c_slope", "the same, (c) over (a)", look_slope(c, 0.5) / look_slope(a, 0.5), 1.5, INFINITY, 1,
               same);

    const double ragged = fire_border(c, b);
    report_bar(report, "d_border", "borders that fire makes by what it takes, (d) over (c): it is ragged",
               fire_border(d, b) / ragged, 1.5, INFINITY, fire_border(mean, b) / ragged,
               "the texture's mean all over, over (c)");
}

SingeResult paper_fig4(Lab *lab, SingeError *error) {
    static const char *const names[COLUMNS] = {"(a) boundary only", "(b) shrinkage only", "(c) both", "(d) texture"};
    static const char *const rows[ROWS] = {"0.9 s", "1.6 s", "2.3 s", "2.7 s"};
    Look look[FIG4_MEAN + 1] = {{.left = 0}};
    double rate = 0;
    uint8_t *rgb[COLUMNS + 1][ROWS] = {{NULL}};
    int size[2] = {0};
    SingeResult result = SINGE_OK;
    for (int i = 0; i <= FIG4_MEAN && !result; i++) {
        // *rate: the mean of (d)'s rate, which the next run uses
        static const double times[ROWS] = {0.9, 1.6, 2.3, 2.7};
        static const char *const scenes[FIG4_MEAN + 1] = {"fig4a.yaml", "fig4b.yaml", "fig4c.yaml", "fig4d.yaml",
                                                          "fig4c.yaml"};
        char mean[60] = "";
        if (i == FIG4_MEAN) snprintf(mean, sizeof mean, "sheets.0.material.mass_rate=%g", rate);

        const double cut = i == 1 ? 0.2 : 0; // the scene's mass_loss: where the edge of (b) would be
        Play play;
        const char *sets[] = {mean, lab->quick ? small_grid : "", lab->quick ? "preview.size=[320, 384]" : "", NULL};
        result = play_open(&play, lab, scenes[i], sets, error);
        if (!result && i == FIG4_MEAN - 1)
            rate = 1e-3 + 19e-3 * texture_mean(&play.job.assets.fields[0][SCENE_PARAM_SLOT(mass_rate)].texture);

        for (int k = 0; k < ROWS && !result; k++) {
            result = play_until(&play, times[k], error);
            if (!result && i < COLUMNS) result = play_draw(&play, &rgb[i][k], size, error);
            if (!result && times[k] > 2) result = look_take(&play, cut, &look[i], error);
        }

        if (!result) result = play_until(&play, 3.6, error);
        if (!result) result = look_take(&play, cut, &look[i], error);
        play_close(&play);
    }

    if (!result) report_pictures(lab->report, COLUMNS);
    for (int k = 0; k < ROWS; k++)
        for (int i = 0; i < COLUMNS; i++) {
            char caption[60];
            snprintf(caption, sizeof caption, "%s, %s", names[i], rows[k]);
            if (!result && rgb[i][k]) report_picture(lab->report, caption, size[0], size[1], rgb[i][k]);
            free(rgb[i][k]);
        }

    if (!result) fig4_report(lab->report, look);
    return result;
}

// ---- Fig 11: the torus burns

enum { FIG11_SHOTS = 6 };

SingeResult paper_fig11(Lab *lab, SingeError *error) {
    static const char *const flat = "the same torus without shrinkage";
    static const double times[FIG11_SHOTS] = {0.5, 1.5, 3, 4.5, 6, 8};
    Look looks[2] = {{.left = 0}};
    int lit[FIG11_SHOTS] = {0};
    double first = 1;
    SingeStats stats = {0};
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, 3);

    for (int plain = 0; plain < 2 && !result; plain++) { // the second does not shrink
        Play play;
        const char *sets[] = {lab->quick ? "sheets.0.mesh=torus-small.obj" : "",
                              plain ? "sheets.0.material.shrink_front=0" : "",
                              plain ? "sheets.0.material.shrink_back=0" : "", NULL};
        result = play_open(&play, lab, "fig11.yaml", sets, error);
        for (int i = 0; i < FIG11_SHOTS && !result; i++) {
            if (plain && times[i] > 6) break;
            result = plain ? play_until(&play, times[i], error) : play_shoot_at(&play, times[i], error);
            if (!result && times[i] > 2 && times[i] < 7) result = look_take(&play, 0, &looks[plain], error);
            if (result || plain) continue;
            SingeView view = singe_sim_view(play.sim);

            // the number of sectors, of 12 around the hole, in which a fifth of the vertices have ignited
            double ignited[12] = {0}, all[12] = {0};
            int count = 0;
            for (uint32_t v = 0; v < view.vertex_count; v++) {
                if (view.source_vertex[v] < 0) continue; // in reserve for tears
                int k =
                    (int)(6 + 6 * atan2((double)view.rest_position[v][1], (double)view.rest_position[v][0]) / acos(-1));
                all[k % 12]++;
                ignited[k % 12] += view.time_ignited[v] >= 0;
            }

            for (int k = 0; k < 12; k++) count += ignited[k] >= 0.2 * all[k];
            lit[i] = count;
            stats = singe_sim_stats(play.sim);
            if (i == 0) first = shape_left(&view);
            looks[0].left = shape_left(&view);
        }

        play_close(&play);
    }

    if (result) return result;
    report_bar(lab->report, "start", "of 12 sectors around the hole, those alight after 1.5 s", lit[1], 1, 6,
               lit[FIG11_SHOTS - 1], "after 8 s");
    report_bar(lab->report, "end", "after 8 s: the fire went both ways around", lit[FIG11_SHOTS - 1], 12, 12, lit[1],
               "after 1.5 s");
    report_bar(lab->report, "left", "share of cells left then", looks[0].left, 0, 0.8, first, "after 0.5 s");
    report_bar(lab->report, "shrunk", "area of the last 4 mm at the rim over that at rest, from 3 to 6 s",
               look_area(&looks[0]), 0.3, 0.8, look_area(&looks[1]), flat);

    const double in = stats.heat_in + stats.heat_of_combustion, kept = stats.heat_stored;
    report_bar(lab->report, "ledger", "error of the heat ledger", stats.ledger_error, 0, 1e-4,
               fabs(in - kept) / fmax(fabs(in), fabs(kept)), "without what is lost to the air in it");
    return SINGE_OK;
}

// ---- section 6: what m_loss does

SingeResult paper_mass_loss(Lab *lab, SingeError *error) {
    enum { CASES = 3, LOOKS = 61 };
    static const char *const names[CASES] = {"m_loss 10 %, below m_min", "m_loss 30 %", "m_loss 95 %, near m_init"};
    static const char *const sets[CASES] = {"sheets.0.material.mass_loss=10 %", "", "sheets.0.material.mass_loss=95 %"};
    static const char *const inks[CASES] = {"#2166ac", "#e08214", "#b2182b"};
    double left[CASES][LOOKS], time[LOOKS], fifth[CASES], bend = 0, before = 0;
    int pieces[CASES] = {0};
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, CASES);

    for (int i = 0; i < CASES && !result; i++) {
        Play play;
        const char *laid[] = {sets[i], lab->quick ? "sheets.0.grid.cells=[20, 28]" : small_grid, "contact=no",
                              "tearing=no", NULL};
        result = play_open(&play, lab, "fig1.yaml", laid, error);

        fifth[i] = INFINITY;
        for (int k = 0; k < LOOKS && !result; k++) {
            time[k] = 0.05 * k;
            result = play_until(&play, time[k], error);
            SingeView view = singe_sim_view(play.sim);
            left[i][k] = shape_left(&view);
            if (left[i][k] < 0.8 && time[k] < fifth[i]) fifth[i] = time[k];

            char caption[80];
            snprintf(caption, sizeof caption, "%s, %.1f s", names[i], time[k]);
            if (!result && k == (i == 2 ? 11 : 30)) result = play_shoot(&play, caption, error);
            if (i == 0) bend = shape_bend(&view);
            if (i == 0 && k == 2) before = bend;
            pieces[i] = (int)singe_sim_stats(play.sim).pieces;
        }

        play_close(&play);
    }
    if (result) return result;

    Plot plot = {.title = "Cells left", .x_label = "s", .y_label = "share"};
    for (int i = 0; i < CASES; i++) plot_add(&plot, (PlotLine){names[i], inks[i], time, left[i], LOOKS, false, false});
    report_plot(lab->report, &plot);

    report_bar(lab->report, "whole", "m_loss below m_min: share of cells left after 3 s", left[0][LOOKS - 1], 1, 1,
               left[1][LOOKS - 1], "m_loss 30 %");
    report_bar(lab->report, "one_piece", "the same: pieces", pieces[0], 1, 1, pieces[1], "m_loss 30 %");
    report_bar(lab->report, "wrinkles", "the same: degrees from cell to cell", bend, 5, INFINITY, before,
               "after 0.1 s");
    report_bar(lab->report, "quick",
               "m_loss near m_init: a fifth is gone in this share of the time of m_loss "
               "30 %",
               fifth[2] / fifth[1], 0, 0.4, fifth[1] / fifth[1], "m_loss 30 % itself");

    return SINGE_OK;
}

// ---- the alternative: bending by the difference of temperature

enum { RIVAL_LOOKS = 145 };

static void scale_to_one(double *values, int count) {
    double max = 0;
    for (int i = 0; i < count; i++) max = fmax(max, fabs(values[i]));
    for (int i = 0; i < count && max > 0; i++) values[i] = fabs(values[i]) / max;
}

/// The strip from the side at some times: ours above, the alternative's arc of the same length below.
enum { RIVAL_SHOTS = 4, RIVAL_POINTS = 31 };
static const int rival_shots[RIVAL_SHOTS] = {8, 24, 48, 144}; // looks

static void rival_draw(FILE *file, const double (*profile)[RIVAL_POINTS][2], const double *bend) {
    const double scale = 2800, length = 0.06;
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"840\" height=\"180\" font-family=\"sans-serif\" "
                  "font-size=\"12\">\n");

    for (int s = 0; s < RIVAL_SHOTS; s++) {
        const double left = 20 + 208 * s, k = bend[s];
        fprintf(file,
                "<text x=\"%g\" y=\"16\">%.1f s</text>\n<polyline fill=\"none\" stroke=\"#2166ac\" "
                "stroke-width=\"3\" points=\"",
                left, rival_shots[s] / 24.0);
        for (int i = 0; i < RIVAL_POINTS; i++)
            fprintf(file, "%.1f,%.1f ", left + 84 + scale * profile[s][i][0], 70 - scale * profile[s][i][1]);
        fprintf(file, "\"/>\n<polyline fill=\"none\" stroke=\"#b2182b\" stroke-width=\"3\" stroke-dasharray=\"6 4\" "
                      "points=\"");

        for (int i = 0; i < RIVAL_POINTS; i++) {
            double at = length * ((double)i / (RIVAL_POINTS - 1) - 0.5);
            double x = k > 1e-3 ? sin(k * at) / k : at, z = k > 1e-3 ? (1 - cos(k * at)) / k : 0;
            fprintf(file, "%.1f,%.1f ", left + 84 + scale * x, 120 + scale * z);
        }

        fprintf(file, "\"/>\n");
    }

    fprintf(file, "</svg>\n");
}

SingeResult paper_rival(Lab *lab, SingeError *error) {
    double time[RIVAL_LOOKS], difference[RIVAL_LOOKS], curvature[RIVAL_LOOKS];
    double profiles[RIVAL_SHOTS][RIVAL_POINTS][2] = {{{0}}}, bend[RIVAL_SHOTS];
    Play play;
    SingeResult result = play_open(&play, lab, "rival.yaml", (const char *const[]){NULL}, error);

    for (int k = 0; k < RIVAL_LOOKS && !result; k++) {
        time[k] = k / 24.0;
        result = play_until(&play, time[k], error);
        SingeView view = singe_sim_view(play.sim);

        // K, temperature of the front minus that of the back; 1/m, curvature along the strip's centre line, positive
        // towards the back
        enum { ALONG = 30 };
        double front = 0, back = 0, angle = 0, length = 0;
        const uint32_t row = ALONG + 1;

        for (uint32_t i = 0; i < view.cell_count; i++)
            front += (double)view.temperature[view.vertex_count + i] / view.cell_count;
        for (uint32_t v = 0; v < view.vertex_count; v++) back += (double)view.temperature[v] / view.vertex_count;

        for (uint32_t i = 2; i + 3 < row; i++) {
            const float *p = view.position[row + i], *q = view.position[row + i + 1], *r = view.position[row + i + 2];
            double a[2] = {(double)q[0] - (double)p[0], (double)q[2] - (double)p[2]};
            double b[2] = {(double)r[0] - (double)q[0], (double)r[2] - (double)q[2]};
            angle += atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
            length += hypot(a[0], a[1]);
        }

        difference[k] = front - back;
        curvature[k] = angle / length;

        for (int s = 0; s < RIVAL_SHOTS; s++)
            if (k == rival_shots[s]) {
                // the centre line relative to its own centre, for rival_draw
                double mean[2] = {0};
                for (int i = 0; i < RIVAL_POINTS; i++)
                    for (int n = 0; n < 2; n++) {
                        profiles[s][i][n] = (double)view.position[RIVAL_POINTS + i][2 * n];
                        mean[n] += profiles[s][i][n] / RIVAL_POINTS;
                    }
                for (int i = 0; i < RIVAL_POINTS; i++)
                    for (int n = 0; n < 2; n++) profiles[s][i][n] -= mean[n];
            }
    }

    play_close(&play);
    if (result) return result;

    double max = 0, hottest = 0;
    for (int k = 0; k < RIVAL_LOOKS; k++) {
        max = fmax(max, fabs(curvature[k]));
        hottest = fmax(hottest, fabs(difference[k]));
    }

    report_text(lab->report,
                "A strip of card is heated from below for a second and cools. The lower side is up to %.0f K hotter, "
                "and chars and shrinks more; the strip curls to %.0f /m. A model that bends by the temperature "
                "difference (dashed, scaled to the same largest curl) is flat again as soon as the strip is cold.",
                hottest, max);
    scale_to_one(difference, RIVAL_LOOKS), scale_to_one(curvature, RIVAL_LOOKS);
    for (int s = 0; s < RIVAL_SHOTS; s++) bend[s] = max * difference[rival_shots[s]];
    rival_draw(report_drawing(lab->report), (const double(*)[RIVAL_POINTS][2])profiles, bend);

    Plot plot = {.title = "Curl while it is heated and cools", .x_label = "s", .y_label = "share of the largest"};
    plot_add(&plot, (PlotLine){"by temperature", "#b2182b", time, difference, RIVAL_LOOKS, false, true});
    plot_add(&plot, (PlotLine){"by shrinkage (here)", "#2166ac", time, curvature, RIVAL_LOOKS, false, false});
    report_plot(lab->report, &plot);

    const double rival_end = difference[RIVAL_LOOKS - 1], here_end = curvature[RIVAL_LOOKS - 1];
    report_bar(lab->report, "curl", "largest curvature, 1/m", max, 3, INFINITY, max * curvature[0],
               "before it is heated");
    report_bar(lab->report, "rival_end", "rival: curl left in the end", rival_end, 0, 0.05, here_end, "by shrinkage");
    report_bar(lab->report, "here_end", "here: curl left in the end", here_end, 0.8, 1, rival_end, "by temperature");
    return SINGE_OK;
}
