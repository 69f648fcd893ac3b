/*
 * space.h - where it is: a space subdivision built over a finished scene.
 *
 * A method is named by its constant, so that a program links only the methods it names:
 *   aset_brute    every object for every ray: the oracle
 *   aset_set      slices where the objects' extents are (Semwal 1987)
 *   aset_mset     equally spaced slices with marked cell sides (Logan 1989; Dauenhauer and Semwal 1990)
 *   aset_grid     equal voxels (Fujimoto et al. 1986; Amanatides and Woo 1987)
 *   aset_octree   halving in three axes, next leaf by descent (Glassner 1984)
 *   aset_arts     the octree with the 3DDA of its finest level (Fujimoto et al. 1986)
 *   aset_excell   halving in turn, next bucket by a directory (Tamminen 1981)
 */
#ifndef ASET_SPACE_H
#define ASET_SPACE_H

#include "aset/scene.h"

ASET_HEADER_BEGIN

typedef struct aset_method aset_method;

extern const aset_method aset_brute, aset_set, aset_mset, aset_grid, aset_octree, aset_arts, aset_excell;

/* The word for a method in reports: "mset". */
const char *aset_method_name(const aset_method *method);

/* All zero is the default: divisions by aset_auto_divisions. */
typedef struct aset_space_options {
    uint32_t divisions[3]; /* MSET, grid: on x, y, z, 1 to ASET_DIVISIONS_MAX each, or all 0 for automatic. SET: the most
                              voxels on each axis */
    uint32_t depth; /* octree, ARTS, EXCELL: halvings of each axis at the most, 1 to ASET_DEPTH_TREE_MAX; 0 for 6, or less
                       where that does not fit */
    uint32_t leaf;  /* octree, ARTS, EXCELL: objects in a leaf that is not halved any more; 0 means 1 */
    size_t reserve;        /* automatic divisions leave so many bytes of the arena free, for a scratch, say */
    uint32_t textures;     /* and, unless 0, room for a summary of that capacity, at most ASET_TEXTURES_MAX */
} aset_space_options;

#define ASET_DIVISIONS_MAX 2048u
#define ASET_DEPTH_TREE_MAX 10u
#define ASET_TEXTURES_MAX 65536u

/* What was built, counted the same way for every method (house definitions: a leaf is a smallest cell). */
typedef struct aset_structure {
    uint64_t interior;   /* inner nodes of a tree */
    uint64_t leaves;     /* MSET: cell sides, 2 sum of (n_a + 1) n_b n_c; brute force: 1 */
    uint64_t nonempty;   /* leaves that refer to an object */
    uint64_t references; /* objects in leaves, each as often as it stands there */
    uint64_t merged;     /* SET: extents that got no slice of their own, for there were more than the cap */
} aset_structure;

/* The bytes of a space, by category, and the counts that they follow from. */
typedef struct aset_space_size {
    size_t cells, references, voxels;
    size_t scratch; /* while building only */
    size_t reused;  /* of it, what cells, references and voxels take afterwards (SET) */
    size_t total;   /* the arena's need while building: all of these, what is reused counted once */
    uint32_t divisions[3];
    uint32_t n_cells;      /* non-empty cells (MSET, SET: cell sides) */
    uint32_t n_references;
    uint32_t n_blocks;     /* MSET, SET, grid: non-empty blocks of 4 x 4 x 4 voxels, counted for each face of a voxel */
    uint32_t n_nodes;      /* octree, ARTS: nodes; EXCELL: cells of the directory */
    uint32_t n_leaves;     /* octree, ARTS, EXCELL: leaves, empty ones included */
    uint32_t depth, leaf;  /* octree, ARTS, EXCELL: the limits taken */
    uint64_t listed;       /* octree, ARTS, EXCELL: object numbers listed at once while building */
    size_t planes;         /* SET: bytes of the table of slices, part of cells */
    uint32_t caps[3];      /* SET: the most voxels asked for; divisions are those made */
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
#define ASET_BYTES_PACKED(count, width)                                                                                \
    ((uint64_t)(count) * (width) >> (8u * sizeof(size_t) - 1u) > 1u ? (uint64_t)1 << (8u * sizeof(size_t) - 1u)        \
                                                                    : ((uint64_t)(count) * (width) + 63u) / 64u * 8u)

/* 64-bit words of the map of blocks, for faces cell sides a voxel (MSET: 6). */
#define ASET_BLOCK_WORDS(nx, ny, nz, faces)                                                                            \
    (((((uint64_t)(nx) + 3u) / 4u) * (((uint64_t)(ny) + 3u) / 4u) * (((uint64_t)(nz) + 3u) / 4u) * (faces) + 63u) / 64u)

/* Bytes of the marks: the map of blocks with a rank for each word; for each non-empty block its 64 marks and its rank. */
#define ASET_BYTES_CELLS(nx, ny, nz, faces, blocks)                                                                    \
    (ASET_ROUND_64(12u * ASET_BLOCK_WORDS(nx, ny, nz, faces)) + ASET_ROUND_64(12u * (uint64_t)(blocks)))

/* Bytes of the references: where each block's begin, one bit for each (set where a cell begins), and the object numbers. */
#define ASET_BYTES_REFERENCES(blocks, references, objects)                                                             \
    (ASET_ROUND_64(4u * (uint64_t)(blocks)) + ASET_BYTES_PACKED(references, 1u) +                                       \
     ASET_BYTES_PACKED(references, ASET_WIDTH(objects)))

/*
 * Bytes of an MSET in the arena: a constant expression of the divisions and of what the measuring pass counts (`aset info`
 * prints them): non-empty blocks, references, objects.
 */
#define ASET_BYTES_MSET(nx, ny, nz, blocks, references, objects)                                                       \
    ((size_t)(ASET_BYTES_CELLS(nx, ny, nz, 6u, blocks) + ASET_BYTES_REFERENCES(blocks, references, objects) +          \
              ASET_ROUND(ASET_LARGE_MAX * sizeof(aset_large))))

/* SET: the table of slices besides; before the marks take that place, both ends of every object. */
#define ASET_BYTES_SET(nx, ny, nz, blocks, references, objects)                                                        \
    (ASET_ROUND(((size_t)(nx) + (ny) + (nz) + 3u) * sizeof(aset_real)) +                                               \
     (ASET_BYTES_MSET(nx, ny, nz, blocks, references, objects) > ASET_ROUND(2u * (size_t)(objects) * sizeof(aset_real)) \
          ? ASET_BYTES_MSET(nx, ny, nz, blocks, references, objects)                                                   \
          : ASET_ROUND(2u * (size_t)(objects) * sizeof(aset_real))))

/* Grid: blocks and references of voxels, and every object's box. */
#define ASET_BYTES_GRID(nx, ny, nz, blocks, references, objects)                                                       \
    ((size_t)(ASET_BYTES_CELLS(nx, ny, nz, 1u, blocks) + ASET_BYTES_REFERENCES(blocks, references, objects) +          \
              ASET_ROUND((uint64_t)(objects) * sizeof(aset_box))))

/* References of the leaves that are not empty, and every object's box; as they are, and as a size. */
#define ASET_BYTES_LEAVES_64(leaves, references, objects)                                                              \
    (ASET_ROUND_64(4u * ((uint64_t)(leaves) + 1u)) + ASET_BYTES_PACKED(references, ASET_WIDTH(objects)) +              \
     ASET_ROUND_64((uint64_t)(objects) * sizeof(aset_box)))
#define ASET_BYTES_LEAVES(leaves, references, objects) ((size_t)ASET_BYTES_LEAVES_64(leaves, references, objects))

/* Octree and ARTS: a word for each node; listed: object numbers on lists while it is built. leaves: those not empty. */
#define ASET_BYTES_OCTREE(nodes, leaves, references, objects, listed)                                                  \
    (ASET_ROUND(4u * (size_t)(nodes)) + ASET_BYTES_LEAVES(leaves, references, objects) +                               \
     ASET_ROUND(4u * (size_t)(listed)))
#define ASET_BYTES_ARTS ASET_BYTES_OCTREE

/* EXCELL: the directory's cells name their bucket; a byte for each bucket's depth. leaves: buckets that are not empty. */
#define ASET_BYTES_EXCELL(directory, buckets, leaves, references, objects, listed)                                     \
    ((size_t)ASET_BYTES_PACKED(directory, ASET_WIDTH(buckets)) + ASET_ROUND(buckets) +                                 \
     ASET_BYTES_LEAVES(leaves, references, objects) + ASET_ROUND(4u * (size_t)(listed)))

/*
 * Bytes of a summary of a space of so many non-empty cells with so many (at least 1) different textures (summary.h): the
 * textures, and for each cell the number of its own.
 */
#define ASET_BYTES_SUMMARY(cells, textures)                                                                            \
    (ASET_ROUND((size_t)(textures) * sizeof(aset_material)) +                                                          \
     (size_t)ASET_BYTES_PACKED(cells, ASET_WIDTH((uint32_t)(textures) - 1u)))

/* Brute force keeps nothing. */
#define ASET_BYTES_BRUTE ((size_t)0)

/* --- private fields, public so that you can hold them --- */

/*
 * Slice k of axis a is the plane at low[a] + k width[a], but the first and the last are at first[a] and last[a], a little
 * outside the scene; or all are in planes[a] if there is a table.
 */
typedef struct aset_slices {
    const aset_real *planes[3];
    aset_real low[3], width[3], per_width[3], first[3], last[3];
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

/* An object's box of voxels, both ends included. */
typedef struct aset_box {
    uint16_t low[3], high[3];
} aset_box;

/* An object whose box is much larger than the others', with its voxels. */
typedef struct aset_large {
    uint32_t object;
    uint16_t low[3], high[3];
} aset_large;

#ifndef ASET_LARGE_MAX
#define ASET_LARGE_MAX 16u
#endif
#if ASET_LARGE_MAX < 1 || ASET_LARGE_MAX > 16 || (ASET_LARGE_MAX != 16 && !ASET_HOSTILE)
#error "ASET_LARGE_MAX is 16, for library and program are to agree on sizes; a hostile build may take 1 to 16"
#endif

typedef struct aset_space {
    const aset_method *method;
    const struct aset_answers *answers; /* exact rays */
    const aset_scene *scene;
    bool is_flat; /* without references and objects (flat.h): for approximate rays alone */
    aset_structure structure;
    aset_slices slices;
    aset_cells cells;
    aset_references references;
    aset_large *large; /* MSET, SET: sorted by object */
    uint32_t n_large;
    uint32_t reach;    /* voxels that the largest other box spans on any axis */
    aset_box *boxes;   /* all others: of every object */
    uint32_t *nodes;   /* octree, ARTS */
    uint32_t depth;    /* of the tree; EXCELL: halvings of the directory */
    uint64_t *directory; /* EXCELL: each cell's bucket, packed */
    unsigned directory_width;
    uint8_t *bucket_depth;
} aset_space;

/* --- end of private fields --- */

/*
 * The divisions taken when none are given: cubic voxels, 64 for each object in the scene's box (the rule of Lagae and Dutre 2008,
 * M_a = S_a cbrt(rho N / V), with rho = 64, chosen by measurement: DESIGN.md), at most 512 an axis; an axis a thousand times
 * thinner than the widest counts as that thick and gets one division; and so few that MSET's map of blocks alone does not
 * take half of budget bytes (0: no such bound).
 */
void aset_auto_divisions(const aset_scene *scene, size_t budget, uint32_t divisions[3]);

/*
 * What aset_space_build will take from the arena for these options, exactly, without taking it. Counting works in the
 * arena's free bytes (nothing is accounted), or in a kilobyte of the stack if arena is NULL. Automatic divisions are those that
 * build begins with: where they do not fit it goes on to coarser ones. Brute force, MSET and grid
 * manage with any scratch; the less there is, the more passes over the objects. The others need what they need while
 * building: too little of it is ASET_ERR_NOMEM, with arena->missing and size->scratch telling what would be enough for any
 * scene of so many objects. ASET_ERR_ARGUMENT: divisions, depth or leaf out of range; ASET_ERR_LIMIT: over 2^32 - 2
 * references; ASET_ERR_PRECISION: between the ends of the scene, on its longest axis, lie fewer than 64 of the numbers that its
 * largest coordinate has for neighbours, and not none at all. In float that is a scene more than 131,072 times its size away
 * from the origin: move it there.
 */
aset_status aset_space_measure(aset_space_size *size, const aset_scene *scene, const aset_method *method,
                               const aset_space_options *options, aset_arena *arena);

/*
 * Builds a space over the scene, which must not change afterwards and must outlive it. options NULL: all defaults, and then
 * the automatic divisions go down until they fit. On ASET_ERR_NOMEM arena->missing is what was missing for the whole space
 * (brute force, MSET, grid), or at least for finding that out (the others): so with that much more, the next try builds or
 * tells the rest. Arena and space are as before. Errors otherwise as aset_space_measure.
 */
aset_status aset_space_build(aset_space *space, const aset_scene *scene, const aset_method *method,
                             const aset_space_options *options, aset_arena *arena);

ASET_HEADER_END
#endif
