/*
 * excell.c - EXCELL (Tamminen 1981): the volume is halved along x, y and z in turn until no region holds more than a bucket
 * may; a directory as fine as the finest region tells the bucket of every cell, so that finding it is one look.
 *
 *      directory  +--+--+--+--+     a bucket of fewer halvings than the directory is shared by all the directory's cells in its
 *                 | 0  0| 1| 2|     region; the directory doubles with each halving of its finest bucket
 *                 | 0  0| 3| 3|
 *                 +--+--+--+--+     buckets: those that are not empty come first, and their numbers are the cells'
 */
#include "space/leaves.h"

#include "base/bits.h"
#include "base/whole.h"

/* Of d halvings in turn, how many are along axis a. */
static uint32_t halvings_of(uint32_t d, int a) {
    return (d + 2 - (uint32_t)a) / 3;
}

static void excell_inner(halving *h, uint32_t number, uint32_t *children) {
    (void)h, (void)number;
    *children = 0; /* regions need no numbers */
}

/* Tells the directory's cells of a region their bucket. */
static void fill_directory(const halving *h, const voxel_box *region, uint32_t bucket) {
    aset_space *space = h->space;
    const uint32_t *n = space->slices.n;
    uint32_t low[3], high[3];
    for (int a = 0; a < 3; a++) {
        uint32_t coarser = halvings_of(h->depth, a) - halvings_of(space->depth, a);
        low[a] = (uint32_t)region->low[a] >> coarser;
        high[a] = (uint32_t)region->high[a] >> coarser;
    }
    for (uint32_t z = low[2]; z <= high[2]; z++) {
        for (uint32_t y = low[1]; y <= high[1]; y++) {
            for (uint32_t x = low[0]; x <= high[0]; x++) {
                bits_put(space->directory, space->directory_width, ((size_t)z * n[1] + y) * n[0] + x, bucket);
            }
        }
    }
}

static void excell_leaf(halving *h, uint32_t number, const voxel_box *region, uint32_t depth, uint32_t n) {
    (void)number;
    if (h->space != NULL) {
        uint32_t empties = (uint32_t)(h->leaves - h->nonempty);
        uint32_t bucket = n > 0 ? (uint32_t)h->nonempty : h->space->cells.n_cells + empties;
        h->space->bucket_depth[bucket] = (uint8_t)depth;
        fill_directory(h, region, bucket);
    }
}

static halving excell_halving(const aset_space_size *size, aset_space *space) {
    halving h = aset_halving_make(size, 2);
    h.space = space;
    h.inner = excell_inner;
    h.leaf_made = excell_leaf;
    return h;
}

static aset_status excell_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch,
                                  size_t scratch_bytes) {
    halving h = excell_halving(size, NULL);
    aset_status status = aset_leaves_measure(size, &h, scene, scratch, scratch_bytes);
    if (status != ASET_OK) {
        return status;
    }
    for (int a = 0; a < 3; a++) {
        size->divisions[a] = 1u << halvings_of(h.deepest, a);
    }
    size->n_nodes = 1u << h.deepest;
    size->cells = whole_bytes(ASET_BYTES_PACKED(size->n_nodes, ASET_WIDTH(size->n_leaves)) + ASET_ROUND_64(size->n_leaves));
    return ASET_OK;
}

static void excell_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    halving h = excell_halving(size, space);
    aset_slices_make(&space->slices, space->scene, size->divisions);
    while (1u << space->depth < size->n_nodes) {
        space->depth++;
    }
    space->directory_width = bits_width(size->n_leaves);
    space->directory =
        aset_arena_alloc(arena, (size_t)ASET_BYTES_PACKED(size->n_nodes, space->directory_width), ASET_CATEGORY_CELLS);
    space->bucket_depth = aset_arena_alloc(arena, size->n_leaves, ASET_CATEGORY_CELLS);
    aset_leaves_build(&h, size, arena);
    aset_boxes_fill(space->boxes, &space->slices, space->scene); /* of the directory's cells, which the ray walks */
    space->structure.interior = size->n_leaves - 1;
}

static leaf excell_find(const aset_space *space, const int32_t voxel[3]) {
    const uint32_t *n = space->slices.n;
    size_t at = ((size_t)voxel[2] * n[1] + (size_t)voxel[1]) * n[0] + (size_t)voxel[0];
    uint32_t bucket = bits_get(space->directory, space->directory_width, at), depth = space->bucket_depth[bucket];
    leaf l;
    for (int a = 0; a < 3; a++) {
        int32_t rest = (int32_t)((1u << (halvings_of(space->depth, a) - halvings_of(depth, a))) - 1);
        l.voxels.low[a] = voxel[a] & ~rest;
        l.voxels.high[a] = voxel[a] | rest;
    }
    l.cell = bucket < space->cells.n_cells ? bucket : NO_CELL;
    return l;
}

static void excell_go(const aset_space *space, const probe *ray, walk_request *walk) {
    aset_leaves_go(space, ray, walk, excell_find, false);
}

const aset_method aset_excell = {"excell", true, 0, excell_measure, excell_build, excell_go, aset_leaves_each};
