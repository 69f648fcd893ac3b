/*
 * mset.c - the modified slicing extent technique (Logan 1989; Dauenhauer and Semwal 1990): marked cell sides (sides.c) of
 * equally spaced slices, whose number is bounded and whose crossings need no search.
 */
#include "space/sides.h"

static aset_status mset_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch,
                                size_t scratch_bytes) {
    aset_slices slices;
    aset_slices_make(&slices, scene, size->divisions);
    return aset_sides_measure(size, scene, &slices, scratch, scratch_bytes);
}

static void mset_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    aset_slices_make(&space->slices, space->scene, size->divisions);
    aset_sides_build(space, size, arena);
}

SIDES_GO(mset_go, true)

const aset_method aset_mset = {"mset", false, 6, mset_measure, mset_build, mset_go, aset_sides_each};
