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
#include "space/boxes.h"
#include "space/bricks.h"
#include "space/walk.h"

static aset_status grid_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch,
                                size_t scratch_bytes) {
    aset_slices slices;
    aset_slices_make(&slices, scene, size->divisions);
    aset_status status = aset_cells_measure(scene, &slices, 1, scratch, scratch_bytes, size);
    size->references += ASET_ROUND(scene->counts.objects * sizeof(aset_box));
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
static aset_real visit_voxel(const aset_space *space, walk_request *walk, const dda *way, uint32_t rank, uint64_t marks) {
    const aset_references *refs = &space->references;
    unsigned place = cells_place(way->voxel);
    int32_t before[3] = {way->voxel[0], way->voxel[1], way->voxel[2]};
    bool is_first = way->axis < 0, more = true;
    walk_cell cell;
    cell.index = space->cells.first[rank] + bits_count(marks & ((UINT64_C(1) << place) - 1));
    cell.face = is_first ? FACE_NONE : way->axis * 2 + (way->step[way->axis] < 0);
    cell.t = way->t;
    cell.n = 0;
    if (!is_first) {
        before[way->axis] -= way->step[way->axis];
    }
    for (uint32_t at = references_begin(refs, rank, marks, place); more;) {
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

/* The walk: as sides.c's, from brick to brick, with the one block of a brick that a grid has. */
static void grid_go(const aset_space *space, const probe *ray, walk_request *walk) {
    const aset_cells *cells = &space->cells;
    const aset_slices *slices = &space->slices;
    voxel_box whole = slices_whole(slices);
    brick_walk bricks;
    dda way;
#if ASET_WITH_APPROXIMATION
    if (!walk->wants_references) {
        const uint32_t faces[3] = {0, 0, 0};
        bricks_go(space, ray, walk, faces, 1, true);
        return;
    }
#endif
    if (cells->n_cells == 0 || (!aset_dda_inside(&way, slices, ray) && !aset_dda_enter(&way, slices, ray, &whole)) ||
        way.t > walk->limit) {
        return;
    }
    aset_brick_begin(&bricks, cells, slices, ray, &way);
    bool inside = true, known = true;
    uint64_t n_cells = 1;
    while (inside && way.t <= walk->limit) {
        uint32_t rank = cells_rank(cells, bricks.block);
        if (rank == NO_CELL) {
            inside = brick_step(&bricks, slices, ray, &way);
            known = false;
            continue;
        }
        n_cells += known ? 0 : aset_brick_land(&bricks, slices, ray, &way);
        known = true;
        uint64_t marks = cells->marks[rank];
        bool left;
        do {
            if ((marks >> cells_place(way.voxel) & 1) != 0) {
                walk->nonempty++;
                walk->limit = visit_voxel(space, walk, &way, rank, marks);
            }
            inside = dda_step(&way, slices, ray);
            n_cells += inside && way.t <= walk->limit;
            left = brick_left(&way);
        } while (inside && !left && way.t <= walk->limit);
        if (inside && left) {
            inside = brick_cross(&bricks, slices, ray, &way, way.axis);
        }
    }
    walk->cells += n_cells + (known ? 0 : aset_brick_count_rest(slices, ray, &way, inside, walk->limit));
}

static void grid_each_cell(const aset_space *space, cell_look look, void *context) {
    aset_cells_each(&space->references, look, context);
}

const aset_method aset_grid = {"grid", false, 1, grid_measure, grid_build, grid_go, grid_each_cell};
