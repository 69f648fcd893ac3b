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
    leaves_go(space, ray, walk, tree_find, false);
}

const aset_method aset_octree = {"octree", true, 0, tree_measure, tree_build, octree_go, leaves_each};
