/* draft_ray.c - single rays through a draft. */
#include "approx/draft_walk.h"

#if ASET_WITH_DRAFTS

#define CLEARANCE R(0.3)
#define SEAM_BESIDE R(0.4) /* so far, on two axes, from a ray that came through a seam lie those that may not have, */
#define SEAM_DEPTH R(4)    /* if what they meet lies so far before: what is nearer may be the same wall, wound the other way */

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

/* A ray from its origin on; the rest as way_make takes it. */
static bool send(way *w, const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max, aset_real t_last,
                 draft_layer *layers, draft_counts *counts) {
    way_make(w, draft, mode, t_max, t_last, layers);
    way_set(w, origin, direction);
    bool done = go(w);
    *counts = w->counts;
    return done;
}

uint32_t aset_draft_layers(draft_layer layers[DRAFT_LAYERS_MAX], const aset_draft *draft, draft_mode mode, aset_vec3 origin,
                           aset_vec3 direction, aset_real t_max, draft_counts *counts) {
    way w;
    (void)send(&w, draft, mode, origin, direction, t_max, t_max, layers, counts);
    for (uint32_t i = 0; i < w.cover.n; i++) {
        layers[i].t += w.moved;
    }
    return w.cover.n;
}

uint32_t aset_draft_close_seam(draft_layer layers[DRAFT_LAYERS_MAX], uint32_t n, const aset_draft *draft, aset_vec3 origin,
                               aset_vec3 direction, draft_counts *counts) {
    aset_real t_max = n > 0 ? layers[0].t - SEAM_DEPTH * draft->column : 0;
    if (!draft->closes_seams || !(t_max > 0) || layers[0].face == 0) {
        return n;
    }
    const aset_real d[3] = {real_abs(direction.x), real_abs(direction.y), real_abs(direction.z)};
    int longest = d[1] > d[0], side = 1;
    longest = d[2] > d[longest] ? 2 : longest;
    for (; side >= -1; side -= 2) {
        aset_real o[3] = {origin.x, origin.y, origin.z};
        draft_layer met[DRAFT_LAYERS_MAX];
        draft_counts more;
        for (int a = 0; a < 3; a++) {
            o[a] += a != longest ? (aset_real)side * SEAM_BESIDE * draft->size[a] : 0;
        }
        uint32_t n_met = aset_draft_layers(met, draft, DRAFT_PLANE, vec(o[0], o[1], o[2]), direction, t_max, &more);
        counts->cells += more.cells;
        counts->nonempty += more.nonempty;
        if (n_met > 0 && met[0].face == 0) {
            layers[0] = met[0];
            layers[0].cover = 1;
            return 1;
        }
    }
    return n;
}

bool aset_draft_blocks(const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                       aset_real t_last, draft_counts *counts) {
    way w;
    return send(&w, draft, mode, origin, direction, t_max, t_last, NULL, counts);
}

#endif
