/*
 * arts.c - ARTS (Fujimoto, Tanaka and Iwata 1986): the octree's leaves, reached by the 3DDA of its finest level.
 *
 *      +-------+-+-+-+-+      the ray steps through the finest voxels with one addition and one comparison each; only when a
 *      |  . . .|.|.| | |      step leaves the leaf is the next one looked up. Steps are cheap, but a large empty leaf
 *      |  o->->|>|>|>|>|>     is crossed voxel by voxel.
 *      +-------+-+-+-+-+
 */
#include "space/tree.h"

static void arts_go(const aset_space *space, const probe *ray, walk_request *walk) {
    aset_leaves_go(space, ray, walk, aset_tree_find, true);
}

const aset_method aset_arts = {"arts", true, 0, aset_tree_measure, aset_tree_build, arts_go, aset_leaves_each};
