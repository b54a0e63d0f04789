// printf with a decimal point in every locale: the C library's follows the host's locale.
#pragma once

#include <stdarg.h>
#include <stddef.h>

/// As vsnprintf, without its result: at most `size` bytes with the closing zero, size > 0. Knows %d, %u, %x with the
/// lengths l, ll and z, %s, %e, %f, %g and %%, with flags, widths and precisions in digits. The text ends at any other
/// conversion.
void text_print(char *out, size_t size, const char *format, va_list arguments);
