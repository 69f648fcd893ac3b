/*
 * vec.c - lengths and directions of vectors of any size: where the square of a component could leave the range of numbers,
 * the vector is scaled by its largest component first.
 */
#include "base/vec.h"

/* Squares between these have neither overflown nor lost bits to underflow. */
#define SQUARE_MIN R(1e-24)
#define SQUARE_MAX R(1e24)

aset_real vec_length(aset_vec3 a) {
    aset_real square = vec_dot(a, a);
    if (square > SQUARE_MIN && square < SQUARE_MAX) {
        return real_sqrt(square);
    }
    aset_real largest = vec_largest(a);
    if (!(largest > 0)) {
        return 0;
    }
    aset_vec3 s = vec(a.x / largest, a.y / largest, a.z / largest);
    return largest * real_sqrt(vec_dot(s, s));
}

aset_vec3 vec_unit(aset_vec3 a) {
    aset_real square = vec_dot(a, a);
    if (!(square > SQUARE_MIN && square < SQUARE_MAX)) {
        aset_real largest = vec_largest(a);
        if (!(largest > 0)) {
            return vec(0, 0, 0);
        }
        a = vec(a.x / largest, a.y / largest, a.z / largest);
        square = vec_dot(a, a);
    }
    return vec_scale(a, 1 / real_sqrt(square));
}
