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

/* --- building by halving --- */

/*
 * A region is halved while it holds more than leaf objects and is above the depth: along all axes at once (octree), or along
 * x, y, z in turn (EXCELL). Every leaf is told with its objects, in the order of their numbers. Building goes twice through the
 * same halving, first counting, then writing.
 */
typedef struct halving {
    aset_space *space;  /* NULL while counting */
    uint32_t leaf, depth;
    int ways;           /* 8: all axes at once; 2: in turn */
    uint32_t voxels[3]; /* along each axis of the whole: powers of two */
    uint64_t halved, leaves, nonempty, references; /* so far: regions halved, leaves, those not empty, objects in them */
    uint32_t deepest;   /* leaf so far */
    uint64_t listed;    /* objects of a region and of all above it, at the most */
    /* a region that is halved; number: what children was told for it (0 for the root) plus the child's place */
    void (*inner)(struct halving *h, uint32_t number, uint32_t *children);
    /* a leaf of n objects, which are counted, or written, afterwards */
    void (*leaf_made)(struct halving *h, uint32_t number, const voxel_box *region, uint32_t depth, uint32_t n);
} halving;

/*
 * A halving within the size's limits, of a whole of 2^depth voxels along each axis; in turn (ways 2), three halvings make a level.
 * What is called for regions and leaves is still to be set.
 */
halving aset_halving_make(const aset_space_size *size, int ways);

/*
 * Counts, with every object's box and the lists of what is being divided in scratch, and fills in all of size that follows from
 * leaves; cells are the caller's. As aset_method.measure.
 */
aset_status aset_leaves_measure(aset_space_size *size, halving *h, const aset_scene *scene, uint64_t *scratch,
                                size_t scratch_bytes);

/* Writes h->space's references, ASET_BYTES_LEAVES, with the lists behind them until all is divided. */
void aset_leaves_build(halving *h, const aset_space_size *size, aset_arena *arena);

#define HALVINGS_MAX 30 /* the depth of ten octree levels, in single halvings */

#endif
