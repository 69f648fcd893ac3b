/*
 * baker.h - what the parts of the baker share: baker.c takes entities, sheet.c samples them into bins (bins.c), baker_pass.c
 * decides between passes, draft_write.c makes the words.
 *
 * The region, one piece of the arena's free bytes:
 *
 *     | points, crossings | marks | textures | keys | bins . . . . .   <- raw facets |
 *
 * points and crossings hold the polygon in hand. marks: 64 bits for each block of voxels, empty blocks too. A bin gathers what
 * faces one side of one voxel, in whole numbers only, so that the order of objects cannot matter; bins are found by hashing their keys,
 * voxel * 6 + side, which stand apart from them as a search looks at many. When a pass has ended, the bins of its blocks become raw
 * facets, in the order of voxels and sides.
 */
#ifndef ASET_APPROX_BAKER_H
#define ASET_APPROX_BAKER_H

#include "approx/facet.h"
#include "approx/texture.h"

#if ASET_WITH_DRAFTS

enum { PHASE_MEASURE, PHASE_FIT, PHASE_BAKE, PHASE_DONE, PHASE_FAILED };

#define BIN_EMPTY UINT32_MAX
/* Units of slopes and heights in a bin. */
#define BIN_UNIT 1024

/*
 * What faces one side. Every sample stands for one column's middle: so a surface counts by the area that the side sees of it.
 * SAMPLES_MAX keeps every sum in its bits; a bin that has as many is an error, not a wrong mean. parts: only where there is more
 * than one material.
 */
typedef struct bin {
    uint32_t footprint;
    uint32_t n, columns_u, columns_v;       /* columns: sums of 0 to 3 */
    int64_t height, slope_u, slope_v;
    uint64_t parts[TEXTURE_PARTS];
} bin;

#define SAMPLES_MAX (UINT32_MAX / 3)
#define SAMPLES_MAX_MIXED 0xffffffu /* with parts, each of up to 2^40 */

#define BIN_BYTES_SINGLE offsetof(bin, parts)

/* A raw facet: footprint 16, then height and two slopes, 5 bits and one to spare each, side 3, first of its voxel 1, texture above. */
enum { RAW_HEIGHT = 16, RAW_SLOPE_U = 22, RAW_SLOPE_V = 28, RAW_SIDE = 34, RAW_FIRST = 37, RAW_TEXTURE = 38 };

static inline bin *baker_bin(const aset_baker *baker, uint32_t slot) {
    return (bin *)(void *)(baker->bins + (size_t)slot * baker->bin_bytes);
}

/* The slot of a key, or the empty one where it belongs. */
static inline uint32_t baker_slot(const aset_baker *baker, uint32_t key) {
    uint32_t slot = (uint32_t)((uint64_t)(key * 2654435769u) * baker->capacity >> 32);
    while (baker->keys[slot] != key && baker->keys[slot] != BIN_EMPTY) {
        slot = slot + 1 < baker->capacity ? slot + 1 : 0;
    }
    return slot;
}

static inline uint32_t baker_blocks(const aset_baker *b) {
    return b->blocks[0] * b->blocks[1] * b->blocks[2];
}

static inline uint32_t baker_block_at(const aset_baker *b, uint32_t x, uint32_t y, uint32_t z) {
    return ((z / 4) * b->blocks[1] + y / 4) * b->blocks[0] + x / 4;
}

void aset_bins_clear(aset_baker *b);

/* The bin of a key, made if there is none; NULL: it lies above the ceiling by now, or there is no room at all. */
bin *aset_bins_find(aset_baker *b, uint32_t key);

/* The bins of the blocks baked in this pass become raw facets, or are only counted if baker->counting. */
void aset_baker_harvest(aset_baker *baker);

/* Makes the words at the region's start from all raw facets. ASET_ERR_NOMEM: the region has no room for both. */
aset_status aset_baker_write(aset_baker *baker);

/* False: there is no room for the words of the raw facets so far, and more of them need more. */
bool aset_baker_may_have_room(aset_baker *baker);

/* The bytes of a draft that is all in raw facets, and of the work to write it; with baker->n_counted facets if that is more. */
size_t aset_baker_words_bound(const aset_baker *baker, uint64_t n_facets);

#endif
#endif
