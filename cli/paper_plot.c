#include "cli/paper_plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "formats/formats.h"

enum { WIDTH = 640, HEIGHT = 420, LEFT = 70, RIGHT = 100, TOP = 40, BOTTOM = 50 };

typedef struct Axis {
    double low, high; ///< decades
    int count;        ///< of steps
} Axis;

static double plot_x(const Axis *axis, int step) {
    return LEFT + (WIDTH - LEFT - RIGHT) * (double)step / (axis->count > 1 ? axis->count - 1 : 1);
}

static double plot_y(const Axis *axis, double value) {
    return TOP + (HEIGHT - TOP - BOTTOM) * (axis->high - log10(value)) / (axis->high - axis->low);
}

static Axis plot_axis(const PlotLine *lines, int line_count, int count) {
    double low = INFINITY, high = 0;
    for (int l = 0; l < line_count; l++)
        for (int i = 0; i < count; i++) {
            double value = lines[l].values[i];
            if (value > 0 && value < low) low = value;
            if (isfinite(value) && value > high) high = value;
        }
    if (!(high > 0)) low = high = 1;
    Axis axis = {floor(log10(low)), ceil(log10(high)), count};
    if (axis.high <= axis.low) axis.high = axis.low + 1;
    return axis;
}

static void plot_frame(FILE *file, const Axis *axis, const char *title) {
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" "
            "font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
            "<text x=\"%d\" y=\"22\" font-size=\"14\">%s</text>\n"
            "<text x=\"%d\" y=\"%d\">projection step</text>\n<text x=\"8\" y=\"%d\">|C|, m</text>\n",
            WIDTH, HEIGHT, LEFT, title, (WIDTH - RIGHT) / 2, HEIGHT - 12, TOP - 8);
    double step = ceil((axis->high - axis->low) / 8); // no more than nine lines
    for (double decade = axis->low; decade <= axis->high; decade += step) {
        double y = plot_y(axis, pow(10, decade));
        fprintf(file,
                "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n"
                "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">1e%.0f</text>\n",
                LEFT, WIDTH - RIGHT, y, y, LEFT - 6, y + 4, decade);
    }
    for (int i = 0; i < axis->count; i++)
        fprintf(file, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%d</text>\n", plot_x(axis, i),
                HEIGHT - BOTTOM + 16, i);
}

static void plot_line(FILE *file, const Axis *axis, const PlotLine *line, int index) {
    bool pen = false;
    fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2\" d=\"", line->colour);
    for (int i = 0; i < axis->count; i++) {
        if (!(line->values[i] > 0) || !isfinite(line->values[i])) {
            pen = false;
            continue;
        }
        fprintf(file, "%c%.1f,%.1f ", pen ? 'L' : 'M', plot_x(axis, i), plot_y(axis, line->values[i]));
        pen = true;
    }
    fprintf(file, "\"/>\n<text x=\"%d\" y=\"%d\" fill=\"%s\">%s</text>\n", WIDTH - RIGHT + 12, TOP + 18 * index + 10,
            line->colour, line->name);
}

SingeResult plot_write(const char *path, const char *title, const PlotLine *lines, int line_count, int count,
                       SingeError *error) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    SingeResult result = SINGE_ERROR_MEMORY;
    if (file) {
        Axis axis = plot_axis(lines, line_count, count);
        plot_frame(file, &axis, title);
        for (int l = 0; l < line_count; l++) plot_line(file, &axis, &lines[l], l);
        fprintf(file, "</svg>\n");
        if (fclose(file) == 0) result = file_write(path, text, size, error);
    }
    if (result == SINGE_ERROR_MEMORY) *error = (SingeError){.code = result, .element = -1};
    free(text);
    return result;
}
