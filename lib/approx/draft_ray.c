/* draft_ray.c - single rays through a draft. */
#include "approx/draft_walk.h"

#if ASET_WITH_DRAFTS

#define CLEARANCE R(0.3)

aset_real aset_draft_clearance(const aset_draft *draft) {
    return CLEARANCE * draft->column;
}

static inline void way_set_axis(way *w, int a, aset_real origin, aset_real direction) {
    draft_axis x = draft_axis_of(w->draft->low[a], w->draft->per_size[a], origin, direction);
    w->o[a] = x.o;
    w->d[a] = x.d;
    w->turned[a] = x.turned;
    w->from[a] = x.from;
    w->rise[a] = x.rise;
    w->inverse[a] = x.inverse;
}

static inline void way_set(way *w, aset_vec3 origin, aset_vec3 direction) {
    w->counts.cells = w->counts.nonempty = 0;
    way_set_axis(w, 0, origin.x, direction.x);
    way_set_axis(w, 1, origin.y, direction.y);
    way_set_axis(w, 2, origin.z, direction.z);
}

uint32_t aset_draft_layers(draft_layer layers[DRAFT_LAYERS_MAX], const aset_draft *draft, draft_mode mode, aset_vec3 origin,
                           aset_vec3 direction, aset_real t_max, draft_counts *counts) {
    way w;
    way_make(&w, draft, mode, t_max, t_max, layers);
    way_set(&w, origin, direction);
    (void)go(&w);
    for (uint32_t i = 0; i < w.cover.n; i++) {
        layers[i].t += w.moved;
    }
    *counts = w.counts;
    return w.cover.n;
}

bool aset_draft_blocks(const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                       aset_real t_last, draft_counts *counts) {
    way w;
    way_make(&w, draft, mode, t_max, t_last, NULL);
    way_set(&w, origin, direction);
    bool blocked = go(&w);
    *counts = w.counts;
    return blocked;
}

#endif
