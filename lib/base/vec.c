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

/*
 * Rarely needed, and long: one for all callers, of vectors whose square is out of range. From the ends of the range, denormals too,
 * at most 15 steps.
 */
static NOINLINE aset_vec3 unusual_unit(aset_vec3 a, aset_real *length) {
    aset_real largest = vec_largest(a), back = 1; /* what a step has to be undone by */
    int steps = 0;
    *length = 0;
    if (!(largest > 0)) {
        return vec(0, 0, 0);
    }
    for (; largest < LEAST; largest *= STEP, steps++) {
        a = vec_scale(a, STEP);
        back = 1 / STEP;
    }
    for (; largest > MOST && largest <= REAL_MAX; largest *= 1 / STEP, steps++) {
        a = vec_scale(a, 1 / STEP);
        back = STEP;
    }
    aset_real root = real_sqrt(vec_dot(a, a));
    for (*length = root; steps > 0; steps--) {
        *length *= back;
    }
    return vec_scale(a, 1 / root);
}

static inline bool is_usual(aset_real square) {
    return square > VEC_SQUARE_MIN && square < VEC_SQUARE_MAX;
}

aset_real aset_vec_length(aset_vec3 a) {
    aset_real square = vec_dot(a, a), length;
    if (is_usual(square)) {
        return real_sqrt(square);
    }
    (void)unusual_unit(a, &length);
    return length;
}

aset_vec3 aset_vec_unit(aset_vec3 a) {
    aset_real square = vec_dot(a, a), length;
    return is_usual(square) ? vec_scale(a, 1 / real_sqrt(square)) : unusual_unit(a, &length);
}

aset_vec3 aset_vec_unit_length(aset_vec3 a, aset_real *length) {
    aset_real square = vec_dot(a, a);
    if (!is_usual(square)) {
        return unusual_unit(a, length);
    }
    *length = real_sqrt(square);
    return vec_scale(a, 1 / *length);
}
