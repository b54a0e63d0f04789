// A decimal number is M 10^e with an integer M. The fast path of floats computes M 10^e in double precision (M of up to 19
// digits, |e| <= 22, relative error below 2^-51) and uses it if that error cannot change the rounding to a float.
#include "formats/number.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the text

enum { FAST_DIGITS = 19, EXACT_DIGITS = 800, EXPONENT_LIMIT = 100000000 };

typedef struct Decimal {
    bool negative;
    uint64_t leading;      // the first FAST_DIGITS significant digits
    int leading_exponent;  // power of ten of their last digit
    const uint8_t *digits; // first significant digit, in the text
    const uint8_t *digits_end;
    int digit_count; // significant digits, EXPONENT_LIMIT at most
    int exponent;    // power of ten of the last of them
} Decimal;

static inline bool is_digit(uint8_t c) { return (uint8_t)(c - '0') < 10; }

static NumberStatus decimal_read(const uint8_t **at, const uint8_t *end, Decimal *number) {
    const uint8_t *p = *at;
    number->negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;

    // the digits before and after the point
    const uint8_t *start = p;
    bool point = false, any = false;
    int64_t behind = 0, count = 0, kept = 0;
    uint64_t leading = 0;
    number->digits = NULL;

    for (; p < end; p++) {
        uint8_t digit = (uint8_t)(*p - '0');
        if (digit > 9) {
            if (*p != '.' || point) break;
            point = true;
            continue;
        }

        any = true;
        behind += point;
        if (digit == 0 && !number->digits) continue;

        if (!number->digits) number->digits = p;
        count++;
        if (kept < FAST_DIGITS) {
            leading = 10 * leading + digit;
            kept++;
        }
    }

    if (!any) {
        static const char *const words[] = {"nan", "inf"};
        for (int w = 0; w < 2; w++) {
            int i = 0;
            while (i < 3 && start + i < end && (start[i] | 32) == words[w][i]) i++;
            if (i == 3) return NUMBER_NOT_FINITE;
        }

        return NUMBER_JUNK;
    }

    if (behind > EXPONENT_LIMIT) behind = EXPONENT_LIMIT;
    if (count > EXPONENT_LIMIT) count = EXPONENT_LIMIT;
    number->digits_end = p;
    number->leading = leading;
    number->digit_count = (int)count;
    number->exponent = -(int)behind;
    number->leading_exponent = number->exponent + (int)(count - kept);

    if (p < end && (*p | 32) == 'e') {
        bool negative = ++p < end && *p == '-';
        if (p < end && (*p == '-' || *p == '+')) p++;
        if (p == end || !is_digit(*p)) return NUMBER_JUNK;

        int exponent = 0;
        for (; p < end && is_digit(*p); p++)
            if (exponent < EXPONENT_LIMIT) exponent = 10 * exponent + (*p - '0');
        if (exponent > EXPONENT_LIMIT) exponent = EXPONENT_LIMIT;
        number->exponent += negative ? -exponent : exponent;
        number->leading_exponent += negative ? -exponent : exponent;
    }

    *at = p;
    return NUMBER_OK;
}

/// The magnitude of the number, exactly rounded to a float or to a double. libc reads its digits without their point, so
/// that no locale matters.
static double decimal_round(const Decimal *number, bool single) {
    char text[EXACT_DIGITS + 24];
    int count = 0;
    if (!number->digits) return 0;
    for (const uint8_t *p = number->digits; p < number->digits_end && count < EXACT_DIGITS; p++)
        if (*p != '.') text[count++] = (char)*p;

    // digits beyond 800 can only break a tie
    int exponent = number->exponent + (number->digit_count - count);
    if (number->digit_count > count) {
        text[count++] = '1';
        exponent--;
    }

    snprintf(text + count, sizeof text - (size_t)count, "e%d", exponent);
    return single ? (double)strtof(text, NULL) : strtod(text, NULL);
}

NumberStatus number_float(const uint8_t **at, const uint8_t *end, float *value) {
    Decimal number;
    const uint8_t *p = *at;
    NumberStatus status = decimal_read(&p, end, &number);

    if (status) return status;

    // a quotient or product of two exact doubles, unless it is close to a tie of floats
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const int e = number.leading_exponent;
    float result = 0;
    bool fast = number.leading == 0;

    if (!fast && e >= -22 && e <= 22) {
        double d = e < 0 ? (double)number.leading / power[-e] : (double)number.leading * power[e];
        uint64_t image;
        memcpy(&image, &d, sizeof image);

        int32_t from_tie = (int32_t)(image & 0x1fffffff) - 0x10000000;
        fast = !(d < 1.2e-38 || d > 3.4e38 || (from_tie > -16 && from_tie < 16));
        if (fast) result = (float)d;
    }

    if (!fast) {
        result = (float)decimal_round(&number, true);
        if (isinf(result)) return NUMBER_RANGE;
    }

    *value = number.negative ? -result : result;
    *at = p;
    return NUMBER_OK;
}

NumberStatus number_double(const uint8_t **at, const uint8_t *end, double *value) {
    Decimal number;
    const uint8_t *p = *at;
    NumberStatus status = decimal_read(&p, end, &number);

    if (status) return status;
    double result = decimal_round(&number, false);
    if (isinf(result)) return NUMBER_RANGE;
    *value = number.negative ? -result : result;
    *at = p;
    return NUMBER_OK;
}

NumberStatus number_integer(const uint8_t **at, const uint8_t *end, int64_t *value) {
    const uint8_t *p = *at;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;
    if (p == end || !is_digit(*p)) return NUMBER_JUNK;

    int64_t magnitude = 0;
    for (; p < end && is_digit(*p); p++) {
        if (magnitude > (INT64_MAX - 9) / 10) return NUMBER_RANGE;
        magnitude = 10 * magnitude + (*p - '0');
    }

    *value = negative ? -magnitude : magnitude;
    *at = p;
    return NUMBER_OK;
}

int number_print(double value, char text[40]) {
    char local[64];
    int length = snprintf(local, sizeof local, "%.17g", value), n = 0;
    bool in_point = false;

    // printf's decimal point depends on the locale and may be several bytes long
    for (int i = 0; i < length && n < 39; i++) {
        char c = local[i];
        bool plain = is_digit((uint8_t)c) || c == '-' || c == '+' || c == 'e';
        if (plain) text[n++] = c;
        else if (!in_point) text[n++] = '.';
        in_point = !plain;
    }

    text[n] = 0;
    return n;
}
