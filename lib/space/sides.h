/* sides.h - marked cell sides over slices that are equally spaced (MSET) or not (SET). */
#ifndef ASET_SPACE_SIDES_H
#define ASET_SPACE_SIDES_H

#include "space/lanes.h"
#include "space/slices.h"
#include "space/walk.h"

aset_status aset_sides_measure(aset_space_size *size, const aset_scene *scene, const aset_slices *slices, uint64_t *scratch,
                               size_t scratch_bytes);
/* space->slices are made. */
void aset_sides_build(aset_space *space, const aset_space_size *size, aset_arena *arena);
/* The exact walk. */
void aset_sides_go(const aset_space *space, const probe *ray, walk_request *walk);

/*
 * Both walks, in the method's own file: of the approximate one (lanes.h) there is one for equally spaced slices and one for a
 * table, as a choice at every crossing would cost a tenth of it, and a program gets that of the method it names.
 */
#if ASET_WITH_APPROXIMATION
#define SIDES_GO(name, even)                                                                                                \
    static void name(const aset_space *space, const probe *ray, walk_request *walk) {                                       \
        if (walk->wants_references) {                                                                                       \
            aset_sides_go(space, ray, walk);                                                                                \
        } else {                                                                                                            \
            const uint32_t faces[3] = {ray->direction[0] < 0, 2 + (ray->direction[1] < 0), 4 + (ray->direction[2] < 0)};    \
            bricks_go(space, ray, walk, faces, 6, even);                                                                    \
        }                                                                                                                   \
    }
#else
#define SIDES_GO(name, even)                                                                                                \
    static void name(const aset_space *space, const probe *ray, walk_request *walk) {                                       \
        aset_sides_go(space, ray, walk);                                                                                    \
    }
#endif

void aset_sides_each(const aset_space *space, cell_look look, void *context);

#endif
