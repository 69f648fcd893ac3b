/*
 * sphere.c - spheres, by the stable quadratic of Haines, Guenther and Akenine-Moeller ("Precision Improvements for
 * Ray/Sphere Intersection", Ray Tracing Gems 2019, chapter 7): the discriminant comes from the distance between the centre
 * and the ray's line, not from the difference of two large squares, and the smaller root from the product of both.
 */
#include "scene/shape.h"

#if ASET_WITH_SPHERES

aset_real aset_sphere_nearest(const aset_real *at, const probe *ray, unsigned sides) {
    aset_vec3 f = vec_sub(probe_origin(ray), vec(at[0], at[1], at[2])), d = probe_direction(ray);
    aset_real radius = real_abs(at[3]);
    aset_real middle = -vec_dot(f, d); /* t of the line's point nearest to the centre */
    aset_vec3 nearest = vec_along(f, middle, d);
    aset_real discriminant = radius * radius - vec_dot(nearest, nearest);
    if (!(discriminant >= 0)) {
        return REAL_INFINITY;
    }
    aset_real half = real_sqrt(discriminant), length = aset_vec_length(f);
    aset_real product = (length - radius) * (length + radius);
    aset_real large = middle + (middle < 0 ? -half : half);
    aset_real small = large != 0 ? product / large : 0;
    aset_real t_in = middle < 0 ? large : small, t_out = middle < 0 ? small : large;
    unsigned outside = at[3] < 0 ? SIDE_BACK : SIDE_FRONT; /* what the entering ray sees */
    if (at[3] < 0) {
        sides = SIDE_FRONT; /* the front of a negative sphere is its inside, and nothing else is visible */
    }
    if (t_in > 0 && (sides & outside) != 0) {
        return t_in;
    }
    return t_out > 0 && (sides & (SIDE_BOTH - outside)) != 0 ? t_out : REAL_INFINITY;
}

void aset_sphere_bounds(const aset_real *at, aset_vec3 *low, aset_vec3 *high) {
    aset_real r = real_abs(at[3]);
    *low = vec(at[0] - r, at[1] - r, at[2] - r);
    *high = vec(at[0] + r, at[1] + r, at[2] + r);
}

aset_vec3 aset_sphere_normal(const aset_real *at, aset_vec3 point) {
    aset_vec3 outward = aset_vec_unit(vec_sub(point, vec(at[0], at[1], at[2])));
    return at[3] < 0 ? vec_scale(outward, -1) : outward;
}

#endif
