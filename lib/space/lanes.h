/*
 * lanes.h - the approximate walk among bricks, told each axis by itself: a lane keeps what a ray does along one, so that with the
 * faces' number and the kind of slices known where the walk is called, all its numbers stay in registers. It takes between 63 and
 * 78 % of the instructions of aset_bricks_walk, which gives the same cells, t and counts, and is taken where walks are not to be fused.
 */
#ifndef ASET_SPACE_LANES_H
#define ASET_SPACE_LANES_H

#include "space/bricks.h"

#if ASET_WITH_APPROXIMATION
#if ASET_FUSED

/*
 * A ray along one axis, as bricks_go keeps it: its brick and a voxel of that. Slice numbers are kept as reals, which hold
 * them exactly; the place is this axis' part of cells_place, but counted along the ray (lanes.flip turns it back).
 * Crossings are dda_crossing's to the last bit.
 */
typedef struct lane {
    aset_real next, slice;             /* where the ray leaves the voxel: t, and which slice that is */
    aset_real brick_next, brick_slice; /* where it leaves the brick; at the volume's end, the slice of a whole one */
    aset_real step;                    /* 1 or -1 */
    uint32_t place, place_last;        /* last: of the brick's voxels, */
    uint32_t place_end;                /* the same if it is the volume's last as well, else no place */
    uint32_t ahead, stride;            /* bricks ahead of this one; blocks from one to the next */
} lane;

/* A voxel may lie behind the ray's, in the same brick: it is only brought along where it matters. */
typedef struct lanes {
    lane x, y, z;
    const aset_slices *slices;
    const probe *ray;
    bool even;      /* no table of slices: a constant where the walk is called */
    uint32_t block; /* the brick's first */
    unsigned flip;
    int axis;       /* of the last crossing, 3 before any, */
    aset_real t;    /* and when it was */
} lanes;

/* dda_crossing for slices that are not the volume's ends. */
FUSED aset_real lane_crossing(const lanes *w, int a, aset_real slice) {
    const aset_slices *s = w->slices;
    aset_real plane = w->even ? s->low[a] + slice * s->width[a] : s->planes[a][(int32_t)slice];
    return (plane - w->ray->origin[a]) * w->ray->inverse[a];
}

/* Sets where the ray leaves the brick: the volume's last one may be thinner, and its last slice is no multiple. */
FUSED void lane_set_exit(lanes *w, lane *l, int a) {
    const aset_slices *s = w->slices;
    l->place_last = 3u << 2 * a;
    l->place_end = UINT32_MAX;
    if (l->ahead > 0) {
        l->brick_next = lane_crossing(w, a, l->brick_slice);
        return;
    }
    bool up = l->step > 0;
    l->brick_next = ((up ? s->last[a] : s->first[a]) - w->ray->origin[a]) * w->ray->inverse[a];
    l->place_last = l->place_end = up ? ((s->n[a] - 1) & 3) << 2 * a : 3u << 2 * a;
}

FUSED void lane_set_next(lanes *w, lane *l, int a) {
    l->next = l->place == l->place_end ? l->brick_next : lane_crossing(w, a, l->slice);
}

/* Puts the lane at a voxel; without a branch, for directions are what the processor cannot guess. */
FUSED void lane_begin(lanes *w, lane *l, const aset_cells *cells, int32_t voxel, int a, uint32_t stride) {
    uint32_t up = w->ray->direction[a] > 0, down = up - 1; /* all bits of it */
    uint32_t at = (uint32_t)voxel, brick = at / 4;
    l->step = (aset_real)(int32_t)(2 * up - 1);
    l->ahead = ((brick ^ ~down) + up) + ((cells->bricks[a] - 1) & ~down);
    l->stride = (stride ^ down) - down;
    l->place = ((at ^ down) & 3) << 2 * a;
    w->flip |= (down & 3) << 2 * a;
    w->block += brick * stride;
    l->slice = (aset_real)(int32_t)(at + up);
    l->brick_slice = (aset_real)(int32_t)(4 * (brick + up));
    lane_set_exit(w, l, a);
    lane_set_next(w, l, a);
    if (!w->ray->moves[a]) {
        l->next = l->brick_next = REAL_INFINITY;
    }
}

/* Into the brick's next voxel. False: this is its last. */
FUSED bool lane_step(lanes *w, lane *l, int a) {
    if (l->place == l->place_last) {
        return false;
    }
    l->place += 1u << 2 * a;
    l->slice += l->step;
    lane_set_next(w, l, a);
    return true;
}

/* From anywhere in the brick into the first voxel of the next. False: there is none, and the voxel is the volume's last. */
FUSED bool lane_cross(lanes *w, lane *l, int a) {
    if (l->ahead == 0) {
        l->place = l->place_last;
        l->slice = l->step > 0 ? (aset_real)(int32_t)w->slices->n[a] : 0;
        return false;
    }
    w->block += l->stride;
    l->place = 0;
    l->slice = l->brick_slice + l->step;
    l->brick_slice += 4 * l->step;
    l->ahead--;
    lane_set_exit(w, l, a);
    lane_set_next(w, l, a);
    return true;
}

/* Brings the voxel to where the ray is after this axis' crossings before t, and with those at t if so wished. */
FUSED void lane_catch_up(lanes *w, lane *l, int a, bool at) {
    while ((l->next < w->t || (at && l->next == w->t)) && lane_step(w, l, a)) {
    }
}

/* The same after the last crossing. In the order of crossings those of lower axes come first at equal t. */
FUSED void lanes_catch_up(lanes *w) {
    lane_catch_up(w, &w->x, 0, w->axis > 0);
    lane_catch_up(w, &w->y, 1, w->axis > 1);
    lane_catch_up(w, &w->z, 2, w->axis > 2);
}

enum { LANES_ENDED, LANES_INSIDE, LANES_CROSSED };

/*
 * The crossing of lane l, which is axis a's. If it lies behind limit, the last one is taken to be at limit, after all axes'.
 * whole: of the brick, from anywhere in it.
 */
FUSED int lanes_cross(lanes *w, lane *l, int a, bool whole, aset_real limit) {
    aset_real t = whole ? l->brick_next : l->next;
    if (t > limit) {
        w->t = limit;
        w->axis = 3;
        return LANES_ENDED;
    }
    w->t = t;
    w->axis = a;
    if (!whole && lane_step(w, l, a)) {
        return LANES_INSIDE;
    }
    return lane_cross(w, l, a) ? LANES_CROSSED : LANES_ENDED;
}

FUSED int lanes_next(lanes *w, bool whole, aset_real limit) {
    aset_real x = whole ? w->x.brick_next : w->x.next, y = whole ? w->y.brick_next : w->y.next;
    aset_real z = whole ? w->z.brick_next : w->z.next;
    if (x <= y) {
        return x <= z ? lanes_cross(w, &w->x, 0, whole, limit) : lanes_cross(w, &w->z, 2, whole, limit);
    }
    return y <= z ? lanes_cross(w, &w->y, 1, whole, limit) : lanes_cross(w, &w->z, 2, whole, limit);
}

/* The crossings made, counted from some place before the volume. */
FUSED aset_real lanes_crossings(const lanes *w) {
    return w->x.slice * w->x.step + w->y.slice * w->y.step + w->z.slice * w->z.step;
}

/* The marks on one face of a brick, 0 for an empty block. map: the brick's; rank: of its first block that is not empty. */
FUSED uint64_t bricks_face(const aset_cells *cells, uint32_t rank, unsigned map, uint32_t face) {
    static const uint8_t counts[32] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,
                                       1, 2, 2, 3, 2, 3, 3, 4, 2, 3, 3, 4, 3, 4, 4, 5}; /* set bits */
    return (map >> face & 1) != 0 ? cells->marks[rank + counts[map & ((1u << face) - 1)]] : 0;
}

/* Loads a brick's marks on the faces that the ray can enter by. */
FUSED void bricks_marks(uint64_t marks[4], const aset_cells *cells, uint32_t first, unsigned map, const uint32_t faces[3],
                        unsigned n_faces) {
    uint32_t word = first >> 6;
    uint32_t rank = cells->map_rank[word] + bits_count(cells->map[word] & ((UINT64_C(1) << (first & 63)) - 1));
    marks[0] = n_faces == 1 ? cells->marks[rank] : bricks_face(cells, rank, map, faces[0]);
    marks[1] = n_faces == 1 ? 0 : bricks_face(cells, rank, map, faces[1]);
    marks[2] = n_faces == 1 ? 0 : bricks_face(cells, rank, map, faces[2]);
    marks[3] = 0;
}

/* The brick's voxels that the ray may still come to: none that lies behind the voxel on any axis. */
FUSED uint64_t lanes_ahead(const lanes *w) {
    static const uint64_t ahead[3][8] = {/* by axis: up and down, and the place */
        {UINT64_C(0xffffffffffffffff), UINT64_C(0xeeeeeeeeeeeeeeee), UINT64_C(0xcccccccccccccccc),
         UINT64_C(0x8888888888888888), UINT64_C(0xffffffffffffffff), UINT64_C(0x7777777777777777),
         UINT64_C(0x3333333333333333), UINT64_C(0x1111111111111111)},
        {UINT64_C(0xffffffffffffffff), UINT64_C(0xfff0fff0fff0fff0), UINT64_C(0xff00ff00ff00ff00),
         UINT64_C(0xf000f000f000f000), UINT64_C(0xffffffffffffffff), UINT64_C(0x0fff0fff0fff0fff),
         UINT64_C(0x00ff00ff00ff00ff), UINT64_C(0x000f000f000f000f)},
        {UINT64_C(0xffffffffffffffff), UINT64_C(0xffffffffffff0000), UINT64_C(0xffffffff00000000),
         UINT64_C(0xffff000000000000), UINT64_C(0xffffffffffffffff), UINT64_C(0x0000ffffffffffff),
         UINT64_C(0x00000000ffffffff), UINT64_C(0x000000000000ffff)}};
    return ahead[0][(w->flip & 1) * 4 + w->x.place] & ahead[1][(w->flip >> 2 & 1) * 4 + (w->y.place >> 2)] &
           ahead[2][(w->flip >> 4 & 1) * 4 + (w->z.place >> 4)];
}

/* Tells the visitor of a marked cell. The new limit. */
static inline aset_real bricks_visit(const aset_cells *cells, walk_request *walk, uint32_t block, unsigned place, int face,
                                     aset_real t) {
    uint32_t rank = cells_rank(cells, block);
    walk_cell cell;
    cell.index = cells->first[rank] + bits_count(cells->marks[rank] & ((UINT64_C(1) << place) - 1));
    cell.face = face;
    cell.t = t;
    cell.n = 0;
    return walk->visit(walk, &cell);
}

/* Puts the lanes where the ray starts, within the volume or where it enters that. False: nowhere. */
FUSED bool lanes_begin(lanes *w, const aset_space *space, const probe *ray, unsigned n_faces, bool even) {
    const aset_cells *cells = &space->cells;
    const uint32_t row = cells->bricks[0] * n_faces;
    int32_t voxel[3];
    w->slices = &space->slices;
    w->ray = ray;
    w->even = even;
    w->axis = 3;
    w->t = 0;
    w->block = w->flip = 0;
    if (!aset_slices_voxel(w->slices, ray, voxel)) {
        voxel_box whole = slices_whole(w->slices);
        dda way;
        if (!aset_dda_enter(&way, w->slices, ray, &whole)) {
            return false;
        }
        voxel[0] = way.voxel[0];
        voxel[1] = way.voxel[1];
        voxel[2] = way.voxel[2];
        w->axis = way.axis;
        w->t = way.t;
    }
    lane_begin(w, &w->x, cells, voxel[0], 0, n_faces);
    lane_begin(w, &w->y, cells, voxel[1], 1, row);
    lane_begin(w, &w->z, cells, voxel[2], 2, row * cells->bricks[1]);
    return true;
}

/*
 * The approximate walk: counts every cell, and shows those that are marked on the ray's faces (of n_faces a voxel) to the
 * visitor. It goes from brick to brick. One without marks on these faces, or with none ahead of where the ray enters it,
 * costs one crossing; in another one voxels are stepped through, each with a crossing and the test of one bit. No cell
 * is counted by itself: a crossing enters one, and the crossings follow from where the walk ends. The origin's own cell
 * counts only if a voxel has one face, for it is entered by none. even: the slices are equally far apart.
 * (tests/test_methods.c walks the plain way beside it: the same cells, t and counts.)
 */
FUSED void bricks_go(const aset_space *space, const probe *ray, walk_request *walk, const uint32_t faces[3],
                     unsigned n_faces, bool even) {
    const aset_cells *cells = &space->cells;
    const unsigned mask = 1u << faces[0] | 1u << faces[1] | 1u << faces[2];
    lanes w;
    aset_real limit = walk->limit; /* kept here, for a visit may change what walk points to */
    if (cells->n_cells == 0 || !lanes_begin(&w, space, ray, n_faces, even) || w.t > limit) {
        return;
    }
    const aset_real before = lanes_crossings(&w) - (aset_real)(n_faces == 1 || w.axis < 3);
    uint64_t n_nonempty = 0;
    bool behind = false; /* may the voxel lie behind the ray's? */
    int step = LANES_CROSSED;
    for (;;) {
        unsigned map = bricks_map(cells, w.block, n_faces);
        bool any = (map & mask) != 0;
        if (behind && (any || step == LANES_ENDED)) {
            lanes_catch_up(&w);
            behind = false;
        }
        if (step == LANES_ENDED) {
            break;
        }
        uint64_t marks[4]; /* by axis; none for the origin's cell */
        if (any) {
            bricks_marks(marks, cells, w.block, map, faces, n_faces);
            any = ((marks[0] | marks[1] | marks[2]) & lanes_ahead(&w)) != 0;
        }
        if (!any) {
            step = lanes_next(&w, true, limit);
            behind = true;
            continue;
        }
        do {
            unsigned place = (w.x.place + w.y.place + w.z.place) ^ w.flip;
            if ((marks[n_faces == 1 ? 0 : w.axis] >> place & 1) != 0) {
                n_nonempty++;
                if (w.t > 0) {
                    int face = w.axis * 2 + (ray->direction[w.axis] < 0);
                    walk->limit = limit = bricks_visit(cells, walk, w.block + faces[w.axis], place, face, w.t);
                }
            }
            step = lanes_next(&w, false, limit);
        } while (step == LANES_INSIDE);
    }
    walk->nonempty += n_nonempty;
    walk->cells += (uint64_t)real_to_whole(lanes_crossings(&w) - before);
}

#else

/* What is known where the walk is called serves the fused one. */
static inline void bricks_go(const aset_space *space, const probe *ray, walk_request *walk, const uint32_t faces[3],
                             unsigned n_faces, bool even) {
    (void)faces, (void)n_faces, (void)even;
    aset_bricks_go(space, ray, walk);
}

#endif
#endif
#endif
