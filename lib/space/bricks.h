/*
 * bricks.h - a ray among bricks of 4 x 4 x 4 voxels: every fourth slice, crossed in the same order as all of them, so that
 * empty bricks are left in one go. Serves the spaces that mark voxels in cells.h's blocks: their exact walks with
 * aset_bricks_walk, a brick_walk beside a dda of voxels; their approximate ones with that too, unless they are fused (lanes.h).
 */
#ifndef ASET_SPACE_BRICKS_H
#define ASET_SPACE_BRICKS_H

#include "space/cells.h"
#include "space/walk.h"

/* Part of the loop of a walk, wherever it is called: else its numbers would not stay in registers. */
#if defined(__GNUC__) && ASET_FUSED
#define FUSED static inline __attribute__((always_inline))
#else
#define FUSED static inline
#endif

typedef struct brick_walk {
    int32_t at[3], end[3], stride[3]; /* stride: blocks from one brick to the next that the ray enters, of all faces */
    aset_real next[3];
    uint32_t block; /* the brick's first */
} brick_walk;

/* The t at which the ray leaves brick number at of axis a. */
static inline aset_real brick_exit(const aset_slices *slices, const probe *ray, int a, int32_t at) {
    int32_t beyond = at * 4 + 4, n = (int32_t)slices->n[a];
    return dda_crossing(slices, ray, a, ray->direction[a] > 0 ? (beyond < n ? beyond : n) : at * 4);
}

void aset_brick_begin(brick_walk *bricks, const aset_cells *cells, const aset_slices *slices, const probe *ray,
                      const dda *way);

/* Into the next brick along axis a. False: out of the volume. */
static inline bool brick_cross(brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way, int a) {
    way->t = bricks->next[a];
    way->axis = a;
    bricks->at[a] += way->step[a];
    if (bricks->at[a] == bricks->end[a]) {
        return false;
    }
    bricks->block += (uint32_t)bricks->stride[a];
    bricks->next[a] = brick_exit(slices, ray, a, bricks->at[a]);
    return true;
}

static inline bool brick_step(brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way) {
    if (bricks->next[0] <= bricks->next[1]) {
        return bricks->next[0] <= bricks->next[2] ? brick_cross(bricks, slices, ray, way, 0)
                                                  : brick_cross(bricks, slices, ray, way, 2);
    }
    return bricks->next[1] <= bricks->next[2] ? brick_cross(bricks, slices, ray, way, 1)
                                              : brick_cross(bricks, slices, ray, way, 2);
}

/* Has the crossing that way has just made led into another brick? Its voxel number, seen along the step, then begins one. */
static inline bool brick_left(const dda *way) {
    int32_t k = way->voxel[way->axis];
    return ((way->step[way->axis] > 0 ? k : ~k) & 3) == 0;
}

/*
 * Brings way into the voxel in which the ray enters the brick that the last brick_step led into. The crossings passed over.
 */
uint32_t aset_brick_land(const brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way);

/*
 * The cells that a walk passed since the voxel last known, when it ended among bricks: out of the volume (inside is false),
 * or in a brick entered behind limit.
 */
uint32_t aset_brick_count_rest(const aset_slices *slices, const probe *ray, dda *way, bool inside, aset_real limit);

/* The map's bits of all faces of a brick, whose first block is given. */
FUSED unsigned bricks_map(const aset_cells *cells, uint32_t first, unsigned n_faces) {
    uint32_t shift = first & 63;
    uint64_t bits = cells->map[first >> 6] >> shift;
    if (shift > 64 - n_faces) {
        bits |= cells->map[(first >> 6) + 1] << (64 - shift);
    }
    return (unsigned)bits & ((1u << n_faces) - 1);
}

/* What a walk does in a marked cell: in block number rank, of these marks, at way->voxel. The new limit. */
typedef aset_real (*brick_visit)(const aset_space *space, walk_request *walk, const dda *way, uint32_t rank, uint64_t marks,
                                 uint32_t held);

/* The cell that such a visit is of, without references. */
static inline void brick_cell(walk_cell *cell, const aset_space *space, const dda *way, uint32_t rank, uint64_t marks) {
    cell->index = space->cells.first[rank] + bits_count(marks & ((UINT64_C(1) << cells_place(way->voxel)) - 1));
    cell->face = way->axis < 0 ? FACE_NONE : way->axis * 2 + (way->step[way->axis] < 0);
    cell->t = way->t;
    cell->n = 0;
}

/* Puts the walk into the voxel of the ray's origin, or where the ray enters the volume. False: it meets no cell at all. */
FUSED bool bricks_begin(dda *way, const aset_space *space, const probe *ray, const walk_request *walk) {
    voxel_box whole = slices_whole(&space->slices);
    return space->cells.n_cells > 0 &&
           (aset_dda_inside(way, &space->slices, ray) || aset_dda_enter(way, &space->slices, ray, &whole)) &&
           way->t <= walk->limit;
}

/* The marks of one brick on the faces that a ray can enter by along each axis, 0 where the block is empty, and those blocks. */
typedef struct brick_sides {
    uint64_t marks[3];
    uint32_t rank[3];
} brick_sides;

FUSED void brick_load(brick_sides *b, const aset_cells *cells, uint32_t block, const uint32_t faces[3], unsigned n_faces) {
    for (int a = 0; a < (n_faces == 1 ? 1 : 3); a++) {
        uint32_t rank = cells_rank(cells, block + faces[a]);
        b->rank[a] = rank;
        b->marks[a] = rank != NO_CELL ? cells->marks[rank] : 0;
    }
}

/*
 * The walk, from where way stands on. It goes from brick to brick of 4 x 4 x 4 voxels. A brick without a mark on the faces that this
 * ray can enter by costs one crossing and one look at the map; only in the others are voxels stepped through, each with one crossing
 * and the test of one bit of the marks at hand. Both levels cross slices in the same order, so this is the plain walk voxel
 * by voxel, with the empty part left out (tests/test_space.c walks the plain way beside it). held is for the visits.
 */
FUSED void bricks_loop(const aset_space *space, const probe *ray, walk_request *walk, dda *way, unsigned n_faces, brick_visit visit,
                       uint32_t held) {
    const aset_cells *cells = &space->cells;
    const aset_slices *slices = &space->slices;
    uint32_t faces[3];
    unsigned mask = 0;
    for (uint32_t a = 0; a < 3; a++) { /* by which the ray can enter */
        faces[a] = n_faces == 1 ? 0 : 2 * a + (ray->direction[a] < 0);
        mask |= 1u << faces[a];
    }
    brick_walk bricks;
    aset_brick_begin(&bricks, cells, slices, ray, way);
    bool inside = true, known = true; /* known: way stands where the ray enters the brick */
    uint64_t n_cells = 1, n_nonempty = 0;
    aset_real limit = walk->limit; /* kept here, for a visit may change what walk points to */
    while (inside && way->t <= limit) {
        if ((bricks_map(cells, bricks.block, n_faces) & mask) == 0) {
            inside = brick_step(&bricks, slices, ray, way);
            known = false;
            continue;
        }
        n_cells += known ? 0 : aset_brick_land(&bricks, slices, ray, way);
        known = true;
        brick_sides b;
        bool left;
        brick_load(&b, cells, bricks.block, faces, n_faces);
        do {
            int a = n_faces == 1 ? 0 : way->axis;
            if ((b.marks[a] >> cells_place(way->voxel) & 1) != 0) {
                n_nonempty++;
                walk->limit = limit = visit(space, walk, way, b.rank[a], b.marks[a], held);
            }
            inside = dda_step(way, slices, ray);
            n_cells += inside && way->t <= limit;
            left = brick_left(way);
        } while (inside && !left && way->t <= limit);
        if (inside && left) {
            inside = brick_cross(&bricks, slices, ray, way, way->axis);
        }
    }
    walk->nonempty += n_nonempty;
    walk->cells += n_cells + (known ? 0 : aset_brick_count_rest(slices, ray, way, inside, limit));
}

#if !ASET_FUSED
/* The same as one function for all spaces. */
void aset_bricks_walk(const aset_space *space, const probe *ray, walk_request *walk, dda *way, brick_visit visit, uint32_t held);

#if ASET_WITH_APPROXIMATION
/* The approximate walk: shows the visitor the marked cells that are entered at t > 0. */
void aset_bricks_go(const aset_space *space, const probe *ray, walk_request *walk);
#endif
#endif

/* Whichever is to be taken. n_faces: of the space's voxels, a constant where this is called. */
FUSED void bricks_walk(const aset_space *space, const probe *ray, walk_request *walk, dda *way, unsigned n_faces, brick_visit visit,
                       uint32_t held) {
#if ASET_FUSED
    bricks_loop(space, ray, walk, way, n_faces, visit, held);
#else
    (void)n_faces;
    aset_bricks_walk(space, ray, walk, way, visit, held);
#endif
}

#endif
