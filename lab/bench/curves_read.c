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

/// Splits a line at its commas, in place. Quotes are not supported: the tables need none.
static int curves_read_split(char *line, char **fields) {
    int count = 0;
    line[strcspn(line, "\r\n")] = 0;
    while (count < COLUMNS_MAX) {
        fields[count++] = line;
        line = strchr(line, ',');
        if (!line) break;
        *line++ = 0;
    }
    return count;
}

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
        int count = curves_read_split(text, fields);
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
