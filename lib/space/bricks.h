/*
 * bricks.h - a ray among bricks of 4 x 4 x 4 voxels: every fourth slice, crossed in the same order as all of them, so that
 * empty bricks are left in one go. Serves the spaces that mark voxels in cells.h's blocks.
 */
#ifndef ASET_SPACE_BRICKS_H
#define ASET_SPACE_BRICKS_H

#include "space/cells.h"

typedef struct brick_walk {
    int32_t at[3], end[3], stride[3]; /* stride: blocks from one brick to the next that the ray enters, of all faces */
    aset_real next[3];
    uint32_t block; /* the brick's first */
} brick_walk;

/* The t at which the ray leaves brick number at of axis a. */
static inline aset_real brick_exit(const aset_slices *slices, const probe *ray, int a, int32_t at) {
    int32_t beyond = at * 4 + 4, n = (int32_t)slices->n[a];
    return dda_crossing(slices, ray, a, ray->direction[a] > 0 ? (beyond < n ? beyond : n) : at * 4);
}

void brick_begin(brick_walk *bricks, const aset_cells *cells, const aset_slices *slices, const probe *ray, const dda *way);

/* Into the next brick along axis a. False: out of the volume. */
static inline bool brick_cross(brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way, int a) {
    way->t = bricks->next[a];
    way->axis = a;
    bricks->at[a] += way->step[a];
    if (bricks->at[a] == bricks->end[a]) {
        return false;
    }
    bricks->block += (uint32_t)bricks->stride[a];
    bricks->next[a] = brick_exit(slices, ray, a, bricks->at[a]);
    return true;
}

static inline bool brick_step(brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way) {
    if (bricks->next[0] <= bricks->next[1]) {
        return bricks->next[0] <= bricks->next[2] ? brick_cross(bricks, slices, ray, way, 0)
                                                  : brick_cross(bricks, slices, ray, way, 2);
    }
    return bricks->next[1] <= bricks->next[2] ? brick_cross(bricks, slices, ray, way, 1)
                                              : brick_cross(bricks, slices, ray, way, 2);
}

/* Has the crossing that way has just made led into another brick? Its voxel number, seen along the step, then begins one. */
static inline bool brick_left(const dda *way) {
    int32_t k = way->voxel[way->axis];
    return ((way->step[way->axis] > 0 ? k : ~k) & 3) == 0;
}

/*
 * Brings way into the voxel in which the ray enters the brick that the last brick_step led into. The crossings passed over.
 */
uint32_t brick_land(const brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way);

/*
 * The cells that a walk passed since the voxel last known, when it ended among bricks: out of the volume (inside is false),
 * or in a brick entered behind limit.
 */
uint32_t brick_count_rest(const aset_slices *slices, const probe *ray, dda *way, bool inside, aset_real limit);

#endif
