// Words and numbers of a text file, for the readers of OFF and STL.
#ifndef FORMATS_SCAN_H
#define FORMATS_SCAN_H

#include "formats/formats.h"
#include "formats/lines.h"

/// A position in a text file, with what is needed to complain about it.
typedef struct Scan {
    const char *name, *stage;
    const uint8_t *begin; ///< of the file
    Text text;
    SingeAllocator allocator;
    SingeError *error;
} Scan;

/// Fails at the cursor's line.
SingeResult scan_refuse(const Scan *scan, SingeResult code, const char *format, ...) SINGE_PRINTF(3, 4);

/// Past blanks, line ends and, where `comment` is not 0, what follows it on a line. False at the end of the file.
bool scan_to_word(Scan *scan, char comment);

/// Reads a finite number, or an integer of at least 0, that stands on this line.
SINGE_NODISCARD SingeResult scan_float(Scan *scan, float *value);
SINGE_NODISCARD SingeResult scan_count(Scan *scan, int64_t *value);

#endif
