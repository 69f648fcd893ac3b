/* draft_ray.h - a ray against a draft's cells. */
#ifndef ASET_APPROX_DRAFT_RAY_H
#define ASET_APPROX_DRAFT_RAY_H

#include "approx/facet.h"

#if ASET_WITH_DRAFTS

/* What a ray may meet before it is taken for covered. */
#define DRAFT_LAYERS_MAX 4

typedef struct draft_layer {
    aset_real t;
    aset_real cover; /* the share of the ray that ends here */
    uint32_t facet;
    int face; /* by side: through which the voxel was entered, axis * 2, + 1 going down; for a facet's plane: 1 if it faces away */
} draft_layer;

/* Of a ray, or of a beam's: a ray crosses no more than 3 x ASET_BAKE_DIVISIONS_MAX slices. What takes them adds to them. */
typedef struct draft_counts {
    uint32_t cells, nonempty;
} draft_counts;

/*
 * How a voxel answers. DRAFT_PLANE: the facets' planes and footprints. DRAFT_SIDE: where the ray enters it, with the normal of
 * the facet that faces the ray most.
 */
typedef enum draft_mode { DRAFT_PLANE, DRAFT_SIDE } draft_mode;

/* The layers that a ray has met so far. */
typedef struct draft_cover {
    draft_layer *layers;
    uint32_t n;
    aset_real left; /* of the ray, uncovered: 0 where nothing behind matters */
} draft_cover;

/*
 * What a ray of unit direction meets at 0 < t < t_max, in order, into the layers. What is left of it goes on behind t_max or leaves
 * the box.
 */
draft_cover aset_draft_layers(draft_layer layers[DRAFT_LAYERS_MAX], const aset_draft *draft, draft_mode mode, aset_vec3 origin,
                              aset_vec3 direction, aset_real t_max, draft_counts *counts);

/*
 * For a ray that has met what it does of facets' planes before t_max. Mostly through a seam between two footprints it came
 * - to the inside of a surface, where the first layer faces away: what one of four rays close beside it meets well before is the one
 *   layer instead,
 * - past a facet that covers a part of it, with some of it left: what two rays close beside it, to opposite sides, cover both is covered,
 *   if that is more, by what the second of them meets,
 * if that faces the ray. Where windings are turned, or mixed, it rarely does, and nothing changes; nor does it where voxels hold many
 * small things, which all have insides and gaps between them.
 */
void aset_draft_close_seam(draft_cover *met, const aset_draft *draft, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                           draft_counts *counts);

/*
 * Whether anything stops a shadow ray: facets that face the origin, and others beyond the origin's own surroundings, but for
 * the voxel that it starts in. No marked voxel lies behind t_last: there the walk ends.
 */
bool aset_draft_blocks(const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                       aset_real t_last, draft_counts *counts);

/*
 * A ray on one axis, in columns. Turned so that it goes up: from is -o where d is below 0, which is exact, rise |d|, and inverse 1 / |d|,
 * the largest number where the ray stands still (d may be -0), so that its next crossing is never near. What beams and single rays
 * must agree on.
 */
typedef struct draft_axis {
    aset_real o, d, from, rise, inverse;
    bool turned;
} draft_axis;

static inline draft_axis draft_axis_of(aset_real low, aset_real per_size, aset_real origin, aset_real direction) {
    draft_axis x;
    x.o = (origin - low) * per_size;
    x.d = direction * per_size;
    x.turned = x.d < 0;
    x.from = x.turned ? -x.o : x.o;
    x.rise = real_abs(x.d);
    x.inverse = 1 / x.rise;
    x.inverse = x.inverse < REAL_MAX ? x.inverse : REAL_MAX;
    return x;
}

/* From so far on the rounding of o + t d would be seen: such rays are brought near first. */
static inline aset_real draft_far(const aset_draft *draft) {
    return R(64) * draft->column * (aset_real)(int32_t)(4 * (draft->n[0] + draft->n[1] + draft->n[2]));
}

/* How far from the surface, along its normal, rays start that are to meet the draft; shadow rays a third of that (trace/shade.h). */
aset_real aset_draft_clearance(const aset_draft *draft);

#endif
#endif
