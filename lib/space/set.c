/*
 * set.c - the slicing extent technique (Semwal 1987): marked cell sides (sides.c) of slices that stand where the objects'
 * extents are, in sorted order, so that every box fits its slices exactly.
 *
 *      |  |  |     |   |            |        each object puts a slice at either end of its box on each axis; shared ends
 *      |  +--|-----|---+            |        share a slice. Slices grow with the objects, and cells with their cube:
 *      |  |  +-----+   |            |        beyond a cap (the divisions given) neighbouring extents are merged, so that
 *      |  +--|-----|---+            |        each remaining slice stands for as many of them, and boxes grow to the
 *      |  |  |     |   |            |        next slice that is left.
 *
 * Where a slice is, is looked up in a table; which one a coordinate belongs to, found by halving it.
 */
#include "base/bits.h"
#include "base/whole.h"
#include "space/sides.h"

#include <string.h>

/* Puts the number at root into its place in the heap of n numbers, the largest on top. */
static void sift(aset_real *heap, size_t root, size_t n) {
    aset_real x = heap[root];
    for (size_t child; (child = 2 * root + 1) < n; root = child) {
        child += child + 1 < n && heap[child + 1] > heap[child];
        if (heap[child] <= x) {
            break;
        }
        heap[root] = heap[child];
    }
    heap[root] = x;
}

/* Heapsort (Williams 1964): in place, without recursion, n log n whatever the order. */
static void sort_reals(aset_real *x, size_t n) {
    for (size_t i = n / 2; i > 0; i--) {
        sift(x, i - 1, n);
    }
    for (size_t i = n; i > 1; i--) {
        aset_real top = x[0];
        x[0] = x[i - 1];
        x[i - 1] = top;
        sift(x, 0, i - 1);
    }
}

/* All extents along an axis, sorted, each once; how many. */
static size_t collect_extents(aset_real *extents, const aset_scene *scene, int a) {
    size_t n = 0, n_objects = scene->counts.objects;
    for (uint32_t i = 0; i < n_objects; i++) {
        aset_vec3 low, high;
        aset_object_own_bounds(scene, i, &low, &high);
        extents[2 * i] = slices_grown_low(scene, vec_at(&low, a));
        extents[2 * i + 1] = slices_grown_high(scene, vec_at(&high, a));
    }
    sort_reals(extents, 2 * n_objects);
    for (size_t i = 0; i < 2 * n_objects; i++) {
        if (n == 0 || extents[i] > extents[n - 1]) {
            extents[n++] = extents[i];
        }
    }
    return n;
}

/*
 * The slices of one axis into planes, which have room for so many numbers: the volume's two ends and up to cap - 1 extents
 * between them. The number of voxels, 0 if there is no room; *merged grows by the extents that got no slice of their own.
 */
static uint32_t choose_planes(aset_real *planes, size_t room, aset_real *extents, const aset_scene *scene,
                              const aset_slices *volume, int a, uint32_t cap, uint64_t *merged) {
    size_t n = collect_extents(extents, scene, a), kept = n < cap ? n : cap - 1;
    aset_real last = volume->first[a];
    uint32_t n_planes = 0;
    for (size_t i = 0; i < kept + 2; i++) {
        bool is_end = i == 0 || i == kept + 1;
        size_t k = kept == n || kept < 2 ? i - 1 : (size_t)whole_quotient((uint64_t)(i - 1) * (n - 1), kept - 1); /* both outermost ones among them */
        aset_real x = i == 0 ? volume->first[a] : is_end ? volume->last[a] : extents[k];
        if (!is_end && (x <= last || x >= volume->last[a])) {
            continue;
        }
        if (n_planes == room) {
            return 0;
        }
        planes[n_planes++] = last = x;
    }
    *merged += n - kept;
    return n_planes - 1;
}

/* The slices of all axes, one axis' planes behind the other's. False: there is no room. */
static bool make_slices(aset_slices *slices, const aset_scene *scene, const uint32_t caps[3], aset_real *planes, size_t room,
                        aset_real *extents, uint64_t *merged) {
    const uint32_t one[3] = {1, 1, 1};
    aset_slices volume;
    aset_slices_make(&volume, scene, one);
    *slices = volume;
    *merged = 0;
    for (int a = 0; a < 3; a++) {
        uint32_t n = choose_planes(planes, room, extents, scene, &volume, a, caps[a], merged);
        if (n == 0) {
            return false;
        }
        slices->planes[a] = planes;
        slices->n[a] = n;
        slices->width[a] = volume.width[a] / (aset_real)n; /* on average: the voxel of footnote 8 */
        planes += n + 1;
        room -= n + 1;
    }
    return true;
}

static size_t planes_bytes(const uint32_t n[3]) {
    return ASET_ROUND(((size_t)n[0] + n[1] + n[2] + 3) * sizeof(aset_real));
}

static size_t extents_bytes(const aset_scene *scene) {
    return ASET_ROUND(2 * (size_t)scene->counts.objects * sizeof(aset_real));
}

/*
 * Extents first, planes behind them; the marks are then counted where the extents were, or behind the planes if there is more
 * room. So measuring needs no more than building, which has the extents only until the slices are made.
 */
static aset_status set_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch, size_t scratch_bytes) {
    aset_slices slices;
    uint64_t merged;
    size_t extents = extents_bytes(scene), room = scratch_bytes > extents ? scratch_bytes - extents : 0;
    memcpy(size->caps, size->divisions, sizeof size->caps);
    size->scratch = extents + planes_bytes(size->caps);
    uint64_t *planes = scratch + extents / 8;
    if (room == 0 || !make_slices(&slices, scene, size->caps, (aset_real *)(void *)planes, room / sizeof(aset_real),
                                  (aset_real *)(void *)scratch, &merged)) {
        return ASET_ERR_NOMEM;
    }
    memcpy(size->divisions, slices.n, sizeof size->divisions);
    size->planes = planes_bytes(size->divisions);
    size_t behind = room > size->planes ? room - size->planes : 0;
    aset_status status = behind > extents ? aset_sides_measure(size, scene, &slices, planes + size->planes / 8, behind)
                                          : aset_sides_measure(size, scene, &slices, scratch, extents);
    size_t sides = whole_bytes((uint64_t)size->cells + size->references + size->voxels);
    size->cells = whole_bytes((uint64_t)size->cells + size->planes);
    size->scratch = extents;
    size->reused = extents < sides ? extents : sides; /* the sides take the extents' place */
    return status;
}

static void set_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    aset_real *planes = aset_arena_alloc(arena, size->planes, ASET_CATEGORY_CELLS);
    aset_mark mark = aset_arena_mark(arena);
    aset_real *extents = aset_arena_alloc(arena, extents_bytes(space->scene), ASET_CATEGORY_SCRATCH);
    (void)make_slices(&space->slices, space->scene, size->caps, planes, size->planes / sizeof(aset_real), extents,
                      &space->structure.merged);
    aset_arena_release(arena, &mark);
    aset_sides_build(space, size, arena);
}

SIDES_GO(set_go, false)

const aset_method aset_set = {"set", false, 0, set_measure, set_build, set_go, aset_sides_each};
