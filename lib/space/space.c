/* space.c - measuring and building any space; the rule for automatic divisions. */
#include "base/bits.h"
#include "space/answers.h"
#include "space/slices.h"
#include "space/walk.h"

#include <string.h>

#define AUTO_DENSITY 64
#define AUTO_DIVISIONS_MAX 512
#define AUTO_THIN R(0.001)
#define AUTO_DEPTH 6
#define STACK_SCRATCH_WORDS 128 /* a kilobyte */

const char *aset_method_name(const aset_method *method) {
    return method->name;
}

/* The cube root of x >= 1, by Newton's steps from above: twice the precision each once they are near. */
static aset_real cube_root(aset_real x) {
    aset_real root = x;
    for (int i = 0; i < 60; i++) {
        root = (2 * root + x / (root * root)) / 3;
    }
    return root;
}

void aset_auto_divisions(const aset_scene *scene, size_t budget, uint32_t divisions[3]) {
    aset_vec3 low = vec(0, 0, 0), high = vec(1, 1, 1);
    aset_scene_bounds(scene, &low, &high);
    aset_vec3 span = vec_sub(high, low);
    aset_real largest = vec_largest(span), sides[3] = {1, 1, 1}, volume = 1;
    for (int a = 0; a < 3 && largest > 0; a++) { /* relative to the largest, so that no product leaves the range */
        sides[a] = real_max(vec_at(&span, a) / largest, AUTO_THIN);
        volume *= sides[a];
    }
    aset_real per_side = cube_root(AUTO_DENSITY * real_max((aset_real)scene->counts.objects, 1) / volume);
    for (int a = 0; a < 3; a++) {
        aset_real n = sides[a] > AUTO_THIN ? sides[a] * per_side + R(0.5) : 1;
        divisions[a] = n < 1 ? 1 : n > AUTO_DIVISIONS_MAX ? AUTO_DIVISIONS_MAX : (uint32_t)n;
    }
    while (budget > 0 && 12 * ASET_BLOCK_WORDS(divisions[0], divisions[1], divisions[2], 6u) > budget / 2 &&
           (divisions[0] > 1 || divisions[1] > 1 || divisions[2] > 1)) {
        for (int a = 0; a < 3; a++) { /* MSET's map of blocks alone would take half of it */
            divisions[a] -= divisions[a] > 1 ? (divisions[a] + 7) / 8 : 0;
        }
    }
}

/* The least steps between neighbouring coordinates that a scene must be long; or it is one point, which needs none. */
#define STEPS_LEAST 64

static bool is_precise(const aset_scene *scene) {
    aset_real size = vec_largest(vec_sub(scene->high, scene->low));
    aset_real largest = real_max(vec_largest(scene->low), vec_largest(scene->high));
    return scene->counts.objects == 0 || size == 0 || size >= STEPS_LEAST * 2 * REAL_UNIT * largest;
}

/* The options, checked; automatic ones are filled in. */
static aset_status choose_size(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                               const aset_space_options *options, const aset_arena *arena, bool *is_auto) {
    const uint32_t *n = size->divisions;
    if (!is_precise(scene)) {
        return ASET_ERR_PRECISION;
    }
    memset(size, 0, sizeof *size);
    if (options != NULL) {
        memcpy(size->divisions, options->divisions, sizeof size->divisions);
        size->depth = options->depth;
        size->leaf = options->leaf;
    }
    *is_auto = method->by_depth ? size->depth == 0 : n[0] == 0 && n[1] == 0 && n[2] == 0;
    size->depth = size->depth > 0 ? size->depth : AUTO_DEPTH;
    size->leaf = size->leaf > 0 ? size->leaf : 1;
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) {
        aset_auto_divisions(scene, arena != NULL ? arena->size - arena->used : 0, size->divisions);
    }
    for (int a = 0; a < 3; a++) {
        if (n[a] < 1 || n[a] > ASET_DIVISIONS_MAX) {
            return ASET_ERR_ARGUMENT;
        }
    }
    return size->depth <= ASET_DEPTH_TREE_MAX ? ASET_OK : ASET_ERR_ARGUMENT;
}

/* One measurement, with the arena's free bytes as scratch if they are worth more than the stack's kilobyte. */
static aset_status measure_with(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                                aset_arena *arena) {
    uint64_t words[STACK_SCRATCH_WORDS];
    size_t left = arena != NULL ? (arena->size - arena->used) / 8 * 8 : 0;
    aset_status status =
        left > sizeof words
            ? method->measure(size, scene, (uint64_t *)(void *)(arena->block + arena->used), left)
            : method->measure(size, scene, words, sizeof words);
    size->total = size->cells + size->references + size->voxels + size->scratch - size->reused;
    if (status == ASET_ERR_NOMEM && arena != NULL) {
        arena->missing = size->scratch > left ? size->scratch - left : 8;
    }
    return status;
}

aset_status aset_space_measure(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                               const aset_space_options *options, aset_arena *arena) {
    bool is_auto;
    if (size == NULL || scene == NULL || method == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = choose_size(size, scene, method, options, arena, &is_auto);
    return status == ASET_OK ? measure_with(size, scene, method, arena) : status;
}

/* What automatic divisions have to leave room for, beside the space. */
static size_t reserved(const aset_space_size *size, const aset_space_options *options) {
    if (options == NULL) {
        return 0;
    }
    return options->reserve + (options->textures > 0 ? ASET_BYTES_SUMMARY(size->n_cells, options->textures) : 0);
}

/* One step coarser, a large one if the need is far off. False: nothing is coarser. */
static bool shrink(aset_space_size *size, const aset_method *method, bool far_off) {
    uint32_t *n = size->divisions;
    if (method->by_depth) {
        size->depth--;
        return size->depth > 0;
    }
    if (size->caps[0] > 0) {
        memcpy(n, size->caps, sizeof size->caps); /* SET: what was asked for, not what was made of it */
    }
    if (n[0] == 1 && n[1] == 1 && n[2] == 1) {
        return false;
    }
    for (int a = 0; a < 3; a++) {
        uint32_t less = far_off ? (n[a] + 1) / 2 : (n[a] + 7) / 8;
        n[a] = n[a] > less ? n[a] - less : 1;
    }
    return true;
}

/* Measures; automatic sizes are made smaller until everything fits. */
static aset_status measure_to_fit(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                                  const aset_space_options *options, aset_arena *arena, bool is_auto) {
    aset_status status = measure_with(size, scene, method, arena);
    while (is_auto && (status == ASET_ERR_NOMEM ||
                       (status == ASET_OK && !aset_arena_fits(arena, size->total + reserved(size, options))))) {
        aset_space_size smaller = *size;
        size_t left = arena->size - arena->used;
        if (!shrink(&smaller, method, size->total / 8 > left)) {
            break; /* a summary may still need less than was reserved for it */
        }
        *size = smaller;
        status = measure_with(size, scene, method, arena);
    }
    return status;
}

aset_status aset_space_build(aset_space *space, const aset_scene *scene, const aset_method *method,
                             const aset_space_options *options, aset_arena *arena) {
    aset_space_size size;
    bool is_auto;
    if (space == NULL || scene == NULL || method == NULL || arena == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = choose_size(&size, scene, method, options, arena, &is_auto);
    if (status == ASET_OK) {
        status = measure_to_fit(&size, scene, method, options, arena, is_auto);
    }
    if (status == ASET_OK && !aset_arena_fits(arena, size.total)) {
        status = ASET_ERR_NOMEM;
    }
    if (status != ASET_OK) {
        return status;
    }
    memset(space, 0, sizeof *space);
    space->method = method;
    space->answers = &exact_answers; /* here, so that a program without a space links none of it */
    space->scene = scene;
    memcpy(space->slices.n, size.divisions, sizeof size.divisions);
    method->build(space, &size, arena);
    return ASET_OK;
}
