/*
 * flat.h - a space and its summary made from a stream of entities of which none is kept: for pictures in which every ray is
 * approximate.
 *
 *     entities --> aset_flat --> stage, space, summary --> tracer
 *
 * What an approximate ray reads, marked cells and average textures, does not say which object is where; so no list of
 * references and no object is needed, only the objects' boxes and materials as they come by, and memory is the divisions' and
 * the marked cells'. The space, the summary and every picture are the same, bit for bit, as those of aset_space_build and
 * aset_summary_build over the whole scene.
 */
#ifndef ASET_FLAT_H
#define ASET_FLAT_H

#include "aset/summary.h"

ASET_HEADER_BEGIN

#if ASET_WITH_APPROXIMATION

/* Private but passes and least; hold it, about 3 kB, until it is finished. */
typedef struct aset_flat {
    aset_counter counter;
    aset_sink checks, stage_sink; /* the counter's, the stage's */
    aset_counts counts; /* of the source, and its box */
    aset_vec3 low, high;
    aset_arena *arena;
    aset_mark mark, stage_mark, work_mark;
    aset_space_options options;
    aset_scene stage;
    aset_space space;
    aset_summary summary;
    int phase;
    bool is_auto, is_first;
    uint64_t parts[8], common[8], step[9]; /* of the current material; of the first; what the current one adds to a sum */
    uint64_t largest_part;
    unsigned differing; /* bits of the parts that differ among materials in use */
    uint32_t n_differing;
    uint64_t *known; /* materials met, by the parts that differ */
    uint32_t n_known, known_max, number; /* number: the current one's among them, from 1; 0: not looked up */
    uint64_t *wide; /* of each cell: first its only material's number or that there are several, then its texture's */
    unsigned wide_width; /* bits of one */
    uint32_t *before; /* for each 16 cells in hand: cells of several materials before them */
    uint64_t *sums;
    uint32_t n_mixed, sum_words, sums_max; /* cells of several materials; 64-bit words of a sum; sums there is room for */
    uint32_t from_cell, until_cell;        /* in hand in this pass */
    int32_t last[6]; /* the box of voxels of the object before, and its number */
    uint32_t last_number;
    bool has_last, has_added; /* has_added: it was part of a sum */
    uint32_t passes; /* over the source, without the counter's */
    size_t least;    /* at the end: the fewest free bytes of the arena that are enough for these divisions and this order of objects;
                        another one may take others where there are more than 254 materials */
} aset_flat;

/*
 * Prepares the space and summary of a source that counter has counted, in the arena's free bytes, which nobody else may use
 * until it is finished. Then:
 *
 *     do {
 *         the source emits the same entities again, its objects in any order, into aset_flat_sink(flat);
 *         status = aset_flat_pass(flat, &again);
 *     } while (status == ASET_OK && again);
 *     status = aset_flat_finish(&stage, &space, &summary, flat);
 *
 * method: &aset_mset or &aset_grid. Of options (NULL: all defaults) divisions, reserve and textures count, the last as the
 * summary's capacity (0: as for aset_summary_build). Two passes where all objects look alike, three where no cell has objects of
 * several materials, four else; where memory is short up to 11. Automatic divisions go down until they fit, each step for up
 * to four more passes. ASET_ERR_ARGUMENT: another method, divisions or a capacity out of range; ASET_ERR_PRECISION as
 * aset_space_build; ASET_ERR_NOMEM as aset_flat_pass.
 */
aset_status aset_flat_init(aset_flat *flat, aset_arena *arena, const aset_counter *counter, const aset_method *method,
                           const aset_space_options *options);

/* Its functions check entities as a scene's do and answer alike. */
aset_sink aset_flat_sink(aset_flat *flat);

/*
 * Ends a pass. *again: the source is wanted once more. ASET_ERR_NOMEM: with arena->missing more bytes the next try succeeds
 * or tells what else is missing; in the end that is least, to the byte. More than that, at most 72 bytes for each cell of
 * several materials, saves passes. ASET_ERR_GEOMETRY: other entities than the counter's; ASET_ERR_LIMIT: over 2^32 - 2 cells, or
 * sums that could leave 64 bits. After an error the arena is as before aset_flat_init. Where the source itself fails within a pass,
 * this is still to be called: it tells other entities, and gives the arena back.
 */
aset_status aset_flat_pass(aset_flat *flat, bool *again);

/*
 * Gives what was made: a scene that has background, view, lights and the box of objects that it does not hold, a space over
 * it for approximate rays alone, and its summary. They lie in the arena and point to each other, so they stay where they are.
 * With a tracer of these in which every kind is approximate from depth 0, everything is as with a whole scene.
 * ASET_ERR_ARGUMENT: a pass is still wanted, or one failed.
 */
aset_status aset_flat_finish(aset_scene *stage, aset_space *space, aset_summary *summary, aset_flat *flat);

#endif

ASET_HEADER_END
#endif
