#include "page/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text.h"
#include "formats/formats.h"

enum { WIDTH = 720, HEIGHT = 400, LEFT = 76, RIGHT = 220, TOP = 48, BOTTOM = 50 };

typedef struct Axis {
    bool log;
    double low, high, step; ///< of the logarithm if log
    double first, last;     ///< pixels
} Axis;

static double scaled(const Axis *axis, double value) { return axis->log ? log10(value) : value; }
static bool shown(const Axis *axis, double value) { return isfinite(value) && (!axis->log || value > 0); }

static double pixel(const Axis *axis, double value) {
    return axis->first + (axis->last - axis->first) * (scaled(axis, value) - axis->low) / (axis->high - axis->low);
}

static double line_x(const PlotLine *line, int i) { return line->x ? line->x[i] : i; }

static Axis axis_fit(const Plot *plot, bool vertical) {
    Axis axis = {.log = vertical ? plot->log_y : plot->log_x, .low = INFINITY, .high = -INFINITY};
    for (int l = 0; l < plot->line_count; l++)
        for (int i = 0; i < plot->lines[l].count; i++) {
            double x = line_x(&plot->lines[l], i), y = plot->lines[l].y[i], value = vertical ? y : x;
            if (!isfinite(x) || !isfinite(y) || !shown(&axis, value)) continue;
            axis.low = fmin(axis.low, scaled(&axis, value));
            axis.high = fmax(axis.high, scaled(&axis, value));
        }

    if (!(axis.low <= axis.high)) {
        axis.low = 0;
        axis.high = 1;
    }

    if (axis.high - axis.low < 1e-12) {
        axis.low -= 0.5;
        axis.high += 0.5;
    }

    if (axis.log) {
        axis.low = floor(axis.low + 1e-9);
        axis.high = fmax(ceil(axis.high - 1e-9), axis.low + 1);
        axis.step = fmax(1, ceil((axis.high - axis.low) / 8));
    } else {
        // 1, 2 or 5 times a power of ten that divides the span into about six
        const double raw = (axis.high - axis.low) / 6, power = pow(10, floor(log10(raw))), f = raw / power;
        axis.step = power * (f < 1.5 ? 1 : f < 3.5 ? 2 : f < 7.5 ? 5 : 10);
        if (vertical) {
            axis.low = axis.step * floor(axis.low / axis.step + 1e-9);
            axis.high = axis.step * ceil(axis.high / axis.step - 1e-9);
        }
    }

    axis.first = vertical ? HEIGHT - BOTTOM : LEFT;
    axis.last = vertical ? TOP : WIDTH - RIGHT;
    return axis;
}

static void draw_ticks(FILE *file, const Axis *axis, bool vertical) {
    for (double at = axis->step * ceil(axis->low / axis->step - 1e-9); at <= axis->high + 1e-9 * axis->step;
         at += axis->step) {
        double value = axis->log ? pow(10, at) : fabs(at) < 1e-9 * axis->step ? 0 : at, p = pixel(axis, value);
        if (vertical)
            fprintf(file,
                    "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#e2e2e2\"/>\n"
                    "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>\n",
                    LEFT, WIDTH - RIGHT, p, p, LEFT - 6, p + 4, value);
        else
            fprintf(file,
                    "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#eee\"/>\n"
                    "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.4g</text>\n",
                    p, p, TOP, HEIGHT - BOTTOM, p, HEIGHT - BOTTOM + 16, value);
    }
}

void plot_add(Plot *plot, PlotLine line) {
    if (plot->line_count < PLOT_LINES_MAX) plot->lines[plot->line_count++] = line;
}

void plot_draw(const Plot *plot, FILE *file) {
    Axis x = axis_fit(plot, false), y = axis_fit(plot, true);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
            "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
            "<text x=\"%d\" y=\"18\" font-size=\"14\">%s</text>\n"
            "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>\n<text x=\"8\" y=\"%d\">%s</text>\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT, LEFT, plot->title, (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, plot->x_label,
            TOP - 12, plot->y_label);

    draw_ticks(file, &x, false);
    draw_ticks(file, &y, true);
    for (int l = 0; l < plot->line_count; l++) {
        bool pen = false;
        fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%s\"%s d=\"", plot->lines[l].colour,
                plot->lines[l].dots ? "0" : "2", plot->lines[l].dashed ? " stroke-dasharray=\"6 4\"" : "");

        for (int i = 0; i < plot->lines[l].count; i++) {
            if (!shown(&x, line_x(&plot->lines[l], i)) || !shown(&y, plot->lines[l].y[i])) {
                pen = false;
                continue;
            }

            fprintf(file, "%c%.1f,%.1f ", pen ? 'L' : 'M', pixel(&x, line_x(&plot->lines[l], i)),
                    pixel(&y, plot->lines[l].y[i]));
            pen = true;
        }

        fprintf(file, "\"/>\n");
        for (int i = 0; i < plot->lines[l].count && plot->lines[l].dots; i++)
            if (shown(&x, line_x(&plot->lines[l], i)) && shown(&y, plot->lines[l].y[i]))
                fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n",
                        pixel(&x, line_x(&plot->lines[l], i)), pixel(&y, plot->lines[l].y[i]), plot->lines[l].colour);
        fprintf(file, "<text x=\"%d\" y=\"%d\" fill=\"%s\">%s</text>\n", WIDTH - RIGHT + 12, TOP + 18 * l + 10,
                plot->lines[l].colour, plot->lines[l].name);
    }

    fprintf(file, "</svg>\n");
}

SingeResult plot_write(const Plot *plot, const char *path, SingeError *error) {
    char *text;
    FILE *file = text_open(&text);
    plot_draw(plot, file);
    text_close(file, &text);
    SingeResult result = file_write(path, text, strlen(text), error);
    free(text);
    return result;
}
