/*
 * summary.h - what a cell remembers: summaries, which approximate rays read instead of objects (ASET).
 */
#ifndef ASET_SUMMARY_H
#define ASET_SUMMARY_H

#include "aset/space.h"

ASET_HEADER_BEGIN

#if ASET_WITH_APPROXIMATION

/*
 * One texture for each non-empty cell of a space: the equal-weight average of the materials of the objects that the cell
 * refers to (Dauenhauer and Semwal 1990, option 1). Textures live in one list of bounded capacity; cells with equal averages
 * share an entry. When the list is full, a cell takes the nearest texture and merged counts it. Averages are of whole
 * numbers (units of 2^-16), so they do not depend on the order of the objects.
 */
typedef struct aset_summary {
    const aset_space *space;
    const struct aset_answers *answers; /* private: approximate rays */
    aset_material *textures;
    uint64_t *of_cell; /* private: each cell's texture, packed to width bits */
    unsigned width;
    uint32_t n_textures, capacity;
    uint32_t merged; /* cells that had to take another texture than their own */
} aset_summary;

/*
 * The capacity taken when 0 is asked for: 32 for each material, rounded up to a power of two, from 16 to 4096. It bounds the
 * list; the bytes are those of the textures that there are.
 */
uint32_t aset_summary_capacity(const aset_scene *scene);

/*
 * The bytes that aset_summary_build will take: ASET_BYTES_SUMMARY(space->cells.n_cells, n) for the n textures that there
 * turn out to be, at most capacity. Makes the list in the arena's free bytes without taking them. ASET_ERR_NOMEM: the list
 * alone does not fit; then *bytes, and arena->missing, are enough but may be more than needed.
 */
aset_status aset_summary_measure(size_t *bytes, const aset_space *space, uint32_t capacity, aset_arena *arena);

/*
 * Makes the summary of a built space; capacity 0 takes aset_summary_capacity. ASET_ERR_NOMEM: arena and summary are as
 * before, and arena->missing as aset_summary_measure would say; ASET_ERR_ARGUMENT: a capacity above ASET_TEXTURES_MAX;
 * ASET_ERR_LIMIT: over 2^24 - 1 objects in one cell.
 */
aset_status aset_summary_build(aset_summary *summary, const aset_space *space, uint32_t capacity, aset_arena *arena);

#endif

ASET_HEADER_END
#endif
