// A page of experiments of `singe paper` and `singe validate`: FOLDER/index.html, which needs only the pictures next to
// it, and its numbers as measures.csv and measures.json.
//
// A page is a list of reports, one per item: the source's result, then tables, plots and pictures as they are added,
// and measures. A measure is a number with a bar. Texts are HTML; captions and names plain. Several reports of a page
// may be filled at once, each by one thread.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "page/plot.h"
#include "singe/base.h"

typedef struct ReportPage ReportPage;
typedef struct Report Report;

/// What a measure is worth: in a word, for its table, and whether it is known to miss its bar. Such a miss is printed and
/// counted, and is no failure; that it holds is one, as then its grade is out of date.
typedef struct ReportGrade {
    const char *word; ///< NULL: it has none, and fails
    bool misses;
} ReportGrade;
typedef ReportGrade ReportGradeFn(const char *item, const char *measure);

/// Creates the folder. `grade` may be NULL: measures have no grades. NULL on failure, with *error filled.
ReportPage *report_page_open(const char *folder, const char *title, const char *lead, ReportGradeFn *grade,
                             SingeError *error);

/// Begins an item. `name` prefixes its pictures and measures. Tables and measures are also printed: at once if `echo`
/// is set, else by report_end. NULL when out of memory. May be called by any thread.
Report *report_begin(const ReportPage *page, const char *name, const char *heading, const char *shows, bool echo);

/// Adds an item to the page, after those added before, and frees it.
void report_end(ReportPage *page, Report *report);

/// A paragraph.
void report_text(Report *report, const char *format, ...) SINGE_PRINTF(2, 3);

/// A table's headings and rows, their cells divided by '|'.
void report_heads(Report *report, const char *heads);
void report_row(Report *report, const char *format, ...) SINGE_PRINTF(2, 3);

/// Writes the last table, complete, to the file NAME.csv beside the page.
SINGE_NODISCARD SingeResult report_table(Report *report, const char *name, SingeError *error);

/// Consecutive pictures are side by side, `columns` in a row.
void report_pictures(Report *report, int columns);
void report_picture(Report *report, const char *caption, int width, int height, const uint8_t *rgb);

void report_plot(Report *report, const Plot *plot);

/// The stream for a custom drawing: SVG, whole elements with their own widths.
FILE *report_drawing(Report *report);

/// Compares a number with a bar: low <= value <= high; infinite for no limit. NaN does not hold.
void report_measure(Report *report, const char *name, const char *what, double value, double low, double high);

/// The same, with a case that must not hold: if `bad` passes the bar, too, the bar cannot fail, and the measure fails.
/// `bad_what` describes the bad case; NULL: there is none.
void report_bar(Report *report, const char *name, const char *what, double value, double low, double high, double bad,
                const char *bad_what);

typedef enum ReportVerdict { REPORT_HOLDS, REPORT_MISSES, REPORT_FAILS } ReportVerdict;

/// A measure that has been taken.
typedef struct ReportTaken {
    char *item, *name;
    double value;
    ReportVerdict verdict;
    char *bad_what; ///< the case that must not hold, empty if its bar has none
} ReportTaken;

/// A measure of an added item, or NULL if it was not taken. Valid until the item at hand ends.
const ReportTaken *report_find(const Report *report, const char *item, const char *name);

/// The path of the report.
const char *report_folder(const Report *report);

/// Writes the files and frees the page. *failed is the number of measures that fail, *missing of those that miss, as is
/// known.
SINGE_NODISCARD SingeResult report_page_close(ReportPage *page, int *failed, int *missing, SingeError *error);
