// The C library's snprintf and vsnprintf for singe.wasm, in a tenth of its bytes. They know what the library's messages
// need: %c, %s, %d, %u, %x, %g, %%, the lengths l, ll and z, widths that begin with 0, and precisions in digits. %g may take
// the other neighbour of a number half-way between two.
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum {
    DIGITS = 24, // of an integer
    FLOAT_DIGITS = 6,
    FLOAT_DIGITS_MAX = 15, // an uint64_t holds them
};

typedef struct Out {
    char *text;
    size_t size, length; // length as if the text had room
} Out;

static void put(Out *out, char c) {
    if (out->length + 1 < out->size) out->text[out->length] = c;
    out->length++;
}

static void put_integer(Out *out, uint64_t value, unsigned base, int width) {
    char digits[DIGITS];
    int count = 0;
    do digits[count++] = "0123456789abcdef"[value % base];
    while (value /= base);
    for (; width > count; width--) put(out, '0');
    while (count) put(out, digits[--count]);
}

/// As %g: `most` digits without zeros at their end, and an exponent where it would take more zeros than that.
static void put_float(Out *out, double value, int most) {
    if (signbit(value)) put(out, '-');
    value = fabs(value);
    if (!isfinite(value)) {
        for (const char *c = isnan(value) ? "nan" : "inf"; *c; c++) put(out, *c);
        return;
    }

    int exponent = 0;
    for (; value >= 10; value /= 10) exponent++;
    for (; value && value < 1; value *= 10) exponent--;
    for (int i = 1; i < most; i++) value *= 10;
    uint64_t digits = (uint64_t)rint(value), unit = 1; // unit: of the first digit
    for (int i = 1; i < most; i++) unit *= 10;
    if (digits >= 10 * unit) {
        digits /= 10;
        exponent++;
    }

    const bool scientific = exponent < -4 || exponent >= most;
    int point = scientific ? 0 : exponent; // place of the digit before the point
    for (int place = point < 0 ? 0 : point; place >= 0 || digits; place--) {
        if (place == -1) put(out, '.');
        const bool begun = place <= point;
        put(out, begun ? (char)('0' + digits / unit) : '0');
        if (begun) digits = digits % unit * 10;
    }
    if (!scientific) return;
    put(out, 'e');
    put(out, exponent < 0 ? '-' : '+');
    put_integer(out, (uint64_t)(exponent < 0 ? -exponent : exponent), 10, 2);
}

int vsnprintf(char *text, size_t size, const char *format, va_list arguments) {
    Out out = {.text = text, .size = size};
    for (; *format; format++) {
        if (*format != '%') {
            put(&out, *format);
            continue;
        }
        int width = 0, precision = -1, longs = 0;
        for (format++; *format >= '0' && *format <= '9'; format++) width = 10 * width + *format - '0';
        if (*format == '.')
            for (precision = 0, format++; *format >= '0' && *format <= '9'; format++)
                precision = 10 * precision + *format - '0';
        for (; *format == 'l' || *format == 'z'; format++) longs++;

        int64_t whole;
        switch (*format) {
        case 's':
            for (const char *c = va_arg(arguments, const char *); *c && precision; c++, precision--) put(&out, *c);
            break;
        case 'c': put(&out, (char)va_arg(arguments, int)); break;
        case 'd':
            whole = longs == 2 ? va_arg(arguments, int64_t) : va_arg(arguments, int);
            if (whole < 0) put(&out, '-');
            put_integer(&out, whole < 0 ? -(uint64_t)whole : (uint64_t)whole, 10, width);
            break;
        case 'u':
        case 'x':
            put_integer(&out, longs == 2 ? va_arg(arguments, uint64_t) : va_arg(arguments, unsigned),
                        *format == 'x' ? 16 : 10, width);
            break;
        case 'g':
            if (precision < 0) precision = FLOAT_DIGITS;
            if (precision < 1) precision = 1;
            put_float(&out, va_arg(arguments, double), precision < FLOAT_DIGITS_MAX ? precision : FLOAT_DIGITS_MAX);
            break;
        default: put(&out, *format); break; // %%
        }
    }
    if (size) text[out.length < size ? out.length : size - 1] = 0;
    return (int)out.length;
}

int snprintf(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return length;
}
