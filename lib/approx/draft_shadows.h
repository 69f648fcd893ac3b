/* draft_shadows.h - shadow rays through a draft, side by side. */
#ifndef ASET_APPROX_DRAFT_SHADOWS_H
#define ASET_APPROX_DRAFT_SHADOWS_H

#include "approx/draft_lanes.h"
#include "approx/draft_ray.h"

#if ASET_WITH_DRAFTS && DRAFT_SHADES_BEAMS

/* Voxels that shadow rays side by side cross together; those that are not at their ends then go on alone. */
#define DRAFT_STEPS 6

/*
 * Shadow rays side by side on an axis: turned, in columns, where the ray is, the far side of the voxel that it has come to, t there, and
 * how many voxels lie behind that one.
 */
typedef struct draft_shadows_axis {
    aset_real from[DRAFT_BEAM], rise[DRAFT_BEAM], inverse[DRAFT_BEAM], plane[DRAFT_BEAM], next[DRAFT_BEAM];
    int32_t left[DRAFT_BEAM], placed[DRAFT_BEAM]; /* placed: 1 where all that is right; on x: on all axes */
    int32_t flip[DRAFT_BEAM], base[DRAFT_BEAM];   /* the voxel, not turned, is (left ^ flip) + base; flip is 0 where it is turned */
} draft_shadows_axis;

typedef struct draft_shadows {
    const aset_draft *draft;
    draft_shadows_axis axes[3];
    aset_real t_max[DRAFT_BEAM], t_last[DRAFT_BEAM]; /* as aset_draft_blocks has them */
    aset_real t[DRAFT_BEAM];                         /* of the last crossing, */
    int32_t axis[DRAFT_BEAM];                        /* and its axis */
    int32_t alive[DRAFT_BEAM];                       /* 1: not at its end after n_steps */
    uint32_t cells[DRAFT_STEPS][DRAFT_BEAM];         /* the voxels behind that of the start: x, y, z of ten bits; at the end UINT32_MAX */
    uint32_t n_steps;
} draft_shadows;

/*
 * Those of the rays asked for, each a bit, of which aset_draft_blocks would say that something stops them. All have unit directions;
 * t_max and t_last are set, t_last is 0 for those that are not asked for. counts: grow by those of all.
 */
uint32_t aset_draft_shadows_send(draft_shadows *restrict shadows, const aset_draft *draft, aset_real (*restrict origins)[DRAFT_BEAM],
                                 aset_real (*restrict directions)[DRAFT_BEAM], uint32_t rays, draft_counts *counts);

#endif
#endif
