// Decimal numbers in text, independent of the locale.
#pragma once

#include <stdint.h>

typedef enum NumberStatus {
    NUMBER_OK = 0,
    NUMBER_JUNK,       ///< not a number
    NUMBER_NOT_FINITE, ///< "nan", "inf" or "infinity"
    NUMBER_RANGE,      ///< larger than the type holds
} NumberStatus;

/// Reads [+-] digits [. digits] [e [+-] digits] from *at and moves *at past it. The result is the nearest float (ties
/// to even); numbers that are too small become 0. On failure *at is unchanged.
NumberStatus number_float(const uint8_t **at, const uint8_t *end, float *value);
NumberStatus number_double(const uint8_t **at, const uint8_t *end, double *value);

/// Reads [+-] digits.
NumberStatus number_integer(const uint8_t **at, const uint8_t *end, int64_t *value);

/// Writes a finite double so that number_double reads it back exactly. Returns the length.
int number_print(double value, char text[40]);
