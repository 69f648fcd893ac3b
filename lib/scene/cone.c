/*
 * cone.c - truncated cones and cylinders with open ends.
 *
 * With the axis k from the base B, a point at height m along it lies on the surface if its distance from the axis is
 * r(m) = r0 + s m, s = (r1 - r0) / H, and 0 <= m <= H. Along the ray that is the quadratic a t^2 + 2 b t + c = 0, taken
 * about the ray's point nearest to the cone's middle, where its coefficients are of the cone's own size (the same remedy as
 * for spheres: Haines et al., Ray Tracing Gems 2019, chapter 7), and solved without cancellation.
 */
#include "scene/shape.h"

#if ASET_WITH_CONES

typedef struct cone {
    aset_vec3 base, axis; /* axis of unit length */
    aset_real length, radius, slope;
    bool inside_only;
} cone;

static cone cone_of(const aset_real *at) {
    aset_vec3 along = vec_sub(vec(at[4], at[5], at[6]), vec(at[0], at[1], at[2]));
    cone c;
    c.base = vec(at[0], at[1], at[2]);
    c.axis = aset_vec_unit_length(along, &c.length);
    c.radius = real_abs(at[3]);
    c.slope = (real_abs(at[7]) - c.radius) / c.length;
    c.inside_only = at[3] < 0 || at[7] < 0;
    return c;
}

/* A disc of radius r across the unit axis k reaches r sqrt(1 - k_a^2) along axis a: here for the radius 1. */
static aset_vec3 disc_reach(aset_vec3 k) {
    return vec(real_sqrt(k.y * k.y + k.z * k.z), real_sqrt(k.x * k.x + k.z * k.z), real_sqrt(k.x * k.x + k.y * k.y));
}

/*
 * One of its components for a radius. A denormal product is rounded up: a scene of such lengths keeps them times a power of two, where
 * the product has all its bits, and its box, which comes from the caller's numbers, must hold what is in it.
 */
static aset_real reach_of(aset_real reach, aset_real radius) {
    aset_real product = reach * radius;
    return product < REAL_LEAST && reach > 0 && radius > 0 ? product + REAL_DENORMAL : product;
}

static aset_vec3 reach_for(aset_vec3 reach, aset_real radius) {
    return vec(reach_of(reach.x, radius), reach_of(reach.y, radius), reach_of(reach.z, radius));
}

static void bounds_of(const cone *c, const aset_real *at, aset_vec3 *low, aset_vec3 *high) {
    aset_vec3 apex = vec(at[4], at[5], at[6]);
    aset_vec3 reach = disc_reach(c->axis), base_reach = reach_for(reach, c->radius), apex_reach = reach_for(reach, real_abs(at[7]));
    *low = vec_min(vec_sub(c->base, base_reach), vec_sub(apex, apex_reach));
    *high = vec_max(vec_add(c->base, base_reach), vec_add(apex, apex_reach));
}

/* Not normalised: from the axis outwards, tilted by the slope. */
static aset_vec3 outward(const cone *c, aset_vec3 from_base) {
    aset_real height = vec_dot(from_base, c->axis);
    aset_vec3 across = aset_vec_unit(vec_along(from_base, -height, c->axis));
    return vec_along(across, -c->slope, c->axis);
}

/* Is the surface's point at t, counted from the shifted origin f, between the ends, in front and on a side that is seen? */
static bool root_counts(const cone *c, aset_vec3 f, aset_vec3 d, aset_real t, aset_real shift, unsigned sides) {
    if (!(t + shift > 0)) {
        return false;
    }
    aset_vec3 point = vec_along(f, t, d);
    aset_real height = vec_dot(point, c->axis);
    if (!(height >= 0 && height <= c->length)) {
        return false;
    }
    if (sides == SIDE_BOTH && !c->inside_only) {
        return true;
    }
    bool from_outside = vec_dot(outward(c, point), d) < 0;
    return from_outside != c->inside_only; /* one side only: the outside, or the inside of a negative cone */
}

/* Both roots of a t^2 + 2 b t + c, the smaller first; false if there is none. */
static bool quadratic_roots(aset_real a, aset_real b, aset_real c, aset_real roots[2]) {
    aset_real discriminant = b * b - a * c;
    if (!(discriminant >= 0)) {
        return false;
    }
    aset_real q = b < 0 ? -b + real_sqrt(discriminant) : -b - real_sqrt(discriminant);
    if (q == 0 && a == 0) {
        return false; /* along the surface's rulings: a constant, never or always 0 */
    }
    roots[0] = a != 0 ? q / a : REAL_INFINITY;
    roots[1] = q != 0 ? c / q : 0;
    if (roots[0] > roots[1]) {
        aset_real swap = roots[0];
        roots[0] = roots[1];
        roots[1] = swap;
    }
    return true;
}

/* Fourth powers of lengths below this tell nothing. */
#define FOURTH_LEAST R(1e-30)

/*
 * Whether the line passes the sphere about the cone, or its axis, by more than the larger radius, as most do that are asked: no root
 * is needed to tell. Both radii are larger by far more than the rounding, 3 u of the distance |f|: (a + b)^2 <= (17 / 16) a^2 + 17 b^2.
 * A line n away from the axis has |d x h| n = |(d x h) . f|, h being half the axis. The quadratic errs by far more where a cone
 * is longer than some thousand radii: it would hit beside it.
 */
static bool surely_missed(const aset_real *at, const probe *ray) {
    const aset_real slack = 17 * (16 * REAL_UNIT) * (16 * REAL_UNIT);
    aset_vec3 base = vec(at[0], at[1], at[2]), apex = vec(at[4], at[5], at[6]), half = vec_scale(vec_sub(apex, base), R(0.5));
    aset_vec3 d = probe_direction(ray), f = vec_sub(vec_sub(probe_origin(ray), base), half); /* no sum of two large coordinates */
    aset_vec3 nearest = vec_along(f, -vec_dot(f, d), d), across = vec_cross(d, half);
    aset_real wider = real_max(real_abs(at[3]), real_abs(at[7])), radius2 = R(17.0 / 16) * (wider * wider);
    aset_real half2 = vec_dot(half, half), rounding2 = slack * vec_dot(f, f);
    if (vec_dot(nearest, nearest) > R(17.0 / 16) * half2 + radius2 + rounding2) {
        return true;
    }
    aset_real past = vec_dot(across, nearest), bound = radius2 * vec_dot(across, across) + (rounding2 + slack * half2) * half2;
    return past * past > bound && bound > FOURTH_LEAST;
}

aset_real aset_cone_nearest(const aset_real *at, const probe *ray, unsigned sides, aset_vec3 *low, aset_vec3 *high) {
    if (surely_missed(at, ray)) {
        return REAL_INFINITY;
    }
    cone c = cone_of(at);
    aset_vec3 d = probe_direction(ray), from_base = vec_sub(probe_origin(ray), c.base);
    aset_real shift = vec_dot(vec_along(vec_scale(c.axis, c.length / 2), -1, from_base), d);
    aset_vec3 f = vec_along(from_base, shift, d);
    aset_real f_height = vec_dot(f, c.axis), d_height = vec_dot(d, c.axis);
    aset_vec3 f_across = vec_along(f, -f_height, c.axis), d_across = vec_along(d, -d_height, c.axis);
    aset_real radius = c.radius + c.slope * f_height, growth = c.slope * d_height;
    aset_real distance = aset_vec_length(f_across);
    aset_real roots[2];
    if (!quadratic_roots(vec_dot(d_across, d_across) - growth * growth, vec_dot(d_across, f_across) - growth * radius,
                         (distance - radius) * (distance + radius), roots)) {
        return REAL_INFINITY;
    }
    for (int i = 0; i < 2; i++) {
        if (real_finite(roots[i]) && root_counts(&c, f, d, roots[i], shift, sides)) {
            bounds_of(&c, at, low, high);
            return roots[i] + shift;
        }
    }
    return REAL_INFINITY;
}

void aset_cone_bounds(const aset_real *at, aset_vec3 *low, aset_vec3 *high) {
    cone c = cone_of(at);
    bounds_of(&c, at, low, high);
}

aset_vec3 aset_cone_normal(const aset_real *at, aset_vec3 point) {
    cone c = cone_of(at);
    aset_vec3 n = aset_vec_unit(outward(&c, vec_sub(point, c.base)));
    return c.inside_only ? vec_scale(n, -1) : n;
}

#endif
