/*
 * leaves.h - the walk that octree, ARTS and EXCELL share: from leaf to leaf of a subdivision by halving, whose leaves are
 * boxes of the voxels of its finest level.
 */
#ifndef ASET_SPACE_LEAVES_H
#define ASET_SPACE_LEAVES_H

#include "space/boxes.h"
#include "space/walk.h"

/* A leaf found for a voxel. */
typedef struct leaf {
    voxel_box voxels;
    uint32_t cell; /* dense number among the leaves that are not empty, or NO_CELL */
} leaf;

typedef leaf (*leaf_find)(const aset_space *space, const int32_t voxel[3]);

/*
 * Walks. by_steps: the next leaf is found by crossing the finest level's slices one by one (ARTS); else by going straight to
 * the crossing that leaves the leaf (Glassner's next point).
 */
void aset_leaves_go(const aset_space *space, const probe *ray, walk_request *walk, leaf_find find, bool by_steps);

/* Looks at every leaf that is not empty: for aset_method.each_cell. */
void aset_leaves_each(const aset_space *space, cell_look look, void *context);

/* Takes the references of leaves, and the objects' boxes, from the arena: ASET_BYTES_LEAVES. */
void aset_leaves_reserve(aset_space *space, const aset_space_size *size, aset_arena *arena);

/* --- building by halving --- */

/*
 * A region is halved while it holds more than leaf objects and is above the depth: along all axes at once (octree), or along
 * x, y, z in turn (EXCELL). Every leaf is told with its objects, in the order of their numbers.
 */
typedef struct halving {
    const aset_box *boxes;
    uint32_t n_objects, leaf, depth;
    int ways;         /* 8: all axes at once; 2: in turn */
    uint32_t size[3]; /* voxels along each axis of the whole: powers of two */
    uint32_t *lists;  /* room for the objects of a region and of all above it */
    uint64_t room;    /* entries */
    uint64_t deepest; /* entries used at the most */
    void *context;
    /* a region that is halved; number: what children was told for it (0 for the root) plus the child's place */
    void (*inner)(void *context, uint32_t number, uint32_t *children);
    void (*leaf_made)(void *context, uint32_t number, const voxel_box *region, uint32_t depth, const uint32_t *objects,
                      uint32_t n);
} halving;

/*
 * A halving within the size's limits, of a whole of 2^depth voxels along each axis; in turn (ways 2), three halvings make a level.
 * What is called for regions and leaves is still to be set.
 */
halving aset_halving_make(const aset_space_size *size, int ways, const aset_box *boxes, uint32_t n_objects, uint32_t *lists,
                          uint64_t room);

/* ASET_ERR_NOMEM if the lists need more room. Halvings nest as deep as depth: the stack here is of fixed size. */
aset_status aset_halving_run(halving *h);

#define HALVINGS_MAX 30 /* the depth of ten octree levels, in single halvings */

#endif
