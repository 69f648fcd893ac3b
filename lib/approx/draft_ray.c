/*
 * draft_ray.c - the way of a ray through a draft: blocks of 4 x 4 x 4 voxels, in those that are not empty the voxels, in those
 * that are marked the facets. Two nested walks of the same kind (Amanatides and Woo 1987), the crossings
 * of an axis t apart by a constant; of an empty block nothing but its bit in the map is looked at. A walk ends after as many steps as there are
 * slices to cross.
 *
 * Everything is in columns here (facet.h), t excepted, which stays in the scene's lengths: the ray is o + t d with o and d
 * divided by a column's size.
 */
#include "approx/draft_ray.h"

#include "approx/draft_cover.h"

#if ASET_WITH_DRAFTS

#define OWN_DISTANCE R(4)     /* a shadow ray passes facets that face away so near to its origin: they are its own surface's */
#define CLEARANCE R(0.3)

/* Columns of a voxel and of a block. */
#define VOXEL R(4)
#define BLOCK R(16)

typedef struct way {
    const aset_draft *draft;
    aset_real o[3], d[3];
    /*
     * The same turned so that it goes up on every axis: the walks know no other rays. -x for x where d is below 0, which is exact;
     * inverse: 1 / |d|, the largest number where the ray stands still, so that its next crossing is never near.
     */
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

aset_real aset_draft_clearance(const aset_draft *draft) {
    return CLEARANCE * draft->column;
}

/* The ray against one facet of the voxel that it sees from q, its origin from the voxel's middle. */
static inline bool meet(const way *w, const aset_real q[3], uint32_t number, aset_real t_min, draft_meeting *m) {
    static const unsigned char next[4] = {1, 2, 0, 0};
    uint64_t record = facet_record(w->draft, number);
    uint32_t surface = facet_surface(w->draft, record);
    aset_real height = facet_height(w->draft, record) - 2;
    aset_real slope_u = surface_slope_u(surface), slope_v = surface_slope_v(surface);
    unsigned a = surface_axis(surface), u = next[a], v = next[u];
    aset_real rate = w->d[a] - slope_u * w->d[u] - slope_v * w->d[v];
    aset_real t = (height + slope_u * q[u] + slope_v * q[v] - q[a]) / rate;
    aset_real ha = q[a] + t * w->d[a], hu = q[u] + t * w->d[u], hv = q[v] + t * w->d[v];
    bool in_voxel = (real_max(real_abs(hu), real_abs(hv)) <= 2 + BEYOND_SIDES) & (real_abs(ha) <= 2 + BEYOND_HEIGHT) &
                    (t > t_min) & (t < w->t_max);
    if (!in_voxel) { /* rate may be 0: t is infinite then, or not a number, and nothing holds */
        return false;
    }
    m->t = t;
    m->u = hu + 2;
    m->v = hv + 2;
    m->facet = number;
    m->footprint = (uint16_t)facet_footprint(w->draft, record);
    m->away = (rate > 0) != surface_down(surface);
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
    aset_draft_cover_add(&w->cover, &m, 1);
    w->cover.layers[0].face = axis * 2 + w->turned[axis];
    return true;
}

/*
 * One of the two nested walks, in a box of cells. For each axis: t of the next crossing and the plane that it is of, how many
 * cells are left before the box's end, what a crossing adds to the cell's number. A plane's t is always computed from the
 * plane alone, in both walks alike, and at equal t the lower axis crosses first: so a ray's way is one fixed chain of cells,
 * wherever on it a walk begins. Fields and no arrays, so that they can live in registers.
 */
typedef struct lane {
    aset_real next, plane;
    aset_real from, inverse; /* the way's */
    int32_t left, add;
} lane;

typedef struct lanes {
    lane x, y, z;
    int32_t cell;
} lanes;

/* Where a walk begins: t, and the axis of the last crossing there, -1 for all that are at t. */
typedef struct entry {
    aset_real t;
    int axis;
} entry;

static inline bool entry_is_behind(const entry *e, int a, aset_real t) {
    return t < e->t || (t == e->t && (e->axis < 0 || a <= e->axis));
}

/*
 * Axis a of a box of count cells whose corner (of the turned box) is at corner columns; stride: of the cells' numbers. The cell
 * is that of the place at t, but for rounding: which side of a plane it is on its crossing decides.
 */
static inline void lane_start(lane *l, int32_t *cell, const way *w, int a, const entry *e, aset_real corner, aset_real width,
                              int32_t count, int32_t stride) {
    aset_real x = (w->from[a] + e->t * w->rise[a] - corner) * (1 / width), last = (aset_real)(count - 1);
    int32_t k = x > 0 ? (int32_t)(x < last ? x : last) : 0;
    l->from = w->from[a];
    l->inverse = w->inverse[a];
    l->plane = corner + (aset_real)(k + 1) * width;
    l->next = (l->plane - l->from) * l->inverse;
    while (k < count - 1 && entry_is_behind(e, a, l->next)) {
        k++;
        l->plane += width;
        l->next = (l->plane - l->from) * l->inverse;
    }
    for (aset_real before; k > 0; k--, l->plane -= width, l->next = before) {
        before = (l->plane - width - l->from) * l->inverse;
        if (entry_is_behind(e, a, before)) {
            break;
        }
    }
    l->left = count - 1 - k;
    *cell += (w->turned[a] ? l->left : k) * stride;
    l->add = w->turned[a] ? -stride : stride;
}

/* The same in a block of four voxels whose corner is at corner columns: of three planes, those behind are counted. */
static inline void lane_start_in_block(lane *l, int32_t *cell, const way *w, int a, const entry *e, aset_real corner, int32_t stride) {
    aset_real from = w->from[a], inverse = w->inverse[a];
    aset_real first = (corner + VOXEL - from) * inverse, second = (corner + 2 * VOXEL - from) * inverse,
              third = (corner + 3 * VOXEL - from) * inverse;
    int32_t tie = (e->axis < 0) | (a <= e->axis);
    int32_t k = ((first < e->t) | ((first == e->t) & tie)) + ((second < e->t) | ((second == e->t) & tie)) +
                ((third < e->t) | ((third == e->t) & tie));
    l->from = from;
    l->inverse = inverse;
    l->plane = corner + (aset_real)(k + 1) * VOXEL;
    l->next = (l->plane - from) * inverse;
    l->left = 3 - k;
    *cell += (w->turned[a] ? l->left : k) * stride;
    l->add = w->turned[a] ? -stride : stride;
}

/* False: out of the box. */
static inline bool lane_cross(lane *l, int32_t *cell, aset_real *t, aset_real width) {
    *t = l->next;
    l->plane += width;
    l->next = (l->plane - l->from) * l->inverse;
    *cell += l->add;
    return --l->left >= 0;
}

/* Into the next cell, through the planes that are width apart. False: out of the box. */
static inline bool lanes_step(lanes *l, entry *e, aset_real width) {
    if (l->x.next <= l->y.next) {
        if (l->x.next <= l->z.next) {
            e->axis = 0;
            return lane_cross(&l->x, &l->cell, &e->t, width);
        }
    } else if (l->y.next <= l->z.next) {
        e->axis = 1;
        return lane_cross(&l->y, &l->cell, &e->t, width);
    }
    e->axis = 2;
    return lane_cross(&l->z, &l->cell, &e->t, width);
}

/* The corner of block number k of n along axis a, or of the turned box's as many blocks from its end. */
static inline aset_real block_corner(const way *w, int a, int32_t k, int32_t n) {
    return (aset_real)(16 * (w->turned[a] ? k - n : k));
}

/* The ray's origin from a voxel's middle on an axis whose lane is in the voxel: planes are whole numbers, so it is exact. */
static inline aset_real from_middle(const way *w, int a, const lane *l) {
    aset_real q = l->from - (l->plane - VOXEL / 2);
    return w->turned[a] ? -q : q;
}

static bool visit_voxel(way *w, const lanes *l, uint32_t block, uint64_t marks, const entry *e) {
    uint32_t first, end;
    w->counts.nonempty++;
    draft_find_facets(w->draft, block, bits_count(marks & ((UINT64_C(1) << l->cell) - 1)), &first, &end);
    if (w->mode == DRAFT_PLANE) {
        const aset_real q[3] = {from_middle(w, 0, &l->x), from_middle(w, 1, &l->y), from_middle(w, 2, &l->z)};
        return visit_planes(w, q, first, end);
    }
    return visit_side(w, e->t, e->axis, first, end);
}

/* outer: the walk of blocks, whose place gives this one's corner. */
static bool walk_block(way *w, uint32_t block, entry e, const lanes *outer) {
    uint64_t marks = draft_marks(w->draft, block);
    const aset_real corner[3] = {outer->x.plane - BLOCK, outer->y.plane - BLOCK, outer->z.plane - BLOCK};
    uint64_t cells = 0;
    bool done = false;
    lanes l;
    l.cell = 0;
    lane_start_in_block(&l.x, &l.cell, w, 0, &e, corner[0], 1);
    lane_start_in_block(&l.y, &l.cell, w, 1, &e, corner[1], 4);
    lane_start_in_block(&l.z, &l.cell, w, 2, &e, corner[2], 16);
    do {
        cells++;
        if ((marks >> l.cell & 1u) != 0 && visit_voxel(w, &l, block, marks, &e)) {
            done = true;
            break;
        }
    } while (lanes_step(&l, &e, VOXEL) && e.t < w->t_last);
    w->counts.cells += cells;
    return done;
}

/* Where the ray begins in the box; false if nowhere. */
static inline bool clip(const way *w, entry *e) {
    aset_real t_out = REAL_INFINITY;
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
        if (in > e->t) {
            e->t = in;
            e->axis = a;
        }
        t_out = real_min(t_out, out);
    }
    return e->t <= t_out && e->t < w->t_last;
}

/* A box's size so often: from farther away the rounding of o + t d would be seen. */
#define FAR R(64)

/* Brings a ray that comes from far away near the box, and clips it again: what is left of it is short. */
static bool clip_near(way *w, entry *e) {
    const uint32_t *n = w->draft->n;
    aset_real size = w->draft->column * (aset_real)(int32_t)(4 * (n[0] + n[1] + n[2]));
    bool meets = clip(w, e);
    for (int i = 0; i < 3 && meets && e->t > FAR * size; i++) {
        aset_real step = e->t - size;
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

static bool go(way *w) {
    const aset_draft *draft = w->draft;
    const int32_t nx = (int32_t)draft->blocks[0], ny = (int32_t)draft->blocks[1], nz = (int32_t)draft->blocks[2];
    const uint32_t *map = draft->map;
    uint64_t empty = 0;
    bool done = false;
    entry e;
    lanes l;
    if (draft->n_facets == 0 || !clip_near(w, &e)) {
        return false;
    }
    l.cell = 0;
    lane_start(&l.x, &l.cell, w, 0, &e, block_corner(w, 0, 0, nx), BLOCK, nx, 1);
    lane_start(&l.y, &l.cell, w, 1, &e, block_corner(w, 1, 0, ny), BLOCK, ny, nx);
    lane_start(&l.z, &l.cell, w, 2, &e, block_corner(w, 2, 0, nz), BLOCK, nz, nx * ny);
    do {
        uint32_t i = (uint32_t)l.cell, word = map[i >> 5], bit = UINT32_C(1) << (i & 31u);
        if ((word & bit) == 0) {
            empty++;
        } else if (walk_block(w, draft->rank[i >> 5] + bits_count(word & (bit - 1)), e, &l)) {
            done = true;
            break;
        }
    } while (lanes_step(&l, &e, BLOCK) && e.t < w->t_last);
    w->counts.cells += empty;
    return done;
}

static inline void way_set_axis(way *w, int a, aset_real o, aset_real d) {
    bool turned = d < 0;
    aset_real rise = turned ? -d : d, inverse = 1 / rise;
    w->o[a] = o;
    w->d[a] = d;
    w->turned[a] = turned;
    w->from[a] = turned ? -o : o;
    w->rise[a] = rise;
    w->inverse[a] = inverse < REAL_MAX ? inverse : REAL_MAX;
}

static inline void way_make(way *w, const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction,
                            aset_real t_max, aset_real t_last, draft_layer *layers) {
    const aset_real *low = draft->low, *per_size = draft->per_size;
    w->draft = draft;
    w->mode = mode;
    w->t_max = t_max;
    w->t_last = real_min(t_last, t_max);
    w->moved = 0;
    w->t_own = mode == DRAFT_PLANE ? OWN_DISTANCE * draft->column : 0;
    w->any = layers == NULL;
    w->cover = draft_cover_of(layers);
    w->counts.cells = w->counts.nonempty = 0;
    way_set_axis(w, 0, (origin.x - low[0]) * per_size[0], direction.x * per_size[0]);
    way_set_axis(w, 1, (origin.y - low[1]) * per_size[1], direction.y * per_size[1]);
    way_set_axis(w, 2, (origin.z - low[2]) * per_size[2], direction.z * per_size[2]);
}

uint32_t aset_draft_layers(draft_layer layers[DRAFT_LAYERS_MAX], const aset_draft *draft, draft_mode mode, aset_vec3 origin,
                           aset_vec3 direction, aset_real t_max, draft_counts *counts) {
    way w;
    way_make(&w, draft, mode, origin, direction, t_max, t_max, layers);
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
    way_make(&w, draft, mode, origin, direction, t_max, t_last, NULL);
    bool blocked = go(&w);
    *counts = w.counts;
    return blocked;
}

#endif
