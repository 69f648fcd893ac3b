/*
 * draft_walk.h - the way of a ray through a draft: in blocks of 4 x 4 x 4 voxels that are not empty from voxel to voxel, in those
 * that are marked the facets; through an empty block, of which nothing but its bit in the map is looked at, at once. It is the walk
 * of Amanatides and Woo (1987), which ends after as many steps as there are slices to cross.
 *
 * Everything is in columns here (facet.h), t excepted, which stays in the scene's lengths: the ray is o + t d with o and d
 * divided by a column's size. For single rays (draft_ray.c) and for shadow rays side by side (draft_shadows.c).
 */
#ifndef ASET_APPROX_DRAFT_WALK_H
#define ASET_APPROX_DRAFT_WALK_H

#include "approx/draft_cover.h"

#if ASET_WITH_DRAFTS

#define OWN_DISTANCE R(4)     /* a shadow ray passes facets that face away so near to its origin: they are its own surface's */

/* Columns of a voxel. */
#define VOXEL R(4)

typedef struct way {
    const aset_draft *draft;
    aset_real o[3], d[3];
    /* The same turned so that it goes up on every axis: the walks know no other rays. */
    aset_real from[3], rise[3], inverse[3];
    bool turned[3];
    aset_real t_max, t_own;
    aset_real t_last; /* no voxel is looked at that the ray enters behind it */
    aset_real moved; /* the ray's own t is so much larger */
    draft_mode mode;
    bool any;
    draft_cover cover;
    draft_counts counts;
} way;

/* The ray against one facet of the voxel that it sees from q, its origin from the voxel's middle. */
static inline bool meet(const way *w, const aset_real q[3], uint32_t number, aset_real t_min, draft_meeting *m) {
    const facet f = facet_read(w->draft, number);
    unsigned a = (unsigned)f.axis, u = facet_next(a), v = facet_next(u);
    aset_real rate = w->d[a] - f.slope_u * w->d[u] - f.slope_v * w->d[v];
    aset_real t = (f.height - 2 + f.slope_u * q[u] + f.slope_v * q[v] - q[a]) / rate;
    aset_real ha = q[a] + t * w->d[a], hu = q[u] + t * w->d[u], hv = q[v] + t * w->d[v];
    aset_real beside = real_max(real_abs(hu), real_abs(hv)), above = real_abs(ha);
    bool in_voxel = (beside <= 2 + BEYOND_SIDES) & (above <= 2 + BEYOND_HEIGHT) & (t > t_min) & (t < w->t_max);
    if (!in_voxel) { /* rate may be 0: t is infinite then, or not a number, and nothing holds */
        return false;
    }
    m->t = t;
    m->u = hu + 2;
    m->v = hv + 2;
    m->facet = number;
    m->footprint = (uint16_t)f.footprint;
    m->away = (rate > 0) != f.down;
    return true;
}

/* Is it in a shadow ray's way? Its own surface stops no ray. */
static inline bool stops(const way *w, const draft_meeting *m) {
    return (!m->away || m->t > w->t_own) && draft_bit_at(m->footprint, (int)m->u, (int)m->v);
}

/* The facets of one voxel, first to end, nearest first. True: nothing behind matters any more. */
static bool visit_planes(way *w, const aset_real q[3], uint32_t first, uint32_t end) {
    draft_meeting found[DRAFT_FACETS_MAX];
    uint32_t n = 0;
    aset_real t_min = draft_cover_end(&w->cover);
    for (uint32_t i = first; i < end; i++) {
        draft_meeting m;
        if (!meet(w, q, i, t_min, &m)) {
            continue;
        }
        if (!w->any) {
            draft_meeting_insert(found, n++, &m);
        } else if (stops(w, &m)) {
            return true;
        }
    }
    return n > 0 && aset_draft_cover_add(&w->cover, found, n);
}

/* The voxel itself is the hit, with the facet that faces the ray most. */
static bool visit_side(way *w, aset_real t, int axis, uint32_t first, uint32_t end) {
    draft_meeting m = {t, 2, 2, first, 0xffffu, false};
    aset_real best = REAL_INFINITY;
    if (!(t > 0 && t < w->t_max) || axis < 0) { /* nor is there a side where a ray starts */
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
    aset_draft_cover_add(&w->cover, &m, 1);
    w->cover.layers[0].face = axis * 2 + w->turned[axis];
    return true;
}

/*
 * Where a walk is on one axis. A plane's t is always computed from the plane alone, and at equal t the lower axis crosses first: so
 * a ray's way is one fixed chain of cells, wherever on it a walk begins. Fields and no arrays, so that they can live in
 * registers.
 */
typedef struct lane {
    aset_real next, plane;   /* the voxel's far side, and t there */
    aset_real from, inverse; /* the way's */
    int32_t at, add;         /* the voxel, not turned, and what a crossing adds */
    int32_t left;            /* voxels to the box's end; the box is of whole blocks, so the lowest two bits: to the block's */
} lane;

typedef struct lanes {
    lane x, y, z;
} lanes;

/* Where a walk begins: t, and the axis of the last crossing there, -1 for all that are at t. */
typedef struct entry {
    aset_real t;
    int axis;
} entry;

static inline bool entry_is_behind(const entry *e, int a, aset_real t) {
    return t < e->t || (t == e->t && (e->axis < 0 || a <= e->axis));
}

/* The voxel of the place at t, but for rounding: which side of a plane it is on its crossing decides. */
static inline void lane_start(lane *l, const way *w, int a, const entry *e) {
    int32_t count = (int32_t)w->draft->blocks[a] * 4;
    aset_real corner = w->turned[a] ? (aset_real)(-4 * count) : 0;
    aset_real x = (w->from[a] + e->t * w->rise[a] - corner) * (1 / VOXEL), last = (aset_real)(count - 1);
    int32_t k = x > 0 ? (int32_t)(x < last ? x : last) : 0;
    l->from = w->from[a];
    l->inverse = w->inverse[a];
    l->plane = corner + (aset_real)(k + 1) * VOXEL;
    l->next = (l->plane - l->from) * l->inverse;
    while (k < count - 1 && entry_is_behind(e, a, l->next)) {
        k++;
        l->plane += VOXEL;
        l->next = (l->plane - l->from) * l->inverse;
    }
    for (aset_real before; k > 0; k--, l->plane -= VOXEL, l->next = before) {
        before = (l->plane - VOXEL - l->from) * l->inverse;
        if (entry_is_behind(e, a, before)) {
            break;
        }
    }
    l->left = count - 1 - k;
    l->at = w->turned[a] ? l->left : k;
    l->add = w->turned[a] ? -1 : 1;
}

static inline void lanes_start(lanes *l, const way *w, const entry *e) {
    lane_start(&l->x, w, 0, e);
    lane_start(&l->y, w, 1, e);
    lane_start(&l->z, w, 2, e);
}

/* Into the next voxel. False: out of its block. */
static inline bool lane_cross(lane *l, aset_real *t) {
    *t = l->next;
    l->plane += VOXEL;
    l->next = (l->plane - l->from) * l->inverse;
    l->at += l->add;
    return (l->left-- & 3) != 0;
}

static inline bool lanes_step(lanes *l, entry *e) {
    if (l->x.next <= l->y.next) {
        if (l->x.next <= l->z.next) {
            e->axis = 0;
            return lane_cross(&l->x, &e->t);
        }
    } else if (l->y.next <= l->z.next) {
        e->axis = 1;
        return lane_cross(&l->y, &e->t);
    }
    e->axis = 2;
    return lane_cross(&l->z, &e->t);
}

/* Where the ray leaves the block. */
static inline aset_real lane_block_end(const lane *l) {
    return (l->plane + (aset_real)(l->left & 3) * VOXEL - l->from) * l->inverse;
}

/* Into the next block, at t. On the other axes a lane stays in whatever voxel of the block it was. */
static inline void lane_cross_block(lane *l) {
    int32_t voxels = (l->left & 3) + 1;
    l->plane += (aset_real)voxels * VOXEL;
    l->at += voxels * l->add;
    l->left -= voxels;
}

static inline void lanes_leave_block(lanes *l, entry *e) {
    aset_real x = lane_block_end(&l->x), y = lane_block_end(&l->y), z = lane_block_end(&l->z);
    if (x <= y && x <= z) {
        e->t = x;
        e->axis = 0;
        lane_cross_block(&l->x);
    } else if (y < x && y <= z) {
        e->t = y;
        e->axis = 1;
        lane_cross_block(&l->y);
    } else {
        e->t = z;
        e->axis = 2;
        lane_cross_block(&l->z);
    }
}

static inline bool lanes_inside(const lanes *l) {
    return (l->x.left | l->y.left | l->z.left) >= 0;
}

/* The ray's origin from a voxel's middle on an axis whose lane is in the voxel: planes are whole numbers, so it is exact. */
static inline aset_real from_middle(const way *w, int a, const lane *l) {
    aset_real q = l->from - (l->plane - VOXEL / 2);
    return w->turned[a] ? -q : q;
}

static bool visit_voxel(way *w, const lanes *l, uint32_t block, uint64_t marks, unsigned bit, const entry *e) {
    uint32_t first, end;
    if (w->any && e->axis < 0) { /* approximate rays ignore the cell that they start in (Dauenhauer and Semwal 1990) */
        return false;
    }
    w->counts.nonempty++;
    draft_find_facets(w->draft, block, bits_count(marks & ((UINT64_C(1) << bit) - 1)), &first, &end);
    if (w->mode == DRAFT_PLANE) {
        const aset_real q[3] = {from_middle(w, 0, &l->x), from_middle(w, 1, &l->y), from_middle(w, 2, &l->z)};
        return visit_planes(w, q, first, end);
    }
    return visit_side(w, e->t, e->axis, first, end);
}

/* The voxels of one block that is not empty. True: nothing behind matters any more. */
static inline bool walk_block(way *w, lanes *l, entry *e, uint32_t block) {
    uint64_t marks = draft_marks(w->draft, block);
    bool inside;
    do {
        unsigned bit = ((unsigned)l->x.at & 3u) | ((unsigned)l->y.at & 3u) << 2 | ((unsigned)l->z.at & 3u) << 4;
        w->counts.cells++;
        if ((marks >> bit & 1u) != 0 && visit_voxel(w, l, block, marks, bit, e)) {
            return true;
        }
        inside = lanes_step(l, e);
    } while (inside && e->t < w->t_last);
    return false;
}

/* Where the ray begins in the box; false if nowhere. */
static inline bool clip(const way *w, entry *e) {
    aset_real t_out = REAL_INFINITY;
    int first_out = 3;
    bool within = true;
    e->t = 0;
    e->axis = -1;
    for (int a = 0; a < 3; a++) {
        within = within & (w->o[a] >= 0) & (w->o[a] <= (aset_real)(int32_t)w->draft->n[a] * VOXEL);
    }
    if (within) {
        return w->t_last > 0;
    }
    for (int a = 0; a < 3; a++) {
        aset_real side = (aset_real)(int32_t)w->draft->n[a] * VOXEL, low = w->turned[a] ? -side : 0;
        aset_real in = (low - w->from[a]) * w->inverse[a], out = (low + side - w->from[a]) * w->inverse[a];
        if (in > e->t || (in == e->t && e->axis >= 0)) {
            e->t = in;
            e->axis = a;
        }
        if (out < t_out) {
            t_out = out;
            first_out = a;
        }
    }
    /* As in the chain of all planes (beams meet them so): of planes crossed at one t, those of the lower axis come first. */
    bool before_out = e->t < t_out || (e->t == t_out && e->axis <= first_out);
    return before_out && e->t < w->t_last;
}

/* Brings a ray that comes from far away near the box, and clips it again: what is left of it is short. */
static bool clip_near(way *w, entry *e) {
    aset_real far = draft_far(w->draft);
    bool meets = clip(w, e);
    for (int i = 0; i < 3 && meets && e->t > far; i++) {
        aset_real step = e->t - far / 64;
        for (int a = 0; a < 3; a++) {
            w->o[a] += step * w->d[a];
            w->from[a] = w->turned[a] ? -w->o[a] : w->o[a];
        }
        w->moved += step;
        w->t_max -= step;
        w->t_last -= step;
        meets = clip(w, e);
    }
    return meets;
}

/* On from where the lanes are. True: nothing behind matters any more. */
static inline bool walk(way *w, lanes *l, entry *e) {
    const aset_draft *draft = w->draft;
    const uint32_t nx = draft->blocks[0], ny = draft->blocks[1];
    const uint32_t *map = draft->map;
    bool placed = true; /* the lanes are where the ray is, not only in its block */
    do {
        uint32_t i = ((uint32_t)l->z.at / 4 * ny + (uint32_t)l->y.at / 4) * nx + (uint32_t)l->x.at / 4;
        uint32_t word = map[i >> 5], bit = UINT32_C(1) << (i & 31u);
        if ((word & bit) == 0) {
            w->counts.cells++;
            lanes_leave_block(l, e);
            placed = false;
            continue;
        }
        if (!placed) {
            lanes_start(l, w, e);
            placed = true;
        }
        if (walk_block(w, l, e, draft->rank[i >> 5] + bits_count(word & (bit - 1)))) {
            return true;
        }
    } while (lanes_inside(l) && e->t < w->t_last);
    return false;
}

/* All but the ray itself: o, d, from, rise, inverse and turned. Without layers it is a shadow ray. */
static inline void way_make(way *w, const aset_draft *draft, draft_mode mode, aset_real t_max, aset_real t_last,
                            draft_layer *layers) {
    w->draft = draft;
    w->mode = mode;
    w->t_max = t_max;
    w->t_last = real_min(t_last, t_max);
    w->moved = 0;
    w->t_own = mode == DRAFT_PLANE ? OWN_DISTANCE * draft->column : 0;
    w->any = layers == NULL;
    w->cover = draft_cover_of(layers);
}

/* From the ray's origin on. */
static bool go(way *w) {
    entry e;
    lanes l;
    if (w->draft->n_facets == 0 || !clip_near(w, &e)) {
        return false;
    }
    lanes_start(&l, w, &e);
    return walk(w, &l, &e);
}

#endif
#endif
