/*
 * shape.h - what the kinds of objects have in common: bounds, the nearest hit of a ray, the normal at a point.
 *
 * A shape is a run of coordinates in the scene's pool; how long it is follows from where the next object's begins:
 *   polygon of 3     x y z, three times
 *   polygon of n > 3 unit normal, then x y z, n times
 *   polygon of n > 8 unit normal, low and high corner of its box, then x y z, n times
 *   patch            the same with  x y z nx ny nz  for each point
 *   sphere           centre, radius (negative: only the inside is visible)
 *   cone             base, base radius, apex, apex radius (both negative: only the inside is visible)
 */
#ifndef ASET_SCENE_SHAPE_H
#define ASET_SCENE_SHAPE_H

#include "aset/scene.h"
#include "base/vec.h"

enum { KIND_POLYGON, KIND_PATCH, KIND_SPHERE, KIND_CONE, KIND_BITS = 3 };

/* Which sides of a surface are seen. */
enum { SIDE_FRONT = 1, SIDE_BACK = 2, SIDE_BOTH = 3 };

/* Below this a component of a unit direction moves a ray by less than any margin: 2^-60 against margins of 2^-21. */
#define STILL R(8.7e-19)

/*
 * A ray made ready. Its direction is of unit length here. inverse is 1 / d, or 0 where |d| is so small (STILL) that
 * the ray does not leave the margin of any box along that axis: there moves is false. axis and shear serve the polygons: the
 * ray's largest component comes last, and shearing by shear makes the ray run along it (Woop, Benthin and Wald 2013).
 */
typedef struct probe {
    aset_real origin[3], direction[3], inverse[3];
    bool moves[3];
    int axis[3];
    aset_real shear[3];
} probe;

/* direction: of unit length */
probe aset_probe_make(aset_vec3 origin, aset_vec3 direction);

static inline aset_vec3 probe_origin(const probe *ray) {
    return vec(ray->origin[0], ray->origin[1], ray->origin[2]);
}

static inline aset_vec3 probe_direction(const probe *ray) {
    return vec(ray->direction[0], ray->direction[1], ray->direction[2]);
}

/* One object taken apart. */
typedef struct shape {
    const aset_real *at;
    uint32_t n; /* coordinates */
    unsigned kind;
    const aset_material *material;
} shape;

static inline shape shape_of(const aset_scene *scene, uint32_t object) {
    const aset_object *record = scene->objects + object;
    uint32_t end =
        object + 1 < scene->counts.objects ? record[1].first : (uint32_t)scene->counts.coordinates;
    shape s = {scene->coordinates + record->first, end - record->first, record->kind_material & ((1u << KIND_BITS) - 1),
               scene->materials + (record->kind_material >> KIND_BITS)};
    return s;
}

/* A point of the caller's in the scene's own lengths. */
static inline aset_vec3 scene_point(const aset_scene *scene, aset_vec3 point) {
    return vec_scale(point, scene->scale);
}

/*
 * A scene is kept times a power of two that brings its box into a range where nothing leaves that of numbers. The box is the
 * caller's: that of all objects' bounds, each taken from the numbers that the caller gave.
 */
aset_real aset_scene_scale_for(aset_vec3 low, aset_vec3 high);

/*
 * The smallest t > 0 at which the ray meets a side that is seen, REAL_INFINITY if there is none. Boxes are margin-free.
 * Normals are unit length and point to the front; a patch's shading normal is interpolated.
 */
#if ASET_WITH_POLYGONS
/*
 * stride: 3, or 6 for a patch. margin is the scene's; a polygon whose grown box the ray misses or enters behind limit may be
 * passed over, for its hit would be clamped to that box.
 */
aset_real aset_polygon_nearest(const aset_real *at, uint32_t n, unsigned stride, const probe *ray, unsigned sides,
                               aset_real margin, aset_real limit);
const aset_real *aset_polygon_points(const aset_real *at, uint32_t n, unsigned stride, uint32_t *n_points);
void aset_polygon_bounds(const aset_real *at, uint32_t n, unsigned stride, aset_vec3 *low, aset_vec3 *high);
aset_vec3 aset_polygon_normal(const aset_real *at, uint32_t n, unsigned stride);
#if ASET_WITH_PATCHES
aset_vec3 aset_patch_normal(const aset_real *at, uint32_t n, aset_vec3 point);
#endif
/* Multiplies what is a length. */
void aset_polygon_scale(aset_real *at, uint32_t n, unsigned stride, aset_real factor);
/* Fills in what stands before the points of a polygon whose points are in place. */
void aset_polygon_finish(aset_real *at, uint32_t n, unsigned stride, aset_vec3 low, aset_vec3 high);
#endif
#if ASET_WITH_SPHERES
aset_real aset_sphere_nearest(const aset_real *at, const probe *ray, unsigned sides);
void aset_sphere_bounds(const aset_real *at, aset_vec3 *low, aset_vec3 *high);
aset_vec3 aset_sphere_normal(const aset_real *at, aset_vec3 point);
#endif
#if ASET_WITH_CONES
/* Where there is a hit also aset_cone_bounds, of which half is known by then. */
aset_real aset_cone_nearest(const aset_real *at, const probe *ray, unsigned sides, aset_vec3 *low, aset_vec3 *high);
void aset_cone_bounds(const aset_real *at, aset_vec3 *low, aset_vec3 *high);
aset_vec3 aset_cone_normal(const aset_real *at, aset_vec3 point);
#endif

/* aset_object_bounds in the scene's own lengths, as everything here. */
void aset_object_own_bounds(const aset_scene *scene, uint32_t object, aset_vec3 *low, aset_vec3 *high);

/*
 * The nearest hit of the ray on one object, REAL_INFINITY without one or if it is certainly behind limit. The result is
 * clamped to the ray's stay in the object's box grown by scene->margin: so the point of every accepted hit lies in that box
 * by construction, and a space that puts the grown box into its cells visits one of them no later than the hit, whatever
 * rounding did to t.
 */
aset_real aset_object_nearest(const aset_scene *scene, uint32_t object, const probe *ray, aset_real limit);

/*
 * How far boxes grow in a scene of these bounds: scene->margin. It must exceed the rounding of a side's t, 3 u of the
 * distance between origin and side, which query.c keeps within 1.1 scene sizes, or 3 u of the largest coordinate: so 4 u of
 * both. Spaces grow boxes by twice this, so that what the clamp keeps lies strictly inside.
 */
aset_real aset_object_margin(aset_vec3 low, aset_vec3 high);

/* Is a box long enough, in the steps of its coordinates, to be cut? */
bool aset_box_is_precise(aset_vec3 low, aset_vec3 high);

/* The unit normals at a point on the object, which is in the caller's lengths, and its material. */
void aset_object_surface(aset_hit *surface, const aset_scene *scene, uint32_t object);

/*
 * The interval of t in which the ray is inside a box; false if it misses. The same formula, (side - origin) * inverse, as
 * every walk uses for its slices: both are monotonous in side, so that the outer of two sides is never met later.
 */
bool aset_probe_box(const probe *ray, aset_vec3 low, aset_vec3 high, aset_real *t_in, aset_real *t_out);

#endif
