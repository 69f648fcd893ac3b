/* leaves.c - from leaf to leaf along a ray, and the building of leaves by halving. */
#include "space/leaves.h"

#include "base/bits.h"

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

void aset_leaves_reserve(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    uint32_t n = space->scene->counts.objects;
    aset_references *refs = &space->references;
    space->cells.n_cells = size->n_cells;
    refs->n = size->n_references;
    refs->width = bits_width(n);
    refs->first = aset_arena_alloc(arena, ((size_t)size->n_cells + 1) * 4, ASET_CATEGORY_REFERENCES);
    refs->objects = aset_arena_alloc(arena, (size_t)ASET_BYTES_PACKED(refs->n, refs->width), ASET_CATEGORY_REFERENCES);
    space->boxes = aset_arena_alloc(arena, (size_t)n * sizeof(aset_box), ASET_CATEGORY_REFERENCES);
}

halving aset_halving_make(const aset_space_size *size, int ways, const aset_box *boxes, uint32_t n_objects, uint32_t *lists,
                          uint64_t room) {
    halving h;
    memset(&h, 0, sizeof h);
    h.boxes = boxes;
    h.n_objects = n_objects;
    h.leaf = size->leaf;
    h.depth = ways == 8 ? size->depth : 3 * size->depth;
    h.ways = ways;
    h.size[0] = h.size[1] = h.size[2] = 1u << size->depth;
    h.lists = lists;
    h.room = room;
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
static aset_status list_child(halving *h, const level *parent, level *child, uint64_t used) {
    child->list = parent->list + parent->n;
    child->n = 0;
    for (uint32_t i = 0; i < parent->n; i++) {
        if (box_meets(h->boxes + parent->list[i], &child->region)) {
            if (used + child->n == h->room) {
                return ASET_ERR_NOMEM;
            }
            child->list[child->n++] = parent->list[i];
        }
    }
    h->deepest = used + child->n > h->deepest ? used + child->n : h->deepest;
    return ASET_OK;
}

aset_status aset_halving_run(halving *h) {
    level levels[HALVINGS_MAX + 1];
    uint32_t depth = 0;
    h->deepest = h->n_objects;
    if (h->room < h->n_objects) {
        return ASET_ERR_NOMEM;
    }
    levels[0].list = h->lists;
    levels[0].n = h->n_objects;
    levels[0].number = 0;
    levels[0].next = -1; /* not looked at yet */
    for (int a = 0; a < 3; a++) {
        levels[0].region.low[a] = 0;
        levels[0].region.high[a] = (int32_t)h->size[a] - 1;
    }
    for (uint32_t i = 0; i < h->n_objects; i++) {
        h->lists[i] = i;
    }
    for (;;) {
        level *l = &levels[depth];
        if (l->next < 0 && (l->n <= h->leaf || depth == h->depth)) {
            h->leaf_made(h->context, l->number, &l->region, depth, l->list, l->n);
        } else if (l->next < 0) {
            h->inner(h->context, l->number, &l->children);
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
        if (list_child(h, l, child, (uint64_t)(l->list + l->n - h->lists)) != ASET_OK) {
            return ASET_ERR_NOMEM;
        }
        depth++;
    }
}
