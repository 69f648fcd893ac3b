/*
 * elementary.c - sine, cosine, tangent and logarithm from + - * / alone.
 *
 * Angles are brought to [-pi/4, pi/4] by a multiple of pi/2 in two parts, of which the first has so few bits that its multiples are
 * exact (W. J. Cody and W. Waite, "Software Manual for the Elementary Functions", 1980); there Taylor's series end below
 * 2^-58. The logarithm splits x = m 2^e with m in [1/sqrt 2, sqrt 2) and sums 2 artanh((m - 1) / (m + 1)): the argument is at
 * most 0.1716, so eleven terms leave less than 2^-60.
 */
#include "elementary.h"

/* pi/2 to 33 bits, and what it lacks */
#define QUARTER_HIGH 1.5707963267341256
#define QUARTER_LOW 6.0771005065061922e-11
#define QUARTERS_PER_RAD 0.63661977236758134

static double sine_near_zero(double x) {
    double s = x * x;
    double series = 1.0 / 355687428096000.0;
    series = 1.0 / 1307674368000.0 - s * series;
    series = 1.0 / 6227020800.0 - s * series;
    series = 1.0 / 39916800.0 - s * series;
    series = 1.0 / 362880.0 - s * series;
    series = 1.0 / 5040.0 - s * series;
    series = 1.0 / 120.0 - s * series;
    series = 1.0 / 6.0 - s * series;
    return x - x * (s * series);
}

static double cosine_near_zero(double x) {
    double s = x * x;
    double series = 1.0 / 20922789888000.0;
    series = 1.0 / 87178291200.0 - s * series;
    series = 1.0 / 479001600.0 - s * series;
    series = 1.0 / 3628800.0 - s * series;
    series = 1.0 / 40320.0 - s * series;
    series = 1.0 / 720.0 - s * series;
    series = 1.0 / 24.0 - s * series;
    series = 1.0 / 2.0 - s * series;
    return 1.0 - s * series;
}

/* The sine of rad + so many quarters of a turn. */
static double sine_of(double rad, int quarters) {
    int nearest = (int)(rad * QUARTERS_PER_RAD + (rad < 0.0 ? -0.5 : 0.5));
    double left = (rad - nearest * QUARTER_HIGH) - nearest * QUARTER_LOW;
    switch ((unsigned)(nearest + quarters) & 3u) {
    case 0: return sine_near_zero(left);
    case 1: return cosine_near_zero(left);
    case 2: return -sine_near_zero(left);
    default: return -cosine_near_zero(left);
    }
}

double aset_emit_sine(double rad) {
    return sine_of(rad, 0);
}

double aset_emit_cosine(double rad) {
    return sine_of(rad, 1);
}

double aset_emit_tangent(double rad) {
    return sine_of(rad, 0) / sine_of(rad, 1);
}

double aset_emit_logarithm(double x) {
    const double least = 0.70710678118654752;
    int exponent = 0;
    while (x < least) { /* doubling and halving are exact */
        x *= 2.0;
        exponent--;
    }
    while (x >= 2.0 * least) {
        x /= 2.0;
        exponent++;
    }
    double s = (x - 1.0) / (x + 1.0), s2 = s * s, series = 0.0;
    for (int k = 21; k >= 1; k -= 2) {
        series = 1.0 / k + s2 * series;
    }
    return exponent * 0.69314718055994531 + 2.0 * s * series;
}
