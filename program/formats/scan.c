#include "formats/scan.h"

#include "formats/number.h"
#include "common/store.h"

#include <stdarg.h>
#include <stdio.h>

SingeResult scan_refuse(const Scan *scan, SingeResult code, const char *format, ...) {
    char what[320];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return refuse(scan->error, code, scan->stage, scan->text.line, "%s:%lld: %s", short_name(scan->name),
                  (long long)scan->text.line, what);
}

bool scan_to_word(Scan *scan, char comment) {
    Text *text = &scan->text;
    for (text_skip_blanks(text); text->at < text->end; text_skip_blanks(text)) {
        if (!text_is_end(*text->at) && (!comment || *text->at != comment)) return true;
        text_next_line(text);
    }
    return false;
}

/// The word at the cursor is reported only by its position: whoever sees the message may not be allowed to read the
/// file.
static SingeResult refuse_word(const Scan *scan, const uint8_t *end, NumberStatus status, const char *what) {
    if (scan->text.at == end) return scan_refuse(scan, SINGE_ERROR_FORMAT, "the line has too few values");
    return scan_refuse(scan, SINGE_ERROR_FORMAT, "the value in column %lld is %s",
                       (long long)text_column(&scan->text, scan->begin),
                       status == NUMBER_NOT_FINITE ? "not a finite number"
                       : status == NUMBER_RANGE    ? "out of range"
                                                   : what);
}

SingeResult scan_float(Scan *scan, float *value) {
    text_skip_blanks(&scan->text);
    const uint8_t *at = scan->text.at, *end = text_word_end(&scan->text);
    NumberStatus status = number_float(&at, end, value);
    if (status || at != end) return refuse_word(scan, end, status, "not a number");
    scan->text.at = at;
    return SINGE_OK;
}

SingeResult scan_count(Scan *scan, int64_t *value) {
    text_skip_blanks(&scan->text);
    const uint8_t *at = scan->text.at, *end = text_word_end(&scan->text);
    NumberStatus status = number_integer(&at, end, value);
    if (status || at != end || *value < 0) return refuse_word(scan, end, status, "not an integer of at least 0");
    scan->text.at = at;
    return SINGE_OK;
}
