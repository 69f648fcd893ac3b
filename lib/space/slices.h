/*
 * slices.h - equally spaced slices, and the way of a ray across them.
 *
 * With n divisions an axis has the slices 0 to n, slice k at low + k width; voxel k lies between slices k and k + 1.
 *
 *      slice 0   1   2   3          The ray's crossings of all slices are put in one order: by t, and at equal t by axis. A
 *            |   |   |   |          crossing's t is always computed from the slice's number, (slice - origin) / direction,
 *         ---+---+--/+---+          never by adding up, so it is the same wherever a walk begins, and it grows with the
 *            |   | / |   |          number of crossings of its axis even after rounding. So a ray's way is one fixed chain of
 *         ---+---+/--+---+          face-to-face voxels: it enters a convex box of voxels at most once, and a walk of
 *            |   /   |   |          n_x + n_y + n_z crossings at most is over. Amanatides and Woo 1987 step the same way.
 */
#ifndef ASET_SPACE_SLICES_H
#define ASET_SPACE_SLICES_H

#include "aset/space.h"
#include "scene/shape.h"

/* A box of voxels, both ends included. */
typedef struct voxel_box {
    int32_t low[3], high[3];
} voxel_box;

/*
 * Cuts the scene's box, grown a little more than the boxes of objects will be. A scene without objects gets a unit cube.
 */
void aset_slices_make(aset_slices *slices, const aset_scene *scene, const uint32_t divisions[3]);

/* The voxels that the grown box of an object from low to high touches: its expanded box in the paper's words. */
voxel_box aset_slices_box(const aset_slices *slices, const aset_scene *scene, aset_vec3 low, aset_vec3 high);
voxel_box aset_slices_object_box(const aset_slices *slices, const aset_scene *scene, uint32_t object);

/* Is the scene long enough, in the steps of its coordinates, to be cut? */
bool aset_slices_precise(const aset_scene *scene);

/* The rule of aset_auto_divisions, for a scene's box and so many objects. */
void aset_slices_auto_divisions(const aset_scene *scene, uint32_t n_objects, size_t budget, uint32_t divisions[3]);

/* One step coarser, a large one if the need is far off. False: nothing is coarser. */
bool aset_slices_coarsen(uint32_t divisions[3], bool far_off);

/* The ends of an object's box as the spaces see it: grown by twice the scene's margin. */
static inline aset_real slices_grown_low(const aset_scene *scene, aset_real low) {
    return low - 2 * scene->margin;
}

static inline aset_real slices_grown_high(const aset_scene *scene, aset_real high) {
    return high + 2 * scene->margin;
}

static inline voxel_box slices_whole(const aset_slices *slices) {
    voxel_box whole = {{0, 0, 0}, {(int32_t)slices->n[0] - 1, (int32_t)slices->n[1] - 1, (int32_t)slices->n[2] - 1}};
    return whole;
}

static inline aset_real slices_plane(const aset_slices *slices, int a, int32_t k) {
    if (slices->planes[a] != NULL) { /* SET */
        return slices->planes[a][k];
    }
    if (k <= 0) {
        return slices->first[a];
    }
    return (uint32_t)k < slices->n[a] ? slices->low[a] + (aset_real)k * slices->width[a] : slices->last[a];
}

/* The voxel that holds x: the last one whose lower slice is not above x; the first or last for x outside. */
int32_t aset_slices_locate(const aset_slices *slices, int a, aset_real x);

/* The voxel of x, or by rounding the one beside it, if all slices are equally far apart. */
static inline int32_t slices_guess(const aset_slices *slices, int a, aset_real x) {
    aset_real guess = (x - slices->low[a]) * slices->per_width[a];
    int32_t last = (int32_t)slices->n[a] - 1;
    return !(guess > 0) ? 0 : guess >= (aset_real)last ? last : (int32_t)guess;
}

/* aset_slices_locate for these. */
static inline int32_t slices_locate_even(const aset_slices *slices, int a, aset_real x) {
    aset_real low = slices->low[a], width = slices->width[a];
    int32_t last = (int32_t)slices->n[a] - 1, k = slices_guess(slices, a, x);
    aset_real slice = (aset_real)k; /* exact */
    for (; k > 0 && low + slice * width > x; k--) { /* slices_plane between the ends */
        slice -= 1;
    }
    for (slice += 1; k < last && low + slice * width <= x; k++) {
        slice += 1;
    }
    return k;
}

/* The voxel that a ray from its origin is in. False: the origin is outside the volume. */
bool aset_slices_voxel(const aset_slices *slices, const probe *ray, int32_t voxel[3]);

typedef struct dda {
    int32_t voxel[3], step[3], end[3]; /* end: the voxel number with which the ray has left the volume */
    aset_real next[3];                 /* t at which each axis is crossed next */
    aset_real t;                       /* of the last crossing */
    int axis;                          /* of the last crossing; -1 before any */
} dda;

static inline aset_real dda_crossing(const aset_slices *slices, const probe *ray, int a, int32_t k) {
    return (slices_plane(slices, a, k) - ray->origin[a]) * ray->inverse[a];
}

/*
 * Puts the walk at the ray's entry into the window (a box of voxels within the volume), wherever on the ray's line that is:
 * the last crossing is the window's face. False if the line misses the window or leaves it before t = 0.
 */
bool aset_dda_enter(dda *walk, const aset_slices *slices, const probe *ray, const voxel_box *window);

/* Puts the walk into the voxel of the ray's origin, before any crossing. False if the origin is outside the volume. */
bool aset_dda_inside(dda *walk, const aset_slices *slices, const probe *ray);

/*
 * Crosses the next slice of axis a, which is a constant where this is called: so the walk's numbers can stay in registers.
 */
static inline bool dda_cross(dda *walk, const aset_slices *slices, const probe *ray, int a) {
    walk->t = walk->next[a];
    walk->axis = a;
    walk->voxel[a] += walk->step[a];
    if (walk->voxel[a] == walk->end[a]) {
        return false;
    }
    walk->next[a] = dda_crossing(slices, ray, a, walk->voxel[a] + (walk->step[a] > 0));
    return true;
}

/* Crosses one more slice. False: the ray has left the volume. */
static inline bool dda_step(dda *walk, const aset_slices *slices, const probe *ray) {
    if (walk->next[0] <= walk->next[1]) {
        return walk->next[0] <= walk->next[2] ? dda_cross(walk, slices, ray, 0) : dda_cross(walk, slices, ray, 2);
    }
    return walk->next[1] <= walk->next[2] ? dda_cross(walk, slices, ray, 1) : dda_cross(walk, slices, ray, 2);
}

/*
 * Brings the walk to where the ray is after all crossings up to the walk's own t and axis, which must lie in the window (a
 * box of voxels that the ray enters by that crossing, or axis = 3: after all crossings not behind t). The number of
 * crossings that the walk had not made yet.
 */
uint32_t aset_dda_land(dda *walk, const aset_slices *slices, const probe *ray, const voxel_box *window);

#endif
