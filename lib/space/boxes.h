/*
 * boxes.h - every object's box of voxels, kept so that a walk can tell where its ray meets an object for the first time.
 *
 * Where several cells refer to one object, it is to be tested once for a ray, and no walk may write into the scene to
 * remember that. The ray's way enters a box of voxels at most once (slices.h); the cell in which it does is the one that
 * tests.
 */
#ifndef ASET_SPACE_BOXES_H
#define ASET_SPACE_BOXES_H

#include "space/slices.h"

/* Every object's box of voxels of these slices, into boxes. */
void aset_boxes_fill(aset_box *boxes, const aset_slices *slices, const aset_scene *scene);

static inline bool box_holds(const aset_box *box, const int32_t voxel[3]) {
    return voxel[0] >= box->low[0] && voxel[0] <= box->high[0] && voxel[1] >= box->low[1] && voxel[1] <= box->high[1] &&
           voxel[2] >= box->low[2] && voxel[2] <= box->high[2];
}

static inline bool box_meets(const aset_box *box, const voxel_box *region) {
    return box->low[0] <= region->high[0] && box->high[0] >= region->low[0] && box->low[1] <= region->high[1] &&
           box->high[1] >= region->low[1] && box->low[2] <= region->high[2] && box->high[2] >= region->low[2];
}

/*
 * Where a walk is: in a cell (a box of voxels) that it has entered at voxel, by a crossing of slices from before (unless
 * is_first), and will leave by the crossing (t_out, axis_out).
 */
typedef struct stay {
    int32_t voxel[3], before[3];
    bool is_first;
    aset_real t_out;
    int axis_out;
} stay;

/* The stay of a walk in a cell of these voxels. */
void aset_stay_make(stay *s, const dda *walk, const aset_slices *slices, const probe *ray, const voxel_box *cell);

/* Does the ray's way enter the object's box during this stay? */
bool aset_stay_enters(const stay *s, const aset_slices *slices, const probe *ray, const aset_box *box);

#endif
