/* sides.h - marked cell sides over slices that are equally spaced (MSET) or not (SET). */
#ifndef ASET_SPACE_SIDES_H
#define ASET_SPACE_SIDES_H

#include "space/slices.h"
#include "space/walk.h"

aset_status sides_measure(aset_space_size *size, const aset_scene *scene, const aset_slices *slices, uint64_t *scratch,
                          size_t scratch_bytes);
/* space->slices are made. */
void sides_build(aset_space *space, const aset_space_size *size, aset_arena *arena);
void sides_go(const aset_space *space, const probe *ray, walk_request *walk);
void sides_each(const aset_space *space, cell_look look, void *context);

#endif
