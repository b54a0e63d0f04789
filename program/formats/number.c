// A decimal number is M 10^e with an integer M. The nearest binary number with p bits is
//
//     q 2^k,  q = round(M 10^e / 2^k),  2^(p-1) <= q < 2^p,
//
// with k at least the exponent of the smallest subnormal. The slow path finds q by exact long division of big integers.
// The fast path computes M 10^e in double precision (M of up to 19 digits, |e| <= 22, relative error below 2^-51) and
// uses it if that error cannot change the rounding to a float.
#include "formats/number.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
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

// ---- big integers, little end first, of up to 4096 + 64 bits: 10^1130 is the largest needed

enum { BIG_WORDS = 136 };

typedef struct Big {
    int count; // words in use; the highest is not zero
    uint32_t words[BIG_WORDS];
} Big;

static void big_multiply_add(Big *a, uint32_t factor, uint32_t summand) {
    uint64_t carry = summand;
    for (int i = 0; i < a->count; i++) {
        carry += (uint64_t)a->words[i] * factor;
        a->words[i] = (uint32_t)carry;
        carry >>= 32;
    }

    if (carry && a->count < BIG_WORDS) a->words[a->count++] = (uint32_t)carry;
}

static void big_times_power_of_ten(Big *a, int power) {
    for (; power >= 9; power -= 9) big_multiply_add(a, 1000000000u, 0);
    for (; power > 0; power--) big_multiply_add(a, 10, 0);
}

static void big_shift_left(Big *a, int bits) {
    int words = bits / 32;
    if (a->count == 0 || a->count + words + 1 > BIG_WORDS) return; // the second never happens: see above
    memmove(a->words + words, a->words, (size_t)a->count * sizeof *a->words);
    memset(a->words, 0, (size_t)words * sizeof *a->words);
    a->count += words;
    if (bits % 32) big_multiply_add(a, (uint32_t)1 << bits % 32, 0);
}

static int big_bits(const Big *a) {
    int bits = 32 * a->count;
    if (a->count)
        for (uint32_t top = a->words[a->count - 1]; !(top & 0x80000000u); top <<= 1) bits--;
    return bits;
}

static bool big_less(const Big *a, const Big *b) {
    if (a->count != b->count) return a->count < b->count;
    for (int i = a->count - 1; i >= 0; i--)
        if (a->words[i] != b->words[i]) return a->words[i] < b->words[i];
    return false;
}

// ---- rounding

// The magnitude of the number, exactly rounded to `bits` bits.
static double decimal_round(const Decimal *number, int bits, int lowest) {
    int count = number->digit_count < EXACT_DIGITS ? number->digit_count : EXACT_DIGITS;
    int exponent = number->exponent + (number->digit_count - count);
    if (number->digit_count == 0 || exponent + count < -330) return 0;
    if (exponent + count > 310) return INFINITY;

    Big over = {0}, under = {.count = 1, .words = {1}};
    int taken = 0;

    for (const uint8_t *p = number->digits; p < number->digits_end && taken < count; p++)
        if (*p != '.') {
            uint32_t digit = (uint32_t)(*p - '0');
            if (over.count) big_multiply_add(&over, 10, digit);
            else {
                over.count = 1;
                over.words[0] = digit;
            }

            taken++;
        }

    // digits beyond 800 can only break a tie
    if (number->digit_count > count) big_multiply_add(&over, 10, 1), exponent--;
    if (exponent >= 0) big_times_power_of_ten(&over, exponent);
    else big_times_power_of_ten(&under, -exponent);

    // over 2^shift / under lies in (2^bits, 2^(bits + 2))
    int shift = bits + 1 - (big_bits(&over) - big_bits(&under));
    if (shift > 0) big_shift_left(&over, shift);
    else big_shift_left(&under, -shift);
    big_shift_left(&under, bits + 1);

    uint64_t quotient = 0;
    for (int i = 0; i < bits + 2; i++) {
        quotient <<= 1;
        if (!big_less(&over, &under)) {
            int64_t borrow = 0;
            for (int k = 0; k < over.count; k++) {
                borrow += (int64_t)over.words[k] - (k < under.count ? under.words[k] : 0);
                over.words[k] = (uint32_t)borrow;
                borrow >>= 32;
            }
            while (over.count && over.words[over.count - 1] == 0) over.count--;
            quotient |= 1;
        }

        big_shift_left(&over, 1);
    }

    // rounds quotient 2^-shift (a little more if `rest`) to `bits` bits, ties to even; the last bit is worth at least 2^lowest
    int have = 0;
    for (uint64_t q = quotient; q; q >>= 1) have++;
    int drop = have - bits;
    if (drop - shift < lowest) drop = lowest + shift;
    if (drop > 62) return 0;

    uint64_t low = quotient & (((uint64_t)1 << drop) - 1), halfway = (uint64_t)1 << (drop - 1);
    uint64_t kept = quotient >> drop;
    if (low > halfway || (low == halfway && ((over.count > 0) || (kept & 1)))) kept++;
    return ldexp((double)kept, drop - shift);
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
        double exact = decimal_round(&number, 24, -149);
        if (exact > 3.4028234663852886e38) return NUMBER_RANGE;
        result = (float)exact;
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
    double result = decimal_round(&number, 53, -1074);
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
