/*
 * outlook.h - where a draft's voxels appear: the rectangle that bounds a voxel's outline, seen from a point or along a direction.
 *
 *        from *-----------[ -1..1 ]- - - - - +---+       a point's place: its vector from `from` times across and down,
 *                    forward                 |   |       by that times forward unless parallel
 *                                            +---+
 *
 * All voxels are boxes of one size, so their extents along forward, across and down are the same three numbers.
 * Everything is conservative: boxes are grown by more than all rounding, and outlines are asked for only from no farther than
 * OUTLOOK_FAR diagonals, with everything in front.
 */
#ifndef ASET_TRACE_OUTLOOK_H
#define ASET_TRACE_OUTLOOK_H

#include "aset/reach.h"
#include "base/vec.h"
#include "trace/camera.h"

#if ASET_WITH_DRAFTS

#define OUTLOOK_FAR R(64)

/* The cells' box and its voxels. */
typedef struct outlook_cells {
    aset_vec3 low, middle, half, voxel; /* half: grown by more than a voxel */
    aset_real diagonal, column;
    aset_real far; /* single rays that meet the box from farther than this begin elsewhere (draft_far) */
} outlook_cells;

typedef struct outlook_rectangle {
    aset_real left, right, top, bottom;
} outlook_rectangle;

outlook_cells aset_outlook_cells_of(const aset_draft *draft);

/* Half the size along a vector of what spans half on each axis, to either side. */
static inline aset_real outlook_extent(aset_vec3 half, aset_vec3 along) {
    return half.x * real_abs(along.x) + half.y * real_abs(along.y) + half.z * real_abs(along.z);
}

/* As a camera sees; -1..1 is the picture. */
void aset_outlook_set_camera(aset_outlook *o, const camera *eye);

/* Voxels' extents, when from, forward, across and down are set; grown: by so much more than rounding asks for, on all sides. */
void aset_outlook_set_voxels(aset_outlook *o, const outlook_cells *cells, aset_real grown);

/* Does all of the cells' box lie before it, and near enough for sharp numbers? */
bool aset_outlook_can_see(const aset_outlook *o, const outlook_cells *cells);

/* The middle of a voxel. */
static inline aset_vec3 outlook_middle(const outlook_cells *c, uint32_t x, uint32_t y, uint32_t z) {
    return vec(c->low.x + ((aset_real)(int32_t)x + R(0.5)) * c->voxel.x, c->low.y + ((aset_real)(int32_t)y + R(0.5)) * c->voxel.y,
               c->low.z + ((aset_real)(int32_t)z + R(0.5)) * c->voxel.z);
}

/* From middle - half to middle + half, of what lies between two depths. */
static inline void outlook_span(aset_real *low, aset_real *high, aset_real middle, aset_real half, aset_real per_near,
                                aset_real per_far) {
    *low = middle - half;
    *high = middle + half;
    *low *= *low < 0 ? per_near : per_far;
    *high *= *high < 0 ? per_far : per_near;
}

/* What bounds the outline of a box whose middle is way from `from`, and which is times as large as a voxel. */
static inline outlook_rectangle outlook_of(const aset_outlook *o, aset_vec3 way, aset_real times) {
    aset_real depth = vec_dot(way, o->forward), half = o->half_forward * times;
    aset_real per_near = o->parallel ? 1 : 1 / (depth - half), per_far = o->parallel ? 1 : 1 / (depth + half);
    outlook_rectangle r;
    outlook_span(&r.left, &r.right, vec_dot(way, o->across), o->half_across * times, per_near, per_far);
    outlook_span(&r.top, &r.bottom, vec_dot(way, o->down), o->half_down * times, per_near, per_far);
    return r;
}

#endif
#endif
