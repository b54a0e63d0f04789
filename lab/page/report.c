#include "page/report.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "formats/formats.h"

/// A growing text.
typedef struct Draft {
    FILE *file;
    char *text;
    size_t size;
} Draft;

/// Elements that must be closed at the end of the body.
typedef enum Block { BLOCK_NONE, BLOCK_TABLE, BLOCK_PICTURES, BLOCK_MEASURES } Block;
static const char *const block_ends[] = {[BLOCK_NONE] = "",
                                         [BLOCK_TABLE] = "</table></div>\n",
                                         [BLOCK_PICTURES] = "</div>\n",
                                         [BLOCK_MEASURES] = "</table></div>\n"};

struct ReportPage {
    char *folder;
    ReportGradeFn *grade; ///< or NULL
    Draft text, index, csv, json;
    int measures, failed, missing;
    ReportTaken *taken; ///< [measures]
    SingeResult result; ///< the first failure
    SingeError error;
};

struct Report {
    const ReportPage *page;
    Draft body, csv, json, echo; ///< `echo` has no file if lines are printed at once
    Draft table;                 ///< rows of the last table
    Block block;
    char *name, *heading;
    int pictures, measures, failed, missing;
    ReportTaken *taken; ///< [measures]
    SingeResult result; ///< the first failure
    SingeError error;
};

static const char style[] =
    "body{font:15px/1.5 system-ui,sans-serif;color:#222;background:#fff;max-width:1180px;margin:2em auto;padding:0 1em}"
    "h1{font-size:1.7em;margin-bottom:.2em}h2{font-size:1.2em;margin:2.6em 0 .3em;border-top:1px solid #ddd;"
    "padding-top:1em}table{border-collapse:collapse;margin:.6em 0;font-variant-numeric:tabular-nums}"
    "td,th{padding:.15em .8em .15em 0;text-align:left;vertical-align:top;font-size:14px}th{color:#666;"
    "font-weight:600;border-bottom:1px solid #ccc}.shows{color:#555}.wide{overflow-x:auto}"
    ".pics{display:grid;gap:6px;margin:.8em 0}figure{margin:0}figure img{width:100%;display:block}"
    "figcaption{font-size:12.5px;color:#555}.good{color:#187a3c}.bad{color:#b3261e}.tag{font-size:.75em;"
    "font-weight:600;margin-left:.7em}code{font-size:12.5px;background:#f4f4f2;padding:.1em .3em}"
    "svg{max-width:100%;height:auto}";

static bool draft_open(Draft *draft) {
    draft->file = open_memstream(&draft->text, &draft->size);
    return draft->file != NULL;
}

static void draft_free(Draft *draft) {
    if (draft->file) fclose(draft->file);
    free(draft->text);
    *draft = (Draft){0};
}

ReportPage *report_page_open(const char *folder, const char *title, const char *lead, ReportGradeFn *grade,
                             SingeError *error) {
    if (folder_make(folder, error)) return NULL;

    ReportPage *page = calloc(1, sizeof *page);
    if (!page || !draft_open(&page->text) || !draft_open(&page->index) || !draft_open(&page->csv) ||
        !draft_open(&page->json)) {
        *error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1};
        if (page) draft_free(&page->text), draft_free(&page->index), draft_free(&page->csv);
        free(page);
        return NULL;
    }

    page->folder = text_format("%s", folder);
    page->grade = grade;
    fprintf(page->index.file,
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>%s</title>\n"
            "<meta name=\"viewport\" content=\"width=device-width\">\n<style>%s</style></head>\n<body>\n<h1>%s</h1>\n"
            "<p>%s</p>\n<div class=\"wide\"><table><tr><th>item</th><th>measures</th><th>verdict</th></tr>\n",
            title, style, title, lead);
    fprintf(page->csv.file, "item,measure,value,low,high,verdict,what,bad,bad_what%s\n", grade ? ",grade" : "");
    fprintf(page->json.file, "{\"title\": ");

    text_json_string(page->json.file, title);
    fprintf(page->json.file, ",\n \"measures\": [");

    return page;
}

const char *report_folder(const Report *report) { return report->page->folder; }

static FILE *echo_file(const Report *report) { return report->echo.file ? report->echo.file : stdout; }

static void report_free(Report *report) {
    Draft *drafts[] = {&report->body, &report->csv, &report->json, &report->table, &report->echo};
    for (int i = 0; i < 5; i++) draft_free(drafts[i]);
    free(report->taken);
    free(report->name), free(report->heading);
    free(report);
}

Report *report_begin(const ReportPage *page, const char *name, const char *heading, const char *shows, bool echo) {
    Report *report = calloc(1, sizeof *report);
    if (!report) return NULL;
    if (!draft_open(&report->body) || !draft_open(&report->csv) || !draft_open(&report->json) ||
        !draft_open(&report->table) || (!echo && !draft_open(&report->echo))) {
        report_free(report);
        return NULL;
    }

    report->page = page;
    report->name = text_format("%s", name);
    report->heading = text_format("%s", heading);
    fprintf(echo_file(report), "\n%s: %s\n", name, heading);
    fprintf(report->body.file, "<p class=\"shows\"><b>The source:</b> %s</p>\n", shows);
    return report;
}

/// Continues blocks of one kind, or ends them.
static FILE *body(Report *report, Block block) {
    if (report->block != block) fputs(block_ends[report->block], report->body.file);
    report->block = block;
    return report->body.file;
}

void report_text(Report *report, const char *format, ...) {
    FILE *file = body(report, BLOCK_NONE);
    va_list list;
    va_start(list, format);
    fputs("<p>", file);
    vfprintf(file, format, list);
    fputs("</p>\n", file);
    va_end(list);
}

/// The same row for printing, in columns.
static void echo(FILE *file, const char *text) {
    fprintf(file, " ");
    while (*text) {
        int length = (int)strcspn(text, "|");
        fprintf(file, " %*.*s", length > 11 ? length : 11, length, text);
        text += length + (text[length] == '|');
    }

    fprintf(file, "\n");
    fflush(file);
}

static void row(Report *report, const char *text, const char *tag) {
    FILE *file = body(report, BLOCK_TABLE), *table = report->table.file;
    echo(echo_file(report), text);
    fputs("<tr>", file);

    for (;; text++) {
        int length = (int)strcspn(text, "|");
        fprintf(table, "\"%.*s\"%c", length, text, text[length] ? ',' : '\n');

        // a cell may have no number, or a range of none: "nan", "+nan", "nan to nan"
        const char *digits = text + (strspn(text, "+-") < (size_t)length ? strspn(text, "+-") : 0);
        if (length >= 3 && strncmp(digits, "nan", 3) == 0) fprintf(file, "<%s>-</%s>", tag, tag);
        else fprintf(file, "<%s>%.*s</%s>", tag, length, text, tag);
        text += length;
        if (!*text) break;
    }

    fputs("</tr>\n", file);
}

void report_heads(Report *report, const char *heads) {
    body(report, BLOCK_NONE);
    rewind(report->table.file);
    fputs("<div class=\"wide\"><table>\n", report->body.file);
    row(report, heads, "th");
}

void report_row(Report *report, const char *format, ...) {
    char text[2000];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    row(report, text, "td");
}

SingeResult report_table(Report *report, const char *name, SingeError *error) {
    char *path = text_format("%s/%s.csv", report_folder(report), name);
    const bool good = fflush(report->table.file) == 0;
    SingeResult result = good ? file_write(path, report->table.text, report->table.size, error) : SINGE_ERROR_MEMORY;
    if (!good) *error = (SingeError){.code = result, .element = -1};
    free(path);
    return result;
}

void report_pictures(Report *report, int columns) {
    body(report, BLOCK_NONE);
    fprintf(body(report, BLOCK_PICTURES), "<div class=\"pics\" style=\"grid-template-columns:repeat(%d,1fr)\">\n",
            columns);
}

void report_picture(Report *report, const char *caption, int width, int height, const uint8_t *rgb) {
    if (report->block != BLOCK_PICTURES) report_pictures(report, 4);
    char *name = text_format("%s-%02d.png", report->name, ++report->pictures);
    char *path = text_format("%s/%s", report_folder(report), name);
    SingeError error;
    SingeResult result = png_write(path, width, height, rgb, &error);
    if (result && !report->result) {
        report->result = result;
        report->error = error;
    }

    fprintf(report->body.file,
            "<figure><img src=\"%s\" alt=\"%s\" width=\"%d\" "
            "height=\"%d\"><figcaption>%s</figcaption></figure>\n",
            name, caption, width, height, caption);
    free(name), free(path);
}

void report_plot(Report *report, const Plot *plot) { plot_draw(plot, body(report, BLOCK_NONE)); }
FILE *report_drawing(Report *report) { return body(report, BLOCK_NONE); }

static void print_bar(FILE *file, double low, double high, const char *min, const char *max, const char *between) {
    if (isfinite(low) && isfinite(high)) fprintf(file, between, low, high);
    else if (isfinite(low)) fprintf(file, min, low);
    else fprintf(file, max, high);
}

static bool within(double value, double low, double high) { return value >= low && value <= high; }

/// What is printed of a verdict, written to the data, and its colour.
static const char *const verdict_words[][3] = {[REPORT_HOLDS] = {"holds", "holds", "good"},
                                               [REPORT_MISSES] = {"MISSES, as known", "misses", "bad"},
                                               [REPORT_FAILS] = {"FAILS", "fails", "bad"}};

void report_bar(Report *report, const char *name, const char *what, double value, double low, double high, double bad,
                const char *bad_what) {
    const bool graded = report->page->grade;
    const ReportGrade grade = graded ? report->page->grade(report->name, name) : (ReportGrade){0};
    const bool blind = bad_what && within(bad, low, high);
    const bool good = within(value, low, high) && !blind;
    const ReportVerdict verdict =
        good != grade.misses && (grade.word || !graded) ? (good ? REPORT_HOLDS : REPORT_MISSES) : REPORT_FAILS;
    const char *const *words = verdict_words[verdict];
    const char *said = blind                   ? "BAR TELLS NOTHING"
                       : graded && !grade.word ? "FAILS: it has no grade"
                       : good && grade.misses  ? "FAILS: it holds, and is graded as one that misses"
                                               : words[0];

    if (report->block != BLOCK_MEASURES)
        fprintf(body(report, BLOCK_MEASURES),
                "<div class=\"wide\"><table><tr><th>measure</th><th>is</th><th>bar</th><th></th><th>%s</th></tr>\n",
                graded ? "grade" : "a case that fails it");

    FILE *file = body(report, BLOCK_MEASURES);
    fprintf(file, "<tr><td>%s</td><td>%.4g</td><td>", what, value);
    print_bar(file, low, high, "&ge; %.4g", "&le; %.4g", "%.4g to %.4g");
    fprintf(file, "</td><td class=\"%s\">%s</td><td>%s", words[2], words[1], grade.word ? grade.word : "");
    if (bad_what) fprintf(file, "%.4g: %s", bad, bad_what);
    fprintf(file, "</td></tr>\n");

    FILE *echo = echo_file(report);
    fprintf(echo, "  %-26s %11.4g  ", name, value);
    print_bar(echo, low, high, "at least %.4g", "at most %.4g", "%.4g to %.4g");
    fprintf(echo, "  %s", said);
    if (grade.word) fprintf(echo, "; %s", grade.word);
    if (bad_what) fprintf(echo, "; not %.4g (%s)", bad, bad_what);
    fprintf(echo, "\n");
    fflush(echo);

    FILE *csv = report->csv.file;
    fprintf(csv, "%s,%s,%.9g,%.9g,%.9g,%s,\"%s\",", report->name, name, value, low, high, words[1], what);
    if (bad_what) fprintf(csv, "%.9g,\"%s\"", bad, bad_what);
    else fprintf(csv, ",");
    fprintf(csv, "%s%s\n", graded ? "," : "", grade.word ? grade.word : "");

    FILE *json = report->json.file;
    fprintf(json, "%s\n  {\"item\": \"%s\", \"measure\": \"%s\", \"value\": ", report->measures ? "," : "",
            report->name, name);
    text_json_number(json, value);
    fprintf(json, ", \"low\": ");

    text_json_number(json, low);
    fprintf(json, ", \"high\": ");
    text_json_number(json, high);
    fprintf(json, ", \"holds\": %s, \"what\": ", verdict == REPORT_HOLDS ? "true" : "false");
    text_json_string(json, what);

    if (bad_what) {
        fprintf(json, ", \"bad\": ");
        text_json_number(json, bad);
        fprintf(json, ", \"bad_what\": ");
        text_json_string(json, bad_what);
    }

    if (grade.word)
        fprintf(json, ", \"grade\": \"%s\", \"known_to_miss\": %s", grade.word, grade.misses ? "true" : "false");

    fputc('}', json);

    ReportTaken *larger = realloc(report->taken, ((size_t)report->measures + 1) * sizeof *larger);
    if (larger) {
        report->taken = larger;
        larger[report->measures] = (ReportTaken){text_format("%s", report->name), text_format("%s", name), value,
                                                 verdict, text_format("%s", bad_what ? bad_what : "")};
        report->measures++;
    } else {
        report->result = SINGE_ERROR_MEMORY;
    }

    report->failed += verdict == REPORT_FAILS;
    report->missing += verdict == REPORT_MISSES;
}

void report_measure(Report *report, const char *name, const char *what, double value, double low, double high) {
    report_bar(report, name, what, value, low, high, 0, NULL);
}

const ReportTaken *report_find(const Report *report, const char *item, const char *name) {
    for (int i = 0; i < report->page->measures; i++) {
        const ReportTaken *taken = &report->page->taken[i];
        if (strcmp(taken->item, item) == 0 && strcmp(taken->name, name) == 0) return taken;
    }

    return NULL;
}

/// Frees what a measure holds.
static void taken_free(const ReportTaken *taken) { free(taken->item), free(taken->name), free(taken->bad_what); }

void report_end(ReportPage *page, Report *report) {
    const char *const *words = verdict_words[report->failed    ? REPORT_FAILS
                                             : report->missing ? REPORT_MISSES
                                                               : REPORT_HOLDS];
    const char *class = words[2], *verdict = words[1];
    Draft *drafts[] = {&report->body, &report->csv, &report->json, &report->echo};
    bool good = true;

    body(report, BLOCK_NONE);
    for (int i = 0; i < 4; i++) {
        if (!drafts[i]->file) continue;
        good = text_stream_end(drafts[i]->file, &drafts[i]->text) && good;
        drafts[i]->file = NULL;
    }

    if (good) {
        if (report->echo.text) printf("%s", report->echo.text), fflush(stdout);
        fprintf(page->text.file, "<h2 id=\"%s\">%s<span class=\"tag %s\">%s</span></h2>\n%s", report->name,
                report->heading, class, verdict, report->body.text);
        fprintf(page->index.file, "<tr><td><a href=\"#%s\">%s</a></td><td>%d of %d</td><td class=\"%s\">%s</td></tr>\n",
                report->name, report->heading, report->measures - report->failed - report->missing, report->measures,
                class, verdict);
        fputs(report->csv.text, page->csv.file);
        fprintf(page->json.file, "%s%s", page->measures && report->measures ? "," : "", report->json.text);
    } else {
        page->result = SINGE_ERROR_MEMORY;
    }

    // moves a report's measures to the page's
    const size_t count = (size_t)page->measures + (size_t)report->measures;
    ReportTaken *larger = realloc(page->taken, (count + 1) * sizeof *larger);
    if (larger) page->taken = larger;
    else page->result = SINGE_ERROR_MEMORY;

    for (int i = 0; i < report->measures; i++) {
        if (larger) larger[page->measures++] = report->taken[i];
        else taken_free(&report->taken[i]);
    }

    page->failed += report->failed;
    page->missing += report->missing;
    if (report->result && !page->result) {
        page->result = report->result;
        page->error = report->error;
    }

    report_free(report);
}

static SingeResult write_draft(const ReportPage *page, const char *name, Draft *draft, const Draft *more,
                               SingeError *error) {
    char *path = text_format("%s/%s", page->folder, name);
    if (more) fwrite(more->text, 1, more->size, draft->file);
    const bool good = text_stream_end(draft->file, &draft->text);
    draft->file = NULL;
    SingeResult result = good ? file_write(path, draft->text, draft->size, error) : SINGE_ERROR_MEMORY;
    if (!good) *error = (SingeError){.code = result, .element = -1};
    free(path);
    return result;
}

SingeResult report_page_close(ReportPage *page, int *failed, int *missing, SingeError *error) {
    *failed = page->failed;
    *missing = page->missing;
    fprintf(page->text.file, "</body></html>\n");
    fflush(page->text.file);
    fprintf(page->index.file,
            "</table></div>\n<p>%d of %d measures hold. As data: <a href=\"measures.csv\">"
            "measures.csv</a>, <a href=\"measures.json\">measures.json</a>.</p>\n",
            page->measures - page->failed - page->missing, page->measures);
    fprintf(page->json.file, "\n ],\n \"failed\": %d, \"missing\": %d}\n", page->failed, page->missing);

    SingeResult result = page->result;
    if (result) {
        *error = page->error;
        error->code = result;
    }

    if (!result) result = write_draft(page, "index.html", &page->index, &page->text, error);
    if (!result) result = write_draft(page, "measures.csv", &page->csv, NULL, error);
    if (!result) result = write_draft(page, "measures.json", &page->json, NULL, error);
    draft_free(&page->text), draft_free(&page->index), draft_free(&page->csv), draft_free(&page->json);
    for (int i = 0; i < page->measures; i++) taken_free(&page->taken[i]);
    free(page->taken);
    free(page->folder);
    free(page);
    return result;
}
