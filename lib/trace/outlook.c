/* outlook.c - the cells' box, and the numbers that all voxels' outlines share. */
#include "trace/outlook.h"

#include "approx/draft_ray.h"

#if ASET_WITH_DRAFTS

#define NEAREST R(0.001)     /* of the box's diagonal: so far before the eye all of it must lie */
#define GROWN (R(1) / 16)    /* of a voxel */
#define ROUNDING (16 * REAL_UNIT) /* of the coordinates */

outlook_cells aset_outlook_cells_of(const aset_draft *draft) {
    outlook_cells c;
    c.low = vec(draft->low[0], draft->low[1], draft->low[2]);
    c.voxel = vec_scale(vec(draft->size[0], draft->size[1], draft->size[2]), 4);
    c.half = vec(c.voxel.x * (aset_real)draft->n[0] / 2, c.voxel.y * (aset_real)draft->n[1] / 2,
                 c.voxel.z * (aset_real)draft->n[2] / 2);
    c.middle = vec_add(c.low, c.half);
    c.column = draft->column;
    c.half = vec_add(vec_add(c.half, c.voxel), vec(c.column, c.column, c.column));
    c.diagonal = 2 * aset_vec_length(c.half);
    c.far = draft_far(draft) - c.diagonal;
    return c;
}

void aset_outlook_set_camera(aset_outlook *o, const camera *eye) {
    o->from = eye->from;
    o->forward = eye->forward;
    o->across = vec_scale(eye->right, 1 / vec_dot(eye->right, eye->right));
    o->down = vec_scale(eye->down, 1 / vec_dot(eye->down, eye->down));
    o->parallel = eye->orthographic;
}

/*
 * By how much places among the cells, and a ray's crossings of slices, err when seen from there: voxels may be far thinner on
 * one axis than on the others, and thinner than this their slices are not told apart.
 */
static aset_real rounding_at(const aset_outlook *o, const outlook_cells *cells) {
    return ROUNDING * (vec_largest(o->from) + vec_largest(cells->middle) + cells->diagonal);
}

void aset_outlook_set_voxels(aset_outlook *o, const outlook_cells *cells, aset_real grown) {
    grown += rounding_at(o, cells);
    aset_vec3 half = vec_add(vec_scale(cells->voxel, (1 + GROWN) / 2), vec(grown, grown, grown));
    o->half_across = outlook_extent(half, o->across);
    o->half_down = outlook_extent(half, o->down);
    o->half_forward = outlook_extent(half, o->forward);
    o->ball = aset_vec_length(half);
}

bool aset_outlook_can_see(const aset_outlook *o, const outlook_cells *cells) {
    aset_vec3 way = vec_sub(cells->middle, o->from), voxel = cells->voxel;
    aset_real before = vec_dot(way, o->forward) - outlook_extent(cells->half, o->forward);
    aset_real thinnest = real_min(voxel.x, real_min(voxel.y, voxel.z));
    /* a narrow enough angle, and places on the picture would leave the range of numbers */
    aset_real farthest = 16 * (vec_largest(way) + cells->diagonal) * real_max(vec_largest(o->across), vec_largest(o->down));
    return aset_vec_length(way) < real_min(OUTLOOK_FAR * cells->diagonal, cells->far) && thinnest > rounding_at(o, cells) &&
           real_finite(farthest) && before > (o->parallel ? 0 : NEAREST * cells->diagonal);
}

#endif
