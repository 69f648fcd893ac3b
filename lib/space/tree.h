/* tree.h - the octree's nodes, which octree and ARTS walk in their own ways. */
#ifndef ASET_SPACE_TREE_H
#define ASET_SPACE_TREE_H

#include "space/leaves.h"

aset_status aset_tree_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch, size_t scratch_bytes);
void aset_tree_build(aset_space *space, const aset_space_size *size, aset_arena *arena);

/* The leaf that holds a voxel of the finest level, found by descending from the root. */
leaf aset_tree_find(const aset_space *space, const int32_t voxel[3]);

#endif
