/* draft_ray.c - single rays through a draft. */
#include "approx/draft_walk.h"

#if ASET_WITH_DRAFTS

#define CLEARANCE R(0.3)
#define SEAM_BESIDE R(0.4) /* so far, on two axes, from a ray that came through a seam lie those that may not have; */
#define SEAM_DEPTH R(4)    /* inside of a surface, what they meet lies so far before: nearer it may be the same wall, wound the other way */

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
    way_set_axis(w, 0, origin.x, direction.x);
    way_set_axis(w, 1, origin.y, direction.y);
    way_set_axis(w, 2, origin.z, direction.z);
}

/* A ray from its origin on; the rest as way_make takes it, but that the counts grow. */
static bool send(way *w, const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max, aset_real t_last,
                 draft_layer *layers, draft_counts *counts) {
    way_make(w, draft, mode, t_max, t_last, layers);
    w->counts = *counts;
    way_set(w, origin, direction);
    bool done = go(w);
    *counts = w->counts;
    for (uint32_t i = 0; i < w->cover.n; i++) {
        layers[i].t += w->moved;
    }
    return done;
}

draft_cover aset_draft_layers(draft_layer layers[DRAFT_LAYERS_MAX], const aset_draft *draft, draft_mode mode, aset_vec3 origin,
                              aset_vec3 direction, aset_real t_max, draft_counts *counts) {
    way w;
    (void)send(&w, draft, mode, origin, direction, t_max, t_max, layers, counts);
    return w.cover;
}

void aset_draft_close_seam(draft_cover *met, const aset_draft *draft, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                           draft_counts *counts) {
    bool is_inside = met->n > 0 && met->layers[0].face != 0;
    aset_real left_here = met->left; /* less must be left beside */
    if (is_inside) {
        t_max = met->layers[0].t - SEAM_DEPTH * draft->column;
        left_here = t_max > 0 ? 1 : 0;
    }
    if (!draft->closes_seams || met->n == 0 || !(left_here > 0)) {
        return;
    }
    const aset_real d[3] = {real_abs(direction.x), real_abs(direction.y), real_abs(direction.z)};
    int longest = d[1] > d[0];
    longest = d[2] > d[longest] ? 2 : longest;
    aset_real beside[3], left = 0;
    for (int a = 0; a < 3; a++) {
        beside[a] = a != longest ? SEAM_BESIDE * draft->size[a] : 0;
    }
    for (int i = 0; i < 4; i++) { /* two rays to opposite sides, and two more across */
        draft_layer layers[DRAFT_LAYERS_MAX];
        bool is_second = (i & 1) != 0;
        aset_vec3 step = {beside[0], beside[1], beside[2]};
        aset_vec3 from = is_second ? vec_sub(origin, step) : vec_add(origin, step);
        draft_cover other = aset_draft_layers(layers, draft, DRAFT_PLANE, from, direction, t_max, counts);
        aset_real left_there = other.n == 0 || layers[0].face != 0 ? 1 : is_inside ? 0 : other.left;
        left = is_second && !is_inside ? real_max(left, left_there) : left_there;
        bool serves = left < left_here;
        if (serves && (is_second || is_inside)) {
            layers[0].cover = 1 - left;
            met->layers[0] = layers[0];
            met->n = 1;
            met->left = left;
            return;
        }
        if (is_second || !(is_inside || serves)) { /* across; without the second, too, if it cannot make good what the first leaves */
            beside[longest == 0] *= -1;
            i |= 1;
        }
    }
}

bool aset_draft_blocks(const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                       aset_real t_last, draft_counts *counts) {
    way w;
    return send(&w, draft, mode, origin, direction, t_max, t_last, NULL, counts);
}

#endif
