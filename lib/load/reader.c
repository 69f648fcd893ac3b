/*
 * reader.c - bytes to tokens, tokens to numbers.
 *
 *     input   ... taken ... | buffer[at .. end) | not yet asked for ...
 *                           ^ offset, line: always those of buffer[at]
 *
 * Only take() moves forward in text, so offset and line cannot disagree with the bytes. A line ends with LF, CRLF or CR: CR
 * counts it and an LF right behind is the same end. (Files with CR alone are rare, but were it not an end, a comment in one
 * would swallow all that follows.)
 *
 * Numbers: digits times 10^e is brought into one long integer, exactly: multiplied by 10^e, or, for e < 0, shifted up until
 * enough bits remain and divided by 10^-e with the remainder remembered. The nearest binary number is then read off its top
 * bits. This is the plain exact method that faster ones fall back on (Clinger, "How to Read Floating Point Numbers
 * Accurately", 1990). Usual numbers take one or two limbs, so it is not slow where it matters.
 */
#include "reader.h"

#include <float.h>
#include <string.h>

/* ---- places and errors ---- */

static void copy_token(char to[32], const char *token) {
    size_t i = 0;
    for (; i + 1 < 32 && token[i] != '\0'; i++) {
        to[i] = token[i] >= ' ' && token[i] <= '~' ? token[i] : '?';
    }
    to[i] = '\0';
}

aset_place aset_reader_place(const aset_reader *reader) {
    aset_place place;
    place.offset = reader->token_offset;
    place.line = reader->token_line;
    copy_token(place.token, reader->token);
    return place;
}

aset_status aset_reader_fail_at(aset_reader *reader, const aset_place *place, aset_status status, const char *what,
                                const char *expected) {
    aset_load_report *report = reader->report;
    report->offset = place->offset;
    report->line = place->line;
    report->what = what;
    report->expected = expected;
    copy_token(report->token, place->token);
    return status;
}

aset_status aset_reader_fail(aset_reader *reader, aset_status status, const char *what, const char *expected) {
    const aset_place place = aset_reader_place(reader);
    return aset_reader_fail_at(reader, &place, status, what, expected);
}

/* At the next byte, which is shown as token. */
static aset_status fail_at_byte(aset_reader *reader, const char *token, aset_status status, const char *what,
                                const char *expected) {
    aset_place place;
    place.offset = reader->offset;
    place.line = reader->line;
    copy_token(place.token, token);
    return aset_reader_fail_at(reader, &place, status, what, expected);
}

/* ---- bytes ---- */

/* Asks once for bytes behind buffer[end); there must be room. */
static aset_status fill(aset_reader *reader) {
    const size_t room = sizeof reader->buffer - reader->end;
    const ptrdiff_t got = reader->read(reader->context, reader->buffer + reader->end, room);
    if (got < 0) {
        return fail_at_byte(reader, "", ASET_ERR_READ, "the input could not be read", NULL);
    }
    if ((size_t)got > room) {
        return fail_at_byte(reader, "", ASET_ERR_READ, "the read callback gave more bytes than it was asked for", NULL);
    }
    reader->ended = got == 0;
    reader->end += (size_t)got;
    return ASET_OK;
}

/* The next byte, not taken; -1 at the end of the input. */
static aset_status look(aset_reader *reader, int *byte) {
    if (reader->at == reader->end && !reader->ended) {
        reader->at = reader->end = 0;
        const aset_status status = fill(reader);
        if (status != ASET_OK) {
            return status;
        }
    }
    *byte = reader->at < reader->end ? reader->buffer[reader->at] : -1;
    return ASET_OK;
}

static bool is_line_end(int byte) {
    return byte == '\n' || byte == '\r';
}

static bool is_blank(int byte) {
    return byte == ' ' || byte == '\t' || is_line_end(byte);
}

/* The next byte, which must be a byte of text or -1. */
static aset_status look_text(aset_reader *reader, int *byte) {
    const aset_status status = look(reader, byte);
    if (status != ASET_OK) {
        return status;
    }
    if (*byte >= 0 && (*byte < ' ' || *byte == 127) && !is_blank(*byte)) {
        return fail_at_byte(reader, "?", ASET_ERR_SYNTAX, "a control byte in the text", "a text file");
    }
    return ASET_OK;
}

/* Moves behind the byte that look() has shown. */
static void take(aset_reader *reader, int byte) {
    reader->at++;
    reader->offset++;
    if (byte == '\r' || (byte == '\n' && !reader->after_cr)) {
        reader->line++;
    }
    reader->after_cr = byte == '\r';
}

/* Stops before the line's end, or at the input's. */
static aset_status skip_to_line_end(aset_reader *reader) {
    for (;;) {
        int byte;
        const aset_status status = look_text(reader, &byte);
        if (status != ASET_OK || byte < 0 || is_line_end(byte)) {
            return status;
        }
        take(reader, byte);
    }
}

/* Stops before the next token's first byte, which is *byte, or at the end with -1. */
static aset_status skip_blanks(aset_reader *reader, int *byte) {
    for (;;) {
        aset_status status = look_text(reader, byte);
        if (status == ASET_OK && *byte >= 0 && *byte == reader->comment) {
            status = skip_to_line_end(reader);
        } else if (status == ASET_OK && is_blank(*byte)) {
            take(reader, *byte);
        } else {
            return status;
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

void aset_reader_init(aset_reader *reader, aset_read read, void *context, aset_load_report *report) {
    memset(report, 0, sizeof *report);
    report->what = report->expected = NULL;
    reader->comment = '#';
    reader->cut = "the file ends too early";
    reader->token[0] = '\0';
    reader->length = 0;
    reader->starts_line = true;
    reader->token_offset = 0;
    reader->token_line = 1;
    reader->has_token = reader->kept = reader->ended = reader->after_cr = false;
    reader->line = 1;
    reader->offset = 0;
    reader->at = reader->end = 0;
    reader->read = read;
    reader->context = context;
    reader->report = report;
}

aset_status aset_reader_skip_line(aset_reader *reader) {
    int byte;
    aset_status status = skip_to_line_end(reader);
    if (status == ASET_OK) {
        status = look(reader, &byte);
    }
    if (status == ASET_OK && byte >= 0) {
        take(reader, byte);
        /* bytes behind the line may be binary, so the LF of a CRLF must go now */
        if (byte == '\r' && (status = look(reader, &byte)) == ASET_OK && byte == '\n') {
            take(reader, byte);
        }
    }
    return status;
}

aset_status aset_reader_peek(aset_reader *reader, size_t wanted, const unsigned char **bytes, size_t *n) {
    if (wanted > sizeof reader->buffer) {
        wanted = sizeof reader->buffer;
    }
    if (reader->end - reader->at < wanted) {
        memmove(reader->buffer, reader->buffer + reader->at, reader->end - reader->at);
        reader->end -= reader->at;
        reader->at = 0;
    }
    while (reader->end - reader->at < wanted && !reader->ended) {
        const aset_status status = fill(reader);
        if (status != ASET_OK) {
            return status;
        }
    }
    *bytes = reader->buffer + reader->at;
    *n = reader->end - reader->at < wanted ? reader->end - reader->at : wanted;
    return ASET_OK;
}

aset_status aset_reader_raw(aset_reader *reader, void *bytes, size_t size, size_t *n) {
    unsigned char *to = bytes;
    *n = 0;
    while (*n < size) {
        int byte;
        const aset_status status = look(reader, &byte);
        if (status != ASET_OK || byte < 0) {
            return status;
        }
        const size_t here = reader->end - reader->at;
        const size_t part = here < size - *n ? here : size - *n;
        memcpy(to + *n, reader->buffer + reader->at, part);
        reader->at += part;
        reader->offset += part;
        reader->after_cr = false;
        *n += part;
    }
    return ASET_OK;
}

/* ---- tokens ---- */

aset_status aset_reader_next(aset_reader *reader) {
    if (reader->kept) {
        reader->kept = false;
        return ASET_OK;
    }
    const uint32_t line_before = reader->token_line;
    int byte;
    aset_status status = skip_blanks(reader, &byte);
    if (status != ASET_OK) {
        return status;
    }
    reader->token_offset = reader->offset;
    reader->token_line = reader->line;
    reader->starts_line = byte < 0 || !reader->has_token || reader->line != line_before;
    reader->has_token = true;
    reader->length = 0;
    while (byte >= 0 && !is_blank(byte) && byte != reader->comment) {
        if (reader->length + 1 == sizeof reader->token) {
            reader->token[reader->length] = '\0';
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, "a word too long for any number or name", NULL);
        }
        reader->token[reader->length++] = (char)byte;
        take(reader, byte);
        status = look_text(reader, &byte);
        if (status != ASET_OK) {
            return status;
        }
    }
    reader->token[reader->length] = '\0';
    return ASET_OK;
}

aset_status aset_reader_keep(aset_reader *reader) {
    const aset_status status = aset_reader_next(reader);
    reader->kept = status == ASET_OK;
    return status;
}

bool aset_reader_is(const aset_reader *reader, const char *word) {
    size_t i = 0;
    while (word[i] != '\0' && reader->token[i] == word[i]) {
        i++;
    }
    return word[i] == reader->token[i]; /* both at their end */
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool aset_reader_is_numeric(const aset_reader *reader) {
    const char c = reader->token[0];
    return is_digit(c) || c == '+' || c == '-' || c == '.';
}

/* ---- numbers ---- */

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

/* "nan..." or "inf...", in any case, which other programs print for numbers that failed. */
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
    return false;
}

const char *aset_number_real(const char *text, size_t length, aset_real *value) {
    static const char not_a_number[] = "not a decimal number";
    if (length >= ASET_READER_TOKEN) {
        return not_a_number;
    }
    decimal d; /* the limbs are written before they are read */
    d.digits.n = 0;
    d.exponent = d.n_digits = 0;
    size_t at = length > 0 && (text[0] == '-' || text[0] == '+') ? 1 : 0;
    d.negative = at == 1 && text[0] == '-';
    if (is_not_finite(text + at, length - at)) {
        return "not a finite number";
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
        return "a number too large";
    }
    *value = d.negative ? -size : size;
    return NULL;
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
        return "a number too large";
    }
    *value = (uint32_t)sum;
    return NULL;
}

/* The next token, which must be there. */
static aset_status need_token(aset_reader *reader, const char *expected) {
    const aset_status status = aset_reader_next(reader);
    if (status == ASET_OK && reader->length == 0) {
        return aset_reader_fail(reader, ASET_ERR_SYNTAX, reader->cut, expected);
    }
    return status;
}

aset_status aset_reader_real(aset_reader *reader, aset_real *value, const char *expected) {
    const aset_status status = need_token(reader, expected);
    if (status != ASET_OK) {
        return status;
    }
    const char *wrong = aset_number_real(reader->token, reader->length, value);
    return wrong == NULL ? ASET_OK : aset_reader_fail(reader, ASET_ERR_SYNTAX, wrong, expected);
}

aset_status aset_reader_whole(aset_reader *reader, uint32_t *value, uint32_t low, uint32_t high, const char *outside,
                              const char *expected) {
    const aset_status status = need_token(reader, expected);
    if (status != ASET_OK) {
        return status;
    }
    const char *wrong = aset_number_whole(reader->token, reader->length, value);
    if (wrong == NULL && (*value < low || *value > high)) {
        wrong = outside;
    }
    return wrong == NULL ? ASET_OK : aset_reader_fail(reader, ASET_ERR_SYNTAX, wrong, expected);
}
