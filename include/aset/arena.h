/*
 * arena.h - the caller's one block of memory, given out from its start upwards and accounted by category.
 */
#ifndef ASET_ARENA_H
#define ASET_ARENA_H

#include "aset/types.h"

ASET_HEADER_BEGIN

/* The one list of categories: it makes the enum, the accounting, the report's lines and the keys of its JSON. */
#define ASET_CATEGORIES(X)                                                                                             \
    X(OBJECTS, objects, "one record for each object")                                                                  \
    X(VERTICES, vertices, "coordinates, radii and vertex normals")                                                     \
    X(MATERIALS, materials, "materials and lights")                                                                    \
    X(CELLS, cells, "which cells are not empty, and their ranks")                                                      \
    X(REFERENCES, references, "which objects each cell refers to")                                                     \
    X(VOXELS, voxels, "what rays that start inside the volume test first")                                             \
    X(TEXTURES, textures, "the texture list and each cell's place in it")                                              \
    X(SCRATCH, scratch, "the stacks of rays, one for each thread")

typedef enum aset_category {
#define ASET_CATEGORY_ENUM(upper, lower, text) ASET_CATEGORY_##upper,
    ASET_CATEGORIES(ASET_CATEGORY_ENUM)
#undef ASET_CATEGORY_ENUM
        ASET_CATEGORY_COUNT
} aset_category;

/* Every allocation starts at, and is rounded up to, a multiple of this many bytes. */
#define ASET_ALIGN 8u
#define ASET_ROUND(bytes) (((size_t)(bytes) + (ASET_ALIGN - 1u)) / ASET_ALIGN * ASET_ALIGN)

/* The same of more bytes than a size_t may hold. */
#define ASET_ROUND_64(bytes) (((uint64_t)(bytes) + (ASET_ALIGN - 1u)) / ASET_ALIGN * ASET_ALIGN)

/* Declares, behind the word static, an aligned block of at least bytes bytes, for aset_arena_init(&arena, name, sizeof name). */
#define ASET_ARENA_BLOCK(name, bytes) uint64_t name[((size_t)(bytes) + 7u) / 8u]

/* The fields are for reading; only the functions below write them. */
typedef struct aset_arena {
    unsigned char *block;
    size_t size, used, peak;
    size_t used_by[ASET_CATEGORY_COUNT], peak_by[ASET_CATEGORY_COUNT];
    size_t missing; /* after ASET_ERR_NOMEM: the bytes by which the block was too small for the whole call */
} aset_arena;

/* A state to return to. */
typedef struct aset_mark {
    size_t used;
    size_t used_by[ASET_CATEGORY_COUNT];
} aset_mark;

/*
 * Starts an arena on the caller's block of size bytes, which must be aligned to ASET_ALIGN and stay valid as long as
 * anything in it is used. A size of 0 with any aligned block, or none, is allowed: every allocation of a byte then
 * fails. ASET_ERR_ARGUMENT: no arena,
 * no block of a size above 0, or a block that is not aligned.
 *
 * Everything begins here, so here the arithmetic is looked at: ASET_ERR_ARITHMETIC if the library was compiled to fuse a * b + c
 * into one rounding (-ffp-contract=off keeps it from that), or if the program at this moment rounds otherwise than to nearest or
 * flushes denormals to 0 (linking with -ffast-math does that). The methods' exact agreement, and the promise of the same picture
 * from every machine, need all three. (What the compiler shows of it by macros already fails when the library is compiled.)
 */
aset_status aset_arena_init(aset_arena *arena, void *block, size_t size);

/*
 * bytes bytes (rounded up to ASET_ALIGN), not cleared, accounted to category. NULL if they do not fit: then missing is set
 * and nothing else changed. For 0 bytes a pointer that must not be read.
 */
void *aset_arena_alloc(aset_arena *arena, size_t bytes, aset_category category);

/*
 * True if bytes more bytes, a multiple of ASET_ALIGN, fit; else false, and missing is set. A builder asks this once for its whole
 * need.
 */
bool aset_arena_fits(aset_arena *arena, size_t bytes);

aset_mark aset_arena_mark(const aset_arena *arena);

/* Gives back everything allocated since the mark was taken; peaks stay. */
void aset_arena_release(aset_arena *arena, const aset_mark *mark);

/* The category's key in reports ("objects") and a description in words; NULL outside the enum. */
const char *aset_category_name(aset_category category);
const char *aset_category_text(aset_category category);

ASET_HEADER_END
#endif
