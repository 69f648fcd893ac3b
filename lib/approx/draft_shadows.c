/*
 * draft_shadows.c - shadow rays side by side: most cross a few voxels, meet nothing and end, and which slice they cross next is anybody's
 * guess. So their first steps are taken together, by draft_walk.h's arithmetic, number for number, with the rays in the innermost
 * loops and no branch in these: compilers use wide registers. Then each looks at the voxels that it has crossed; what is longer
 * goes on alone.
 */
#include "approx/draft_shadows.h"

#if ASET_WITH_DRAFTS && DRAFT_SHADES_BEAMS

#include "approx/draft_walk.h"

#define NO_CELL UINT32_MAX

/* A voxel's bit in its block's marks. */
static inline unsigned cell_bit(uint32_t cell) {
    return (cell & 3u) | (cell >> 10 & 3u) << 2 | (cell >> 20 & 3u) << 4;
}

/* lane_start's arithmetic for rays that begin at t = 0; in steps, for what depends on branches is no loop for wide registers. */
DRAFT_WORK void axis_start(draft_shadows_axis *restrict x, const aset_draft *draft, int a, const aset_real *restrict origins,
                           const aset_real *restrict directions) {
    aset_real low = draft->low[a], per_size = draft->per_size[a];
    int32_t last = (int32_t)draft->blocks[a] * 4 - 1;
    aset_real side = (aset_real)(int32_t)draft->n[a] * VOXEL, turned_corner = (aset_real)(-4 * (last + 1)), last_real = (aset_real)last;
    aset_real corner[DRAFT_BEAM], at[DRAFT_BEAM];
    EACH_RAY(i) {
        draft_axis ray = draft_axis_of(low, per_size, origins[i], directions[i]);
        x->from[i] = ray.from;
        x->rise[i] = ray.rise;
        x->inverse[i] = ray.inverse;
        x->flip[i] = -(ray.d >= 0); /* a direction is a number */
        x->base[i] = ray.d >= 0 ? last + 1 : 0;
        x->placed[i] = (ray.o >= 0) & (ray.o <= side);
        corner[i] = ray.d < 0 ? turned_corner : 0;
    }
    EACH_RAY(i) {
        aset_real k = real_max((x->from[i] - corner[i]) * (1 / VOXEL), 0);
        at[i] = real_min(k, last_real);
    }
    EACH_RAY(i) {
        int32_t k = (int32_t)at[i];
        aset_real far_side = corner[i] + (aset_real)(k + 1) * VOXEL, near_side = far_side - VOXEL;
        aset_real ahead = (far_side - x->from[i]) * x->inverse[i], behind = (near_side - x->from[i]) * x->inverse[i];
        x->plane[i] = far_side;
        x->next[i] = ahead;
        x->left[i] = last - k;
        x->placed[i] &= behind <= 0; /* from - corner may have been rounded up to a whole voxel, but not down from one */
    }
}

/* lanes_step for all rays. How many are not at their ends. */
DRAFT_WORK int32_t step_all(draft_shadows *restrict s, uint32_t *restrict cells) {
    draft_shadows_axis *x = &s->axes[0], *y = &s->axes[1], *z = &s->axes[2];
    int32_t n = 0;
    EACH_RAY(i) {
        aset_real t_x = x->next[i], t_y = y->next[i], t_z = z->next[i];
        int32_t on_x = (t_x <= t_y) & (t_x <= t_z), on_y = (t_y < t_x) & (t_y <= t_z), on_z = 1 - on_x - on_y;
        aset_real t = real_min(t_x, real_min(t_y, t_z));
        int32_t left_x = x->left[i] - on_x, left_y = y->left[i] - on_y, left_z = z->left[i] - on_z;
        x->plane[i] += (aset_real)on_x * VOXEL;
        y->plane[i] += (aset_real)on_y * VOXEL;
        z->plane[i] += (aset_real)on_z * VOXEL;
        x->next[i] = (x->plane[i] - x->from[i]) * x->inverse[i];
        y->next[i] = (y->plane[i] - y->from[i]) * y->inverse[i];
        z->next[i] = (z->plane[i] - z->from[i]) * z->inverse[i];
        x->left[i] = left_x;
        y->left[i] = left_y;
        z->left[i] = left_z;
        s->t[i] = t;
        s->axis[i] = on_y + 2 * on_z;
        uint32_t at_x = (uint32_t)((left_x ^ x->flip[i]) + x->base[i]), at_y = (uint32_t)((left_y ^ y->flip[i]) + y->base[i]);
        uint32_t at_z = (uint32_t)((left_z ^ z->flip[i]) + z->base[i]); /* of a ray at its end any number */
        int32_t alive = s->alive[i] & ((left_x | left_y | left_z) >= 0) & (t < s->t_last[i]);
        s->alive[i] = alive;
        cells[i] = (at_x | at_y << 10 | at_z << 20) | (uint32_t)(alive - 1);
        n += alive;
    }
    return n;
}

/* Takes the first steps. */
DRAFT_WORK void set_out(draft_shadows *restrict shadows, const aset_draft *draft, aset_real (*restrict origins)[DRAFT_BEAM],
                        aset_real (*restrict directions)[DRAFT_BEAM]) {
    shadows->draft = draft;
    for (int a = 0; a < 3; a++) {
        axis_start(&shadows->axes[a], draft, a, origins[a], directions[a]);
    }
    int32_t n = 0;
    EACH_RAY(i) {
        shadows->t_last[i] = real_min(shadows->t_last[i], shadows->t_max[i]);
        int32_t placed = shadows->axes[0].placed[i] & shadows->axes[1].placed[i] & shadows->axes[2].placed[i];
        shadows->axes[0].placed[i] = placed;
        shadows->alive[i] = placed & (shadows->t_last[i] > 0);
        n += shadows->alive[i];
    }
    shadows->n_steps = 0;
    for (; n > 0 && shadows->n_steps < DRAFT_STEPS; shadows->n_steps++) {
        n = step_all(shadows, shadows->cells[shadows->n_steps]);
    }
}

static void set_way(way *w, const draft_shadows *s, uint32_t i) {
    way_make(w, s->draft, DRAFT_PLANE, s->t_max[i], s->t_last[i], NULL);
    for (int a = 0; a < 3; a++) {
        const draft_shadows_axis *x = &s->axes[a];
        w->turned[a] = x->flip[i] == 0;
        w->from[a] = x->from[i];
        w->rise[a] = x->rise[i];
        w->inverse[a] = x->inverse[i];
        w->o[a] = w->turned[a] ? -w->from[a] : w->from[a];
        w->d[a] = w->turned[a] ? -w->rise[a] : w->rise[a];
    }
}

static inline lane lane_now(const draft_shadows *s, uint32_t i, int a) {
    const draft_shadows_axis *x = &s->axes[a];
    int32_t left = x->left[i], flip = x->flip[i];
    lane l = {x->next[i], x->plane[i], x->from[i], x->inverse[i], (left ^ flip) + x->base[i], flip == 0 ? -1 : 1, left};
    return l;
}

/* One that is not at its end, on from where it is. */
DRAFT_RARE_WORK bool go_on(way *w, const draft_shadows *s, uint32_t i) {
    lanes l = {lane_now(s, i, 0), lane_now(s, i, 1), lane_now(s, i, 2)};
    entry e = {s->t[i], s->axis[i]};
    return walk(w, &l, &e);
}

/* One that the first steps are not for. */
DRAFT_RARE_WORK bool go_alone(way *w, const draft_shadows *s, uint32_t i) {
    set_way(w, s, i);
    return go(w);
}

/* Where a ray looks its voxels up: the block of the last one. */
typedef struct look {
    uint32_t block, dense, cells; /* cells: so many were looked at */
    uint64_t marks;               /* 0 if it is empty */
} look;

/* Is the voxel marked? */
static inline bool look_up(look *l, const aset_draft *draft, uint32_t cell) {
    uint32_t x = cell & 1023u, y = cell >> 10 & 1023u, z = cell >> 20;
    uint32_t block = ((z >> 2) * draft->blocks[1] + (y >> 2)) * draft->blocks[0] + (x >> 2);
    l->cells += l->marks != 0 || block != l->block; /* an empty block is one, as for the walk */
    if (block != l->block) {
        l->block = block;
        l->marks = 0;
        if (draft_has_block(draft, block)) {
            l->dense = draft_dense_block(draft, block);
            l->marks = draft_marks(draft, l->dense);
        }
    }
    return (l->marks >> cell_bit(cell) & 1u) != 0;
}

/* Does anything in the marked voxel that was looked up last stop the ray? */
static bool stops_in(way *w, const look *l, uint32_t cell) {
    uint32_t first, end;
    const uint32_t at[3] = {cell & 1023u, cell >> 10 & 1023u, cell >> 20};
    aset_real q[3]; /* from the voxel's middle */
    for (int a = 0; a < 3; a++) {
        q[a] = w->o[a] - (aset_real)(int32_t)(4 * at[a] + 2);
    }
    w->counts.nonempty++;
    draft_find_facets(w->draft, l->dense, bits_count(l->marks & ((UINT64_C(1) << cell_bit(cell)) - 1)), &first, &end);
    return visit_planes(w, q, first, end);
}

/* All but the voxel of the start, which approximate rays ignore (Dauenhauer and Semwal 1990). */
static bool go_together(way *w, const draft_shadows *s, uint32_t i) {
    bool goes_on = s->alive[i] != 0, made = goes_on, blocked = false;
    uint32_t n = s->n_steps - goes_on; /* the walk looks at the last one */
    look l = {UINT32_MAX, 0, 0, 0};
    if (made) {
        set_way(w, s, i);
    }
    for (uint32_t k = 0; k < n && s->cells[k][i] != NO_CELL && !blocked; k++) {
        uint32_t cell = s->cells[k][i];
        if (!look_up(&l, s->draft, cell)) {
            continue;
        }
        if (!made) { /* most rays need none */
            set_way(w, s, i);
            made = true;
        }
        blocked = stops_in(w, &l, cell);
    }
    if (goes_on && !blocked) {
        (void)look_up(&l, s->draft, s->cells[n][i]); /* where the walk counts one that has been counted so */
        l.cells--;
        blocked = go_on(w, s, i);
    }
    w->counts.cells += l.cells;
    return blocked;
}

DRAFT_WORK uint32_t send(draft_shadows *restrict shadows, const aset_draft *draft, aset_real (*restrict origins)[DRAFT_BEAM],
                         aset_real (*restrict directions)[DRAFT_BEAM], uint32_t rays, draft_counts *counts) {
    uint32_t blocked = 0;
    way w;
    w.counts = *counts;
    set_out(shadows, draft, origins, directions);
    for (; rays != 0; rays &= rays - 1) {
        uint32_t i = bits_lowest(rays);
        bool placed = shadows->axes[0].placed[i] != 0;
        blocked |= (uint32_t)(placed ? go_together(&w, shadows, i) : go_alone(&w, shadows, i)) << i;
    }
    *counts = w.counts;
    return blocked;
}

DRAFT_WIDE_WORK uint32_t send_wide(draft_shadows *restrict shadows, const aset_draft *draft,
                                   aset_real (*restrict origins)[DRAFT_BEAM], aset_real (*restrict directions)[DRAFT_BEAM],
                                   uint32_t rays, draft_counts *counts) {
    return send(shadows, draft, origins, directions, rays, counts);
}

uint32_t aset_draft_shadows_send(draft_shadows *restrict shadows, const aset_draft *draft, aset_real (*restrict origins)[DRAFT_BEAM],
                                 aset_real (*restrict directions)[DRAFT_BEAM], uint32_t rays, draft_counts *counts) {
    if (DRAFT_HAS_WIDE) {
        return send_wide(shadows, draft, origins, directions, rays, counts);
    }
    return send(shadows, draft, origins, directions, rays, counts);
}

#endif
