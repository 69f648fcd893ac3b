/* object.c - one object of any kind against a ray: dispatch, and the box that bounds every accepted hit. */
#include "scene/shape.h"

probe aset_probe_make(aset_vec3 origin, aset_vec3 direction) {
    probe ray = {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, {0, 0, 0}, {false, false, false},
                 {0, 1, 2}, {0, 0, 0}};
    for (int a = 0; a < 3; a++) {
        ray.moves[a] = real_abs(ray.direction[a]) > STILL;
        ray.inverse[a] = ray.moves[a] ? 1 / ray.direction[a] : 0;
    }
    int z = 0;
    for (int a = 1; a < 3; a++) {
        if (real_abs(ray.direction[a]) > real_abs(ray.direction[z])) {
            z = a;
        }
    }
    ray.axis[2] = z;
    ray.axis[0] = (z + 1) % 3;
    ray.axis[1] = (z + 2) % 3;
    ray.shear[2] = 1 / ray.direction[z];
    ray.shear[0] = ray.direction[ray.axis[0]] * ray.shear[2];
    ray.shear[1] = ray.direction[ray.axis[1]] * ray.shear[2];
    return ray;
}

bool aset_probe_box(const probe *ray, aset_vec3 low, aset_vec3 high, aset_real *t_in, aset_real *t_out) {
    const aset_real lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    aset_real in = -REAL_INFINITY, out = REAL_INFINITY;
    for (int a = 0; a < 3; a++) {
        aset_real o = ray->origin[a];
        if (!ray->moves[a]) {
            if (o < lows[a] || o > highs[a]) {
                return false;
            }
            continue;
        }
        bool up = ray->direction[a] > 0;
        aset_real t_near = ((up ? lows[a] : highs[a]) - o) * ray->inverse[a];
        aset_real t_far = ((up ? highs[a] : lows[a]) - o) * ray->inverse[a];
        in = t_near > in ? t_near : in;
        out = t_far < out ? t_far : out;
    }
    *t_in = in;
    *t_out = out;
    return in <= out;
}

static void shape_bounds(const shape *s, aset_vec3 *low, aset_vec3 *high) {
    switch (s->kind) {
#if ASET_WITH_POLYGONS
    case KIND_POLYGON: aset_polygon_bounds(s->at, s->n, 3, low, high); return;
#if ASET_WITH_PATCHES
    case KIND_PATCH: aset_polygon_bounds(s->at, s->n, 6, low, high); return;
#endif
#endif
#if ASET_WITH_SPHERES
    case KIND_SPHERE: aset_sphere_bounds(s->at, low, high); return;
#endif
#if ASET_WITH_CONES
    case KIND_CONE: aset_cone_bounds(s->at, low, high); return;
#endif
    default: break;
    }
    *low = *high = vec(0, 0, 0); /* no other kind is ever stored */
}

void aset_object_own_bounds(const aset_scene *scene, uint32_t object, aset_vec3 *low, aset_vec3 *high) {
    shape s = shape_of(scene, object);
    shape_bounds(&s, low, high);
}

void aset_object_bounds(const aset_scene *scene, uint32_t object, aset_vec3 *low, aset_vec3 *high) {
    aset_object_own_bounds(scene, object, low, high);
    *low = vec_scale(*low, 1 / scene->scale);
    *high = vec_scale(*high, 1 / scene->scale);
}

/* How long a box is, and its largest coordinate. */
static aset_real box_size(aset_vec3 low, aset_vec3 high, aset_real *largest) {
    *largest = real_max(vec_largest(low), vec_largest(high));
    return vec_largest(vec_sub(high, low));
}

aset_real aset_object_margin(aset_vec3 low, aset_vec3 high) {
    aset_real largest, size = box_size(low, high, &largest);
    aset_real margin = real_max(size, largest) * (4 * REAL_UNIT);
    return margin > 0 ? margin : R(1e-30); /* every object in the point 0: any width will do, but a width it must be */
}

bool aset_box_is_precise(aset_vec3 low, aset_vec3 high) {
    aset_real largest, size = box_size(low, high, &largest);
    return size == 0 || size >= STEPS_LEAST * 2 * REAL_UNIT * largest;
}

/* Where there is a hit also the bounds of a cone. */
static aset_real shape_nearest(const shape *s, const probe *ray, unsigned sides, aset_real margin, aset_real limit, aset_vec3 *low,
                               aset_vec3 *high) {
    (void)ray, (void)sides, (void)margin, (void)limit, (void)low, (void)high;
    switch (s->kind) {
#if ASET_WITH_POLYGONS
    case KIND_POLYGON: return aset_polygon_nearest(s->at, s->n, 3, ray, sides, margin, limit);
#if ASET_WITH_PATCHES
    case KIND_PATCH: return aset_polygon_nearest(s->at, s->n, 6, ray, sides, margin, limit);
#endif
#endif
#if ASET_WITH_SPHERES
    case KIND_SPHERE: return aset_sphere_nearest(s->at, ray, sides);
#endif
#if ASET_WITH_CONES
    case KIND_CONE: return aset_cone_nearest(s->at, ray, sides, low, high);
#endif
    default: return REAL_INFINITY;
    }
}

aset_real aset_object_nearest(const aset_scene *scene, uint32_t object, const probe *ray, aset_real limit) {
    shape s = shape_of(scene, object);
    aset_vec3 low, high, margin;
    aset_real t = shape_nearest(&s, ray, s.material->one_sided ? SIDE_FRONT : SIDE_BOTH, scene->margin, limit, &low, &high);
    if (!(t < REAL_INFINITY)) {
        return REAL_INFINITY;
    }
    if (s.kind != KIND_CONE) {
        shape_bounds(&s, &low, &high);
    }
    aset_real m = scene->margin, t_in, t_out;
    margin = vec(m, m, m);
    if (!aset_probe_box(ray, vec_sub(low, margin), vec_add(high, margin), &t_in, &t_out)) {
        return REAL_INFINITY;
    }
    t = t < t_in ? t_in : t > t_out ? t_out : t;
    return t > 0 ? t : REAL_INFINITY;
}

void aset_object_surface(aset_hit *surface, const aset_scene *scene, uint32_t object) {
    shape s = shape_of(scene, object);
    aset_vec3 point = scene_point(scene, surface->point), *geometric = &surface->geometric, *shading = &surface->normal;
    (void)point;
    surface->material = s.material;
    switch (s.kind) {
#if ASET_WITH_POLYGONS
    case KIND_POLYGON: *geometric = aset_polygon_normal(s.at, s.n, 3); break;
#if ASET_WITH_PATCHES
    case KIND_PATCH:
        *geometric = aset_polygon_normal(s.at, s.n, 6);
        *shading = aset_patch_normal(s.at, s.n, point);
        return;
#endif
#endif
#if ASET_WITH_SPHERES
    case KIND_SPHERE: *geometric = aset_sphere_normal(s.at, point); break;
#endif
#if ASET_WITH_CONES
    case KIND_CONE: *geometric = aset_cone_normal(s.at, point); break;
#endif
    default: *geometric = vec(0, 0, 0); break;
    }
    *shading = *geometric;
}
