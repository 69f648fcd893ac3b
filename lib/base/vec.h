/* vec.h - three-component vectors: the arithmetic of points, directions and colours. */
#ifndef ASET_BASE_VEC_H
#define ASET_BASE_VEC_H

#include "base/real.h"

/* Inlined where it is called, but for programs that are compiled for size: these have it once. */
#if defined(__GNUC__) && defined(__OPTIMIZE_SIZE__)
#define INLINE_BUT_FOR_SIZE static __attribute__((noinline, unused))
#else
#define INLINE_BUT_FOR_SIZE static inline
#endif

/*
 * Numbers of the axes side by side where a loop does the same for all: with a fourth one that is nothing, so that compilers use wide
 * registers; without in programs that are compiled for size.
 */
#if defined(__OPTIMIZE_SIZE__)
#define AXES 3
#else
#define AXES 4
#endif

static inline aset_vec3 vec(aset_real x, aset_real y, aset_real z) {
    aset_vec3 v = {x, y, z};
    return v;
}

static inline aset_vec3 vec_add(aset_vec3 a, aset_vec3 b) {
    return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline aset_vec3 vec_sub(aset_vec3 a, aset_vec3 b) {
    return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline aset_vec3 vec_scale(aset_vec3 a, aset_real s) {
    return vec(a.x * s, a.y * s, a.z * s);
}

/* a + s b */
static inline aset_vec3 vec_along(aset_vec3 a, aset_real s, aset_vec3 b) {
    return vec(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline aset_real vec_dot(aset_vec3 a, aset_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline aset_vec3 vec_cross(aset_vec3 a, aset_vec3 b) {
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

INLINE_BUT_FOR_SIZE aset_real vec_largest(aset_vec3 a) {
    return real_max(real_abs(a.x), real_max(real_abs(a.y), real_abs(a.z)));
}

static inline aset_vec3 vec_min(aset_vec3 a, aset_vec3 b) {
    return vec(real_min(a.x, b.x), real_min(a.y, b.y), real_min(a.z, b.z));
}

static inline aset_vec3 vec_max(aset_vec3 a, aset_vec3 b) {
    return vec(real_max(a.x, b.x), real_max(a.y, b.y), real_max(a.z, b.z));
}

static inline bool vec_finite(aset_vec3 a) {
    return real_finite(a.x) && real_finite(a.y) && real_finite(a.z);
}

/* Component 0, 1 or 2. */
static inline aset_real vec_at(const aset_vec3 *a, int axis) {
    return axis == 0 ? a->x : axis == 1 ? a->y : a->z;
}

/* Squares of lengths between these have neither overflown nor lost bits to underflow. */
#define VEC_SQUARE_MIN R(1e-24)
#define VEC_SQUARE_MAX R(1e24)

/* The length without overflow or underflow on the way; 0 for the zero vector. */
aset_real aset_vec_length(aset_vec3 a);

/* The unit vector along a, or zero for zero; tiny and huge vectors keep their direction. */
aset_vec3 aset_vec_unit(aset_vec3 a);

/* Both, for one root. */
aset_vec3 aset_vec_unit_length(aset_vec3 a, aset_real *length);

#endif
