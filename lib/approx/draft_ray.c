/*
 * draft_ray.c - the way of a ray through a draft: blocks of 4 x 4 x 4 voxels, in those that are not empty the voxels, in those
 * that are marked the facets. Two nested walks of the same kind (Amanatides and Woo 1987), the crossings
 * of an axis t apart by a constant; of an empty block nothing but its bit in the map is looked at. A walk ends after as many steps as there are
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
    aset_real moved; /* the ray's own t is so much larger */
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

/* The ray against one facet of the voxel that it sees from q, its origin from the voxel's corner. */
static inline bool meet(const way *w, const aset_real q[3], uint32_t number, aset_real t_min, meeting *m) {
    static const unsigned next[3] = {1, 2, 0};
    uint64_t record = facet_record(w->draft, number);
    uint32_t surface = facet_surface(w->draft, record);
    aset_real height = facet_height(w->draft, record);
    aset_real slope_u = surface_slope_u(surface), slope_v = surface_slope_v(surface);
    unsigned a = surface_axis(surface), u = next[a], v = next[u];
    aset_real rate = w->d[a] - slope_u * w->d[u] - slope_v * w->d[v];
    aset_real t = (height + slope_u * (q[u] - 2) + slope_v * (q[v] - 2) - q[a]) / rate;
    aset_real ha = q[a] + t * w->d[a], hu = q[u] + t * w->d[u], hv = q[v] + t * w->d[v];
    bool in_voxel = (hu >= -BEYOND_SIDES) & (hu <= 4 + BEYOND_SIDES) & (hv >= -BEYOND_SIDES) & (hv <= 4 + BEYOND_SIDES) &
                    (ha >= -BEYOND_HEIGHT) & (ha <= 4 + BEYOND_HEIGHT) & (t > t_min) & (t < w->t_max);
    if (!in_voxel) { /* rate may be 0: t is infinite then, or not a number, and nothing holds */
        return false;
    }
    uint32_t footprint = facet_footprint(w->draft, record);
    m->t = t;
    m->facet = number;
    m->away = (rate > 0) != surface_down(surface);
    m->cover = w->any ? bit_at(footprint, (int)hu, (int)hv) : soft_cover(footprint, hu, hv);
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
    aset_real q[3] = {w->o[0] - base[0], w->o[1] - base[1], w->o[2] - base[2]};
    uint32_t n = 0;
    aset_real t_min = w->n > 0 ? w->layers[w->n - 1].t : 0;
    for (uint32_t i = first; i < end; i++) {
        meeting m;
        if (!meet(w, q, i, t_min, &m)) {
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

/*
 * One of the two nested walks, in a box of cells. For each axis: t of the next crossing, how much t grows from one to the next,
 * how many cells are left before the box's end, what a crossing adds to the cell's number. Fields and no arrays, so that they
 * can live in registers.
 */
typedef struct lane {
    aset_real next, delta;
    int32_t left, add;
} lane;

typedef struct lanes {
    lane x, y, z;
    int32_t cell;
} lanes;

/* Axis a of a box of count cells whose corner is at corner columns; stride: of the cells' numbers. */
static inline lane lane_start(int32_t *cell, const way *w, int a, aset_real t, aset_real corner, aset_real width,
                              aset_real per_width, int32_t count, int32_t stride) {
    aset_real x = (w->o[a] + t * w->d[a] - corner) * per_width, last = (aset_real)(count - 1);
    int32_t k = x > 0 ? (int32_t)(x < last ? x : last) : 0;
    bool up = w->step[a] > 0;
    lane l;
    *cell += k * stride;
    l.left = up ? count - 1 - k : k;
    l.add = up ? stride : -stride;
    l.next = w->inverse[a] != 0 ? (corner + (aset_real)(k + up) * width - w->o[a]) * w->inverse[a] : REAL_INFINITY;
    l.delta = width * real_abs(w->inverse[a]);
    return l;
}

/* False: out of the box. */
static inline bool lane_cross(lane *l, int32_t *cell, aset_real *t) {
    *t = l->next;
    l->next += l->delta;
    *cell += l->add;
    return --l->left >= 0;
}

/* Into the next cell; its axis of entry, or -1 if the ray leaves the box. */
static inline int lanes_step(lanes *l, aset_real *t) {
    if (l->x.next <= l->y.next) {
        if (l->x.next <= l->z.next) {
            return lane_cross(&l->x, &l->cell, t) ? 0 : -1;
        }
    } else if (l->y.next <= l->z.next) {
        return lane_cross(&l->y, &l->cell, t) ? 1 : -1;
    }
    return lane_cross(&l->z, &l->cell, t) ? 2 : -1;
}

static bool visit_voxel(way *w, uint32_t block, uint64_t marks, unsigned bit, aset_real t, int axis, const aset_real corner[3]) {
    aset_real base[3] = {corner[0] + (aset_real)(bit % 4 * 4), corner[1] + (aset_real)(bit / 4 % 4 * 4),
                         corner[2] + (aset_real)(bit / 16 * 4)};
    uint32_t first, end;
    w->counts.nonempty++;
    find_facets(w->draft, block, bits_count(marks & ((UINT64_C(1) << bit) - 1)), &first, &end);
    return w->mode == DRAFT_PLANE ? visit_planes(w, base, first, end) : visit_side(w, t, axis, first, end);
}

static bool walk_block(way *w, uint32_t block, aset_real t, int axis, const aset_real corner[3]) {
    uint64_t marks = (uint64_t)w->draft->marks[2 * block] | (uint64_t)w->draft->marks[2 * block + 1] << 32;
    uint64_t cells = 0;
    bool done = false;
    lanes l;
    l.cell = 0;
    l.x = lane_start(&l.cell, w, 0, t, corner[0], 4, R(0.25), 4, 1);
    l.y = lane_start(&l.cell, w, 1, t, corner[1], 4, R(0.25), 4, 4);
    l.z = lane_start(&l.cell, w, 2, t, corner[2], 4, R(0.25), 4, 16);
    do {
        cells++;
        if ((marks >> l.cell & 1u) != 0 && visit_voxel(w, block, marks, (unsigned)l.cell, t, axis, corner)) {
            done = true;
            break;
        }
        axis = lanes_step(&l, &t);
    } while (axis >= 0 && t < w->t_max);
    w->counts.cells += cells;
    return done;
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

/* A box's diagonal so often: from farther away the rounding of o + t d would be seen. */
#define FAR R(64)

/* Brings a ray that comes from far away near the box, and clips it again: what is left of it is short. */
static bool clip_near(way *w, aset_real *t, int *axis) {
    aset_real size = 0;
    for (int a = 0; a < 3; a++) {
        size += w->draft->size[a] * (aset_real)(4 * w->draft->n[a]);
    }
    bool meets = clip(w, t, axis);
    for (int i = 0; i < 3 && meets && *t > FAR * size; i++) {
        aset_real step = *t - size;
        for (int a = 0; a < 3; a++) {
            w->o[a] += step * w->d[a];
        }
        w->moved += step;
        w->t_max -= step;
        meets = clip(w, t, axis);
    }
    return meets;
}

static bool go(way *w) {
    const aset_draft *draft = w->draft;
    const int32_t nx = (int32_t)draft->blocks[0], ny = (int32_t)draft->blocks[1], nz = (int32_t)draft->blocks[2];
    const uint32_t *map = draft->map;
    uint64_t empty = 0;
    bool done = false;
    aset_real t;
    int axis;
    lanes l;
    if (draft->n_facets == 0 || !clip_near(w, &t, &axis)) {
        return false;
    }
    l.cell = 0;
    l.x = lane_start(&l.cell, w, 0, t, 0, 16, R(1) / 16, nx, 1);
    l.y = lane_start(&l.cell, w, 1, t, 0, 16, R(1) / 16, ny, nx);
    l.z = lane_start(&l.cell, w, 2, t, 0, 16, R(1) / 16, nz, nx * ny);
    do {
        uint32_t i = (uint32_t)l.cell, word = map[i >> 5], bit = UINT32_C(1) << (i & 31u);
        if ((word & bit) == 0) {
            empty++;
        } else {
            aset_real corner[3] = {(aset_real)(l.cell % nx * 16), (aset_real)(l.cell / nx % ny * 16),
                                   (aset_real)(l.cell / nx / ny * 16)};
            if (walk_block(w, draft->rank[i >> 5] + bits_count(word & (bit - 1)), t, axis, corner)) {
                done = true;
                break;
            }
        }
        axis = lanes_step(&l, &t);
    } while (axis >= 0 && t < w->t_max);
    w->counts.cells += empty;
    return done;
}

static void way_make(way *w, const aset_draft *draft, draft_mode mode, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                     draft_layer *layers) {
    w->draft = draft;
    w->mode = mode;
    w->t_max = t_max;
    w->moved = 0;
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
    for (uint32_t i = 0; i < w.n; i++) {
        layers[i].t += w.moved;
    }
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
