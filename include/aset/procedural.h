/*
 * procedural.h - scenes made by rule instead of read. Their own archive, libaset_procedural.a.
 */
#ifndef ASET_PROCEDURAL_H
#define ASET_PROCEDURAL_H

#include "aset/scene.h"

ASET_HEADER_BEGIN

/*
 * Emits one scene into sink: view, background, lights, then materials and objects. size 0 takes the scene's default size.
 * ASET_ERR_ARGUMENT: a size above the scene's largest; ASET_ERR_UNSUPPORTED: it needs a kind of object that is switched off;
 * otherwise the sink's first error or ASET_OK. The same arguments emit the same entities, always.
 */
typedef aset_status (*aset_procedural_emit)(const aset_sink *sink, uint32_t size);

typedef struct aset_procedural {
    const char *name;
    const char *text; /* one line: what it is and what size means */
    uint32_t default_size, largest_size;
    aset_procedural_emit emit;
} aset_procedural;

/* The scene number index, counted from 0, or NULL behind the last: for listing them. */
const aset_procedural *aset_procedural_at(size_t index);

/* The scene of that name (balls, gears, mount, rings, teapot, tetra, tree, snow, tetra-moon, skull), or NULL. */
const aset_procedural *aset_procedural_find(const char *name);

ASET_HEADER_END
#endif
