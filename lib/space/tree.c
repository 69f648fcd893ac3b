/*
 * tree.c - octree nodes in the arena (Glassner 1984): a region with more than leaf objects is halved along all axes at its
 * centre, down to a largest depth; the root has depth 0.
 *
 *      nodes   a word each:  inner   the number of the first of its eight children, which follow one another
 *                            leaf    LEAF | its dense number among the leaves that are not empty
 *                            EMPTY
 *      references.first      where each non-empty leaf's objects begin; one more for the end
 *      boxes                 every object's box of finest voxels: an object stands in a leaf if the box meets its region
 */
#include "space/tree.h"

#include "base/whole.h"

#include <string.h>

#define LEAF 0x80000000u
#define EMPTY 0xffffffffu

/* The root, and eight for each region that is halved. */
static uint64_t nodes_of(const halving *h) {
    return 8 * h->halved + 1;
}

static void tree_inner(halving *h, uint32_t number, uint32_t *children) {
    *children = (uint32_t)nodes_of(h);
    if (h->space != NULL) {
        h->space->nodes[number] = *children;
    }
}

static void tree_leaf(halving *h, uint32_t number, const voxel_box *region, uint32_t depth, uint32_t n) {
    (void)region, (void)depth;
    if (h->space != NULL) {
        h->space->nodes[number] = n > 0 ? LEAF | (uint32_t)h->nonempty : EMPTY;
    }
}

static halving tree_halving(const aset_space_size *size, aset_space *space) {
    halving h = aset_halving_make(size, 8);
    h.space = space;
    h.inner = tree_inner;
    h.leaf_made = tree_leaf;
    return h;
}

aset_status aset_tree_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch, size_t scratch_bytes) {
    halving h = tree_halving(size, NULL);
    memcpy(size->divisions, h.voxels, sizeof h.voxels);
    aset_status status = aset_leaves_measure(size, &h, scene, scratch, scratch_bytes);
    if (status != ASET_OK || nodes_of(&h) >= LEAF) {
        return status != ASET_OK ? status : ASET_ERR_LIMIT;
    }
    size->n_nodes = (uint32_t)nodes_of(&h);
    size->cells = whole_bytes(ASET_ROUND_64((uint64_t)size->n_nodes * 4));
    return ASET_OK;
}

void aset_tree_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    halving h = tree_halving(size, space);
    aset_slices_make(&space->slices, space->scene, size->divisions);
    space->depth = size->depth;
    space->nodes = aset_arena_alloc(arena, (size_t)size->n_nodes * 4, ASET_CATEGORY_CELLS);
    aset_leaves_build(&h, size, arena);
    space->structure.interior = h.halved;
}

leaf aset_tree_find(const aset_space *space, const int32_t voxel[3]) {
    uint32_t node = space->nodes[0], level = space->depth;
    while (node < LEAF) {
        level--;
        node = space->nodes[node + (((uint32_t)voxel[0] >> level & 1) | ((uint32_t)voxel[1] >> level & 1) << 1 |
                                    ((uint32_t)voxel[2] >> level & 1) << 2)];
    }
    leaf l;
    int32_t rest = (int32_t)((1u << level) - 1);
    for (int a = 0; a < 3; a++) {
        l.voxels.low[a] = voxel[a] & ~rest;
        l.voxels.high[a] = voxel[a] | rest;
    }
    l.cell = node == EMPTY ? NO_CELL : node & ~LEAF;
    return l;
}
