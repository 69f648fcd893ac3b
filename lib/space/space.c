/* space.c - measuring and building any space; automatic divisions that fit. */
#include "base/bits.h"
#include "base/whole.h"
#include "space/answers.h"
#include "space/slices.h"
#include "space/walk.h"

#include <string.h>

#define AUTO_DEPTH 6
#define STACK_SCRATCH_WORDS 128 /* a kilobyte */

const char *aset_method_name(const aset_method *method) {
    return method->name;
}

void aset_auto_divisions(const aset_scene *scene, size_t budget, uint32_t divisions[3]) {
    aset_slices_auto_divisions(scene, scene->counts.objects, budget, divisions);
}

/* The options, checked; automatic ones are filled in. */
static aset_status choose_size(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                               const aset_space_options *options, const aset_arena *arena, bool *is_auto) {
    const uint32_t *n = size->divisions;
    if (!aset_slices_precise(scene)) {
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
    bool fine = size->depth <= ASET_DEPTH_TREE_MAX && (options == NULL || options->textures <= ASET_TEXTURES_MAX);
    return fine ? ASET_OK : ASET_ERR_ARGUMENT;
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
    size->total = whole_bytes((uint64_t)size->cells + size->references + size->voxels + size->scratch - size->reused);
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
    aset_space_size measured;
    aset_status status = choose_size(&measured, scene, method, options, arena, &is_auto);
    if (status == ASET_OK) {
        status = measure_with(&measured, scene, method, arena);
    }
    if (status == ASET_OK) {
        *size = measured;
    } else if (status == ASET_ERR_NOMEM) {
        size->scratch = measured.scratch;
    }
    return status;
}

/* What automatic divisions have to leave room for, beside the space. */
static size_t reserved(const aset_space_size *size, const aset_space_options *options) {
    if (options == NULL) {
        return 0;
    }
    return whole_bytes_sum(options->reserve, options->textures > 0 ? ASET_BYTES_SUMMARY(size->n_cells, options->textures) : 0);
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
    return aset_slices_coarsen(n, far_off);
}

/* Measures; automatic sizes are made smaller until everything fits. */
static aset_status measure_to_fit(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                                  const aset_space_options *options, aset_arena *arena, bool is_auto) {
    aset_status status = measure_with(size, scene, method, arena);
    while (is_auto && (status == ASET_ERR_NOMEM ||
                       (status == ASET_OK && !aset_arena_fits(arena, whole_bytes_sum(size->total, reserved(size, options)))))) {
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
    bool is_auto = false;
    if (space == NULL || scene == NULL || method == NULL || arena == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = choose_size(&size, scene, method, options, arena, &is_auto);
    if (status == ASET_OK) {
        status = measure_to_fit(&size, scene, method, options, arena, is_auto);
    }
    size_t kept = is_auto && options != NULL ? options->reserve : 0; /* room for a summary is an estimate, and may be missing */
    if (status == ASET_OK && !aset_arena_fits(arena, whole_bytes_sum(size.total, kept))) {
        status = ASET_ERR_NOMEM;
    }
    if (status != ASET_OK) {
        return status;
    }
    memset(space, 0, sizeof *space);
    space->method = method;
    space->answers = &aset_exact_answers; /* here, so that a program without a space links none of it */
    space->scene = scene;
    memcpy(space->slices.n, size.divisions, sizeof size.divisions);
    method->build(space, &size, arena);
    return ASET_OK;
}
