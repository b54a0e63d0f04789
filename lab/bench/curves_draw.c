#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/curves.h"

enum { WIDTH = 920, HEIGHT = 560, LEFT = 76, RIGHT = 340, TOP = 24, BOTTOM = 56 };

static const char *const colours[CURVES_MAX] = {"#888888", "#444444", "#c8401c", "#1c6cc8", "#2c8c3c", "#8c3ca0",
                                                "#c89018", "#18a0a0", "#a03c5c", "#5c5cc8", "#6c8c1c", "#7c5c3c"};

/// Powers of ten that enclose all points.
typedef struct Frame {
    int springs_low, springs_high, ms_low, ms_high;
} Frame;

static double position_x(const Frame *f, double power) {
    return LEFT + (power - f->springs_low) / (f->springs_high - f->springs_low) * (WIDTH - LEFT - RIGHT);
}

static double position_y(const Frame *f, double power) {
    return HEIGHT - BOTTOM - (power - f->ms_low) / (f->ms_high - f->ms_low) * (HEIGHT - TOP - BOTTOM);
}

/// A line at every power of ten, with its number: from 0.01 to 1000 in full, else as a power.
static void draw_number(FILE *file, double x, double y, const char *anchor, int power) {
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
    if (power >= -2 && power <= 3) fprintf(file, "%.*f", power < 0 ? -power : 0, pow(10, power));
    else fprintf(file, "10<tspan dy=\"-6\" font-size=\"9\">%d</tspan>", power);
    fputs("</text>\n", file);
}

static void draw_curve(FILE *file, const Frame *f, const Curve *curve, int index) {
    const char *colour = colours[index];
    const double right = WIDTH - RIGHT + 16, y = TOP + 12 + 20 * index;
    fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2\" d=\"", colour);
    for (int p = 0; p < curve->count; p++)
        fprintf(file, "%s%.1f %.1f", p ? " L" : "M", position_x(f, log10(curve->springs[p])),
                position_y(f, log10(curve->ms[p])));
    fputs("\"/>\n", file);
    for (int p = 0; p < curve->count; p++)
        fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n",
                position_x(f, log10(curve->springs[p])), position_y(f, log10(curve->ms[p])), colour);
    fprintf(file, "<path d=\"M%.1f %.1f h20\" stroke=\"%s\" stroke-width=\"2\"/>\n", right, y - 4, colour);
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\">", right + 26, y);

    const char *text = curve->name;
    for (; *text; text++) {
        if (*text == '<') fputs("&lt;", file);
        else if (*text == '&') fputs("&amp;", file);
        else if ((unsigned char)*text >= ' ') fputc(*text, file);
    }

    fputs("</text>\n", file);
}

SingeResult curves_draw(const Curves *curves, const char *path, SingeError *error) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int c = 0; c < curves->count; c++)
        for (int p = 0; p < curves->list[c].count; p++) {
            const double at[2] = {log10(curves->list[c].springs[p]), log10(curves->list[c].ms[p])};
            for (int axis = 0; axis < 2; axis++) low[axis] = fmin(low[axis], at[axis]);
            for (int axis = 0; axis < 2; axis++) high[axis] = fmax(high[axis], at[axis]);
        }
    const Frame frame = (Frame){(int)floor(low[0]), (int)fmax(ceil(high[0]), floor(low[0]) + 1), (int)floor(low[1]),
                                (int)fmax(ceil(high[1]), floor(low[1]) + 1)};

    FILE *file = fopen(path, "w");
    if (file) {
        fprintf(file,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" "
                "font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
                "<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n",
                WIDTH, HEIGHT, WIDTH, HEIGHT, WIDTH, HEIGHT);

        const double bottom = HEIGHT - BOTTOM, right = WIDTH - RIGHT;
        for (int p = frame.springs_low; p <= frame.springs_high; p++) {
            double x = position_x(&frame, p);
            fprintf(file, "<path d=\"M%.1f %d V%.1f\" stroke=\"#dddddd\"/>\n", x, TOP, bottom);
            draw_number(file, x, bottom + 20, "middle", p);
        }
        for (int p = frame.ms_low; p <= frame.ms_high; p++) {
            double y = position_y(&frame, p);
            fprintf(file, "<path d=\"M%d %.1f H%.1f\" stroke=\"#dddddd\"/>\n", LEFT, y, right);
            draw_number(file, LEFT - 8, y + 4, "end", p);
        }
        fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">springs</text>\n", 0.5 * (LEFT + right),
                bottom + 42);
        fprintf(file, "<text transform=\"translate(20 %.1f) rotate(-90)\" text-anchor=\"middle\">ms a step</text>\n",
                0.5 * (TOP + bottom));

        for (int c = 0; c < curves->count; c++) draw_curve(file, &frame, &curves->list[c], c);
        fputs("</svg>\n", file);
    }
    bool failed = !file || ferror(file);
    if (file && fclose(file)) failed = true;
    if (!failed) return SINGE_OK;
    *error = (SingeError){.code = SINGE_ERROR_FILE, .element = -1};
    snprintf(error->message, sizeof error->message, "cannot write %s: %s", path, strerror(errno));
    return SINGE_ERROR_FILE;
}
