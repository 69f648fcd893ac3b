/* outlook.c - the cells' box, and the numbers that all voxels' outlines share. */
#include "trace/outlook.h"

#if ASET_WITH_DRAFTS

#define NEAREST R(0.001)     /* of the box's diagonal: so far before the eye all of it must lie */
#define GROWN (R(1) / 16)    /* of a voxel */

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
    return c;
}

void aset_outlook_set_camera(aset_outlook *o, const camera *eye) {
    o->from = eye->from;
    o->forward = eye->forward;
    o->across = vec_scale(eye->right, 1 / vec_dot(eye->right, eye->right));
    o->down = vec_scale(eye->down, 1 / vec_dot(eye->down, eye->down));
    o->parallel = eye->orthographic;
}

void aset_outlook_set_voxels(aset_outlook *o, const outlook_cells *cells, aset_real grown) {
    aset_vec3 half = vec_add(vec_scale(cells->voxel, (1 + GROWN) / 2), vec(grown, grown, grown));
    o->half_across = outlook_extent(half, o->across);
    o->half_down = outlook_extent(half, o->down);
    o->half_forward = outlook_extent(half, o->forward);
    o->ball = aset_vec_length(half);
}

bool aset_outlook_can_see(const aset_outlook *o, const outlook_cells *cells) {
    aset_vec3 way = vec_sub(cells->middle, o->from);
    aset_real before = vec_dot(way, o->forward) - outlook_extent(cells->half, o->forward);
    return aset_vec_length(way) < OUTLOOK_FAR * cells->diagonal && (o->parallel || before > NEAREST * cells->diagonal);
}

#endif
