// Errors: filled in once, where most is known, and passed up unchanged.
#pragma once

#include "singe/base.h"

/// Fills *error (may be NULL) and returns `code`. The format is text_print's (common/format.h).
SingeResult error_set(SingeError *error, SingeResult code, const char *stage, int64_t element, const char *format, ...)
    SINGE_PRINTF(5, 6);

/// Returns from the calling function when `call` fails.
#define TRY(call)                            \
    do {                                     \
        SingeResult try_result_ = (call);    \
        if (try_result_) return try_result_; \
    } while (0)
