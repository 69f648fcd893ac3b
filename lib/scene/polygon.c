/*
 * polygon.c - planar polygons of any number of vertices, concave too, and patches with normals at their vertices.
 *
 * Every vertex is moved to the ray's origin and sheared so that the ray runs along one axis (Woop, Benthin and Wald,
 * "Watertight Ray/Triangle Intersection", JCGT 2013); what is left is whether (0, 0) lies in a polygon of the plane. It does
 * if a half line along +x crosses an odd number of edges. An edge crosses if its ends lie on different sides of y = 0 (0
 * counts as below) and its cross product, always taken from the lower to the upper end, is positive. Two polygons that share
 * an edge compute the same numbers for it, so they agree about it to the last bit: no ray slips between them.
 *
 *          . q (y > 0)                 cross(p, q) = p.x q.y - p.y q.x > 0
 *         /                            if the crossing is right of 0
 *    0 --+----------> x
 *       /
 *      . p (y <= 0)
 */
#include "scene/shape.h"

#if ASET_WITH_POLYGONS

enum { HEAD_NORMAL = 3, HEAD_BOX = 9, BOXED_FROM = 9 /* points */ };

/* The points of a shape: behind the normal if there are more than three, and behind its box if there are more than eight. */
static const aset_real *points_of(const aset_real *at, uint32_t n, unsigned stride, uint32_t *n_points) {
    uint32_t head = n == 3 * stride ? 0 : n >= BOXED_FROM * stride + HEAD_BOX ? HEAD_BOX : HEAD_NORMAL;
    *n_points = (n - head) / stride;
    return at + head;
}

const aset_real *aset_polygon_points(const aset_real *at, uint32_t n, unsigned stride, uint32_t *n_points) {
    return points_of(at, n, stride, n_points);
}

/* Twice the area times the normal (Newell), from n_points points stride apart. */
static aset_vec3 polygon_area(const aset_real *points, uint32_t n_points, unsigned stride) {
    aset_vec3 first = vec(points[0], points[1], points[2]), sum = vec(0, 0, 0), previous = sum;
    for (uint32_t i = 1; i < n_points; i++) {
        const aset_real *p = points + (size_t)i * stride;
        aset_vec3 edge = vec_sub(vec(p[0], p[1], p[2]), first);
        sum = vec_add(sum, vec_cross(previous, edge));
        previous = edge;
    }
    return sum;
}

/*
 * The unit normal of three points, or zero, and a corner to take the plane's distance from: the one between the two shorter edges,
 * whose product errs least. From the tip of a needle the normal would err by as much as the needle is longer than wide.
 */
static aset_vec3 triangle_normal(const aset_real *points, unsigned stride, aset_vec3 *corner) {
    const aset_real *p = points, *q = p + stride, *r = q + stride;
    aset_vec3 a = vec(p[0], p[1], p[2]), b = vec(q[0], q[1], q[2]), c = vec(r[0], r[1], r[2]);
    aset_vec3 ab = vec_sub(b, a), bc = vec_sub(c, b), ca = vec_sub(a, c);
    aset_real ab2 = vec_dot(ab, ab), bc2 = vec_dot(bc, bc), ca2 = vec_dot(ca, ca);
    if (bc2 >= ab2 && bc2 >= ca2) {
        *corner = a;
        return aset_vec_unit(vec_cross(ca, ab));
    }
    *corner = ca2 >= ab2 ? b : c;
    return aset_vec_unit(ca2 >= ab2 ? vec_cross(ab, bc) : vec_cross(bc, ca));
}

aset_vec3 aset_polygon_normal(const aset_real *at, uint32_t n, unsigned stride) {
    aset_vec3 corner;
    return n > 3 * stride ? vec(at[0], at[1], at[2]) : triangle_normal(at, stride, &corner);
}

static void put_vec(aset_real *at, aset_vec3 v) {
    at[0] = v.x;
    at[1] = v.y;
    at[2] = v.z;
}

void aset_polygon_finish(aset_real *at, uint32_t n, unsigned stride, aset_vec3 low, aset_vec3 high) {
    uint32_t n_points;
    aset_real *points = at + (points_of(at, n, stride, &n_points) - at);
    aset_vec3 normal =
        n_points == 3 ? aset_polygon_normal(at, n, stride) : aset_vec_unit(polygon_area(points, n_points, stride));
    if (n_points > 3) {
        put_vec(at, normal);
    }
    if (n_points >= BOXED_FROM) {
        put_vec(at + 3, low);
        put_vec(at + 6, high);
    }
    for (uint32_t i = 0; stride == 6 && i < n_points; i++) {
        aset_real *given = points + (size_t)i * stride + 3;
        if (given[0] == 0 && given[1] == 0 && given[2] == 0) {
            put_vec(given, normal); /* a patch's point without a normal takes the polygon's own */
        }
    }
}

void aset_polygon_scale(aset_real *at, uint32_t n, unsigned stride, aset_real factor) {
    uint32_t n_points;
    aset_real *points = at + (points_of(at, n, stride, &n_points) - at);
    for (uint32_t i = 0; n_points >= BOXED_FROM && i < 6; i++) {
        at[3 + i] *= factor;
    }
    for (uint32_t i = 0; i < n_points; i++, points += stride) {
        put_vec(points, vec_scale(vec(points[0], points[1], points[2]), factor));
    }
}

void aset_polygon_bounds(const aset_real *at, uint32_t n, unsigned stride, aset_vec3 *low, aset_vec3 *high) {
    uint32_t n_points;
    const aset_real *p = points_of(at, n, stride, &n_points);
    if (n_points >= BOXED_FROM) {
        *low = vec(at[3], at[4], at[5]);
        *high = vec(at[6], at[7], at[8]);
        return;
    }
    *low = *high = vec(p[0], p[1], p[2]);
    for (uint32_t i = 1; i < n_points; i++) {
        p += stride;
        aset_vec3 point = vec(p[0], p[1], p[2]);
        *low = vec_min(*low, point);
        *high = vec_max(*high, point);
    }
}

/* A vertex in the ray's frame: the ray starts at 0 and runs along z; z is still to be scaled by shear[2]. */
typedef struct framed {
    aset_real x, y, z;
} framed;

static inline framed frame(const aset_real *p, const probe *ray) {
    int kx = ray->axis[0], ky = ray->axis[1], kz = ray->axis[2];
    framed f;
    f.z = p[kz] - ray->origin[kz];
    f.x = p[kx] - ray->origin[kx] - ray->shear[0] * f.z;
    f.y = p[ky] - ray->origin[ky] - ray->shear[1] * f.z;
    return f;
}

/* Its y alone: the same number. */
static inline aset_real frame_y(const aset_real *p, const probe *ray) {
    aset_real z = p[ray->axis[2]] - ray->origin[ray->axis[2]];
    return p[ray->axis[1]] - ray->origin[ray->axis[1]] - ray->shear[1] * z;
}

/* 1 if the edge crosses the half line y = 0, x > 0. */
static inline unsigned edge_crosses(const framed *p, const framed *q) {
    if ((p->y > 0) == (q->y > 0)) {
        return 0;
    }
    const framed *low = p->y > 0 ? q : p, *high = p->y > 0 ? p : q;
    return low->x * high->y - low->y * high->x > 0;
}

/* Where a ray that is known to cross is made to hit: t within the corners' own, which rounding must not take away from it. */
static aset_real between_corners(aset_real t, aset_real a, aset_real b, aset_real c) {
    aset_real low = real_min(a, real_min(b, c)), high = real_max(a, real_max(b, c));
    return t > high ? high : t >= low ? t : low; /* low also for what is no number: the ray runs in the plane */
}

/*
 * Three points. The plane's distance, as of more points, and not the corners' distances weighted by u, v and w (Woop, Benthin and
 * Wald): seen edge-on these are what is left of two nearly equal products, and the hit may be anywhere in the triangle.
 */
static aset_real triangle_nearest(const aset_real *points, unsigned stride, const probe *ray) {
    framed a = frame(points, ray), b = frame(points + stride, ray), c = frame(points + 2 * stride, ray);
    if (((edge_crosses(&a, &b) + edge_crosses(&b, &c) + edge_crosses(&c, &a)) & 1) == 0) {
        return REAL_INFINITY;
    }
    aset_vec3 corner, normal = triangle_normal(points, stride, &corner);
    if (!(vec_largest(normal) > 0)) {
        return REAL_INFINITY; /* on one line: what crossed are rounding errors */
    }
    aset_real t = vec_dot(normal, vec_sub(corner, probe_origin(ray))) / vec_dot(normal, probe_direction(ray));
    return between_corners(t, a.z * ray->shear[2], b.z * ray->shear[2], c.z * ray->shear[2]);
}

/* More points: the plane's distance first, since half of all planes lie behind the ray. */
static aset_real outline_nearest(const aset_real *at, const aset_real *points, uint32_t n_points, unsigned stride,
                                 const probe *ray) {
    aset_vec3 normal = vec(at[0], at[1], at[2]), first = vec(points[0], points[1], points[2]);
    aset_real slope = vec_dot(normal, probe_direction(ray));
    aset_real t = vec_dot(normal, vec_sub(first, probe_origin(ray))) / slope;
    if (!(t > 0) || slope == 0) {
        return REAL_INFINITY;
    }
    const aset_real *previous = points + (size_t)(n_points - 1) * stride, *next = points;
    bool was_above = frame_y(previous, ray) > 0;
    unsigned crossings = 0;
    for (uint32_t i = 0; i < n_points; i++, previous = next, next += stride) {
        bool is_above = frame_y(next, ray) > 0;
        if (is_above != was_above) { /* few edges do, so only they are framed whole */
            framed p = frame(previous, ray), q = frame(next, ray);
            crossings += edge_crosses(&p, &q);
        }
        was_above = is_above;
    }
    return (crossings & 1) != 0 ? t : REAL_INFINITY;
}

/* Whether the ray misses the grown box that a polygon of many points keeps, or enters it behind limit. */
static bool box_missed(const aset_real *at, const probe *ray, aset_real margin, aset_real limit) {
    aset_vec3 m = vec(margin, margin, margin);
    aset_real t_in, t_out;
    return !aset_probe_box(ray, vec_sub(vec(at[3], at[4], at[5]), m), vec_add(vec(at[6], at[7], at[8]), m), &t_in, &t_out) ||
           t_in > limit || t_out < 0;
}

aset_real aset_polygon_nearest(const aset_real *at, uint32_t n, unsigned stride, const probe *ray, unsigned sides,
                               aset_real margin, aset_real limit) {
    uint32_t n_points;
    const aset_real *points = points_of(at, n, stride, &n_points);
    if (n_points >= BOXED_FROM && box_missed(at, ray, margin, limit)) {
        return REAL_INFINITY;
    }
    aset_real t = n_points == 3 ? triangle_nearest(points, stride, ray)
                                : outline_nearest(at, points, n_points, stride, ray);
    if (!(t > 0)) {
        return REAL_INFINITY;
    }
    if (sides != SIDE_BOTH && vec_dot(aset_polygon_normal(at, n, stride), probe_direction(ray)) >= 0) {
        return REAL_INFINITY; /* seen from behind; a polygon has no other side to hit */
    }
    return t;
}

#if ASET_WITH_PATCHES

/*
 * Weights of the corners a, b, c at a point in their plane, by areas against the plane's normal; the smallest of them tells
 * how far inside the point is.
 */
static aset_real corner_weights(const aset_real *a, const aset_real *b, const aset_real *c, aset_vec3 normal,
                                aset_vec3 point, aset_real weights[3]) {
    aset_vec3 pa = vec_sub(vec(a[0], a[1], a[2]), point), pb = vec_sub(vec(b[0], b[1], b[2]), point),
              pc = vec_sub(vec(c[0], c[1], c[2]), point);
    weights[0] = vec_dot(normal, vec_cross(pb, pc));
    weights[1] = vec_dot(normal, vec_cross(pc, pa));
    weights[2] = vec_dot(normal, vec_cross(pa, pb));
    aset_real sum = weights[0] + weights[1] + weights[2];
    if (!(sum > 0)) {
        return -REAL_INFINITY;
    }
    for (int i = 0; i < 3; i++) {
        weights[i] /= sum;
    }
    return real_min(weights[0], real_min(weights[1], weights[2]));
}

/* Of the triangles that fan out from the first point, the one that holds the point best gives the normal. */
aset_vec3 aset_patch_normal(const aset_real *at, uint32_t n, aset_vec3 point) {
    uint32_t n_points;
    const aset_real *p = points_of(at, n, 6, &n_points);
    aset_vec3 normal = aset_polygon_normal(at, n, 6), best = normal;
    aset_real best_weight = -REAL_INFINITY;
    for (uint32_t i = 1; i + 1 < n_points; i++) {
        const aset_real *b = p + (size_t)i * 6, *c = b + 6;
        aset_real w[3], smallest = corner_weights(p, b, c, normal, point, w);
        if (smallest > best_weight) {
            best_weight = smallest;
            best = vec(w[0] * p[3] + w[1] * b[3] + w[2] * c[3], w[0] * p[4] + w[1] * b[4] + w[2] * c[4],
                       w[0] * p[5] + w[1] * b[5] + w[2] * c[5]);
        }
    }
    best = aset_vec_unit(best);
    return vec_largest(best) > 0 ? best : normal;
}

#endif
#endif
