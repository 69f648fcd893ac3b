/*
 * real.c - power and tangent without libm.
 *
 * power: x^y = 2^(y log2 x). The logarithm splits x = m 2^e with m in [1/sqrt 2, sqrt 2) and sums the odd series of
 * 2 artanh((m - 1) / (m + 1)); with |argument| <= 0.1716 six terms leave less than 2^-33. The exponential sums Taylor's
 * series on [-1/2, 1/2] to the seventh power, below 2^-27. In float the product y log2 x is at most 150 before the result is
 * 0, with a relative error of a few u, so the result errs by less than 150 * 2^-22 relatively near 2^-150 and far less near
 * 1: a picture of 8 bits does not see it.
 */
#include "base/real.h"

/* All numbers through volatile ones: so the compiler cannot do these sums itself. */
bool aset_real_is_sound(void) {
    const volatile aset_real one = 1, up = 1 + 2 * REAL_UNIT, unit = REAL_UNIT, least = REAL_LEAST;
    aset_real x = up, square = one + 4 * unit;
    aset_real fused = x * x - square; /* x * x = 1 + 4 u + 4 u^2, of which the last is rounded away */
    aset_real even_below = one + unit, even_above = one + 3 * unit, below = -one - unit; /* ties */
    volatile aset_real denormal = least / 2;
    return fused == 0 && even_below == 1 && even_above == square && below == -1 && denormal > 0 && denormal + denormal == least;
}

/* The logarithm to base 2 of a normal x > 0. Halving and doubling are exact, so no bit pattern is looked at. */
static aset_real log2_of(aset_real x) {
    const aset_real least = R(0.70710678);
    int exponent = 0;
    for (int bits = 16; bits > 0; bits /= 2) {
        aset_real factor = (aset_real)(INT32_C(1) << bits);
        while (x * factor < 2 * least) {
            x *= factor;
            exponent -= bits;
        }
    }
    aset_real s = (x - 1) / (x + 1), s2 = s * s;
    aset_real series =
        1 + s2 * (R(1.0 / 3) + s2 * (R(1.0 / 5) + s2 * (R(1.0 / 7) + s2 * (R(1.0 / 9) + s2 * R(1.0 / 11)))));
    return (aset_real)exponent + R(2.8853900817779268) * s * series; /* 2 / ln 2 */
}

/* 2^x for x <= 0; 0 below -120. */
static aset_real exp2_of(aset_real x) {
    if (x < -120) {
        return 0;
    }
    int whole = (int)(x - R(0.5)); /* towards 0, so to the nearest of the negatives */
    aset_real f = (x - (aset_real)whole) * R(0.69314718055994531);
    aset_real value =
        1 +
        f * (1 + f * (R(1.0 / 2) +
                      f * (R(1.0 / 6) + f * (R(1.0 / 24) + f * (R(1.0 / 120) + f * (R(1.0 / 720) + f * R(1.0 / 5040)))))));
    for (; whole <= -16; whole += 16) {
        value *= R(1.0 / 65536);
    }
    return value / (aset_real)(1 << -whole);
}

aset_real aset_real_power(aset_real base, aset_real exponent) {
    if (exponent <= 0 || base >= 1) {
        return 1;
    }
    if (base < R(1e-30)) {
        return 0; /* also keeps log2_of from denormals */
    }
    return exp2_of(exponent * log2_of(base));
}

aset_real aset_real_tangent_deg(aset_real angle_deg) {
    /* sine and cosine of a quarter of the angle (at most 0.393 rad) by Taylor's series, then doubled twice */
    aset_real x = angle_deg * R(0.25 * 3.14159265358979323846 / 180), x2 = x * x;
    aset_real sine = x * (1 - x2 * (R(1.0 / 6) - x2 * (R(1.0 / 120) - x2 * (R(1.0 / 5040) - x2 * R(1.0 / 362880)))));
    aset_real cosine = 1 - x2 * (R(0.5) - x2 * (R(1.0 / 24) - x2 * (R(1.0 / 720) - x2 * R(1.0 / 40320))));
    for (int i = 0; i < 2; i++) {
        aset_real twice = 2 * sine * cosine;
        cosine = 1 - 2 * sine * sine;
        sine = twice;
    }
    return sine / cosine;
}
