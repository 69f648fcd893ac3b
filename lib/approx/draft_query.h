/* draft_query.h - what a draft answers, in parts: for single rays (draft_query.c) and for beams (trace/beam.c). */
#ifndef ASET_APPROX_DRAFT_QUERY_H
#define ASET_APPROX_DRAFT_QUERY_H

#include "approx/draft_ray.h"
#include "space/answers.h"

#if ASET_WITH_DRAFTS

/* The t of the nearest of the objects that the draft keeps exact, in *hit; t_max if there is none before it. */
aset_real aset_draft_query_kept(query_hit *hit, const aset_draft *draft, aset_vec3 origin, aset_vec3 direction,
                                aset_real t_max, aset_statistics *statistics);

/* The layers that a ray met, and behind them the kept object if there is one (NULL: none), as hits. How many. */
uint32_t aset_draft_query_layers(query_hit *hits, const draft_cover *met, aset_vec3 origin, const query_hit *kept);

#endif
#endif
