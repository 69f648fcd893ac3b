/* leaves.c - from leaf to leaf along a ray, and the building of leaves by halving. */
#include "space/leaves.h"

#include "base/bits.h"
#include "base/whole.h"

#include <string.h>

/* The references of a leaf whose objects the ray meets here for the first time. */
static void visit_leaf(const aset_space *space, const probe *ray, walk_request *walk, const stay *s, uint32_t begin,
                       uint32_t end, walk_cell *cell) {
    const aset_references *refs = &space->references;
    cell->n = 0;
    for (uint32_t at = begin; at < end; at++) {
        uint32_t object = bits_get(refs->objects, refs->width, at);
        if (aset_stay_enters(s, &space->slices, ray, space->boxes + object)) {
            cell->objects[cell->n++] = object;
        }
        if (cell->n == WALK_BATCH || (at + 1 == end && cell->n > 0)) {
            walk->limit = walk->visit(walk, cell);
            cell->n = 0;
            if (!(walk->limit > -REAL_INFINITY)) {
                return; /* the end of the walk, within a cell too */
            }
        }
    }
}

/* Out of the leaf, into the voxel behind the crossing that leaves it. False: out of the volume. */
static bool leave_leaf(dda *way, const aset_slices *slices, const probe *ray, const stay *s, const voxel_box *cell,
                       bool by_steps) {
    if (by_steps) {
        do {
            if (!dda_step(way, slices, ray)) {
                return false;
            }
        } while (way->voxel[way->axis] >= cell->low[way->axis] && way->voxel[way->axis] <= cell->high[way->axis]);
        return true;
    }
    int a = s->axis_out;
    if (a > 2) {
        return false; /* a ray that moves along no axis stays where it is */
    }
    voxel_box window = *cell; /* of the other axes; along a, the next voxel */
    int32_t next = way->step[a] > 0 ? cell->high[a] + 1 : cell->low[a] - 1;
    window.low[a] = window.high[a] = next;
    way->t = s->t_out;
    way->axis = a;
    if (next == way->end[a]) {
        return false;
    }
    (void)aset_dda_land(way, slices, ray, &window);
    return true;
}

void aset_leaves_go(const aset_space *space, const probe *ray, walk_request *walk, leaf_find find, bool by_steps) {
    const aset_slices *slices = &space->slices;
    voxel_box whole = slices_whole(slices);
    dda way;
    if (space->cells.n_cells == 0 || (!aset_dda_inside(&way, slices, ray) && !aset_dda_enter(&way, slices, ray, &whole))) {
        return;
    }
    bool inside = true;
    while (inside && way.t <= walk->limit) {
        leaf l = find(space, way.voxel);
        stay s;
        aset_stay_make(&s, &way, slices, ray, &l.voxels);
        walk->cells++;
        if (l.cell != NO_CELL && (walk->wants_references || way.t > 0)) {
            walk_cell cell;
            walk->nonempty++;
            cell.index = l.cell;
            cell.t = way.t;
            cell.face = way.axis < 0 ? FACE_NONE : way.axis * 2 + (way.step[way.axis] < 0);
            cell.n = 0;
            if (walk->wants_references) {
                const uint32_t *first = space->references.first + l.cell;
                visit_leaf(space, ray, walk, &s, first[0], first[1], &cell);
            } else {
                walk->limit = walk->visit(walk, &cell);
            }
        }
        inside = leave_leaf(&way, slices, ray, &s, &l.voxels, by_steps);
    }
}

void aset_leaves_each(const aset_space *space, cell_look look, void *context) {
    const aset_references *refs = &space->references;
    for (uint32_t cell = 0; cell < space->cells.n_cells; cell++) {
        for (uint32_t at = refs->first[cell]; at < refs->first[cell + 1]; at++) {
            uint32_t object = bits_get(refs->objects, refs->width, at);
            look(context, cell, &object, 1);
        }
    }
}

/* --- building by halving --- */

halving aset_halving_make(const aset_space_size *size, int ways) {
    halving h;
    memset(&h, 0, sizeof h);
    h.leaf = size->leaf;
    h.depth = ways == 8 ? size->depth : 3 * size->depth;
    h.ways = ways;
    h.voxels[0] = h.voxels[1] = h.voxels[2] = 1u << size->depth;
    return h;
}

/* One level of the halving in progress. */
typedef struct level {
    voxel_box region;
    uint32_t *list;
    uint32_t n;        /* objects in list */
    uint32_t number;   /* the region's */
    uint32_t children; /* the number of its first child */
    int next;          /* the child to be done next */
} level;

/* Room for the objects of a region and of all above it. */
typedef struct lists {
    uint32_t *objects;
    uint64_t room;
} lists;

/* Child number child of a region: along each halved axis, bit 0 the lower half and 1 the upper. */
static voxel_box half_of(const halving *h, const voxel_box *region, uint32_t depth, int child) {
    voxel_box half = *region;
    for (int a = 0; a < 3; a++) {
        if (h->ways == 2 && (uint32_t)a != depth % 3) {
            continue;
        }
        int32_t middle = region->low[a] + (region->high[a] - region->low[a] + 1) / 2;
        bool upper = h->ways == 2 ? child != 0 : (child >> a & 1) != 0;
        half.low[a] = upper ? middle : half.low[a];
        half.high[a] = upper ? half.high[a] : middle - 1;
    }
    return half;
}

/* The objects of a child, listed behind its parent's. */
static aset_status list_child(halving *h, const aset_box *boxes, const lists *all, const level *parent, level *child) {
    uint64_t used = (uint64_t)(parent->list + parent->n - all->objects);
    child->list = parent->list + parent->n;
    child->n = 0;
    for (uint32_t i = 0; i < parent->n; i++) {
        if (box_meets(boxes + parent->list[i], &child->region)) {
            if (used + child->n == all->room) {
                return ASET_ERR_NOMEM;
            }
            child->list[child->n++] = parent->list[i];
        }
    }
    h->listed = used + child->n > h->listed ? used + child->n : h->listed;
    return ASET_OK;
}

/* A leaf's objects behind those of the leaves before. */
static void add_leaf(halving *h, const level *l, uint32_t depth) {
    if (h->space != NULL) {
        aset_references *refs = &h->space->references;
        for (uint32_t i = 0; i < l->n; i++) {
            bits_put(refs->objects, refs->width, (size_t)h->references + i, l->list[i]);
        }
        if (l->n > 0) {
            refs->first[h->nonempty] = (uint32_t)h->references;
            refs->first[h->nonempty + 1] = (uint32_t)(h->references + l->n);
        }
    }
    h->deepest = depth > h->deepest ? depth : h->deepest;
    h->leaves++;
    h->nonempty += l->n > 0;
    h->references += l->n;
}

/* ASET_ERR_NOMEM if the lists need more room. Halvings nest as deep as depth: the stack here is of fixed size. */
static aset_status run(halving *h, const aset_box *boxes, uint32_t n_objects, const lists *all) {
    level levels[HALVINGS_MAX + 1];
    uint32_t depth = 0;
    h->listed = n_objects;
    if (all->room < n_objects) {
        return ASET_ERR_NOMEM;
    }
    levels[0].list = all->objects;
    levels[0].n = n_objects;
    levels[0].number = 0;
    levels[0].next = -1; /* not looked at yet */
    for (int a = 0; a < 3; a++) {
        levels[0].region.low[a] = 0;
        levels[0].region.high[a] = (int32_t)h->voxels[a] - 1;
    }
    for (uint32_t i = 0; i < n_objects; i++) {
        all->objects[i] = i;
    }
    for (;;) {
        level *l = &levels[depth];
        if (l->next < 0 && (l->n <= h->leaf || depth == h->depth)) {
            h->leaf_made(h, l->number, &l->region, depth, l->n);
            add_leaf(h, l, depth);
        } else if (l->next < 0) {
            h->inner(h, l->number, &l->children);
            h->halved++;
            l->next = 0;
        }
        if (l->next < 0 || l->next == h->ways) { /* done with: back to the level above */
            if (depth == 0) {
                return ASET_OK;
            }
            depth--;
            continue;
        }
        level *child = &levels[depth + 1];
        child->region = half_of(h, &l->region, depth, l->next);
        child->number = l->children + (uint32_t)l->next;
        child->next = -1;
        l->next++;
        if (list_child(h, boxes, all, l, child) != ASET_OK) {
            return ASET_ERR_NOMEM;
        }
        depth++;
    }
}

aset_status aset_leaves_measure(aset_space_size *size, halving *h, const aset_scene *scene, uint64_t *scratch,
                                size_t scratch_bytes) {
    aset_slices slices;
    uint32_t n = scene->counts.objects;
    size_t boxes_bytes = ASET_ROUND((size_t)n * sizeof(aset_box));
    size->scratch = whole_bytes(boxes_bytes + ASET_ROUND_64((uint64_t)n * 4 * (h->depth + 1))); /* enough for any scene */
    if (scratch_bytes < boxes_bytes) {
        return ASET_ERR_NOMEM;
    }
    aset_box *boxes = (aset_box *)(void *)scratch;
    const lists all = {(uint32_t *)(void *)((unsigned char *)scratch + boxes_bytes), (scratch_bytes - boxes_bytes) / 4};
    aset_slices_make(&slices, scene, h->voxels);
    aset_boxes_fill(boxes, &slices, scene);
    if (run(h, boxes, n, &all) != ASET_OK) {
        return ASET_ERR_NOMEM;
    }
    if (h->references > UINT32_MAX - 2) {
        return ASET_ERR_LIMIT;
    }
    size->n_leaves = (uint32_t)h->leaves;
    size->n_cells = (uint32_t)h->nonempty;
    size->n_references = (uint32_t)h->references;
    size->listed = h->listed;
    size->references = whole_bytes(ASET_BYTES_LEAVES_64(h->nonempty, h->references, n));
    size->scratch = whole_bytes(ASET_ROUND_64((uint64_t)h->listed * 4));
    return ASET_OK;
}

void aset_leaves_build(halving *h, const aset_space_size *size, aset_arena *arena) {
    aset_space *space = h->space;
    aset_references *refs = &space->references;
    aset_slices slices;
    uint32_t n = space->scene->counts.objects;
    space->cells.n_cells = size->n_cells;
    refs->n = size->n_references;
    refs->width = bits_width(n);
    refs->first = aset_arena_alloc(arena, ((size_t)size->n_cells + 1) * 4, ASET_CATEGORY_REFERENCES);
    refs->objects = aset_arena_alloc(arena, (size_t)ASET_BYTES_PACKED(refs->n, refs->width), ASET_CATEGORY_REFERENCES);
    space->boxes = aset_arena_alloc(arena, (size_t)n * sizeof(aset_box), ASET_CATEGORY_REFERENCES);
    aset_slices_make(&slices, space->scene, h->voxels);
    aset_boxes_fill(space->boxes, &slices, space->scene);
    aset_mark mark = aset_arena_mark(arena);
    const lists all = {aset_arena_alloc(arena, size->scratch, ASET_CATEGORY_SCRATCH), size->listed};
    (void)run(h, space->boxes, n, &all); /* the lists have the room that measuring found */
    aset_arena_release(arena, &mark);
    space->structure.leaves = size->n_leaves;
    space->structure.nonempty = size->n_cells;
    space->structure.references = size->n_references;
}
