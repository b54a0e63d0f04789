#include "common/error.h"
#include "common/format.h"

#include <stdarg.h>
#include <stdio.h>

SingeResult error_set(SingeError *error, SingeResult code, const char *stage, int64_t element, const char *format,
                      ...) {
    if (!error) return code;
    error->code = code;
    error->element = element;
    snprintf(error->stage, sizeof error->stage, "%s", stage);

    va_list arguments;
    va_start(arguments, format);
    text_print(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    return code;
}

const char *singe_result_name(SingeResult result) {
    switch (result) {
    case SINGE_OK: return "success";
    case SINGE_ERROR_ARGUMENT: return "bad argument";
    case SINGE_ERROR_MEMORY: return "out of memory";
    case SINGE_ERROR_MESH: return "bad mesh";
    case SINGE_ERROR_HANDLE: return "stale handle";
    case SINGE_ERROR_STATE: return "not allowed now";
    case SINGE_ERROR_DIVERGED: return "diverged";
    case SINGE_ERROR_FORMAT: return "bad format";
    case SINGE_ERROR_VERSION: return "other version";
    case SINGE_ERROR_FILE: return "file error";
    case SINGE_ERROR_LIMIT: return "too large";
    case SINGE_ERROR_CANCELLED: return "cancelled";
    }

    return "unknown result";
}

const char *singe_version(void) { return SINGE_VERSION; }
