#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/curves.h"

void curves_add_paper(Curves *curves) {
    static const double springs[] = {1000, 4000, 16000, 25000, 100000};
    static const double stopped[] = {6.50, 27.93, 159.17, 211.67, 1045.02};
    static const double full[] = {142.46, 362.69, 1268.00, 1877.92, 7412.92};

    for (int kind = 0; kind < 2; kind++) {
        Curve *curve = &curves->list[curves->count++];
        *curve = (Curve){.count = 5};
        snprintf(curve->name, sizeof curve->name, "Table 2 (four cores, 2010), %s",
                 kind ? "7 projections" : "to convergence");
        memcpy(curve->springs, springs, sizeof springs);
        memcpy(curve->ms, kind ? full : stopped, sizeof full);
    }
}

enum { COLUMNS_MAX = 64, LINE_MAX_LENGTH = 4096 };

static int curves_read_find(char **fields, int count, const char *name) {
    for (int i = 0; i < count; i++)
        if (strcmp(fields[i], name) == 0) return i;
    return -1;
}

static SingeResult curves_read_fail(SingeError *error, SingeResult code, const char *path, int line, const char *what) {
    *error = (SingeError){.code = code, .element = line};
    if (line > 0) snprintf(error->message, sizeof error->message, "%s:%d: %s", path, line, what);
    else snprintf(error->message, sizeof error->message, "%s: %s", path, what);
    return code;
}

/// The curve of that name, added if it is new; NULL if there is no room.
static Curve *curve_named(Curves *curves, int first, const char *name) {
    for (int i = first; i < curves->count; i++)
        if (strcmp(curves->list[i].name, name) == 0) return &curves->list[i];
    if (curves->count == CURVES_MAX) return NULL;
    Curve *curve = &curves->list[curves->count++];
    *curve = (Curve){0};
    snprintf(curve->name, sizeof curve->name, "%s", name);
    return curve;
}

typedef struct Columns {
    int springs, ms, solver, threads; ///< of the columns; -1 if there is none
} Columns;

static SingeResult read_lines(Curves *curves, FILE *file, const char *path, SingeError *error) {
    char text[LINE_MAX_LENGTH], *fields[COLUMNS_MAX];
    Columns columns = {-1, -1, -1, -1};
    const int first = curves->count;

    for (int line = 1; fgets(text, sizeof text, file); line++) {
        if (text[0] == '#' || text[0] == '\n') continue;

        // split the line at its commas, in place; quotes are not supported: the tables need none
        int count = 0;
        text[strcspn(text, "\r\n")] = 0;
        for (char *at = text; at && count < COLUMNS_MAX;) {
            fields[count++] = at;
            at = strchr(at, ',');
            if (at) *at++ = 0;
        }

        if (columns.springs >= 0) {
            char *springs_end, *ms_end, name[80];
            if (columns.springs >= count || columns.ms >= count || columns.solver >= count || columns.threads >= count)
                return curves_read_fail(error, SINGE_ERROR_FORMAT, path, line, "has fewer fields than the header");
            double springs = strtod(fields[columns.springs], &springs_end), ms = strtod(fields[columns.ms], &ms_end);
            if (*springs_end || *ms_end || !(springs > 0) || !(ms > 0) || !isfinite(springs) || !isfinite(ms))
                return curves_read_fail(error, SINGE_ERROR_FORMAT, path, line,
                                        "springs and step_ms must be numbers above 0");

            // "strand, 2 threads, zen4" of a file zen4.csv
            const size_t size = sizeof name;
            const char *base = strrchr(path, '/'), *end;
            base = base ? base + 1 : path;
            end = strrchr(base, '.');
            int length = end && end > base ? (int)(end - base) : (int)strlen(base);
            const char *solver = columns.solver >= 0 ? fields[columns.solver] : "";
            const char *threads = columns.threads >= 0 ? fields[columns.threads] : "";
            const char *word = !*threads ? "" : strcmp(threads, "1") == 0 ? " thread, " : " threads, ";
            snprintf(name, size, "%s%s%s%s%.*s", solver, *solver ? ", " : "", threads, word, length > 40 ? 40 : length,
                     base);

            Curve *curve = curve_named(curves, first, name);
            if (!curve || curve->count == CURVE_POINTS_MAX)
                return curves_read_fail(error, SINGE_ERROR_LIMIT, path, line,
                                        "more curves or points than a picture can hold");
            curve->springs[curve->count] = springs;
            curve->ms[curve->count++] = ms;

            continue;
        }

        columns = (Columns){curves_read_find(fields, count, "springs"), curves_read_find(fields, count, "step_ms"),
                            curves_read_find(fields, count, "solver"), curves_read_find(fields, count, "threads")};
        if (columns.springs < 0 || columns.ms < 0)
            return curves_read_fail(error, SINGE_ERROR_FORMAT, path, line,
                                    "the columns springs and step_ms are missing");
    }

    return curves->count > first ? SINGE_OK : curves_read_fail(error, SINGE_ERROR_FORMAT, path, 0, "holds no rows");
}

SingeResult curves_read(Curves *curves, const char *path, SingeError *error) {
    FILE *file = fopen(path, "r");
    if (!file) return curves_read_fail(error, SINGE_ERROR_FORMAT, path, 0, strerror(errno));
    SingeResult result = read_lines(curves, file, path, error);
    if (!result && ferror(file)) result = curves_read_fail(error, SINGE_ERROR_FORMAT, path, 0, "cannot be read");
    fclose(file);
    return result;
}

// ---- the picture

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

        for (int c = 0; c < curves->count; c++) {
            const char *colour = colours[c];
            const double end = WIDTH - RIGHT + 16, y = TOP + 12 + 20 * c;
            fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2\" d=\"", colour);
            for (int p = 0; p < curves->list[c].count; p++)
                fprintf(file, "%s%.1f %.1f", p ? " L" : "M", position_x(&frame, log10(curves->list[c].springs[p])),
                        position_y(&frame, log10(curves->list[c].ms[p])));
            fputs("\"/>\n", file);
            for (int p = 0; p < curves->list[c].count; p++)
                fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n",
                        position_x(&frame, log10(curves->list[c].springs[p])),
                        position_y(&frame, log10(curves->list[c].ms[p])), colour);
            fprintf(file, "<path d=\"M%.1f %.1f h20\" stroke=\"%s\" stroke-width=\"2\"/>\n", end, y - 4, colour);
            fprintf(file, "<text x=\"%.1f\" y=\"%.1f\">", end + 26, y);

            const char *text = curves->list[c].name;
            for (; *text; text++) {
                if (*text == '<') fputs("&lt;", file);
                else if (*text == '&') fputs("&amp;", file);
                else if ((unsigned char)*text >= ' ') fputc(*text, file);
            }

            fputs("</text>\n", file);
        }

        fputs("</svg>\n", file);
    }

    bool failed = !file || ferror(file);
    if (file && fclose(file)) failed = true;
    if (!failed) return SINGE_OK;
    *error = (SingeError){.code = SINGE_ERROR_FILE, .element = -1};
    snprintf(error->message, sizeof error->message, "cannot write %s: %s", path, strerror(errno));
    return SINGE_ERROR_FILE;
}
