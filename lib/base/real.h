/*
 * real.h - the few functions of real numbers that the core needs, for float and double from one source.
 *
 * Pictures and counts are to be the same with every compiler and libm, so only + - * / and the square root (all exactly
 * rounded by IEEE 754) come from outside; power and tangent are our own, made of these.
 */
#ifndef ASET_BASE_REAL_H
#define ASET_BASE_REAL_H

#include "aset/types.h"

#include <float.h>
#include <limits.h>
#include <math.h>

#if UINT_MAX < 0xffffffff
#error "int has fewer than 32 bits, which libaset's arithmetic counts on"
#endif

/*
 * The promise needs every operation rounded to its own type: not the x87's registers (FLT_EVAL_METHOD 2), nor float computed
 * in double (1: GCC for s390x with -std=c99, cured by -fexcess-precision=fast), nor what the compiler cannot tell (below 0).
 */
#ifdef FLT_EVAL_METHOD
#if FLT_EVAL_METHOD < 0 || FLT_EVAL_METHOD == 2 || (FLT_EVAL_METHOD == 1 && ASET_REAL_BITS == 32)
#error "arithmetic in more than the type's precision: use SSE2 (-msse2 -mfpmath=sse), or -fexcess-precision=fast"
#endif
#endif
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(__ASSOCIATIVE_MATH__) || \
    defined(__RECIPROCAL_MATH__)
#error "libaset is not correct with -ffast-math or its parts: NaN, infinity and the order of operations matter"
#endif

#define R(x) ((aset_real)(x))

#if ASET_REAL_BITS == 32
#define REAL_MAX FLT_MAX
#define REAL_LEAST FLT_MIN /* the smallest that is no denormal */
/* u, the largest relative error of one rounding */
#define REAL_UNIT (FLT_EPSILON / 2)
#else
#define REAL_MAX DBL_MAX
#define REAL_LEAST DBL_MIN
#define REAL_UNIT (DBL_EPSILON / 2)
#endif
#define REAL_DENORMAL (REAL_LEAST * (2 * REAL_UNIT)) /* the smallest of all */
#define REAL_INFINITY ((aset_real)INFINITY)

/* The least steps between neighbouring coordinates that a scene or a model must be long; or it is one point, which needs none. */
#define STEPS_LEAST 64

/*
 * What macros do not show: that a product and a sum are rounded each by itself, to nearest, and that denormals are numbers. False
 * where a compiler's flags or the program's own settings have it otherwise.
 */
bool aset_real_is_sound(void);

static inline aset_real real_sqrt(aset_real x) {
#if ASET_REAL_BITS == 32
    return sqrtf(x);
#else
    return sqrt(x);
#endif
}

static inline aset_real real_abs(aset_real x) {
#if ASET_REAL_BITS == 32
    return fabsf(x);
#else
    return fabs(x);
#endif
}

static inline aset_real real_min(aset_real a, aset_real b) {
    return a < b ? a : b;
}

static inline aset_real real_max(aset_real a, aset_real b) {
    return a > b ? a : b;
}

static inline bool real_finite(aset_real x) {
    return x - x == 0; /* infinity - infinity and anything with NaN are NaN */
}

/*
 * Between real numbers and whole ones of 64 bits, as casts convert them; x lies within 2^47 of 0. The compiler's library for a
 * processor of 32 bits does it in doubles, which nothing else in the core needs: 2 kB of a program there.
 */
static inline int64_t real_to_whole(aset_real x) {
#if ASET_REAL_BITS == 32 && UINTPTR_MAX <= UINT32_MAX
    int32_t high = (int32_t)(x / 65536); /* what is left for the low part is exact */
    return (int64_t)high * 65536 + (int32_t)(x - (aset_real)high * 65536);
#else
    return (int64_t)x;
#endif
}

static inline aset_real real_of_whole(int64_t x) {
#if ASET_REAL_BITS == 32 && UINTPTR_MAX <= UINT32_MAX
    uint64_t size = x < 0 ? -(uint64_t)x : (uint64_t)x;
    aset_real scale = x < 0 ? -1 : 1;
    for (; size > UINT32_MAX; size = size >> 1 | (size & 1)) { /* 32 bits are rounded like all: the last tells of those dropped */
        scale *= 2;
    }
    return (aset_real)(uint32_t)size * scale;
#else
    return (aset_real)x;
#endif
}

/* base^exponent for 0 <= base <= 1 (above 1 is taken as 1) and exponent >= 0; within 2^-12 of the true value. */
aset_real aset_real_power(aset_real base, aset_real exponent);

/* The tangent of an angle of 0 <= angle_deg < 90 degrees. */
aset_real aset_real_tangent_deg(aset_real angle_deg);

#endif
