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
        aset_object_bounds(scene, i, &low, &high);
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
 * The slices of one axis into planes: the volume's two ends and up to cap - 1 extents between them. The number of voxels;
 * *merged grows by the extents that got no slice of their own.
 */
static uint32_t choose_planes(aset_real *planes, aset_real *extents, const aset_scene *scene, const aset_slices *volume,
                              int a, uint32_t cap, uint64_t *merged) {
    size_t n = collect_extents(extents, scene, a), kept = n < cap ? n : cap - 1;
    uint32_t n_planes = 0;
    planes[n_planes++] = slices_plane(volume, a, 0);
    for (size_t i = 0; i < kept; i++) {
        aset_real x = kept == n ? extents[i] : extents[(2 * i + 1) * n / (2 * kept)];
        if (x > planes[n_planes - 1] && x < slices_plane(volume, a, 1)) {
            planes[n_planes++] = x;
        }
    }
    planes[n_planes] = slices_plane(volume, a, 1);
    *merged += n - kept;
    return n_planes;
}

/* The slices of all axes; planes has room for three times cap + 1 numbers, extents for twice the objects. */
static uint64_t make_slices(aset_slices *slices, const aset_scene *scene, const uint32_t caps[3], aset_real *planes,
                            aset_real *extents) {
    const uint32_t one[3] = {1, 1, 1};
    aset_slices volume;
    uint64_t merged = 0;
    slices_make(&volume, scene, one);
    *slices = volume;
    for (int a = 0; a < 3; a++) {
        slices->planes[a] = planes;
        slices->n[a] = choose_planes(planes, extents, scene, &volume, a, caps[a], &merged);
        slices->width[a] = volume.width[a] / (aset_real)slices->n[a]; /* on average: the voxel of footnote 8 */
        planes += slices->n[a] + 1;
    }
    return merged;
}

static size_t planes_bytes(const uint32_t n[3]) {
    return ASET_ROUND(((size_t)n[0] + n[1] + n[2] + 3) * sizeof(aset_real));
}

static aset_status set_measure(aset_space_size *size, const aset_scene *scene, uint64_t *scratch, size_t scratch_bytes) {
    aset_slices slices;
    size_t room = planes_bytes(size->divisions), extents = ASET_ROUND(2 * scene->counts.objects * sizeof(aset_real));
    size->scratch = room + extents;
    if (scratch_bytes < room + extents + 8) {
        return ASET_ERR_NOMEM;
    }
    memcpy(size->caps, size->divisions, sizeof size->caps);
    (void)make_slices(&slices, scene, size->caps, (aset_real *)(void *)scratch, (aset_real *)(void *)(scratch + room / 8));
    memcpy(size->divisions, slices.n, sizeof size->divisions);
    aset_status status = sides_measure(size, scene, &slices, scratch + room / 8, scratch_bytes - room);
    size->planes = planes_bytes(size->divisions);
    size->cells += size->planes;
    size->scratch = extents;
    return status;
}

static void set_build(aset_space *space, const aset_space_size *size, aset_arena *arena) {
    aset_real *planes = aset_arena_alloc(arena, size->planes, ASET_CATEGORY_CELLS);
    aset_mark mark = aset_arena_mark(arena);
    aset_real *extents = aset_arena_alloc(arena, size->scratch, ASET_CATEGORY_SCRATCH);
    space->structure.merged = make_slices(&space->slices, space->scene, size->caps, planes, extents);
    aset_arena_release(arena, &mark);
    sides_build(space, size, arena);
}

const aset_method aset_set = {"set", false, set_measure, set_build, sides_go, sides_each};
