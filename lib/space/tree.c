/*
 * tree.c - octree nodes in the arena (Glassner 1984): a region with more than leaf objects is halved along all axes at its
 * centre, down to a largest depth; the root has depth 0.
 *
 *      nodes   a word each:  inner   the number of the first of its eight children, which follow one another
 *                            leaf    LEAF | its dense number among the leaves that are not empty
 *                            EMPTY
 *      references.first      where each non-empty leaf's objects begin; one more for the end
 *      boxes                 every object's box of finest voxels: an object stands in a leaf if the box meets its region
 *
 * Building goes twice through the same halving, first counting, then writing; what is being divided is listed behind the
 * result while it is built.
 */
#include "space/tree.h"

#include "base/bits.h"

#define LEAF 0x80000000u
#define EMPTY 0xffffffffu

typedef struct tree_pass {
    aset_space *space; /* NULL while counting */
    uint64_t nodes, leaves, nonempty, references;
} tree_pass;

static void tree_inner(void *context, uint32_t number, uint32_t *children) {
    tree_pass *p = context;
    *children = (uint32_t)p->nodes;
    if (p->space != NULL) {
        p->space->nodes[number] = *children;
    }
    p->nodes += 8;
}

static void tree_leaf(void *context, uint32_t number, const voxel_box *region, uint32_t depth, const uint32_t *objects,
                      uint32_t n) {
    tree_pass *p = context;
    (void)region, (void)depth;
    if (p->space != NULL) {
        aset_references *refs = &p->space->references;
        p->space->nodes[number] = n > 0 ? LEAF | (uint32_t)p->nonempty : EMPTY;
        for (uint32_t i = 0; i < n; i++) {
            bits_put(refs->objects, refs->width, (size_t)p->references + i, objects[i]);
        }
        if (n > 0) {
            refs->first[p->nonempty] = (uint32_t)p->references;
            refs->first[p->nonempty + 1] = (uint32_t)(p->references + n);
        }
    }
    p->leaves++;
    p->nonempty += n > 0;
    p->references += n;
}

static halving tree_halving(const aset_space_size *size, const aset_box *boxes, uint32_t n_objects, uint32_t *lists,
                            uint64_t room, tree_pass *pass) {
    halving h = aset_halving_make(size, 8, boxes, n_objects, lists, room);
    h.context = pass;
    h.inner = tree_inner;
    h.leaf_made = tree_leaf;
    return h;
}

aset_status aset_tree_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch, size_t scratch_bytes) {
    aset_slices slices;
    uint32_t n = scene->counts.objects;
    tree_pass pass = {NULL, 1, 0, 0, 0};
    size->divisions[0] = size->divisions[1] = size->divisions[2] = 1u << size->depth;
    aset_slices_make(&slices, scene, size->divisions);
    size_t boxes_bytes = ASET_ROUND((size_t)n * sizeof(aset_box));
    size->scratch = boxes_bytes + ASET_ROUND((size_t)n * 4 * (size->depth + 1)); /* enough for any scene */
    if (scratch_bytes < boxes_bytes) {
        return ASET_ERR_NOMEM;
    }
    aset_box *boxes = (aset_box *)(void *)scratch;
    aset_boxes_fill(boxes, &slices, scene);
    halving h = tree_halving(size, boxes, n, (uint32_t *)(void *)((unsigned char *)scratch + boxes_bytes),
                             (scratch_bytes - boxes_bytes) / 4, &pass);
    if (aset_halving_run(&h) != ASET_OK) {
        return ASET_ERR_NOMEM;
    }
    if (pass.references > UINT32_MAX - 2 || pass.nodes >= LEAF) {
        return ASET_ERR_LIMIT;
    }
    size->n_nodes = (uint32_t)pass.nodes;
    size->n_leaves = (uint32_t)pass.leaves;
    size->n_cells = (uint32_t)pass.nonempty;
    size->n_references = (uint32_t)pass.references;
    size->listed = h.deepest;
    size->cells = ASET_ROUND((size_t)pass.nodes * 4);
    size->references = ASET_BYTES_LEAVES(pass.nonempty, pass.references, n);
    size->scratch = ASET_ROUND((size_t)h.deepest * 4);
    return ASET_OK;
}

void aset_tree_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    uint32_t n = space->scene->counts.objects;
    tree_pass pass = {space, 1, 0, 0, 0};
    aset_slices_make(&space->slices, space->scene, size->divisions);
    space->depth = size->depth;
    space->nodes = aset_arena_alloc(arena, (size_t)size->n_nodes * 4, ASET_CATEGORY_CELLS);
    aset_leaves_reserve(space, size, arena);
    aset_boxes_fill(space->boxes, &space->slices, space->scene);
    aset_mark mark = aset_arena_mark(arena);
    uint32_t *lists = aset_arena_alloc(arena, size->scratch, ASET_CATEGORY_SCRATCH);
    halving h = tree_halving(size, space->boxes, n, lists, size->listed, &pass);
    (void)aset_halving_run(&h); /* the lists have the room that measuring found */
    aset_arena_release(arena, &mark);
    space->structure.interior = (size->n_nodes - 1) / 8;
    space->structure.leaves = size->n_leaves;
    space->structure.nonempty = size->n_cells;
    space->structure.references = size->n_references;
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
