/*
 * grid.c - the uniform grid (Fujimoto, Tanaka and Iwata 1986; Amanatides and Woo 1987): every voxel refers to the objects
 * whose boxes touch it.
 *
 *      +---+---+---+---+       an object stands in every voxel of its box, so its references grow with its volume where MSET's
 *      |   | a | a |   |       grow with its surface. A ray meets it first in the voxel by which the ray's way enters the box:
 *      +---+---+---+---+       there the voxel before lies outside. That needs every object's box of voxels beside the
 *      | o-|-a-|-a-|-> |       grid (boxes.h), 12 bytes each, and no memory of the ray's past.
 *      +---+---+---+---+
 */
#include "base/whole.h"
#include "space/boxes.h"
#include "space/lanes.h"
#include "space/walk.h"

static aset_status grid_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch,
                                size_t scratch_bytes) {
    aset_slices slices;
    aset_slices_make(&slices, scene, size->divisions);
    aset_status status = aset_cells_measure(scene, &slices, 1, scratch, scratch_bytes, size);
    size->references = whole_bytes((uint64_t)size->references + ASET_ROUND(scene->counts.objects * sizeof(aset_box)));
    return status;
}

static void grid_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    aset_slices_make(&space->slices, space->scene, size->divisions);
    aset_cells_build(&space->cells, &space->references, space->scene, &space->slices, size, 1, arena);
    space->boxes = aset_arena_alloc(arena, space->scene->counts.objects * sizeof(aset_box), ASET_CATEGORY_REFERENCES);
    aset_boxes_fill(space->boxes, &space->slices, space->scene);
    space->structure.leaves = aset_cells_in_all(size->divisions, 1);
    space->structure.nonempty = space->cells.n_cells;
    space->structure.references = space->references.n;
}

/* The voxel's references that the ray meets for the first time. The new limit. */
static aset_real visit_voxel(const aset_space *space, walk_request *walk, const dda *way, uint32_t rank, uint64_t marks,
                             uint32_t held) {
    (void)held;
    const aset_references *refs = &space->references;
    int32_t before[3] = {way->voxel[0], way->voxel[1], way->voxel[2]};
    bool is_first = way->axis < 0, more = true;
    walk_cell cell;
    brick_cell(&cell, space, way, rank, marks);
    if (!is_first) {
        before[way->axis] -= way->step[way->axis];
    }
    for (uint32_t at = references_begin(refs, rank, marks, cells_place(way->voxel)); more;) {
        uint32_t object = bits_get(refs->objects, refs->width, at++);
        more = !references_ended(refs, at);
        if (is_first || !box_holds(space->boxes + object, before)) {
            cell.objects[cell.n++] = object;
        }
        if (cell.n == WALK_BATCH || (!more && cell.n > 0)) {
            walk->limit = walk->visit(walk, &cell);
            cell.n = 0;
            more = more && walk->limit > -REAL_INFINITY; /* which ends the walk, within a cell too */
        }
    }
    return walk->limit;
}

static void grid_go(const aset_space *space, const probe *ray, walk_request *walk) {
    dda way;
#if ASET_WITH_APPROXIMATION
    if (!walk->wants_references) {
        const uint32_t faces[3] = {0, 0, 0};
        bricks_go(space, ray, walk, faces, 1, true);
        return;
    }
#endif
    if (bricks_begin(&way, space, ray, walk)) {
        bricks_walk(space, ray, walk, &way, 1, visit_voxel, 0);
    }
}

static void grid_each_cell(const aset_space *space, cell_look look, void *context) {
    aset_cells_each(&space->references, look, context);
}

const aset_method aset_grid = {"grid", false, 1, grid_measure, grid_build, grid_go, grid_each_cell};
