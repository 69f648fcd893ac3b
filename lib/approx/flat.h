/*
 * flat.h - what the parts of the flat way share: flat.c takes entities, flat_pass.c decides between passes.
 *
 * In the arena, behind the stage:
 *
 *     | map, ranks | marks, first | wide numbers, known materials | before, textures, sums |
 *       first pass   second         third                           further ones, each for the next cells
 *
 * Most cells have objects of one material only, and then its number says all. Sums are for the others.
 */
#ifndef ASET_APPROX_FLAT_H
#define ASET_APPROX_FLAT_H

#include "aset/flat.h"
#include "approx/texture.h"

#if ASET_WITH_APPROXIMATION

/*
 * Of each object the phases want: its box's blocks; its marks, and in which parts materials differ; its material's number;
 * its material as part of sums.
 */
enum { FLAT_BLOCKS, FLAT_MARKS, FLAT_NUMBERS, FLAT_SUMS, FLAT_DONE, FLAT_FAILED };

/* What stands in wide before a cell has its texture: 0, the number of a known material, or that there are several. */
static inline uint32_t flat_several(const aset_flat *f) {
    return f->known_max + 1;
}

#define FLAT_KNOWN_MAX 254u /* so that this fits in 8 bits */
#define FLAT_GROUP 16u      /* cells for each entry of before */

/* The parts that differ of a known material. */
static inline uint64_t *flat_known(const aset_flat *f, uint32_t number) {
    return f->known + (size_t)(number - 1) * f->n_differing;
}

/* The words of a cell's sum: how many objects, then each part that differs. */
static inline uint64_t *flat_sum(const aset_flat *f, uint32_t number) {
    return f->sums + (size_t)number * f->sum_words;
}

#endif
#endif
