/*
 * draft.h - a model that is only drafted: its surface as facets on the sides of a slice grid's cells, made from a stream of
 * entities of which none is kept, in memory that the divisions alone decide.
 *
 *     entities --> baker --> draft (an array of 32-bit words) --> tracer
 *                              |        ^
 *                              +-> file or const array
 *
 * A voxel has six sides, and each side hears only the surface that faces it: where it is (a 4 x 4 footprint), the plane that
 * lies best in it, the mean material. A ray that enters the voxel meets these planes, and nothing else is asked. That is the
 * paper's "one ray-polygon intersection per cell" (Dauenhauer and Semwal 1990, abstract), with its up and down sides.
 */
#ifndef ASET_DRAFT_H
#define ASET_DRAFT_H

#include "aset/scene.h"

ASET_HEADER_BEGIN

#if ASET_WITH_DRAFTS

/* Most divisions of an axis. */
#define ASET_BAKE_DIVISIONS_MAX 512u

/*
 * Objects that are far larger than the rest (a ground) spoil the slices and look crude as facets: up to so many are kept
 * exact beside the cells, of up to so many points each; a patch among them is kept without its normals.
 */
#define ASET_KEPT_MAX 16u
#define ASET_KEPT_POINTS_MAX 8u

/*
 * What a draft is drawn from. Its cells are seen from both sides, also those of one-sided materials, and no ray is curtailed in them.
 * The fields are private but words, n_words and stage, which are for reading.
 */
typedef struct aset_draft {
    const uint32_t *words; /* the whole draft: to be written to a file, or compiled in as a const array */
    size_t n_words;
    aset_scene stage;      /* background, view and lights as the source gave them, and the objects kept exact */
    const struct aset_answers *answers;
    const uint32_t *map, *rank, *marks, *first, *starts, *facets, *surfaces, *footprints, *textures;
    uint32_t n[3], blocks[3];
    uint32_t n_blocks, n_facets, n_surfaces, n_footprints, n_textures;
    unsigned surface_width, footprint_width, width; /* bits */
    aset_real low[3], size[3], per_size[3];         /* the box's corner, a column's size, its inverse */
    aset_real column;                               /* the mean of size */
    bool closes_seams;                              /* its voxels hold single surfaces, not many small things */
} aset_draft;

/* All zero is the default. */
typedef struct aset_bake_options {
    uint32_t divisions[3]; /* on x, y, z, 1 to ASET_BAKE_DIVISIONS_MAX each; all 0: cubic voxels, as many as bytes allow, at
                              most 128 on the longest axis */
    size_t bytes;          /* the most that the bake may take of the arena; 0: ASET_BYTES_BAKE of the divisions and the stage,
                              or more if the model turns out to need it, or what is free if that is less. Fewer bytes cost
                              more passes over the source; below 512 kB (1 MB in double), the stage, 8 bytes for each 64 voxels and 16
                              (32 in double) for each point of the largest polygon apart, also textures of cells with mixed materials */
    bool keep_none;        /* no object is kept exact */
} aset_bake_options;

/* The bytes that a bake takes unless told otherwise: it rarely needs more than one pass then. */
#define ASET_BYTES_BAKE(nx, ny, nz)                                                                                    \
    (((size_t)(nx) * (ny) + (size_t)(ny) * (nz) + (size_t)(nz) * (nx)) * 124u + (size_t)(nx) * (ny) * (nz) / 8u + 65536u)

/* What the bake did. */
typedef struct aset_bake_report {
    uint64_t objects;  /* in the source, kept ones included */
    uint64_t unseen;   /* of these, so small or thin that they meet no column's middle: they add nothing of their own */
    uint32_t kept;     /* exact beside the cells */
    uint32_t passes;   /* over the source */
    uint32_t voxels, facets;
    uint32_t textures, merged; /* merged: facets that had to share the nearest texture, for the list was full */
} aset_bake_report;

/* Private; hold it, 2.4 kB on a 64-bit machine. */
typedef struct aset_baker {
    aset_arena *arena;
    aset_bake_options options;
    aset_bake_report report;
    aset_mark mark;
    aset_counter counter;
    aset_scene stage;
    aset_sink stage_sink;
    int phase;
    aset_status failure;
    bool single, has_material, is_other, counting;
    uint64_t taken; /* objects in this pass */
    aset_material material, only;
    uint32_t n_materials;
    aset_real largest[ASET_KEPT_MAX + 1]; /* squared diagonals of the largest objects, in descending order */
    uint32_t n_largest, n_kept;
    aset_real kept_from;
    aset_vec3 low, high;      /* of what the cells hold */
    aset_real origin[3], scale[3], size[3]; /* scene to columns; a column's size */
    uint32_t n[3], blocks[3], max_points, n_lights;
    uint32_t floor_block, ceiling_block; /* this pass bakes the blocks from floor up to, not including, ceiling */
    aset_real *points;
    aset_real *crossings;
    uint64_t *marks;
    unsigned char *region, *after, *bins;
    uint32_t *keys;
    size_t region_bytes, bin_bytes;
    uint32_t capacity, n_bins;
    void *recent[6]; /* what each side found last, and under which key */
    uint32_t recent_keys[6];
    uint64_t *raw; /* one past the first facet; they grow downwards */
    uint32_t n_raw, n_listed, n_surfaces, n_footprints; /* the last three: when room for words was looked for */
    uint64_t n_counted;
    size_t n_words;
    aset_material *textures;
    uint32_t n_textures, texture_capacity;
    uint64_t parts[8]; /* of the current material */
} aset_baker;

/*
 * Prepares a bake in the arena's free bytes, which nobody else may use until it is finished. Then:
 *
 *     do {
 *         the source emits all its entities, in any order of objects, into aset_baker_sink(baker), or what it has as
 *         triangles by aset_baker_triangles;
 *         status = aset_baker_pass(baker, &again);
 *     } while (status == ASET_OK && again);
 *     status = aset_baker_finish(&draft, baker);
 *
 * Where the source fails, or an entity is refused, aset_baker_abandon(baker). The source must give the same entities each time. The
 * first pass measures, further ones bake: two in all for most models, one more if objects are kept exact, and more where memory is
 * short. options may be NULL. ASET_ERR_ARGUMENT: divisions out of range.
 */
aset_status aset_baker_init(aset_baker *baker, aset_arena *arena, const aset_bake_options *options);

/* Its functions check entities as a scene's do and answer alike; but coordinates end at 10^15 here, in double too. */
aset_sink aset_baker_sink(aset_baker *baker);

#if ASET_WITH_POLYGONS
/* n triangles of nine coordinates each, of the current material: the quick way in for models in memory. */
aset_status aset_baker_triangles(aset_baker *baker, const aset_real *coordinates, size_t n);
#endif

/*
 * Ends a pass. *again: the source is wanted once more. ASET_ERR_NOMEM: arena->missing tells the bytes that this pass lacked (at
 * least 1, too, where options.bytes is what is too small); a later one may lack others. ASET_ERR_GEOMETRY: the source gave no object,
 * or not as many objects, kept ones or lights as in the first pass; ASET_ERR_LIMIT: over 8 10^7 layers of surface in
 * one voxel, or 10^6 if the model has more than one material;
 * ASET_ERR_PRECISION, in double: between the ends of what the cells hold lie fewer than 64 of the floats that a draft's words are
 * made of, for the model is small and far from the origin. After an error the arena is as before the bake.
 */
aset_status aset_baker_pass(aset_baker *baker, bool *again);

/*
 * Gives up: the arena is as before aset_baker_init. For a source that fails within a pass, which then is not ended; at any time
 * before aset_baker_finish, and harmless after it or after an error.
 */
void aset_baker_abandon(aset_baker *baker);

/*
 * Makes the draft, in the arena: the words, and the stage. The result is the same, bit for bit, for every order of the objects
 * and every number of passes. ASET_ERR_ARGUMENT: a pass is still wanted; ASET_ERR_PRECISION: a light, the view or a kept
 * object cannot be told in the words' floats: in double it lies beyond their range, or its parts fall together; in float, too, where
 * one is so small in so large a model that nothing is left of it. Then the arena is as before the bake.
 */
aset_status aset_baker_finish(aset_draft *draft, aset_baker *baker);

/*
 * Opens a draft where it lies, in read-only memory if you like: only the stage takes some hundred bytes of the arena. words: in
 * the machine's own byte order, and valid as long as the draft is used. Every word is checked first, so that no broken or hostile
 * draft makes the library read outside of it: ASET_ERR_SYNTAX, and *why (unless why is NULL) says in a static sentence what is
 * wrong. ASET_ERR_UNSUPPORTED: objects or effects that are switched off; ASET_ERR_NOMEM.
 */
aset_status aset_draft_open(aset_draft *draft, const uint32_t *words, size_t n_words, aset_arena *arena, const char **why);

/* The mean material of a facet (aset_hit.cell of a ray that met the draft; below draft->n_facets). */
aset_material aset_draft_texture(const aset_draft *draft, uint32_t facet);

#endif

ASET_HEADER_END
#endif
