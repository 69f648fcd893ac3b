/*
 * sides.c - marked cell sides: what MSET and SET share. They differ in where the slices are, and in nothing else.
 *
 * An object is written into the up sides that the low face of its expanded box covers and the down sides that the high face
 * covers:
 *
 *        slice k            slice m
 *           |   expanded box   |           A ray from outside enters the box once, through one of these sides, and so meets
 *     up -> |==================| <- down   the object exactly once: no object is tested twice for one ray. The hit may
 *           |     (object)     |           lie beyond the next slices, so the walk goes on until the next cell begins
 *           |                  |           behind the nearest hit.
 *
 * An up side of slice k is the way into voxel k, a down side of slice k the way into voxel k - 1: a side is kept as (voxel,
 * face of entry). The up sides of the last slice and the down sides of the first are never marked.
 *
 * Rays that start inside: an object whose box holds the origin's voxel is never entered from there. Instead of lists for
 * every voxel (bytes in proportion to the objects' volumes) the ray's line is walked from a little before its origin: boxes
 * span at most reach voxels, so a box that holds the origin's voxel lies in the window of reach - 1 voxels around it, and
 * the line enters it there, before t = 0. The few boxes that are much larger than the others would make that window the
 * whole scene; these, at most ASET_LARGE_MAX, are kept in a list with their voxels, tested first if they hold the origin's
 * voxel, and passed over when the backward part of the walk meets them.
 */
#include "space/sides.h"

#include <string.h>

#define FACES 6u

aset_status aset_sides_measure(aset_space_size *size, const aset_scene *scene, const aset_slices *slices, uint64_t *scratch,
                               size_t scratch_bytes) {
    size->voxels = ASET_ROUND(ASET_LARGE_MAX * sizeof(aset_large));
    return aset_cells_measure(scene, slices, FACES, scratch, scratch_bytes, size);
}

/* The voxels that a box spans along its longest axis. */
static uint32_t box_span(const voxel_box *box) {
    uint32_t span = 0;
    for (int a = 0; a < 3; a++) {
        uint32_t n = (uint32_t)(box->high[a] - box->low[a] + 1);
        span = n > span ? n : span;
    }
    return span;
}

/* Among the kept ones, the one with the smallest span. */
static uint32_t smallest_of(const uint32_t *spans, uint32_t n) {
    uint32_t least = 0;
    for (uint32_t i = 1; i < n; i++) {
        least = spans[i] < spans[least] ? i : least;
    }
    return least;
}

/*
 * Finds the largest boxes and the reach of the rest. A box that is no larger than that reach would gain nothing by being
 * listed, and is dropped again.
 */
static void find_large(aset_space *space) {
    uint32_t spans[ASET_LARGE_MAX], objects[ASET_LARGE_MAX], n = 0, rest = 1;
    for (uint32_t i = 0; i < space->scene->counts.objects; i++) {
        voxel_box box = aset_slices_object_box(&space->slices, space->scene, i);
        uint32_t span = box_span(&box), at = n;
        if (n == ASET_LARGE_MAX) {
            at = smallest_of(spans, n);
            uint32_t leaves = span > spans[at] ? spans[at] : span;
            rest = leaves > rest ? leaves : rest;
            if (span <= spans[at]) {
                continue;
            }
            for (; at + 1 < n; at++) { /* keeps the list sorted by object */
                spans[at] = spans[at + 1];
                objects[at] = objects[at + 1];
            }
        } else {
            n++;
        }
        spans[at] = span;
        objects[at] = i;
    }
    rest = rest < 2 ? 2 : rest;
    for (uint32_t i = 0; i < n; i++) {
        if (spans[i] > rest) {
            voxel_box box = aset_slices_object_box(&space->slices, space->scene, objects[i]);
            aset_large *large = space->large + space->n_large++;
            large->object = objects[i];
            for (int a = 0; a < 3; a++) {
                large->low[a] = (uint16_t)box.low[a];
                large->high[a] = (uint16_t)box.high[a];
            }
        }
    }
    space->reach = rest;
}

void aset_sides_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    aset_cells_build(&space->cells, &space->references, space->scene, &space->slices, size, FACES, arena);
    space->large = aset_arena_alloc(arena, size->voxels, ASET_CATEGORY_VOXELS);
    find_large(space);
    space->structure.leaves = aset_cells_in_all(size->divisions, FACES);
    space->structure.nonempty = space->cells.n_cells;
    space->structure.references = space->references.n;
}

static bool large_holds(const aset_large *large, const int32_t voxel[3]) {
    for (int a = 0; a < 3; a++) {
        if (voxel[a] < large->low[a] || voxel[a] > large->high[a]) {
            return false;
        }
    }
    return true;
}

/* Visits the large objects whose boxes hold the origin's voxel; held keeps a bit for each. The new limit. */
static aset_real visit_large(const aset_space *space, const int32_t voxel[3], walk_request *walk, uint32_t *held) {
    walk_cell cell = {NO_CELL, FACE_NONE, 0, 0, {0}};
    for (uint32_t i = 0; i < space->n_large; i++) {
        if (large_holds(space->large + i, voxel)) {
            *held |= UINT32_C(1) << i;
            cell.objects[cell.n++] = space->large[i].object;
        }
    }
    return cell.n > 0 ? walk->visit(walk, &cell) : walk->limit;
}

/* Was this object visited by visit_large? */
static bool was_held(const aset_space *space, uint32_t object, uint32_t held) {
    for (uint32_t i = 0; held >> i != 0; i++) {
        if ((held >> i & 1) != 0 && space->large[i].object == object) {
            return true;
        }
    }
    return false;
}

/* The references of a cell, in batches; in the backward part (held) without those already visited. The new limit. */
static aset_real visit_cell(const aset_space *space, walk_request *walk, walk_cell *cell, uint32_t begin, uint32_t held) {
    const aset_references *refs = &space->references;
    aset_real limit = walk->limit;
    uint32_t at = begin;
    bool more = true;
    while (more) {
        cell->n = 0;
        do {
            uint32_t object = bits_get(refs->objects, refs->width, at++);
            more = !references_ended(refs, at);
            if (held == 0 || !was_held(space, object, held)) {
                cell->objects[cell->n++] = object;
            }
        } while (more && cell->n < WALK_BATCH);
        if (cell->n > 0) {
            limit = walk->visit(walk, cell);
            more = more && limit > -REAL_INFINITY; /* which ends the walk, within a cell too */
        }
    }
    return limit;
}

/* Where an exact walk from inside begins: at the edge of the window around the origin's voxel. */
static voxel_box window_around(const aset_space *space, const int32_t voxel[3]) {
    voxel_box window;
    int32_t reach = (int32_t)space->reach - 1;
    for (int a = 0; a < 3; a++) {
        int32_t last = (int32_t)space->slices.n[a] - 1;
        window.low[a] = voxel[a] > reach ? voxel[a] - reach : 0;
        window.high[a] = last - voxel[a] > reach ? voxel[a] + reach : last;
    }
    return window;
}

/* Puts the walk at its first cell. False: there is none. */
static bool sides_begin(const aset_space *space, const probe *ray, walk_request *walk, dda *way, uint32_t *held) {
    voxel_box window = slices_whole(&space->slices);
    if (aset_dda_inside(way, &space->slices, ray)) {
        walk->limit = visit_large(space, way->voxel, walk, held);
        window = window_around(space, way->voxel);
    }
    return aset_dda_enter(way, &space->slices, ray, &window);
}

/* A marked cell side: its references or its number go to the visitor. The new limit. */
static aset_real visit_side(const aset_space *space, walk_request *walk, const dda *way, uint32_t rank, uint64_t marks,
                            uint32_t held) {
    walk_cell cell;
    brick_cell(&cell, space, way, rank, marks);
    return visit_cell(space, walk, &cell, references_begin(&space->references, rank, marks, cells_place(way->voxel)),
                      way->t > 0 ? 0 : held);
}

void aset_sides_go(const aset_space *space, const probe *ray, walk_request *walk) {
    uint32_t held = 0;
    dda way;
    if (space->cells.n_cells > 0 && sides_begin(space, ray, walk, &way, &held) && way.t <= walk->limit) {
        bricks_walk(space, ray, walk, &way, FACES, visit_side, held);
    }
}

void aset_sides_each(const aset_space *space, cell_look look, void *context) {
    aset_cells_each(&space->references, look, context);
}
