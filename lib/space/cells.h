/*
 * cells.h - which cells are marked, and their dense numbers; the references of each.
 *
 * A cell is (voxel, face): MSET marks the cell side by which a ray would enter a voxel, so it has six faces a voxel (axis *
 * 2, + 1 for a ray going down); a grid has one. Marks are kept in blocks of 4 x 4 x 4 voxels of one face, and only blocks
 * with a mark exist:
 *
 *      map        0 1 0 0 1 1 0 ...   a bit for each block, in the order of bricks, then faces; a rank for each word of 64
 *                   |     | |
 *      marks        .     . .         64 bits for each non-empty block; first[]: the cells before it
 *
 * so a cell's dense number is first[block] + the marks below it, and finding it costs two counts of bits. An empty block
 * costs one bit, a non-empty one 12 bytes (16 with references), whatever the number of objects.
 *
 * The references of all cells follow one another in dense order: one bit a reference says where a cell's begin, and object
 * numbers are packed to the bits that the largest needs. (Counts in unary with ranks: Jacobson 1989.)
 */
#ifndef ASET_SPACE_CELLS_H
#define ASET_SPACE_CELLS_H

#include "base/bits.h"
#include "space/slices.h"
#include "space/walk.h"

/* The block of a voxel and face, in the map's order, and the voxel's place in it. */
static inline uint32_t cells_block(const aset_cells *cells, const int32_t voxel[3], uint32_t face) {
    uint32_t brick = ((uint32_t)voxel[2] / 4 * cells->bricks[1] + (uint32_t)voxel[1] / 4) * cells->bricks[0] +
                     (uint32_t)voxel[0] / 4;
    return brick * cells->faces + face;
}

static inline unsigned cells_place(const int32_t voxel[3]) {
    return ((unsigned)voxel[2] & 3) << 4 | ((unsigned)voxel[1] & 3) << 2 | ((unsigned)voxel[0] & 3);
}

/* The number of a block among the non-empty ones, NO_CELL if it is empty. */
static inline uint32_t cells_rank(const aset_cells *cells, uint32_t block) {
    uint64_t word = cells->map[block >> 6] >> (block & 63);
    if ((word & 1) == 0) {
        return NO_CELL;
    }
    return cells->map_rank[block >> 6] + bits_count(cells->map[block >> 6] & ((UINT64_C(1) << (block & 63)) - 1));
}

/* The part of an expanded box that is marked for one of six faces: the layer of voxels that a ray enters there. */
static inline voxel_box cells_face_box(const voxel_box *box, uint32_t face) {
    voxel_box layer = *box;
    if ((face & 1) == 0) {
        layer.high[face / 2] = box->low[face / 2];
    } else {
        layer.low[face / 2] = box->high[face / 2];
    }
    return layer;
}

/*
 * Counts what build would make: blocks, cells and references of every object's box of voxels, its six layers for faces = 6
 * or the whole box for faces = 1. Works in scratch, a bitmap of as many blocks at a time as fit; at least 8 bytes.
 * ASET_ERR_LIMIT: more than 2^32 - 2 of any.
 */
aset_status aset_cells_measure(const aset_scene *scene, const aset_slices *slices, uint32_t faces, uint64_t *scratch,
                               size_t scratch_bytes, aset_space_size *size);

/* All cells of so many voxels, empty ones included: for faces = 6 the cell sides, 2 sum of (n_a + 1) n_b n_c. */
uint64_t aset_cells_in_all(const uint32_t n[3], uint32_t faces);

/* The cells that refer to an object of this box. */
uint64_t aset_cells_references(const voxel_box *box, uint32_t faces);

/* Called for every block that an object's box marks, with the marks it sets there. */
typedef void (*cells_action)(void *context, uint32_t block, uint64_t marks);

void aset_cells_each_block(const aset_cells *cells, const voxel_box *box, cells_action act, void *context);

/*
 * Building, step by step, of boxes in any order, each step with all boxes: the map (cleared) and its blocks; when those have
 * their ranks, the marks (cleared), and when they are set, dense numbers. Both takes want an arena that holds
 * ASET_BYTES_CELLS: the first that of 0 blocks, the second the rest. aset_cells_rank_marks is false, and n_cells wrong, if that
 * exceeds 2^32 - 2.
 */
void aset_cells_take_map(aset_cells *cells, const aset_slices *slices, uint32_t faces, aset_arena *arena);
void aset_cells_mark_blocks(aset_cells *cells, const voxel_box *box);
void aset_cells_rank_blocks(aset_cells *cells);
void aset_cells_take_marks(aset_cells *cells, aset_arena *arena);
void aset_cells_mark(aset_cells *cells, const voxel_box *box); /* in blocks that are marked; others stay as they are */
bool aset_cells_rank_marks(aset_cells *cells);

/* Makes marks and references of the counts that measure gave, in an arena that holds them. */
void aset_cells_build(aset_cells *cells, aset_references *references, const aset_scene *scene, const aset_slices *slices,
                      const aset_space_size *size, uint32_t faces, aset_arena *arena);

/* Looks at every cell, in dense order: for aset_method.each_cell. */
void aset_cells_each(const aset_references *references, cell_look look, void *context);

/* Where the references of the cell at place in non-empty block number rank begin. */
static inline uint32_t references_begin(const aset_references *references, uint32_t rank, uint64_t marks,
                                        unsigned place) {
    unsigned skip = bits_count(marks & ((UINT64_C(1) << place) - 1));
    uint32_t at = references->first[rank], word = at >> 6;
    uint64_t starts = references->starts[word] & (~UINT64_C(0) << (at & 63));
    unsigned here = bits_count(starts);
    while (here <= skip) {
        skip -= here;
        starts = references->starts[++word];
        here = bits_count(starts);
    }
    for (; skip > 0; skip--) {
        starts &= starts - 1;
    }
    return word * 64 + bits_lowest(starts);
}

/* Is this position behind the last reference of the cell that the position before it belongs to? */
static inline bool references_ended(const aset_references *references, uint32_t at) {
    return at == references->n || (references->starts[at >> 6] >> (at & 63) & 1) != 0;
}

#endif
