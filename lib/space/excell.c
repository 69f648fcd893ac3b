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

#include <string.h>

typedef struct excell_pass {
    aset_space *space; /* NULL while counting */
    uint64_t buckets, nonempty, references;
    uint32_t deepest;
    uint32_t full[3]; /* the logarithm of the whole's voxels along each axis, as the halving counts them */
} excell_pass;

/* Of d halvings in turn, how many are along axis a. */
static uint32_t halvings_of(uint32_t d, int a) {
    return (d + 2 - (uint32_t)a) / 3;
}

static void excell_inner(void *context, uint32_t number, uint32_t *children) {
    (void)context, (void)number;
    *children = 0; /* regions need no numbers */
}

/* Tells the directory's cells of a region their bucket. */
static void fill_directory(excell_pass *p, const voxel_box *region, uint32_t bucket) {
    aset_space *space = p->space;
    const uint32_t *n = space->slices.n;
    uint32_t low[3], high[3];
    for (int a = 0; a < 3; a++) {
        uint32_t coarser = p->full[a] - halvings_of(space->depth, a);
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

static void excell_leaf(void *context, uint32_t number, const voxel_box *region, uint32_t depth, const uint32_t *objects,
                        uint32_t n) {
    excell_pass *p = context;
    (void)number;
    if (p->space != NULL) {
        aset_references *refs = &p->space->references;
        uint32_t empties = (uint32_t)(p->buckets - p->nonempty);
        uint32_t bucket = n > 0 ? (uint32_t)p->nonempty : p->space->cells.n_cells + empties;
        p->space->bucket_depth[bucket] = (uint8_t)depth;
        fill_directory(p, region, bucket);
        for (uint32_t i = 0; i < n; i++) {
            bits_put(refs->objects, refs->width, (size_t)p->references + i, objects[i]);
        }
        if (n > 0) {
            refs->first[p->nonempty] = (uint32_t)p->references;
            refs->first[p->nonempty + 1] = (uint32_t)(p->references + n);
        }
    }
    p->deepest = depth > p->deepest ? depth : p->deepest;
    p->buckets++;
    p->nonempty += n > 0;
    p->references += n;
}

static halving excell_halving(const aset_space_size *size, const aset_box *boxes, uint32_t n_objects, uint32_t *lists,
                              uint64_t room, excell_pass *pass) {
    halving h = aset_halving_make(size, 2, boxes, n_objects, lists, room);
    pass->full[0] = pass->full[1] = pass->full[2] = size->depth;
    h.context = pass;
    h.inner = excell_inner;
    h.leaf_made = excell_leaf;
    return h;
}

static aset_status excell_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch,
                                  size_t scratch_bytes) {
    aset_slices slices;
    uint32_t n = scene->counts.objects, finest[3];
    excell_pass pass;
    memset(&pass, 0, sizeof pass);
    finest[0] = finest[1] = finest[2] = 1u << size->depth;
    aset_slices_make(&slices, scene, finest);
    size_t boxes_bytes = ASET_ROUND((size_t)n * sizeof(aset_box));
    size->scratch = boxes_bytes + ASET_ROUND((size_t)n * 4 * (3 * size->depth + 1));
    if (scratch_bytes < boxes_bytes) {
        return ASET_ERR_NOMEM;
    }
    aset_box *boxes = (aset_box *)(void *)scratch;
    aset_boxes_fill(boxes, &slices, scene);
    halving h = excell_halving(size, boxes, n, (uint32_t *)(void *)((unsigned char *)scratch + boxes_bytes),
                               (scratch_bytes - boxes_bytes) / 4, &pass);
    if (aset_halving_run(&h) != ASET_OK) {
        return ASET_ERR_NOMEM;
    }
    if (pass.references > UINT32_MAX - 2) {
        return ASET_ERR_LIMIT;
    }
    for (int a = 0; a < 3; a++) {
        size->divisions[a] = 1u << halvings_of(pass.deepest, a);
    }
    size->n_nodes = 1u << pass.deepest;
    size->n_leaves = (uint32_t)pass.buckets;
    size->n_cells = (uint32_t)pass.nonempty;
    size->n_references = (uint32_t)pass.references;
    size->listed = h.deepest;
    size->cells = (size_t)ASET_BYTES_PACKED(size->n_nodes, ASET_WIDTH(size->n_leaves)) + ASET_ROUND(size->n_leaves);
    size->references = ASET_BYTES_LEAVES(pass.nonempty, pass.references, n);
    size->scratch = ASET_ROUND((size_t)h.deepest * 4);
    return ASET_OK;
}

static void excell_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    uint32_t n = space->scene->counts.objects;
    const uint32_t finest[3] = {1u << size->depth, 1u << size->depth, 1u << size->depth};
    excell_pass pass;
    aset_slices fine;
    memset(&pass, 0, sizeof pass);
    pass.space = space;
    aset_slices_make(&fine, space->scene, finest);
    aset_slices_make(&space->slices, space->scene, size->divisions);
    while (1u << space->depth < size->n_nodes) {
        space->depth++;
    }
    space->cells.n_cells = size->n_cells;
    space->directory_width = bits_width(size->n_leaves);
    space->directory =
        aset_arena_alloc(arena, (size_t)ASET_BYTES_PACKED(size->n_nodes, space->directory_width), ASET_CATEGORY_CELLS);
    space->bucket_depth = aset_arena_alloc(arena, size->n_leaves, ASET_CATEGORY_CELLS);
    aset_leaves_reserve(space, size, arena);
    aset_boxes_fill(space->boxes, &fine, space->scene);
    aset_mark mark = aset_arena_mark(arena);
    uint32_t *lists = aset_arena_alloc(arena, size->scratch, ASET_CATEGORY_SCRATCH);
    halving h = excell_halving(size, space->boxes, n, lists, size->listed, &pass);
    (void)aset_halving_run(&h); /* the lists have the room that measuring found */
    aset_arena_release(arena, &mark);
    aset_boxes_fill(space->boxes, &space->slices, space->scene); /* of the directory's cells, which the ray walks */
    space->structure.interior = size->n_leaves - 1;
    space->structure.leaves = size->n_leaves;
    space->structure.nonempty = size->n_cells;
    space->structure.references = size->n_references;
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
