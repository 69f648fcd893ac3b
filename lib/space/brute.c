/*
 * brute.c - no subdivision at all: one cell, the scene's box, that refers to every object. The oracle of all other methods:
 * it tests every object for every ray, whatever the visitor says, so tests = rays x objects.
 */
#include "space/slices.h"
#include "space/walk.h"

static aset_status brute_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch,
                                 size_t scratch_bytes) {
    (void)scratch;
    (void)scratch_bytes;
    size->n_cells = scene->counts.objects > 0;
    size->n_references = scene->counts.objects;
    return ASET_OK;
}

static void brute_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    (void)arena;
    const uint32_t one[3] = {1, 1, 1};
    aset_slices_make(&space->slices, space->scene, one);
    space->cells.n_cells = size->n_cells;
    space->structure.leaves = 1;
    space->structure.nonempty = size->n_cells;
    space->structure.references = size->n_references;
}

static void brute_go(const aset_space *space, const probe *ray, walk_request *walk) {
    const voxel_box whole = {{0, 0, 0}, {0, 0, 0}};
    uint32_t n_objects = space->scene->counts.objects;
    walk_cell cell = {0, FACE_NONE, 0, 0, {0}};
    dda entry;
    walk->cells++;
    walk->nonempty += n_objects > 0;
    if (!walk->wants_references) {
        if (n_objects > 0 && aset_dda_enter(&entry, &space->slices, ray, &whole) && entry.t > 0 && entry.t <= walk->limit) {
            cell.t = entry.t;
            cell.face = entry.axis * 2 + (ray->direction[entry.axis] < 0);
            walk->visit(walk, &cell);
        }
        return;
    }
    for (uint32_t i = 0; i < n_objects; i++) {
        cell.objects[0] = i; /* one at a time: a visitor that has enough leaves the rest of a batch */
        cell.n = 1;
        walk->visit(walk, &cell);
    }
}

static void brute_each_cell(const aset_space *space, cell_look look, void *context) {
    for (uint32_t i = 0; i < space->scene->counts.objects; i++) {
        look(context, 0, &i, 1);
    }
}

const aset_method aset_brute = {"brute", false, 0, brute_measure, brute_build, brute_go, brute_each_cell};
