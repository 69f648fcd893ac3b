/*
 * space.h - where it is: a space subdivision built over a finished scene.
 *
 * A method is named by its constant, so that a program links only the methods it names:
 *   aset_brute   every object for every ray: the oracle
 *   aset_mset    equally spaced slices with marked cell sides (Logan 1989; Dauenhauer and Semwal 1990)
 */
#ifndef ASET_SPACE_H
#define ASET_SPACE_H

#include "aset/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct aset_method aset_method;

extern const aset_method aset_brute;
extern const aset_method aset_mset;

/* The word for a method in reports: "mset". */
const char *aset_method_name(const aset_method *method);

/* All zero is the default: divisions by aset_auto_divisions. */
typedef struct aset_space_options {
    uint32_t divisions[3]; /* on x, y, z: 1 to ASET_DIVISIONS_MAX each, or all 0 for automatic */
    size_t reserve;        /* automatic divisions leave so many bytes of the arena free, for a scratch, say */
    uint32_t textures;     /* and, unless 0, room for a summary of that capacity */
} aset_space_options;

#define ASET_DIVISIONS_MAX 2048u

/* What was built, counted the same way for every method (house definitions: a leaf is a smallest cell). */
typedef struct aset_structure {
    uint64_t interior;   /* inner nodes of a tree */
    uint64_t leaves;     /* MSET: cell sides, 2 sum of (n_a + 1) n_b n_c; brute force: 1 */
    uint64_t nonempty;   /* leaves that refer to an object */
    uint64_t references; /* objects in leaves, each as often as it stands there */
} aset_structure;

/* The bytes of a space, by category, and the counts that they follow from. */
typedef struct aset_space_size {
    size_t cells, references, voxels, total;
    uint32_t divisions[3];
    uint32_t n_blocks;     /* non-empty blocks of 4 x 4 x 4 voxels, counted for each face of a voxel */
    uint32_t n_cells;      /* non-empty cells (MSET: cell sides) */
    uint32_t n_references;
} aset_space_size;

/* Bits that hold the numbers 0 to n, as a constant expression: 1 to 32. */
#define ASET_WIDTH(n)                                                                                                  \
    (1u + (((n) >> 1) != 0) + (((n) >> 2) != 0) + (((n) >> 3) != 0) + (((n) >> 4) != 0) + (((n) >> 5) != 0) +          \
     (((n) >> 6) != 0) + (((n) >> 7) != 0) + (((n) >> 8) != 0) + (((n) >> 9) != 0) + (((n) >> 10) != 0) +              \
     (((n) >> 11) != 0) + (((n) >> 12) != 0) + (((n) >> 13) != 0) + (((n) >> 14) != 0) + (((n) >> 15) != 0) +          \
     (((n) >> 16) != 0) + (((n) >> 17) != 0) + (((n) >> 18) != 0) + (((n) >> 19) != 0) + (((n) >> 20) != 0) +          \
     (((n) >> 21) != 0) + (((n) >> 22) != 0) + (((n) >> 23) != 0) + (((n) >> 24) != 0) + (((n) >> 25) != 0) +          \
     (((n) >> 26) != 0) + (((n) >> 27) != 0) + (((n) >> 28) != 0) + (((n) >> 29) != 0) + (((n) >> 30) != 0) +          \
     (((n) >> 31) != 0))

/* Bytes of an array of count numbers of width bits. */
#define ASET_BYTES_PACKED(count, width) (((uint64_t)(count) * (width) + 63u) / 64u * 8u)

/* 64-bit words of the map of blocks, for faces cell sides a voxel (MSET: 6). */
#define ASET_BLOCK_WORDS(nx, ny, nz, faces)                                                                            \
    (((((uint64_t)(nx) + 3u) / 4u) * (((uint64_t)(ny) + 3u) / 4u) * (((uint64_t)(nz) + 3u) / 4u) * (faces) + 63u) / 64u)

/* Bytes of the marks: the map of blocks with a rank for each word; for each non-empty block its 64 marks and its rank. */
#define ASET_BYTES_CELLS(nx, ny, nz, faces, blocks)                                                                    \
    (ASET_ROUND(12u * ASET_BLOCK_WORDS(nx, ny, nz, faces)) + ASET_ROUND(12u * (uint64_t)(blocks)))

/* Bytes of the references: where each block's begin, one bit for each (set where a cell begins), and the object numbers. */
#define ASET_BYTES_REFERENCES(blocks, references, objects)                                                             \
    (ASET_ROUND(4u * (uint64_t)(blocks)) + ASET_BYTES_PACKED(references, 1u) +                                         \
     ASET_BYTES_PACKED(references, ASET_WIDTH(objects)))

/*
 * Bytes of an MSET in the arena: a constant expression of the divisions and of what the measuring pass counts (`aset info` prints
 * them): non-empty blocks, references, objects.
 */
#define ASET_BYTES_MSET(nx, ny, nz, blocks, references, objects)                                                       \
    ((size_t)(ASET_BYTES_CELLS(nx, ny, nz, 6u, blocks) + ASET_BYTES_REFERENCES(blocks, references, objects) +          \
              ASET_ROUND(ASET_LARGE_MAX * sizeof(aset_large))))

/*
 * Bytes of a summary of a space of so many non-empty cells with so many (at least 1) different textures (draft.h): the textures,
 * and for each cell the number of its own.
 */
#define ASET_BYTES_SUMMARY(cells, textures)                                                                            \
    (ASET_ROUND((size_t)(textures) * sizeof(aset_material)) +                                                          \
     (size_t)ASET_BYTES_PACKED(cells, ASET_WIDTH((uint32_t)(textures) - 1u)))

/* Brute force keeps nothing. */
#define ASET_BYTES_BRUTE ((size_t)0)

/* --- private fields, public so that you can hold them --- */

/* Slice k of axis a is the plane at low[a] + k width[a]. */
typedef struct aset_slices {
    aset_real low[3], width[3], per_width[3];
    uint32_t n[3];
} aset_slices;

typedef struct aset_cells {
    uint64_t *map;      /* a bit for each block: is any of its 64 cells marked? */
    uint32_t *map_rank; /* set bits before each word of the map */
    uint64_t *marks;    /* for each non-empty block, its 64 cells */
    uint32_t *first;    /* cells before each non-empty block: the dense number of its first */
    uint32_t bricks[3]; /* blocks along each axis */
    uint32_t faces, n_blocks, n_cells;
} aset_cells;

typedef struct aset_references {
    uint32_t *first;  /* references before each non-empty block */
    uint64_t *starts; /* a bit for each reference: is it its cell's first? */
    uint64_t *objects;
    unsigned width; /* bits of an object number */
    uint32_t n;
} aset_references;

/* An object whose box is much larger than the others', with its voxels. */
typedef struct aset_large {
    uint32_t object;
    uint16_t low[3], high[3];
} aset_large;

#define ASET_LARGE_MAX 16u

typedef struct aset_space {
    const aset_method *method;
    const aset_scene *scene;
    aset_structure structure;
    aset_slices slices;
    aset_cells cells;
    aset_references references;
    aset_large *large; /* sorted by object */
    uint32_t n_large;
    uint32_t reach[3]; /* voxels that the largest other box spans */
} aset_space;

/* --- end of private fields --- */

/*
 * The divisions taken when none are given: the same number on every axis (the paper's "grid size"), 4 for each cube root of the
 * number of objects, at most 128; 1 on an axis a thousand times thinner than the widest; and so few that the map of blocks
 * alone does not take half of budget bytes (0: no such bound).
 */
void aset_auto_divisions(const aset_scene *scene, size_t budget, uint32_t divisions[3]);

/*
 * What aset_space_build will take from the arena for these options, exactly, without taking it. The counts need a bitmap: it
 * stands in the arena's free bytes (nothing is accounted), or in a kilobyte of the stack if arena is NULL; the less there is,
 * the more passes over the objects. ASET_ERR_ARGUMENT: divisions out of range; ASET_ERR_LIMIT: over 2^32 - 2 references.
 */
aset_status aset_space_measure(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                               const aset_space_options *options, aset_arena *arena);

/*
 * Builds a space over the scene, which must not change afterwards and must outlive it. options NULL: all defaults, and then the
 * automatic divisions go down until they fit. On ASET_ERR_NOMEM arena->missing is what was missing for the whole space,
 * and arena and space are as before. Errors otherwise as aset_space_measure.
 */
aset_status aset_space_build(aset_space *space, const aset_scene *scene, const aset_method *method,
                             const aset_space_options *options, aset_arena *arena);

#ifdef __cplusplus
}
#endif
#endif
