/* draft_beam.h - a beam: neighbouring rays that meet a draft's voxels together. */
#ifndef ASET_APPROX_DRAFT_BEAM_H
#define ASET_APPROX_DRAFT_BEAM_H

#include "approx/draft_cover.h"
#include "approx/draft_lanes.h"

#if ASET_WITH_DRAFTS

/* Rays side by side in every array, so that a compiler can do several at a time. In columns, as in draft_walk.h. */
typedef struct draft_beam {
    const aset_draft *draft;
    aset_real o[3][DRAFT_BEAM], d[3][DRAFT_BEAM];
    aset_real from[3][DRAFT_BEAM], inverse[3][DRAFT_BEAM], turned[3][DRAFT_BEAM]; /* turned: 1 or 0 */
    aset_real t_max[DRAFT_BEAM];
    aset_real end[DRAFT_BEAM];  /* of the last layer */
    aset_real left[DRAFT_BEAM]; /* 0: the ray is done */
    draft_cover cover[DRAFT_BEAM];
    draft_layer layers[DRAFT_BEAM][DRAFT_LAYERS_MAX];
    uint32_t n_left;    /* rays that are not done */
    uint32_t n_visited; /* voxels, of all rays */
} draft_beam;

/* The first n of DRAFT_BEAM rays of unit direction (the others only fill the arrays), which meet facets at 0 < t < t_max. */
void aset_draft_beam_start(draft_beam *beam, const aset_draft *draft, aset_real (*origins)[DRAFT_BEAM],
                           aset_real (*directions)[DRAFT_BEAM], const aset_real *t_max, uint32_t n);

/*
 * Lays on the rays what they meet in voxel number k (by its bit) of a block that is not empty: number dense, the at[0]-th on x and so
 * on. Voxels must come in an order in which every ray passes those that it meets. True: all rays are done.
 */
bool aset_draft_beam_visit(draft_beam *beam, const uint32_t at[3], uint32_t dense, unsigned k);

#endif
#endif
