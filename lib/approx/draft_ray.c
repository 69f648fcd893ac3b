/*
 * draft_ray.c - the way of a ray through a draft: blocks of 4 x 4 x 4 voxels, in those that are not empty the voxels, in those
 * that are marked the facets. Two nested walks of the same kind (Amanatides and Woo 1987), each crossing computed from its
 * slice's number; of an empty block nothing but its bit in the map is looked at. A walk ends after as many steps as there are
 * slices to cross.
 *
 * Everything is in columns here (facet.h), t excepted, which stays in the scene's lengths: the ray is o + t d with o and d
 * divided by a column's size.
 *
 * The tolerances, all in columns, were chosen on bunny, gears, mount and tetra (docs/drafts.md):
 */
#include "approx/draft_ray.h"

#if ASET_WITH_DRAFTS

#define BEYOND_SIDES R(0.25)  /* a facet's plane is met so far beside its voxel, */
#define BEYOND_HEIGHT R(0.5)  /* and so far above or below it: neighbours' planes do not meet exactly */
#define SOFTNESS R(2)         /* how steeply cover falls across a footprint's edge, per column */
#define SOFT_BIAS R(0.2)      /* and how much more than half of it lies outside: closes the seams between footprints */
#define COVER_LEAST R(0.03)   /* less cover is none, */
#define COVER_MOST R(0.97)    /* more is all */
#define OWN_DISTANCE R(4)     /* a shadow ray passes facets that face away so near to its origin: they are its own surface's */
#define CLEARANCE R(0.3)

typedef struct way {
    const aset_draft *draft;
    aset_real o[3], d[3], inverse[3]; /* inverse: 0 where the ray stands still */
    aset_real t_max, t_own;
    int step[3];
    draft_mode mode;
    bool any;
    draft_layer *layers;
    uint32_t n;
    aset_real left; /* of the ray, uncovered */
    draft_counts counts;
} way;

aset_real draft_clearance(const aset_draft *draft) {
    return CLEARANCE * draft->column;
}

/* One facet's answer. */
typedef struct meeting {
    aset_real t, cover;
    uint32_t facet;
    bool away; /* it faces away from the ray's origin */
} meeting;

static aset_real bit_at(uint32_t footprint, int i, int j) {
    i = i < 0 ? 0 : i > 3 ? 3 : i;
    j = j < 0 ? 0 : j > 3 ? 3 : j;
    return (aset_real)(footprint >> (i + 4 * j) & 1u);
}

/* How much of a ray through (u, v) the footprint stops: its columns interpolated, so that edges are soft. */
static aset_real soft_cover(uint32_t footprint, aset_real u, aset_real v) {
    if (footprint == 0xffffu) {
        return 1;
    }
    aset_real x = u - R(0.5), y = v - R(0.5);
    int i = (int)(x + 1) - 1, j = (int)(y + 1) - 1; /* floor: both are above -1 */
    aset_real a = x - (aset_real)i, b = y - (aset_real)j;
    aset_real mean = (1 - b) * ((1 - a) * bit_at(footprint, i, j) + a * bit_at(footprint, i + 1, j)) +
                     b * ((1 - a) * bit_at(footprint, i, j + 1) + a * bit_at(footprint, i + 1, j + 1));
    aset_real cover = (mean - R(0.5)) * SOFTNESS + R(0.5) + SOFT_BIAS;
    return cover < COVER_LEAST ? 0 : cover > COVER_MOST ? 1 : cover;
}

/* The ray against one facet of the voxel whose corner lies at base. */
static bool meet(const way *w, const aset_real base[3], uint32_t number, aset_real t_min, meeting *m) {
    static const int next[3] = {1, 2, 0};
    facet f = facet_read(w->draft, number);
    int a = f.axis, u = next[a], v = next[u];
    aset_real qa = w->o[a] - base[a], qu = w->o[u] - base[u], qv = w->o[v] - base[v];
    aset_real rate = w->d[a] - f.slope_u * w->d[u] - f.slope_v * w->d[v];
    aset_real t = (f.height + f.slope_u * (qu - 2) + f.slope_v * (qv - 2) - qa) / rate;
    if (!(t > t_min && t < w->t_max)) { /* rate may be 0: t is infinite then, or not a number */
        return false;
    }
    aset_real ha = qa + t * w->d[a], hu = qu + t * w->d[u], hv = qv + t * w->d[v];
    if (!(hu >= -BEYOND_SIDES && hu <= 4 + BEYOND_SIDES && hv >= -BEYOND_SIDES && hv <= 4 + BEYOND_SIDES &&
          ha >= -BEYOND_HEIGHT && ha <= 4 + BEYOND_HEIGHT)) {
        return false;
    }
    m->t = t;
    m->facet = number;
    m->away = (rate > 0) != f.down;
    m->cover = w->any ? bit_at(f.footprint, (int)hu, (int)hv) : soft_cover(f.footprint, hu, hv);
    return m->cover > 0;
}

static void add_layer(way *w, const meeting *m, int face) {
    draft_layer *layer = w->layers + w->n++;
    layer->t = m->t;
    layer->facet = m->facet;
    layer->face = face;
    layer->cover = w->left * m->cover;
    w->left -= layer->cover;
    if (w->n == DRAFT_LAYERS_MAX || w->left < COVER_LEAST) {
        layer->cover += w->left;
        w->left = 0;
    }
}

/* The facets of one voxel, first to end, nearest first. True: nothing behind matters any more. */
static bool visit_planes(way *w, const aset_real base[3], uint32_t first, uint32_t end) {
    meeting found[6];
    uint32_t n = 0;
    aset_real t_min = w->n > 0 ? w->layers[w->n - 1].t : 0;
    for (uint32_t i = first; i < end; i++) {
        meeting m;
        if (!meet(w, base, i, t_min, &m)) {
            continue;
        }
        if (w->any) {
            if (!m.away || m.t > w->t_own) {
                return true;
            }
            continue;
        }
        uint32_t k = n++;
        for (; k > 0 && found[k - 1].t > m.t; k--) {
            found[k] = found[k - 1];
        }
        found[k] = m;
    }
    for (uint32_t i = 0; i < n; i++) {
        if (w->n > 0 && found[i].away) { /* the surface's inside: the ray came through a seam, not past an edge */
            w->layers[w->n - 1].cover += w->left;
            w->left = 0;
        } else {
            add_layer(w, &found[i], 0);
        }
        if (!(w->left > 0)) {
            return true;
        }
    }
    return false;
}

/* The voxel itself is the hit, with the facet that faces the ray most. */
static bool visit_side(way *w, aset_real t, int axis, uint32_t first, uint32_t end) {
    meeting m = {t, 1, first, false};
    aset_real best = REAL_INFINITY;
    if (!(t > 0 && t < w->t_max) || axis < 0) { /* approximate rays ignore the cell that they start in */
        return false;
    }
    if (w->any) {
        return t > w->t_own;
    }
    for (uint32_t i = first; i < end; i++) {
        facet f = facet_read(w->draft, i);
        aset_vec3 n = facet_normal(w->draft, &f);
        aset_real facing = n.x * w->d[0] * w->draft->size[0] + n.y * w->d[1] * w->draft->size[1] + n.z * w->d[2] * w->draft->size[2];
        if (facing < best) {
            best = facing;
            m.facet = i;
        }
    }
    add_layer(w, &m, axis * 2 + (w->step[axis] < 0));
    return true;
}

/* The facets of the k-th marked voxel of a block, counted from 0. */
static void find_facets(const aset_draft *draft, uint32_t block, unsigned k, uint32_t *first, uint32_t *end) {
    uint32_t at = draft->first[block], word = at >> 5;
    uint32_t bits = draft->starts[word] & 0xffffffffu << (at & 31u);
    for (unsigned n; k >= (n = bits_count(bits)); bits = draft->starts[++word]) {
        k -= n;
    }
    for (; k > 0; k--) {
        bits &= bits - 1;
    }
    *first = word * 32 + bits_lowest(bits);
    bits &= bits - 1;
    while (bits == 0) {
        bits = draft->starts[++word]; /* there is a bit behind the last facet's */
    }
    *end = word * 32 + bits_lowest(bits);
}

/* One of the two nested walks: cells of a width in columns, in a box of count cells whose corner is at corner columns. */
typedef struct grid_walk {
    int at[3], end[3];
    aset_real next[3];
} grid_walk;

static void walk_start(grid_walk *g, const way *w, aset_real t, const aset_real corner[3], aset_real width, const int count[3]) {
    for (int a = 0; a < 3; a++) {
        aset_real x = (w->o[a] + t * w->d[a] - corner[a]) / width;
        int k = !(x > 0) ? 0 : x >= (aset_real)count[a] ? count[a] - 1 : (int)x;
        g->at[a] = k;
        g->end[a] = w->step[a] > 0 ? count[a] : -1;
        g->next[a] = w->inverse[a] != 0 ? (corner[a] + (aset_real)(k + (w->step[a] > 0)) * width - w->o[a]) * w->inverse[a]
                                        : REAL_INFINITY;
    }
}

/* Crosses into the next cell; the axis, or -1 if the ray leaves the box or the interesting part of the ray. */
static inline int walk_step(grid_walk *g, const way *w, aset_real *t, const aset_real corner[3], aset_real width) {
    int a = g->next[0] <= g->next[1] ? (g->next[0] <= g->next[2] ? 0 : 2) : (g->next[1] <= g->next[2] ? 1 : 2);
    *t = g->next[a];
    g->at[a] += w->step[a];
    if (g->at[a] == g->end[a] || !(*t < w->t_max)) {
        return -1;
    }
    g->next[a] = (corner[a] + (aset_real)(g->at[a] + (w->step[a] > 0)) * width - w->o[a]) * w->inverse[a];
    return a;
}

static bool walk_block(way *w, uint32_t block, aset_real t, int axis, const int at[3]) {
    static const int four[3] = {4, 4, 4};
    const aset_draft *draft = w->draft;
    uint64_t marks = (uint64_t)draft->marks[2 * block] | (uint64_t)draft->marks[2 * block + 1] << 32;
    aset_real corner[3] = {(aset_real)at[0] * 16, (aset_real)at[1] * 16, (aset_real)at[2] * 16};
    grid_walk g;
    walk_start(&g, w, t, corner, 4, four);
    do {
        unsigned bit = (unsigned)(g.at[0] + 4 * g.at[1] + 16 * g.at[2]);
        w->counts.cells++;
        if ((marks >> bit & 1u) != 0) {
            aset_real base[3] = {corner[0] + (aset_real)g.at[0] * 4, corner[1] + (aset_real)g.at[1] * 4,
                                 corner[2] + (aset_real)g.at[2] * 4};
            uint32_t first, end;
            w->counts.nonempty++;
            find_facets(draft, block, bits_count(marks & ((UINT64_C(1) << bit) - 1)), &first, &end);
            if (w->mode == DRAFT_PLANE ? visit_planes(w, base, first, end) : visit_side(w, t, axis, first, end)) {
                return true;
            }
        }
        axis = walk_step(&g, w, &t, corner, 4);
    } while (axis >= 0);
    return false;
}

/* The part of the ray that lies in the box; false if there is none. *axis: of entry, -1 if it starts inside. */
static bool clip(const way *w, aset_real *t_in, int *axis) {
    aset_real t_out = w->t_max;
    *t_in = 0;
    *axis = -1;
    for (int a = 0; a < 3; a++) {
        aset_real side = (aset_real)w->draft->n[a] * 4;
        if (w->inverse[a] == 0) {
            if (!(w->o[a] >= 0 && w->o[a] <= side)) {
                return false;
            }
            continue;
        }
        aset_real low = -w->o[a] * w->inverse[a], high = (side - w->o[a]) * w->inverse[a];
        aset_real in = real_min(low, high), out = real_max(low, high);
        if (in > *t_in) {
            *t_in = in;
            *axis = a;
        }
        t_out = real_min(t_out, out);
    }
    return *t_in <= t_out;
}

static bool go(way *w) {
    const aset_draft *draft = w->draft;
    static const aset_real zero[3] = {0, 0, 0};
    const int count[3] = {(int)draft->blocks[0], (int)draft->blocks[1], (int)draft->blocks[2]};
    aset_real t;
    int axis;
    grid_walk g;
    if (draft->n_facets == 0 || !clip(w, &t, &axis)) {
        return false;
    }
    walk_start(&g, w, t, zero, 16, count);
    for (;;) {
        uint32_t i = ((uint32_t)g.at[2] * draft->blocks[1] + (uint32_t)g.at[1]) * draft->blocks[0] + (uint32_t)g.at[0];
        uint32_t word = draft->map[i >> 5], bit = UINT32_C(1) << (i & 31u);
        if ((word & bit) != 0) {
            if (walk_block(w, draft->rank[i >> 5] + bits_count(word & (bit - 1)), t, axis, g.at)) {
                return true;
            }
        } else {
            w->counts.cells++;
        }
        axis = walk_step(&g, w, &t, zero, 16);
        if (axis < 0) {
            return false;
        }
    }
}

static void way_make(way *w, const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                     draft_layer *layers) {
    w->draft = draft;
    w->mode = mode;
    w->t_max = t_max;
    w->t_own = mode == DRAFT_PLANE ? OWN_DISTANCE * draft->column : 0;
    w->any = layers == NULL;
    w->layers = layers;
    w->n = 0;
    w->left = 1;
    w->counts.cells = w->counts.nonempty = 0;
    for (int a = 0; a < 3; a++) {
        aset_real inverse;
        w->o[a] = (vec_at(&origin, a) - draft->low[a]) * draft->per_size[a];
        w->d[a] = vec_at(&direction, a) * draft->per_size[a];
        inverse = 1 / w->d[a];
        w->step[a] = w->d[a] < 0 ? -1 : 1;
        w->inverse[a] = real_finite(inverse) ? inverse : 0;
    }
}

uint32_t draft_layers(draft_layer layers[DRAFT_LAYERS_MAX], const aset_draft *draft, draft_mode mode, aset_vec3 origin,
                      aset_vec3 direction, aset_real t_max, draft_counts *counts) {
    way w;
    way_make(&w, draft, mode, origin, direction, t_max, layers);
    (void)go(&w);
    *counts = w.counts;
    return w.n;
}

bool draft_blocks(const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                  draft_counts *counts) {
    way w;
    way_make(&w, draft, mode, origin, direction, t_max, NULL);
    bool blocked = go(&w);
    *counts = w.counts;
    return blocked;
}

#endif
