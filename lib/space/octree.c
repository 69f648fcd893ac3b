/*
 * octree.c - the octree (Glassner 1984): from a leaf the ray goes to the next point behind the leaf's wall, and the leaf
 * that holds it is found by descending from the root.
 *
 *      +-------+---+---+
 *      |       |   |   |      a leaf may be as large as the half of the volume: empty space is crossed in one step,
 *      |    o--+-->|->-+->    and each step costs a descent
 *      |       +---+---+
 *      |       |   | |-|
 *      +-------+---+---+
 */
#include "space/tree.h"

static void octree_go(const aset_space *space, const probe *ray, walk_request *walk) {
    aset_leaves_go(space, ray, walk, aset_tree_find, false);
}

const aset_method aset_octree = {"octree", true, 0, aset_tree_measure, aset_tree_build, octree_go, aset_leaves_each};
