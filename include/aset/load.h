/*
 * load.h - readers: bytes in, entities out. Their own archive, libaset_load.a; fixed buffers, no malloc, no stdio.
 */
#ifndef ASET_LOAD_H
#define ASET_LOAD_H

#include "aset/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * The caller's way to more bytes: writes at most size bytes into buffer and returns how many (short reads are fine), 0 at
 * the end of the input, below 0 on failure.
 */
typedef ptrdiff_t (*aset_read)(void *context, void *buffer, size_t size);

typedef struct aset_load_options {
    bool one_sided_opaque; /* materials with T = 0 are one-sided (the SPD testing procedure) */
} aset_load_options;

/* What a reader says beside its status. On an error: where (the first byte of the token it could not take) and why. */
typedef struct aset_load_report {
    uint64_t offset;    /* bytes from the start of the input */
    uint32_t line;      /* counted from 1 */
    const char *what;   /* what is wrong, static text; NULL without an error */
    const char *expected; /* what was expected there, static text; NULL if there is nothing to add */
    char token[32];     /* the token in question, cut if longer, unprintable bytes as '?'; "" if none */
} aset_load_report;

/*
 * Reads a scene in the Neutral File Format (Haines 1987) and emits its entities into sink. Tokens decide, not lines. Takes
 * v, b, l, f, c, s, p, pp and comments; a view's hither is read and not used (it serves hidden-surface programs); objects
 * need a material and a view before them, and a file without a view is an error. options may be NULL for all defaults.
 *
 * ASET_ERR_SYNTAX: not NFF (letters for numbers, a number that is not finite or outside the range of aset_real, counts that
 * are not positive whole numbers, a file that ends within an entity, an empty one). ASET_ERR_GEOMETRY: a view without a
 * direction or with up along it. ASET_ERR_UNSUPPORTED: an object or effect that is switched off. Others: the sink's, at the
 * entity that it refused. ASET_ERR_READ: the callback failed. report (not NULL) tells the place.
 */
aset_status aset_load_nff(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report);

#ifdef __cplusplus
}
#endif
#endif
