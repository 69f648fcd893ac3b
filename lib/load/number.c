/*
 * number.c - decimal text to numbers.
 *
 * Digits times 10^e is brought into one long integer, exactly: multiplied by 10^e, or, for e < 0, shifted up until enough
 * bits remain and divided by 10^-e with the remainder remembered. The nearest binary number is then read off its top bits.
 * This is the plain exact method that faster ones fall back on (Clinger, "How to Read Floating Point Numbers Accurately",
 * 1990). Ahead of it stands his shortcut for the short numbers that nearly all are, where one exactly rounded operation
 * gives the result.
 */
#include "number.h"

#include <float.h>
#include <string.h>

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* ---- the exact way ---- */

/*
 * Limits of aset_real as powers of two and ten: it holds MANTISSA_BITS, and values from 2^(SMALLEST - 1) up to just below
 * 2^LARGEST in full. A number of 10^(LARGEST_DECIMAL + 1) or more is too large; one below 10^ZERO_DECIMAL is less than half
 * the least denormal (1.4e-45, 4.9e-324), so 0.
 */
#if ASET_REAL_BITS == 32
#define MANTISSA_BITS FLT_MANT_DIG
#define SMALLEST FLT_MIN_EXP
#define LARGEST FLT_MAX_EXP
#define LARGEST_DECIMAL FLT_MAX_10_EXP
#define ZERO_DECIMAL (-46)
#else
#define MANTISSA_BITS DBL_MANT_DIG
#define SMALLEST DBL_MIN_EXP
#define LARGEST DBL_MAX_EXP
#define LARGEST_DECIMAL DBL_MAX_10_EXP
#define ZERO_DECIMAL (-324)
#endif

/*
 * Limbs that suffice. For e < 0 the integer is shifted to MANTISSA_BITS + 4 bits more than 10^-e has, and -e is at most the
 * digits of a token - ZERO_DECIMAL; for e >= 0 it stays below 10^(LARGEST_DECIMAL + 1), which is less. 10 / 3 > log2(10).
 * 3 limbs on top: the ends not filled, and the one that a shift may leave empty.
 */
#define LIMBS (((ASET_READER_TOKEN + (uint32_t)-ZERO_DECIMAL) * 10u / 3u + MANTISSA_BITS + 4u) / 32u + 3u)

/* limb[0] is the lowest; limb[n - 1] is not 0, and n is 0 for zero. */
typedef struct natural {
    uint32_t limb[LIMBS];
    uint32_t n;
} natural;

typedef struct decimal {
    natural digits;
    int32_t exponent; /* the value is digits * 10^exponent */
    int32_t n_digits; /* without leading zeros */
    bool negative;
} decimal;

static const uint32_t ten_to[10] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000, 1000000000};

static void multiply_add(natural *a, uint32_t factor, uint32_t add) {
    uint64_t carry = add;
    for (uint32_t i = 0; i < a->n; i++) {
        carry += (uint64_t)a->limb[i] * factor;
        a->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0) {
        a->limb[a->n++] = (uint32_t)carry;
    }
}

static void trim(natural *a) {
    while (a->n > 0 && a->limb[a->n - 1] == 0) {
        a->n--;
    }
}

/* Gives the remainder. Floors of successive quotients are the floor of the whole quotient, so steps lose nothing. */
static uint32_t divide(natural *a, uint32_t divisor) {
    uint64_t rest = 0;
    for (uint32_t i = a->n; i-- > 0;) {
        rest = rest << 32 | a->limb[i];
        a->limb[i] = (uint32_t)(rest / divisor);
        rest %= divisor;
    }
    trim(a);
    return (uint32_t)rest;
}

static uint32_t limb_at(const natural *a, uint32_t i) {
    return i < a->n ? a->limb[i] : 0;
}

/* From the top down, in place: limb i only needs those at and below i - words. */
static void shift_left(natural *a, uint32_t bits) {
    const uint32_t words = bits / 32, rest = bits % 32;
    for (uint32_t i = a->n + words + 1; i-- > 0;) {
        const uint64_t high = i >= words ? limb_at(a, i - words) : 0;
        const uint64_t low = i >= words + 1 ? limb_at(a, i - words - 1) : 0;
        a->limb[i] = (uint32_t)((high << 32 | low) << rest >> 32);
    }
    a->n += words + 1;
    trim(a);
}

static int32_t bit_length(const natural *a) {
    int32_t bits = (int32_t)a->n * 32;
    for (uint32_t top = limb_at(a, a->n - 1); a->n > 0 && top < 0x80000000u; top <<= 1) {
        bits--;
    }
    return bits;
}

/* Bits from number first up, as many as 64. */
static uint64_t bits_from(const natural *a, uint32_t first) {
    const uint32_t word = first / 32, rest = first % 32;
    const uint64_t low = (uint64_t)limb_at(a, word + 1) << 32 | limb_at(a, word);
    return rest == 0 ? low : low >> rest | (uint64_t)limb_at(a, word + 2) << (64 - rest);
}

/* Any bit set below number end. */
static bool any_below(const natural *a, uint32_t end) {
    for (uint32_t i = 0; i < end / 32; i++) {
        if (limb_at(a, i) != 0) {
            return true;
        }
    }
    return (limb_at(a, end / 32) & ((1u << end % 32) - 1u)) != 0;
}

/* mantissa * 2^exponent, which must be an aset_real, so that no step rounds. */
static aset_real exact_real(uint64_t mantissa, int32_t exponent) {
    const aset_real step = (aset_real)1073741824, two = 2;
    aset_real value = (aset_real)mantissa;
    for (; exponent >= 30; exponent -= 30) {
        value *= step;
    }
    for (; exponent > 0; exponent--) {
        value *= two;
    }
    for (; exponent <= -30; exponent += 30) {
        value /= step;
    }
    for (; exponent < 0; exponent++) {
        value /= two;
    }
    return value;
}

/* The aset_real nearest to (a + f) * 2^-shift; inexact: 0 < f < 1, else f = 0. False if that is too large. */
static bool nearest_real(const natural *a, int32_t shift, bool inexact, aset_real *value) {
    const int32_t length = bit_length(a), exponent = length - shift; /* 2^(exponent - 1) <= it < 2^exponent */
    const int32_t kept = exponent >= SMALLEST ? MANTISSA_BITS : MANTISSA_BITS - (SMALLEST - exponent);
    const int32_t dropped = length - kept;
    if (kept < 0) { /* less than half the least denormal */
        *value = 0;
        return true;
    }
    uint64_t mantissa = bits_from(a, dropped > 0 ? (uint32_t)dropped : 0);
    if (dropped > 0) {
        const bool half = (bits_from(a, (uint32_t)dropped - 1) & 1) != 0;
        const bool more = inexact || any_below(a, (uint32_t)dropped - 1);
        mantissa += half && (more || (mantissa & 1) != 0) ? 1u : 0u;
    }
    const bool carried = mantissa >> MANTISSA_BITS != 0;
    if (exponent + (carried ? 1 : 0) > LARGEST) {
        return false;
    }
    *value = exact_real(mantissa, (dropped > 0 ? dropped : 0) - shift);
    return true;
}

/* The value of d, which is between the decimal limits and not 0. */
static bool scale(decimal *d, aset_real *value) {
    int32_t left = d->exponent < 0 ? -d->exponent : d->exponent, shift = 0;
    bool inexact = false;
    if (d->exponent < 0) {
        /* 10^left < 2^(bits + 1); the factor is log2(10), a little up. The quotient gets MANTISSA_BITS + 2 bits or more. */
        const int32_t bits = left * 33220 / 10000;
        shift = MANTISSA_BITS + 3 + bits - bit_length(&d->digits);
        shift = shift < 0 ? 0 : shift;
        shift_left(&d->digits, (uint32_t)shift);
    }
    while (left > 0) {
        const int32_t step = left < 9 ? left : 9;
        if (d->exponent >= 0) {
            multiply_add(&d->digits, ten_to[step], 0);
        } else if (divide(&d->digits, ten_to[step]) != 0) {
            inexact = true;
        }
        left -= step;
    }
    return nearest_real(&d->digits, shift, inexact, value);
}

/* Takes the digits from text[at] on; the place behind them. */
static size_t take_digits(decimal *d, const char *text, size_t length, size_t at, bool fraction) {
    for (; at < length && is_digit(text[at]); at++) {
        multiply_add(&d->digits, 10, (uint32_t)(text[at] - '0'));
        d->n_digits += d->digits.n > 0 ? 1 : 0;
        d->exponent -= fraction ? 1 : 0;
    }
    return at;
}

/* Takes an exponent with its letter from text[at] on, if there is one; the place behind it, or 0 if it has no digits. */
static size_t take_exponent(decimal *d, const char *text, size_t length, size_t at) {
    const int32_t enough = 100000; /* beyond all limits, whatever the digits */
    if (at == length || (text[at] != 'e' && text[at] != 'E')) {
        return at;
    }
    at++;
    const bool negative = at < length && text[at] == '-';
    at += at < length && (text[at] == '-' || text[at] == '+') ? 1 : 0;
    int32_t exponent = 0;
    const size_t first = at;
    for (; at < length && is_digit(text[at]); at++) {
        exponent = exponent >= enough ? enough : exponent * 10 + (text[at] - '0');
    }
    d->exponent += negative ? -exponent : exponent;
    return at == first ? 0 : at;
}

/* "nan..." or "inf...", in any case, and "1.#...", which other programs print for numbers that failed. */
static bool is_not_finite(const char *text, size_t length) {
    static const char names[2][3] = {{'n', 'a', 'n'}, {'i', 'n', 'f'}};
    for (size_t k = 0; k < 2 && length >= 3; k++) {
        size_t i = 0;
        while (i < 3 && (text[i] == names[k][i] || text[i] == names[k][i] - 'a' + 'A')) {
            i++;
        }
        if (i == 3) {
            return true;
        }
    }
    return length > 3 && memcmp(text, "1.#", 3) == 0;
}

static const char not_a_number[] = "not a decimal number", not_finite[] = "not a finite number",
                  too_large[] = "a number too large";

static const char *exact_number(const char *text, size_t length, aset_real *value) {
    if (length >= ASET_READER_TOKEN) {
        return not_a_number;
    }
    decimal d; /* the limbs are written before they are read */
    d.digits.n = 0;
    d.exponent = d.n_digits = 0;
    size_t at = length > 0 && (text[0] == '-' || text[0] == '+') ? 1 : 0;
    d.negative = at == 1 && text[0] == '-';
    if (is_not_finite(text + at, length - at)) {
        return not_finite;
    }
    const size_t first = at;
    at = take_digits(&d, text, length, at, false);
    size_t n_digits = at - first;
    if (at < length && text[at] == '.') {
        const size_t behind = at + 1;
        at = take_digits(&d, text, length, behind, true);
        n_digits += at - behind;
    }
    at = take_exponent(&d, text, length, at);
    if (n_digits == 0 || at != length) {
        return not_a_number;
    }
    aset_real size = 0;
    const int32_t magnitude = d.n_digits + d.exponent; /* it is below 10^magnitude, and not below a tenth of it */
    if (d.n_digits > 0 && (magnitude > LARGEST_DECIMAL + 1 || (magnitude > ZERO_DECIMAL && !scale(&d, &size)))) {
        return too_large;
    }
    *value = d.negative ? -size : size;
    return NULL;
}

/* ---- the shortcut ---- */

/*
 * Digits below 2^53 and a power of ten up to 10^22 are doubles, so one multiplication or division gives the double nearest
 * to the number. The float nearest to that is the float nearest to the number, unless the double lies just between two
 * floats: then the number may lie on either side. This needs doubles that are not kept in wider registers, and normal
 * floats.
 */
#if FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1
static const double power_of_ten[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* The nearest aset_real to a positive double that is the nearest to a number; false where that cannot be told. */
static bool narrow(double wide, aset_real *value) {
#if ASET_REAL_BITS == 32
    const uint64_t below = 0x1fffffffu, half = 0x10000000u; /* of the 53 bits of a double a float keeps all but 29 */
    uint64_t bits;
    memcpy(&bits, &wide, sizeof bits);
    if (!(wide > 1e-37 && wide < 1e38) || (bits & below) == half) {
        return false;
    }
#endif
    *value = (aset_real)wide;
    return true;
}

static bool short_number(const char *text, size_t length, aset_real *value) {
    uint64_t digits = 0;
    int32_t exponent = 0;
    const bool negative = length > 0 && text[0] == '-';
    size_t i = negative ? 1 : 0, n_digits = 0;
    for (bool fraction = false; i < length; i++) {
        if (is_digit(text[i])) {
            digits = digits * 10 + (uint64_t)(text[i] - '0');
            exponent -= fraction ? 1 : 0;
            n_digits++;
        } else if (text[i] == '.' && !fraction) {
            fraction = true;
        } else {
            break;
        }
    }
    if (n_digits == 0 || n_digits > 19) {
        return false;
    }
    if (i + 2 < length && i + 6 > length && (text[i] == 'e' || text[i] == 'E') &&
        (text[i + 1] == '-' || text[i + 1] == '+')) {
        int32_t given = 0;
        const bool down = text[i + 1] == '-';
        for (i += 2; i < length && is_digit(text[i]); i++) {
            given = given * 10 + (text[i] - '0');
        }
        exponent += down ? -given : given;
    }
    if (i != length || digits >> 53 != 0 || exponent < -22 || exponent > 22) {
        return false;
    }
    aset_real size = 0;
    const double wide = (double)digits;
    if (digits != 0 && !narrow(exponent < 0 ? wide / power_of_ten[-exponent] : wide * power_of_ten[exponent], &size)) {
        return false;
    }
    *value = negative ? -size : size;
    return true;
}
#else
static bool short_number(const char *text, size_t length, aset_real *value) {
    (void)text, (void)length, (void)value;
    return false;
}
#endif

const char *aset_number_real(const char *text, size_t length, aset_real *value) {
    return short_number(text, length, value) ? NULL : exact_number(text, length, value);
}

const char *aset_number_coordinate(const char *text, size_t length, aset_real *value) {
    const char *wrong = aset_number_real(text, length, value);
    if (wrong == not_finite || wrong == too_large) {
        *value = ASET_NUMBER_OUTSIDE;
        return NULL;
    }
    return wrong;
}

const char *aset_number_whole(const char *text, size_t length, uint32_t *value) {
    uint64_t sum = 0;
    for (size_t i = 0; i < length; i++) {
        if (!is_digit(text[i])) {
            return "not a whole number";
        }
        sum = sum * 10 + (uint64_t)(text[i] - '0');
        sum = sum > UINT32_MAX ? (uint64_t)UINT32_MAX + 1 : sum; /* stays above, whatever follows */
    }
    if (length == 0) {
        return "not a whole number";
    }
    if (sum > UINT32_MAX) {
        return too_large;
    }
    *value = (uint32_t)sum;
    return NULL;
}
