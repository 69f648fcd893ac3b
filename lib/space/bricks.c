/* bricks.c - the walk among bricks. */
#include "space/bricks.h"

void aset_brick_begin(brick_walk *bricks, const aset_cells *cells, const aset_slices *slices, const probe *ray,
                      const dda *way) {
    const int32_t apart[3] = {1, (int32_t)cells->bricks[0], (int32_t)(cells->bricks[0] * cells->bricks[1])};
    bricks->block = cells_block(cells, way->voxel, 0);
    for (int a = 0; a < 3; a++) {
        bricks->at[a] = way->voxel[a] / 4;
        bricks->end[a] = way->step[a] > 0 ? (int32_t)cells->bricks[a] : -1;
        bricks->stride[a] = way->step[a] * apart[a] * (int32_t)cells->faces;
        bricks->next[a] = ray->moves[a] ? brick_exit(slices, ray, a, bricks->at[a]) : REAL_INFINITY;
    }
}

uint32_t aset_brick_land(const brick_walk *bricks, const aset_slices *slices, const probe *ray, dda *way) {
    voxel_box window;
    for (int a = 0; a < 3; a++) {
        int32_t last = (int32_t)slices->n[a] - 1, high = bricks->at[a] * 4 + 3;
        window.low[a] = bricks->at[a] * 4;
        window.high[a] = high < last ? high : last;
    }
    return aset_dda_land(way, slices, ray, &window);
}

uint32_t aset_brick_count_rest(const aset_slices *slices, const probe *ray, dda *way, bool inside, aset_real limit) {
    voxel_box whole = slices_whole(slices);
    uint32_t leaving = 0;
    if (inside || way->t > limit) {
        way->t = limit;
        way->axis = 3;
    } else {
        int a = way->axis; /* the voxel before the crossing that left */
        int32_t last = way->step[a] > 0 ? whole.high[a] : whole.low[a];
        leaving = (uint32_t)((last - way->voxel[a]) * way->step[a]);
        way->voxel[a] = last;
        whole.low[a] = whole.high[a] = last;
    }
    return leaving + aset_dda_land(way, slices, ray, &whole);
}

#if !ASET_FUSED
void aset_bricks_walk(const aset_space *space, const probe *ray, walk_request *walk, dda *way, brick_visit visit, uint32_t held) {
    bricks_loop(space, ray, walk, way, space->cells.faces, visit, held);
}

#if ASET_WITH_APPROXIMATION
static aset_real visit_mark(const aset_space *space, walk_request *walk, const dda *way, uint32_t rank, uint64_t marks,
                            uint32_t held) {
    (void)held;
    walk_cell cell;
    brick_cell(&cell, space, way, rank, marks);
    return way->t > 0 ? walk->visit(walk, &cell) : walk->limit;
}

void aset_bricks_go(const aset_space *space, const probe *ray, walk_request *walk) {
    dda way;
    if (!bricks_begin(&way, space, ray, walk)) {
        return;
    }
    bool is_entered = space->cells.faces == 1 || way.axis >= 0; /* else the voxel has no side that the ray crossed */
    if (is_entered || (dda_step(&way, &space->slices, ray) && way.t <= walk->limit)) {
        aset_bricks_walk(space, ray, walk, &way, visit_mark, 0);
    }
}
#endif
#endif
