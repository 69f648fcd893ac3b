/*
 * vec.c - lengths and directions of vectors of any size: where the square of a component could leave the range of numbers,
 * the vector is scaled by a power of two first. So a vector times a power of two has the same direction, bit for bit.
 */
#include "base/vec.h"

/* Components between LEAST and MOST have squares in VEC_SQUARE_MIN to VEC_SQUARE_MAX; one step brings the others in, or near. */
#define LEAST R(1e-11)
#define MOST R(1e11)
#if ASET_REAL_BITS == 32
#define STEP R(0x1p40)
#else
#define STEP R(0x1p72)
#endif

#if defined(__GNUC__)
#define NOINLINE __attribute__((noinline))
#else
#define NOINLINE
#endif

/* Rarely needed, and long: one for both callers. a times STEP to the power of *steps; a is not 0. From the ends of the range, denormals too, at most 15 steps. */
static NOINLINE aset_vec3 in_range(aset_vec3 a, int *steps) {
    aset_real largest = vec_largest(a);
    for (; largest < LEAST; largest *= STEP, ++*steps) {
        a = vec_scale(a, STEP);
    }
    for (; largest > MOST && largest <= REAL_MAX; largest *= 1 / STEP, --*steps) {
        a = vec_scale(a, 1 / STEP);
    }
    return a;
}

aset_real aset_vec_length(aset_vec3 a) {
    aset_real square = vec_dot(a, a);
    if (square > VEC_SQUARE_MIN && square < VEC_SQUARE_MAX) {
        return real_sqrt(square);
    }
    if (!(vec_largest(a) > 0)) {
        return 0;
    }
    int steps = 0;
    a = in_range(a, &steps);
    aset_real length = real_sqrt(vec_dot(a, a));
    for (; steps > 0; steps--) {
        length *= 1 / STEP;
    }
    for (; steps < 0; steps++) {
        length *= STEP;
    }
    return length;
}

aset_vec3 aset_vec_unit(aset_vec3 a) {
    aset_real square = vec_dot(a, a);
    if (!(square > VEC_SQUARE_MIN && square < VEC_SQUARE_MAX)) {
        if (!(vec_largest(a) > 0)) {
            return vec(0, 0, 0);
        }
        int steps = 0;
        a = in_range(a, &steps);
        square = vec_dot(a, a);
    }
    return vec_scale(a, 1 / real_sqrt(square));
}

aset_vec3 aset_vec_unit_length(aset_vec3 a, aset_real *length) {
    aset_real square = vec_dot(a, a);
    if (!(square > VEC_SQUARE_MIN && square < VEC_SQUARE_MAX)) {
        *length = aset_vec_length(a);
        return aset_vec_unit(a);
    }
    *length = real_sqrt(square);
    return vec_scale(a, 1 / *length);
}
