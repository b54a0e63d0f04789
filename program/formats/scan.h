// Words and numbers of a text file, for the readers of OFF and STL.
#ifndef FORMATS_SCAN_H
#define FORMATS_SCAN_H

#include "formats/formats.h"
#include "formats/lines.h"

/// A position in a text file, with the context of error messages.
typedef struct Scan {
    const char *name, *stage;
    const uint8_t *begin; ///< of the file
    Text text;
    SingeAllocator allocator;
    SingeError *error;
} Scan;

/// Fails at the cursor's line.
SingeResult scan_refuse(const Scan *scan, SingeResult code, const char *format, ...) SINGE_PRINTF(3, 4);

/// Moves past blanks, line ends and, if `comment` is not 0, comments that begin with it. False at the end of the file.
bool scan_to_word(Scan *scan, char comment);

/// Reads a finite number, or an integer of at least 0, from this line.
SINGE_NODISCARD SingeResult scan_float(Scan *scan, float *value);
SINGE_NODISCARD SingeResult scan_count(Scan *scan, int64_t *value);

#endif
